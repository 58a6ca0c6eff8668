//! What all passes of one frame read: the view, the lights in view space, the placement of every instance.

use crate::scene::gpu_data::{FrameUniform, InstanceRecord, LightRecord, UNROLLED};
use crate::scene::layouts::{Layouts, bind};
use crate::{Gpu, RenderError};
use bytemuck::Pod;
use zfail_plan::glam::{DAffine3, DMat3, DVec3};
use zfail_plan::view::{Projection, View};
use zfail_scene::{Ground, Instance, Sky};

/// Data of a frame, on the device. The buffers grow to the largest frame seen.
#[derive(Debug)]
pub struct FrameData {
    /// Group 0 of every pass that knows the view.
    pub bind_group: wgpu::BindGroup,
    /// [`InstanceRecord`]s in the order of the draw list.
    pub instances: wgpu::Buffer,
    uniform: wgpu::Buffer,
    lights: wgpu::Buffer,
    /// Indices of lights, the range of every instance after the other.
    lists: wgpu::Buffer,
    /// What stays from frame to frame of the lights.
    shapes: wgpu::Buffer,
    records: Vec<InstanceRecord>,
    listed: Vec<u32>,
}

/// The numbers of a frame.
#[derive(Clone, Copy, Debug)]
pub struct Shading<'a> {
    /// Pre-exposed.
    pub lights: &'a [LightRecord],
    /// Pre-exposed: all others, which the ground wants to know of.
    pub other_lights: &'a [LightRecord],
    /// Pre-exposed.
    pub ambient: [f32; 3],
    /// Pre-exposed.
    pub background: [f32; 3],
    /// Pre-exposed.
    pub sky: Option<Sky>,
    /// One that is seen; its placement comes after those of all instances.
    pub ground: Option<&'a Ground>,
    /// Scale from scene radiance to what shaders compute with.
    pub pre_exposure: f32,
    /// Scale from there to the picture.
    pub exposure: f32,
}

impl FrameData {
    pub fn new(gpu: &Gpu, layouts: &Layouts, shapes: &wgpu::Buffer) -> Self {
        let uniform = buffer(gpu, "frame", wgpu::BufferUsages::UNIFORM, size_of::<FrameUniform>() as u64);
        let lights = buffer(gpu, "lights", wgpu::BufferUsages::STORAGE, size_of::<LightRecord>() as u64);
        let lists = buffer(gpu, "lists of lights", wgpu::BufferUsages::STORAGE, 4);
        let instances = buffer(gpu, "instances", wgpu::BufferUsages::VERTEX, size_of::<InstanceRecord>() as u64);
        let bind_group = group(gpu, layouts, [&uniform, &lights, &lists, shapes]);
        let shapes = shapes.clone();
        Self { bind_group, instances, uniform, lights, lists, shapes, records: Vec::new(), listed: Vec::new() }
    }

    /// Reads the shapes of lights from another buffer.
    pub fn set_shapes(&mut self, gpu: &Gpu, layouts: &Layouts, shapes: &wgpu::Buffer) {
        self.shapes = shapes.clone();
        self.bind_group = group(gpu, layouts, [&self.uniform, &self.lights, &self.lists, &self.shapes]);
    }

    /// Uploads view, lights and, in their order, instances.
    pub fn update<'i>(
        &mut self,
        gpu: &Gpu,
        layouts: &Layouts,
        view: &View,
        shading: &Shading<'_>,
        instances: impl Iterator<Item = &'i Instance>,
        reaches: impl Fn(usize, usize) -> bool,
    ) -> Result<(), RenderError> {
        let lights = shading.lights;
        let clip_from_view = view.clip_from_view();
        let mut first = [LightRecord::default(); UNROLLED];
        for (slot, light) in first.iter_mut().zip(lights) {
            *slot = *light;
        }
        let sky = shading.sky.unwrap_or_default();
        let middle = shading.ground.map_or(DVec3::ZERO, Ground::middle);
        let uniform = FrameUniform {
            view_per_ndc: [clip_from_view.x_axis.x.recip() as f32, clip_from_view.y_axis.y.recip() as f32],
            size: view.size.map(|s| s as f32),
            ambient: shading.ambient,
            orthographic: if matches!(view.projection, Projection::Orthographic { .. }) { 1.0 } else { 0.0 },
            up: view.world_from_view.matrix3.row(1).as_vec3().to_array(),
            pre_exposure: shading.pre_exposure,
            background: shading.background,
            exposure: shading.exposure,
            zenith: sky.zenith,
            light_count: lights.len() as u32,
            horizon: sky.horizon,
            all_lights: (lights.len() + shading.other_lights.len()) as u32,
            nadir: sky.nadir,
            per_ground_radius: shading.ground.map_or(0.0, |ground| ground.radius.recip() as f32),
            ground: view.view_from_object(&DAffine3::from_translation(middle)).translation.as_vec3().to_array(),
            pad: 0,
            window_offset: view.window.offset.as_vec2().to_array(),
            pad_to_lights: [0; 2],
            lights: first,
        };
        gpu.queue.write_buffer(&self.uniform, 0, bytemuck::bytes_of(&uniform));

        self.records.clear();
        self.listed.clear();
        for (i, instance) in instances.enumerate() {
            let start = self.listed.len() as u32;
            if lights.len() > UNROLLED {
                self.listed.extend((0..lights.len()).filter(|&l| reaches(l, i)).map(|l| l as u32));
            }
            let range = [start, self.listed.len() as u32];
            self.records.push(record(view, &instance.world_from_object, range, !instance.receives_shadow));
        }
        if let Some(ground) = shading.ground {
            let end = self.listed.len() as u32;
            self.records.push(record(view, &ground.world_from_disc(), [end; 2], false));
        }
        let usage = wgpu::BufferUsages::STORAGE;
        let lights: &[LightRecord] = match shading.other_lights {
            [] => lights,
            others => &[lights, others].concat(),
        };
        let grown = [
            write(gpu, &mut self.lights, "lights", usage, lights)?,
            write(gpu, &mut self.lists, "lists of lights", usage, &self.listed)?,
        ];
        write(gpu, &mut self.instances, "instances", wgpu::BufferUsages::VERTEX, &self.records)?;
        if grown.contains(&true) {
            self.bind_group = group(gpu, layouts, [&self.uniform, &self.lights, &self.lists, &self.shapes]);
        }
        Ok(())
    }
}

fn record(view: &View, world_from_object: &DAffine3, lights: [u32; 2], exempt: bool) -> InstanceRecord {
    let view_from_object = view.view_from_object(world_from_object);
    let m = view_from_object.matrix3;
    let row = |i: usize| m.row(i).extend(view_from_object.translation[i]).as_vec4().to_array();
    InstanceRecord {
        clip_from_object: view.clip_from_object(world_from_object).to_cols_array_2d(),
        view_from_object: [row(0), row(1), row(2)],
        normal: normal_matrix(&m).as_mat3().to_cols_array_2d(),
        lights,
        exempt: u32::from(exempt),
    }
}

/// The inverse transpose up to a positive factor, its greatest element 1. Defined for singular matrices too.
fn normal_matrix(m: &DMat3) -> DMat3 {
    let cofactors = DMat3::from_cols(m.y_axis.cross(m.z_axis), m.z_axis.cross(m.x_axis), m.x_axis.cross(m.y_axis));
    let greatest = cofactors.to_cols_array().into_iter().fold(0.0, |g: f64, c| g.max(c.abs()));
    let scale = if m.determinant() < 0.0 { -greatest } else { greatest };
    if greatest > 0.0 { cofactors * scale.recip() } else { DMat3::ZERO }
}

/// Writes `data`, into a larger buffer if need be; returns whether it is a new one.
fn write<T: Pod>(
    gpu: &Gpu,
    target: &mut wgpu::Buffer,
    label: &str,
    usage: wgpu::BufferUsages,
    data: &[T],
) -> Result<bool, RenderError> {
    let bytes: &[u8] = bytemuck::cast_slice(data);
    let size = bytes.len() as u64;
    let limits = gpu.device.limits();
    if size > limits.max_buffer_size.min(limits.max_storage_buffer_binding_size) {
        return Err(RenderError::Scene(format!("too many {label} for this device")));
    }
    let grow = size > target.size();
    if grow {
        *target = buffer(gpu, label, usage, size);
    }
    gpu.queue.write_buffer(target, 0, bytes);
    Ok(grow)
}

fn buffer(gpu: &Gpu, label: &str, usage: wgpu::BufferUsages, size: u64) -> wgpu::Buffer {
    gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: Some(label),
        size,
        usage: usage | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    })
}

fn group(gpu: &Gpu, layouts: &Layouts, buffers: [&wgpu::Buffer; 4]) -> wgpu::BindGroup {
    bind(&gpu.device, "frame", &layouts.frame, &buffers.map(wgpu::Buffer::as_entire_binding))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn normals_stay_perpendicular_and_outside() {
        let shear = DMat3::from_cols(DVec3::new(2.0, 0.3, 0.0), DVec3::new(-0.5, 1.0, 0.2), DVec3::new(0.0, 0.1, 5.0));
        for m in [shear, shear * DMat3::from_diagonal(DVec3::new(-1.0, 1.0, 1.0)), shear * 1e-4] {
            let n = normal_matrix(&m) * DVec3::Z;
            assert!(n.dot(m * DVec3::X).abs() < 1e-12 * n.length() && n.dot(m * DVec3::Y).abs() < 1e-12 * n.length());
            assert!(n.dot(m * DVec3::Z) > 0.0, "inside out: {n}");
        }
    }
}
