//! One moment of a scene: what may differ from frame to frame while everything else stays.
//!
//! In: placements by index. Out: the same placements in a [`Scene`].

use crate::{Mesh, Scene};
use glam::{DAffine3, DMat3};
use zfail_plan::light::LightKind;

/// Where everything is that an animation can move; each list has the indices of the [`Scene`] that it belongs to.
///
/// A list may be shorter than the scene's: what it does not reach stays where it is.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Pose {
    /// Per instance, object to world; invertible.
    pub instances: Vec<DAffine3>,
    /// Per light, its placement and reach.
    pub lights: Vec<LightKind>,
    /// Per light, world from its own space: [`crate::LightShape::axes`].
    pub light_axes: Vec<DMat3>,
    /// Per camera, view to world: rotation and translation only.
    pub cameras: Vec<DAffine3>,
    /// Of every mesh that bends, in the order of the scene's meshes.
    pub bent: Vec<BentMesh>,
}

/// The vertices of a mesh that bends: skins and morph targets, computed once for all who read them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct BentMesh {
    /// Index into [`Scene::meshes`].
    pub mesh: usize,
    /// As [`crate::Mesh::positions`], of the same length.
    pub positions: Vec<[f32; 3]>,
    /// As [`crate::Mesh::normals`], of the same length.
    pub normals: Vec<[f32; 3]>,
    /// As [`crate::Mesh::tangents`], of the same length.
    pub tangents: Vec<[f32; 4]>,
}

impl Pose {
    /// The pose in which `scene` is.
    #[must_use]
    pub fn of(scene: &Scene) -> Self {
        let mut pose = Self::default();
        pose.take(scene);
        pose
    }

    /// Becomes the pose in which `scene` is, in the memory that it has.
    pub fn take(&mut self, scene: &Scene) {
        self.instances.clear();
        self.instances.extend(scene.instances.iter().map(|instance| instance.world_from_object));
        self.lights.clear();
        self.lights.extend(scene.lights.iter().map(|light| light.kind));
        self.light_axes.clear();
        self.light_axes.extend(scene.lights.iter().map(|light| light.shape.axes));
        self.cameras.clear();
        self.cameras.extend(scene.cameras.iter().map(|camera| camera.world_from_view));
        let bending = || scene.meshes.iter().enumerate().filter(|(_, mesh)| mesh.bends());
        self.bent.resize_with(bending().count(), BentMesh::default);
        for (bent, (index, mesh)) in self.bent.iter_mut().zip(bending()) {
            bent.mesh = index;
            bent.take(mesh);
        }
    }
}

impl BentMesh {
    /// Becomes the vertices of `mesh` as it is, in the memory that it has.
    pub fn take(&mut self, mesh: &Mesh) {
        self.positions.clone_from(&mesh.positions);
        self.normals.clone_from(&mesh.normals);
        self.tangents.clone_from(&mesh.tangents);
    }

    /// Whether these can be the vertices of `mesh`.
    #[must_use]
    pub fn fits(&self, mesh: &Mesh) -> bool {
        let lengths = |p: usize, n: usize, t: usize| [p, n, t];
        mesh.bends()
            && lengths(self.positions.len(), self.normals.len(), self.tangents.len())
                == lengths(mesh.positions.len(), mesh.normals.len(), mesh.tangents.len())
    }
}

impl Scene {
    /// Moves everything to where `pose` has it. Entries beyond the scene's own are ignored, and so are bent meshes that
    /// do not fit the scene's.
    pub fn set_pose(&mut self, pose: &Pose) {
        for (instance, world_from_object) in self.instances.iter_mut().zip(&pose.instances) {
            instance.world_from_object = *world_from_object;
        }
        for (light, kind) in self.lights.iter_mut().zip(&pose.lights) {
            light.kind = *kind;
        }
        for (light, axes) in self.lights.iter_mut().zip(&pose.light_axes) {
            light.shape.axes = *axes;
        }
        for (camera, world_from_view) in self.cameras.iter_mut().zip(&pose.cameras) {
            camera.world_from_view = *world_from_view;
        }
        for bent in &pose.bent {
            if let Some(mesh) = self.meshes.get_mut(bent.mesh).filter(|mesh| bent.fits(mesh)) {
                mesh.positions.clone_from(&bent.positions);
                mesh.normals.clone_from(&bent.normals);
                mesh.tangents.clone_from(&bent.tangents);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Instance;
    use glam::DVec3;

    fn instance(x: f64) -> Instance {
        let world_from_object = DAffine3::from_translation(DVec3::X * x);
        Instance { name: String::new(), mesh: 0, world_from_object, casts_shadow: true, receives_shadow: true }
    }

    #[test]
    fn a_pose_taken_and_set_changes_nothing_else() {
        let mut scene = Scene { instances: vec![instance(1.0), instance(2.0)], ..Scene::default() };
        let rest = Pose::of(&scene);
        let mut moved = rest.clone();
        moved.instances[1] = DAffine3::from_translation(DVec3::Y);
        scene.set_pose(&moved);
        assert_eq!(Pose::of(&scene), moved);
        assert_ne!(Pose::of(&scene), rest);
        scene.set_pose(&rest);
        assert_eq!(Pose::of(&scene), rest);
    }

    #[test]
    fn only_meshes_that_bend_are_bent() {
        let triangle = |alike: &[u32]| Mesh {
            positions: vec![[0.0; 3]; 3],
            triangles: vec![[0, 1, 2]],
            alike: alike.to_vec(),
            ..Mesh::default()
        };
        let mut scene = Scene { meshes: vec![triangle(&[]), triangle(&[0, 1, 2])], ..Scene::default() };
        let mut pose = Pose::of(&scene);
        assert_eq!(pose.bent.iter().map(|bent| bent.mesh).collect::<Vec<_>>(), [1]);
        pose.bent[0].positions[2] = [1.0; 3];
        scene.set_pose(&pose);
        assert_eq!(scene.meshes[1].positions[2], [1.0; 3]);
        assert_eq!(Pose::of(&scene), pose);
        let rigid = BentMesh { mesh: 0, ..pose.bent[0].clone() };
        let short = BentMesh { positions: vec![[2.0; 3]; 2], ..pose.bent[0].clone() };
        scene.set_pose(&Pose {
            bent: vec![rigid, short, BentMesh { mesh: 7, ..BentMesh::default() }],
            ..Pose::default()
        });
        assert_eq!(Pose::of(&scene), pose);
        assert_eq!(scene.meshes[0].positions[2], [0.0; 3]);
    }

    #[test]
    fn lists_of_other_lengths_are_no_fault() {
        let mut scene = Scene { instances: vec![instance(1.0), instance(2.0)], ..Scene::default() };
        scene.set_pose(&Pose { instances: vec![DAffine3::IDENTITY], ..Pose::default() });
        assert_eq!(scene.instances[0].world_from_object, DAffine3::IDENTITY);
        assert_eq!(scene.instances[1].world_from_object.translation, DVec3::X * 2.0);
        scene.set_pose(&Pose { instances: vec![DAffine3::IDENTITY; 9], ..Pose::default() });
        assert_eq!(scene.instances.len(), 2);
    }
}
