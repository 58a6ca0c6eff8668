//! What figures need to know of a scene, and where its vertices are.
//!
//! In: a scene and its poses. Out: casters and lights for planning, and positions relative to an anchor amid the scene, so
//! that single precision suffices whatever the scene's place. Surfaces and volumes take positions from [`Place`] alone: a
//! light cap has the very depths of the surface that it lies on.

use crate::{Error, palette};
use std::collections::HashMap;
use std::sync::OnceLock;
use zfail_plan::bounds::Bounds;
use zfail_plan::glam::{DAffine3, DMat4, DVec3, DVec4};
use zfail_plan::plan::Caster;
use zfail_plan::topology::{Blocking, Topology};
use zfail_plan::view::View;
use zfail_scene::{Ground, Instance, Light, Mesh, Pose, Receivers, Scene};

/// A scene without what only pictures need.
#[derive(Debug)]
pub struct Model {
    pub meshes: Vec<MeshModel>,
    pub instances: Vec<Instance>,
    pub lights: Vec<Light>,
    /// Of each light in figures.
    pub hues: Vec<[u8; 3]>,
    /// Boxes around what can be seen.
    receivers: Receivers,
    /// Catches shadows beside the instances.
    ground: Option<Ground>,
    /// World space.
    pub anchor: DVec3,
    /// Indices of the instances that cast, and of each instance among these.
    casters: Vec<usize>,
    caster_of: Vec<Option<usize>>,
}

/// A mesh and what is visible of it.
#[derive(Debug)]
pub struct MeshModel {
    /// Positions and triangles; nothing else is kept.
    pub mesh: Mesh,
    pub faces: Vec<Face>,
    blocking: Vec<Blocking>,
    /// Made when the first volume is needed: proofs about solids take their time.
    topology: Option<Topology>,
    /// Made when they are first asked for.
    edges: OnceLock<Vec<[u32; 2]>>,
}

/// How a triangle looks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Face {
    /// sRGB.
    pub color: [u8; 3],
    /// Nothing else is seen through it.
    pub solid: bool,
    pub double_sided: bool,
}

/// From the object space of an instance to the anchor's.
#[derive(Clone, Copy, Debug)]
pub struct Place {
    anchored_from_object: DAffine3,
    pub mirrored: bool,
}

impl Place {
    /// A point of the object, homogeneous.
    pub fn point(&self, p: DVec3) -> DVec4 {
        self.anchored_from_object.transform_point3(p).extend(1.0)
    }

    /// A point at infinity, its direction of unit length.
    pub fn direction(&self, d: DVec3) -> DVec4 {
        self.anchored_from_object.transform_vector3(d).normalize_or_zero().extend(0.0)
    }
}

impl Model {
    /// Takes what figures need of `scene`.
    pub fn new(scene: &Scene) -> Result<Self, Error> {
        check(scene)?;
        let bounds = scene.bounds();
        let mut casters = Vec::new();
        let mut caster_of = Vec::with_capacity(scene.instances.len());
        for (i, instance) in scene.instances.iter().enumerate() {
            let casts = instance.casts_shadow && !scene.meshes[instance.mesh].triangles.is_empty();
            caster_of.push(casts.then_some(casters.len()));
            casters.extend(casts.then_some(i));
        }
        Ok(Self {
            meshes: (0..scene.meshes.len()).map(|m| MeshModel::new(scene, m)).collect(),
            instances: scene.instances.clone(),
            hues: hues(&scene.lights),
            lights: scene.lights.clone(),
            receivers: Receivers::new(scene),
            ground: scene.ground,
            anchor: if bounds.is_empty() { DVec3::ZERO } else { bounds.center() },
            casters,
            caster_of,
        })
    }

    /// Moves what `pose` moves.
    pub fn set_pose(&mut self, pose: &Pose) -> Result<(), Error> {
        for bent in &pose.bent {
            let Some(model) = self.meshes.get_mut(bent.mesh) else { continue };
            if !model.mesh.bends() || bent.positions.len() != model.mesh.positions.len() {
                return Err(Error::Unfit(format!("a pose does not fit mesh {}", bent.mesh)));
            }
            self.receivers.bend(bent.mesh, &bent.positions);
            if let Some(topology) = &mut model.topology {
                let moved = topology.move_vertices(&bent.positions);
                moved.map_err(|source| Error::Topology { name: model.mesh.name.clone(), source })?;
            }
            model.mesh.positions.clone_from(&bent.positions);
        }
        for (instance, place) in self.instances.iter_mut().zip(&pose.instances) {
            instance.world_from_object = *place;
        }
        for (light, kind) in self.lights.iter_mut().zip(&pose.lights) {
            light.kind = *kind;
        }
        for (light, axes) in self.lights.iter_mut().zip(&pose.light_axes) {
            light.shape.axes = *axes;
        }
        Ok(())
    }

    /// Replaces all lights.
    pub fn set_lights(&mut self, lights: &[Light]) {
        self.hues = hues(lights);
        self.lights = lights.to_vec();
    }

    /// Makes the topologies of all casters that have none yet.
    pub fn make_topologies(&mut self) -> Result<(), Error> {
        for &i in &self.casters {
            let model = &mut self.meshes[self.instances[i].mesh];
            if model.topology.is_none() {
                let topology = model.weld().map_err(|source| Error::Topology { name: model.mesh.name.clone(), source });
                model.topology = Some(topology?);
            }
        }
        Ok(())
    }

    /// Everything that may block light, in the order that [`Self::instance_of`] numbers.
    pub fn casters(&self) -> Vec<Caster<'_>> {
        let caster = |&i: &usize| {
            let Instance { mesh, world_from_object, .. } = self.instances[i];
            let topology = self.meshes[mesh].topology.as_ref()?;
            Some(Caster { topology, mesh: mesh as u64, world_from_object })
        };
        self.casters.iter().filter_map(caster).collect()
    }

    /// The instance that is caster number `caster`.
    pub fn instance_of(&self, caster: u32) -> usize {
        self.casters[caster as usize]
    }

    /// The casters that ignore a light.
    pub fn excluded(&self, light: usize) -> Vec<usize> {
        self.lights[light].excluded.iter().filter_map(|&i| self.caster_of.get(i).copied().flatten()).collect()
    }

    /// Where an instance is.
    pub fn place(&self, instance: usize) -> Place {
        let m = self.instances[instance].world_from_object;
        Place {
            anchored_from_object: DAffine3 { translation: m.translation - self.anchor, ..m },
            mirrored: m.matrix3.determinant() < 0.0,
        }
    }

    /// Corners of a triangle of an instance, in the order in which it is rendered.
    pub fn corners(&self, instance: usize, triangle: usize) -> [DVec4; 3] {
        let (place, mesh) = (self.place(instance), &self.meshes[self.instances[instance].mesh].mesh);
        mesh.triangles[triangle].map(|v| place.point(mesh.position(v)))
    }

    /// A point in world space, homogeneous, relative to the anchor.
    pub fn anchored(&self, p: DVec4) -> DVec4 {
        (p.truncate() - self.anchor * p.w).extend(p.w)
    }

    /// Boxes around everything on which `view` shows shadows, world space.
    pub fn receivers(&self, view: &View) -> Vec<Bounds> {
        let ground = self.ground.filter(|ground| ground.faces(view));
        let mut boxes = Vec::new();
        self.receivers.place(&self.instances, &mut boxes);
        boxes.extend(ground.map(|ground| ground.bounds()));
        boxes
    }

    /// Anchored to clip space of `view`.
    pub fn clip_from_anchored(&self, view: &View) -> DMat4 {
        view.clip_from_relative() * DMat4::from_translation(self.anchor - view.eye())
    }
}

impl MeshModel {
    fn new(scene: &Scene, m: usize) -> Self {
        let mesh = &scene.meshes[m];
        let color = |material: Option<usize>| match material.map(|m| &scene.materials[m]) {
            Some(material) => Face {
                color: crate::surface_color::of(scene, material),
                solid: !material.is_blended(),
                double_sided: material.double_sided,
            },
            None => Face { color: [255; 3], solid: true, double_sided: false },
        };
        let mut faces = vec![color(None); mesh.triangles.len()];
        for primitive in &mesh.primitives {
            let face = color(primitive.material);
            faces[primitive.triangles.start as usize..primitive.triangles.end as usize].fill(face);
        }
        let (positions, triangles) = (mesh.positions.clone(), mesh.triangles.clone());
        Self {
            blocking: (0..triangles.len()).map(|t| scene.triangle_blocking(m, t)).collect(),
            mesh: Mesh { name: mesh.name.clone(), positions, triangles, alike: mesh.alike.clone(), ..Mesh::default() },
            faces,
            topology: None,
            edges: OnceLock::new(),
        }
    }

    /// The edges of all triangles, each once, by vertices of the mesh.
    pub fn edges(&self) -> &[[u32; 2]] {
        self.edges.get_or_init(|| {
            let mut first = HashMap::new();
            let bits = |v: u32| self.mesh.positions[v as usize].map(f32::to_bits);
            let mut weld = |v: u32| *first.entry(bits(v)).or_insert(v);
            let welded: Vec<[u32; 3]> = self.mesh.triangles.iter().map(|t| t.map(&mut weld)).collect();
            let sides = welded.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]);
            let mut edges: Vec<[u32; 2]> = sides.map(|[a, b]| [a.min(b), a.max(b)]).collect();
            edges.sort_unstable();
            edges.dedup();
            edges
        })
    }

    fn weld(&self) -> Result<Topology, zfail_plan::topology::TopologyError> {
        let Mesh { positions, triangles, alike, .. } = &self.mesh;
        let surface = |t: usize| self.blocking[t];
        match self.mesh.bends() {
            false => Topology::new(positions, triangles, surface),
            true => Topology::bending(positions, triangles, alike, surface),
        }
    }
}

fn hues(lights: &[Light]) -> Vec<[u8; 3]> {
    palette::lights(&lights.iter().map(|light| light.color).collect::<Vec<_>>())
}

/// Finds indices that lead astray.
fn check(scene: &Scene) -> Result<(), Error> {
    let fail = |message: String| Err(Error::Unfit(message));
    for (m, mesh) in scene.meshes.iter().enumerate() {
        if mesh.triangles.iter().flatten().any(|&v| v as usize >= mesh.positions.len()) {
            return fail(format!("mesh {m} refers to a vertex that does not exist"));
        }
        let astray = |p: &zfail_scene::Primitive| {
            p.triangles.start > p.triangles.end
                || p.triangles.end as usize > mesh.triangles.len()
                || p.material.is_some_and(|material| material >= scene.materials.len())
        };
        if mesh.primitives.iter().any(astray) {
            return fail(format!("mesh {m} has a primitive of triangles or a material that do not exist"));
        }
    }
    match scene.instances.iter().position(|i| i.mesh >= scene.meshes.len() || !i.world_from_object.is_finite()) {
        Some(i) => fail(format!("instance {i} has a mesh that does not exist, or a transform that is not finite")),
        None => Ok(()),
    }
}
