//! What all passes of one frame read: the view, the lights in view space, the placement of every instance.

use crate::draw_list::{Draw, DrawList, DrawState, back_to_front};
use crate::geometry::MeshBuffers;
use crate::gpu_data::{FrameUniform, InstanceUniform, LightRecord};
use crate::layouts::{Layouts, bind};
use crate::{Gpu, RenderError};
use zfail_plan::glam::{DAffine3, DMat3, DMat4};
use zfail_plan::scene::Instance;
use zfail_plan::view::{Projection, View};

/// Uniforms of a frame, on the device. The buffers stay from frame to frame.
#[derive(Debug)]
pub struct FrameData {
    /// Group 0 of every pass that knows the view.
    pub bind_group: wgpu::BindGroup,
    instances: wgpu::BindGroup,
    uniform: wgpu::Buffer,
    lights: wgpu::Buffer,
    placements: wgpu::Buffer,
    /// Bytes from one instance's uniform to the next.
    instance_stride: u32,
    view_from_object: Vec<DAffine3>,
    /// What `placements` holds, kept for its memory.
    bytes: Vec<u8>,
}

impl FrameData {
    /// Buffers for frames with `lights` lights and `instances` instances.
    pub fn new(gpu: &Gpu, layouts: &Layouts, instances: usize, lights: usize) -> Result<Self, RenderError> {
        let alignment = gpu.device.limits().min_uniform_buffer_offset_alignment;
        let stride = (size_of::<InstanceUniform>() as u32).next_multiple_of(alignment);
        let uniform = buffer(gpu, "frame", wgpu::BufferUsages::UNIFORM, size_of::<FrameUniform>())?;
        let lights = buffer(gpu, "lights", wgpu::BufferUsages::STORAGE, lights.max(1) * size_of::<LightRecord>())?;
        let size = instances.max(1) * stride as usize;
        let placements = buffer(gpu, "instances", wgpu::BufferUsages::UNIFORM, size)?;
        let window = wgpu::BindingResource::Buffer(wgpu::BufferBinding {
            buffer: &placements,
            offset: 0,
            size: std::num::NonZeroU64::new(size_of::<InstanceUniform>() as u64),
        });
        let resources = [uniform.as_entire_binding(), lights.as_entire_binding()];
        Ok(Self {
            bind_group: bind(&gpu.device, "frame", &layouts.frame, &resources),
            instances: bind(&gpu.device, "instance", &layouts.instance, &[window]),
            uniform,
            lights,
            placements,
            instance_stride: stride,
            view_from_object: Vec::new(),
            bytes: vec![0; size],
        })
    }

    /// Whether `lights` lights fit.
    pub fn holds(&self, lights: usize) -> bool {
        (lights * size_of::<LightRecord>()) as u64 <= self.lights.size()
    }

    /// Uploads a frame; `ambient` and the lights are pre-exposed, and there are no more of either than room for them.
    pub fn update(
        &mut self,
        gpu: &Gpu,
        view: &View,
        instances: &[Instance],
        lights: &[LightRecord],
        ambient: [f32; 3],
        pre_exposure: f32,
    ) {
        let uniform = FrameUniform {
            view_per_ndc: view_per_ndc(view),
            size: view.size.map(|s| s as f32),
            ambient,
            orthographic: if matches!(view.projection, Projection::Orthographic { .. }) { 1.0 } else { 0.0 },
            pre_exposure,
            light_count: lights.len() as u32,
            pad: [0; 2],
        };
        gpu.queue.write_buffer(&self.uniform, 0, bytemuck::bytes_of(&uniform));
        gpu.queue.write_buffer(&self.lights, 0, bytemuck::cast_slice(lights));
        for (slot, instance) in self.bytes.chunks_exact_mut(self.instance_stride as usize).zip(instances) {
            let uniform = instance_uniform(view, &instance.world_from_object);
            slot[..size_of::<InstanceUniform>()].copy_from_slice(bytemuck::bytes_of(&uniform));
        }
        gpu.queue.write_buffer(&self.placements, 0, &self.bytes);
        self.view_from_object.clear();
        self.view_from_object.extend(instances.iter().map(|i| view.view_from_object(&i.world_from_object)));
    }

    /// The scene's blended draws from back to front.
    pub fn blended<'d>(&self, list: &'d DrawList) -> Vec<&'d Draw> {
        back_to_front(&list.blended, &self.view_from_object)
    }

    /// Draws `draws` in order, `pipelines` giving one pipeline after the other for each.
    pub fn draw<'d, 'p, P>(
        &self,
        pass: &mut wgpu::RenderPass<'_>,
        draws: impl IntoIterator<Item = &'d Draw>,
        meshes: &[Option<MeshBuffers>],
        materials: &[wgpu::BindGroup],
        pipelines: impl Fn(DrawState) -> P,
    ) where
        P: IntoIterator<Item = &'p wgpu::RenderPipeline>,
    {
        pass.set_bind_group(0, &self.bind_group, &[]);
        for draw in draws {
            let Some(mesh) = &meshes[draw.mesh] else { continue };
            mesh.bind(pass);
            pass.set_bind_group(1, &self.instances, &[draw.instance as u32 * self.instance_stride]);
            pass.set_bind_group(2, &materials[draw.material], &[]);
            for pipeline in pipelines(draw.state) {
                pass.set_pipeline(pipeline);
                pass.draw_indexed(draw.indices.clone(), 0, 0..1);
            }
        }
    }
}

/// View-space x and y per unit of NDC: at unit depth (perspective), or anywhere (orthographic).
pub fn view_per_ndc(view: &View) -> [f32; 2] {
    let clip_from_view = view.clip_from_view();
    [clip_from_view.x_axis.x.recip() as f32, clip_from_view.y_axis.y.recip() as f32]
}

fn instance_uniform(view: &View, world_from_object: &DAffine3) -> InstanceUniform {
    let view_from_object = view.view_from_object(world_from_object);
    InstanceUniform {
        clip_from_object: view.clip_from_object(world_from_object).to_cols_array_2d(),
        view_from_object: DMat4::from(view_from_object).as_mat4().to_cols_array_2d(),
        view_from_object_normal: DMat4::from_mat3(normal_matrix(&view_from_object.matrix3))
            .as_mat4()
            .to_cols_array_2d(),
    }
}

/// The inverse transpose up to a positive factor, its greatest element 1. Defined for singular matrices too.
fn normal_matrix(m: &DMat3) -> DMat3 {
    let cofactors = DMat3::from_cols(m.y_axis.cross(m.z_axis), m.z_axis.cross(m.x_axis), m.x_axis.cross(m.y_axis));
    let greatest = cofactors.to_cols_array().into_iter().fold(0.0, |g: f64, c| g.max(c.abs()));
    let scale = if m.determinant() < 0.0 { -greatest } else { greatest };
    if greatest > 0.0 { cofactors * scale.recip() } else { DMat3::ZERO }
}

fn buffer(gpu: &Gpu, label: &str, usage: wgpu::BufferUsages, size: usize) -> Result<wgpu::Buffer, RenderError> {
    if size as u64 > gpu.device.limits().max_buffer_size {
        return Err(RenderError::Scene(format!("too many {label} for this device")));
    }
    Ok(gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: Some(label),
        size: size as u64,
        usage: usage | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    }))
}

#[cfg(test)]
mod tests {
    use super::*;
    use zfail_plan::glam::DVec3;

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
