//! The scene as plain data: meshes, materials, instances, lights and cameras in world space.
//!
//! In: what a loader or a generator fills. Out: read-only input of topology, plan, renderer and oracle.

use crate::{AlphaMode, Camera, Ground, Image, Light, MaskCasting, Material, Mesh, Sky, Texture};
use glam::{DAffine3, DVec3};
use zfail_plan::bounds::Bounds;
use zfail_plan::topology::Blocking;

/// A posed scene: one moment of it, everything in world space.
#[derive(Clone, Debug, Default)]
pub struct Scene {
    /// Name for reports: the file's stem or the generator's name.
    pub name: String,
    /// Triangle meshes, each in its own object space.
    pub meshes: Vec<Mesh>,
    /// Materials, referred to by [`crate::Primitive::material`].
    pub materials: Vec<Material>,
    /// Textures: an image and how it is sampled.
    pub textures: Vec<Texture>,
    /// Decoded images.
    pub images: Vec<Image>,
    /// Placed meshes, in depth-first order of the nodes that hold them.
    pub instances: Vec<Instance>,
    /// Lights, in depth-first order of the nodes that hold them.
    pub lights: Vec<Light>,
    /// Cameras, in depth-first order of the nodes that hold them.
    pub cameras: Vec<Camera>,
    /// What masked surfaces are to light.
    pub mask_casting: MaskCasting,
    /// Ambient radiance that reaches every surface, linear RGB.
    pub ambient: [f32; 3],
    /// Radiance of pixels that see no surface, linear RGB.
    pub background: [f32; 3],
    /// A sky whose light comes from all sides, beside [`Scene::ambient`].
    pub sky: Option<Sky>,
    /// A ground that shows shadows and is otherwise not there.
    pub ground: Option<Ground>,
    /// The stops that suit the lights, for automatic exposure to take instead of measuring the picture: set where lights
    /// and surroundings were made for each other.
    pub exposure: Option<f32>,
    /// Whether blended and transmissive surfaces cast shadows, as solid ones do.
    pub blended_casts: bool,
    /// What the loader repaired, replaced or left out, for the user to read.
    pub notices: Vec<String>,
}

/// A mesh placed in the world.
#[derive(Clone, Debug)]
pub struct Instance {
    /// The node's name, or an invented one.
    pub name: String,
    /// Index into [`Scene::meshes`].
    pub mesh: usize,
    /// Object to world; invertible (loaders bake flattened nodes into meshes of their own), may mirror.
    pub world_from_object: DAffine3,
    /// Whether its triangles block light (node extras `castShadow`, inherited).
    pub casts_shadow: bool,
    /// Whether shadows fall on it; a label or another annotation is lit whatever stands between it and a light (McGuire et al.
    /// section 8; node extras `receiveShadow`, inherited).
    pub receives_shadow: bool,
}

impl Scene {
    /// A world-space box around all instances, including those that cast no shadow; empty for an empty scene. It is made
    /// of the boxes of meshes, so it may be larger than what it holds where those are turned; see [`Self::tight_bounds`].
    #[must_use]
    pub fn bounds(&self) -> Bounds {
        let of_mesh: Vec<Bounds> = self.meshes.iter().map(Mesh::bounds).collect();
        let mut bounds = Bounds::EMPTY;
        for instance in &self.instances {
            let world = of_mesh[instance.mesh].transformed(&instance.world_from_object);
            if !world.is_empty() {
                bounds.add(world.min);
                bounds.add(world.max);
            }
        }
        bounds
    }

    /// The smallest world-space box around all triangles of all instances; empty for an empty scene. Unlike
    /// [`Self::bounds`] it reads every vertex of every instance.
    #[must_use]
    pub fn tight_bounds(&self) -> Bounds {
        let used: Vec<Vec<u32>> = self.meshes.iter().map(Mesh::used_vertices).collect();
        Bounds::of(self.instances.iter().flat_map(|instance| {
            let (mesh, world_from_object) = (&self.meshes[instance.mesh], &instance.world_from_object);
            used[instance.mesh].iter().map(|&v| world_from_object.transform_point3(mesh.position(v)))
        }))
    }

    /// Whether triangle `triangle` of mesh `mesh` blocks light at all: blended materials let it through unless
    /// [`Scene::blended_casts`], and masked ones where [`Scene::mask_casting`] says so.
    #[must_use]
    pub fn triangle_casts(&self, mesh: usize, triangle: usize) -> bool {
        self.triangle_blocking(mesh, triangle) != Blocking::Nothing
    }

    /// What triangle `triangle` of mesh `mesh` is to light and to the depth buffer.
    #[must_use]
    pub fn triangle_blocking(&self, mesh: usize, triangle: usize) -> Blocking {
        let Some(material) = self.meshes[mesh].material_of(triangle).map(|m| &self.materials[m]) else {
            return Blocking::Front;
        };
        match material.alpha {
            // No depth pass draws it.
            _ if material.is_blended() && self.blended_casts => Blocking::Partly,
            _ if material.is_blended() => Blocking::Nothing,
            AlphaMode::Mask(_) if self.mask_casting == MaskCasting::Off => Blocking::Nothing,
            AlphaMode::Mask(_) => Blocking::Partly,
            _ if material.double_sided => Blocking::BothSides,
            _ => Blocking::Front,
        }
    }
}

/// Vertices of triangle `t` of `mesh` in world space.
#[must_use]
pub fn world_triangle(mesh: &Mesh, world_from_object: &DAffine3, t: usize) -> [DVec3; 3] {
    mesh.triangles[t].map(|v| {
        let p = mesh.positions[v as usize];
        world_from_object.transform_point3(DVec3::new(p[0].into(), p[1].into(), p[2].into()))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tight_bounds_hold_vertices_and_not_their_boxes() {
        // A diamond in its mesh, which is a square in the world; and a vertex that no triangle uses.
        let positions =
            [[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0], [9.0, 9.0]].map(|[x, y]| [x, y, 0.0]).to_vec();
        let mesh = Mesh { positions, triangles: vec![[0, 1, 2], [0, 2, 3]], ..Mesh::default() };
        let world_from_object = DAffine3::from_rotation_z(std::f64::consts::FRAC_PI_4);
        let instance =
            Instance { name: String::new(), mesh: 0, world_from_object, casts_shadow: false, receives_shadow: true };
        let scene = Scene { meshes: vec![mesh], instances: vec![instance], ..Scene::default() };
        let half = |bounds: Bounds| bounds.half().truncate();
        assert!((half(scene.tight_bounds()) - glam::DVec2::splat(0.5_f64.sqrt())).length() < 1e-12);
        assert!(half(scene.bounds()).x > 1.4, "boxes of turned boxes are larger, or this test could not fail");
        assert!(Scene::default().tight_bounds().is_empty());
    }
}
