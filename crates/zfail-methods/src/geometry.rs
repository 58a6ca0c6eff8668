//! The scene as every method draws it.
//!
//! In: a [`Scene`]. Out: per mesh its topology, positions and index lists on the device, of what is visible and of what
//! casts; under a view, the matrices of all instances. Masked materials are drawn whole: loaders have cut them to shape.

use bytemuck::{Pod, Zeroable};
use std::ops::Range;
use wgpu::util::{BufferInitDescriptor, DeviceExt};
use zfail_plan::bounds::Bounds;
use zfail_plan::casting::ObjectLight;
use zfail_plan::glam::{DVec4, Mat4};
use zfail_plan::topology::{NONE, Topology, TopologyError};
use zfail_plan::view::{Projection, View};
use zfail_scene::{Instance, Light, Material, Receivers, Scene};

/// What stays from view to view.
#[derive(Debug)]
pub struct Geometry {
    /// `None` for meshes without triangles.
    pub meshes: Vec<Option<Mesh>>,
    pub instances: Vec<Instance>,
    pub lights: Vec<Light>,
    /// World space.
    pub bounds: Bounds,
    /// Boxes around everything that can be seen, world space.
    pub receivers: Vec<Bounds>,
}

/// One mesh.
#[derive(Debug)]
pub struct Mesh {
    pub topology: Topology,
    /// Three floats per welded vertex.
    pub positions: wgpu::Buffer,
    /// All triangles, as they are rendered.
    pub triangles: wgpu::Buffer,
    /// What the depth pass draws of these, and whether from both sides.
    pub visible: Vec<(Range<u32>, bool)>,
    /// The triangles that block light.
    pub casting: wgpu::Buffer,
    /// How many indices these have.
    pub casting_len: u32,
}

/// An instance under a view, as `stage.wgsl` reads it.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct Placement {
    clip_from_object: [[f32; 4]; 4],
    /// Rows; world directions, relative to the eye.
    relative_from_object: [[f32; 4]; 3],
}

impl Geometry {
    /// Uploads `scene`, whose indices have been checked.
    pub fn new(device: &wgpu::Device, scene: &Scene) -> Result<Self, TopologyError> {
        let mesh = |m: usize| match scene.meshes[m].triangles.is_empty() {
            true => Ok(None),
            false => Mesh::new(device, scene, m).map(Some),
        };
        let mut receivers = Vec::new();
        Receivers::new(scene).place(&scene.instances, &mut receivers);
        Ok(Self {
            receivers,
            meshes: (0..scene.meshes.len()).map(mesh).collect::<Result<_, _>>()?,
            instances: scene.instances.clone(),
            lights: scene.lights.clone(),
            bounds: scene.bounds(),
        })
    }

    /// The same on another device.
    pub fn on(&self, device: &wgpu::Device) -> Self {
        let mesh = |mesh: &Mesh| Mesh::upload(device, mesh.topology.clone(), mesh.visible.clone());
        Self {
            meshes: self.meshes.iter().map(|slot| slot.as_ref().map(mesh)).collect(),
            instances: self.instances.clone(),
            lights: self.lights.clone(),
            bounds: self.bounds,
            receivers: self.receivers.clone(),
        }
    }

    /// The instances that cast shadows from `light`, with their numbers.
    pub fn casters<'a>(&'a self, light: &'a Light) -> impl Iterator<Item = (usize, &'a Instance, &'a Mesh)> {
        let casts = |&(i, instance): &(usize, &Instance)| instance.casts_shadow && !light.excluded.contains(&i);
        let with_mesh =
            |(i, instance): (usize, &'a Instance)| Some((i, instance, self.meshes[instance.mesh].as_ref()?));
        self.instances.iter().enumerate().filter(casts).filter_map(with_mesh).filter(|(.., mesh)| mesh.casting_len > 0)
    }

    /// Every instance under `view`, and as one more the identity, for vertices that are in clip space already.
    pub fn placements(&self, view: &View) -> Vec<Placement> {
        let place = |instance: &Instance| {
            let mut relative = instance.world_from_object;
            relative.translation -= view.eye();
            let rows = zfail_plan::glam::DMat4::from(relative).as_mat4().transpose();
            Placement {
                clip_from_object: view.clip_from_object(&instance.world_from_object).to_cols_array_2d(),
                relative_from_object: [rows.x_axis, rows.y_axis, rows.z_axis].map(|row| row.to_array()),
            }
        };
        let identity =
            Placement { clip_from_object: Mat4::IDENTITY.to_cols_array_2d(), relative_from_object: [[0.0; 4]; 3] };
        self.instances.iter().map(place).chain([identity]).collect()
    }

    /// The number of the identity in [`Self::placements`].
    pub fn identity(&self) -> u32 {
        self.instances.len() as u32
    }
}

impl Mesh {
    fn new(device: &wgpu::Device, scene: &Scene, m: usize) -> Result<Self, TopologyError> {
        let topology = scene.topology(m)?;
        let material = |index: Option<usize>| index.and_then(|i| scene.materials.get(i));
        let solid =
            scene.meshes[m].primitives.iter().filter(|p| !material(p.material).is_some_and(Material::is_blended));
        let visible = solid
            .map(|p| {
                let indices = 3 * p.triangles.start..3 * p.triangles.end;
                (indices, material(p.material).is_some_and(|material| material.double_sided))
            })
            .collect();
        Ok(Self::upload(device, topology, visible))
    }

    fn upload(device: &wgpu::Device, topology: Topology, visible: Vec<(Range<u32>, bool)>) -> Self {
        let casting: Vec<[u32; 3]> = topology
            .triangles()
            .iter()
            .zip(topology.part_of())
            .filter(|(_, part)| **part != NONE)
            .map(|(t, _)| *t)
            .collect();
        // What rays are traced against, where the device can.
        let traced = match device.features().contains(wgpu::Features::EXPERIMENTAL_RAY_QUERY) {
            true => wgpu::BufferUsages::BLAS_INPUT,
            false => wgpu::BufferUsages::empty(),
        };
        let buffer = |contents: &[u8], usage| {
            device.create_buffer_init(&BufferInitDescriptor { label: Some("mesh"), contents, usage: usage | traced })
        };
        Self {
            positions: buffer(bytemuck::cast_slice(topology.positions()), wgpu::BufferUsages::VERTEX),
            triangles: buffer(bytemuck::cast_slice(topology.triangles()), wgpu::BufferUsages::INDEX),
            casting: buffer(bytemuck::cast_slice(&casting), wgpu::BufferUsages::INDEX),
            casting_len: 3 * casting.len() as u32,
            visible,
            topology,
        }
    }
}

/// `light` in the object space of `instance`, computed in f64 and rounded once; `None` if the transform is singular.
pub fn object_light(instance: &Instance, light: &Light) -> Option<ObjectLight> {
    let light = light.kind.homogeneous();
    let world = &instance.world_from_object;
    let to_light = world.matrix3.inverse() * (light.truncate() - world.translation * light.w);
    let to_light = if light.w == 0.0 { to_light.try_normalize()? } else { to_light };
    let rounded = to_light.extend(light.w).as_vec4();
    rounded.is_finite().then_some(rounded)
}

/// The homogeneous eye in the object space of `instance`: a direction under orthographic views.
pub fn object_eye(instance: &Instance, view: &View) -> DVec4 {
    let inverse = instance.world_from_object.matrix3.inverse();
    match view.projection {
        Projection::Perspective { .. } => (inverse * (view.eye() - instance.world_from_object.translation)).extend(1.0),
        Projection::Orthographic { .. } => (inverse * view.world_from_view.matrix3.z_axis).extend(0.0),
    }
}
