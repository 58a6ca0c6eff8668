//! A ray from every visible point to the light, traced by the device: VK_KHR_ray_query, 2020.
//!
//! What shadow volumes count along the view ray, a shadow ray finds directly: whether any caster lies between the point and
//! the light. The casters are in a tree of boxes on the device (one per mesh, and one over all instances), positions
//! relative to the eye.
//!
//! The point is not known exactly: its position is interpolated and rounded, and the tracer rounds as well. So a ray that
//! started on the surface would often hit that very surface, and every renderer starts it a little off, here by
//! [`OFFSET`] of the distance, on the eye's side. What is nearer than that to a contact or to a silhouette may differ from
//! the truth; therefore the method promises nothing ([`Method::exact`](crate::Method::exact)), although few pixels show it.

mod device;

use crate::geometry::Geometry;
use crate::stage::{Stage, Surfaces};
use crate::{Error, Figures};
use bytemuck::{Pod, Zeroable};
use std::time::Instant;
use wgpu::util::{BufferInitDescriptor, DeviceExt};
use wgpu::{
    AccelerationStructureFlags, AccelerationStructureGeometryFlags, AccelerationStructureUpdateMode, AdapterInfo,
    BindGroupLayout, BindingType, Blas, BlasBuildEntry, BlasGeometries, BlasGeometrySizeDescriptors,
    BlasTriangleGeometry, BlasTriangleGeometrySizeDescriptor, CreateBlasDescriptor, CreateTlasDescriptor, IndexFormat,
    Tlas, TlasInstance, VertexFormat,
};
use zfail_plan::bounds::Bounds;
use zfail_plan::view::{Projection, View};
use zfail_render::Gpu;
use zfail_scene::Light;

/// How far off the surface rays start, as a share of the distance to the eye or of the light to the eye, whichever is
/// greater: a few roundings of f32. With none, half of all lit pixels go dark; with 16 times as much, rays start beyond thin
/// casters and contacts.
const OFFSET: f32 = 1.0 / (1 << 20) as f32;

/// `Rays` of `ray_query.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct RaysUniform {
    light: [f32; 4],
    eye: [f32; 4],
    offset: f32,
    padding: [u32; 3],
}

/// A scene on a device of its own that traces rays.
#[derive(Debug)]
pub struct RayTracer {
    gpu: Gpu,
    stage: Stage,
    geometry: Geometry,
    /// One per mesh that casts.
    trees: Vec<Option<Blas>>,
    layout: BindGroupLayout,
}

impl RayTracer {
    /// Opens the adapter once more and copies the scene there; says what is missing if it has no ray queries.
    pub fn new(info: &AdapterInfo, geometry: &Geometry) -> Result<Self, String> {
        let gpu = device::open(info)?;
        let geometry = geometry.on(&gpu.device);
        let layout = layout(&gpu.device);
        let mut tracer = Self { stage: Stage::new(&gpu), trees: Vec::new(), geometry, layout, gpu };
        tracer.plant();
        tracer.gpu.wait().map_err(|e| e.to_string())?;
        Ok(tracer)
    }

    /// Builds a tree over the casting triangles of every mesh.
    fn plant(&mut self) {
        let device = &self.gpu.device;
        let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        for mesh in &self.geometry.meshes {
            let Some(mesh) = mesh.as_ref().filter(|mesh| mesh.casting_len > 0) else {
                self.trees.push(None);
                continue;
            };
            let size = BlasTriangleGeometrySizeDescriptor {
                vertex_format: VertexFormat::Float32x3,
                vertex_count: mesh.topology.positions().len() as u32,
                index_format: Some(IndexFormat::Uint32),
                index_count: Some(mesh.casting_len),
                flags: AccelerationStructureGeometryFlags::OPAQUE,
            };
            let tree = device.create_blas(
                &CreateBlasDescriptor {
                    label: Some("mesh"),
                    flags: AccelerationStructureFlags::PREFER_FAST_TRACE,
                    update_mode: AccelerationStructureUpdateMode::Build,
                },
                BlasGeometrySizeDescriptors::Triangles { descriptors: vec![size.clone()] },
            );
            let triangles = BlasTriangleGeometry {
                size: &size,
                vertex_buffer: &mesh.positions,
                first_vertex: 0,
                vertex_stride: 12,
                index_buffer: Some(&mesh.casting),
                first_index: Some(0),
                transform_buffer: None,
                transform_buffer_offset: None,
            };
            let geometry = BlasGeometries::TriangleGeometries(vec![triangles]);
            encoder.build_acceleration_structures([&BlasBuildEntry { blas: &tree, geometry }], []);
            self.trees.push(Some(tree));
        }
        self.gpu.queue.submit([encoder.finish()]);
    }

    /// What light number `light` reaches.
    pub fn shadow(&mut self, view: &View, light: usize) -> Result<(Vec<u8>, Figures), Error> {
        let Self { gpu, stage, geometry, trees, layout } = self;
        let device = &gpu.device;
        let light = &geometry.lights[light];
        let start = Instant::now();
        let Some(casters) = over_all(gpu, geometry, trees, view, light) else {
            let lit = vec![255; view.size[0] as usize * view.size[1] as usize];
            return Ok((lit, Figures::default()));
        };
        gpu.wait()?;
        let planning_ms = start.elapsed().as_secs_f64() * 1e3;

        let uniform = device.create_buffer_init(&BufferInitDescriptor {
            label: Some("rays"),
            contents: bytemuck::bytes_of(&RaysUniform::new(view, light, &geometry.bounds)),
            usage: wgpu::BufferUsages::UNIFORM,
        });
        let entries = [
            wgpu::BindGroupEntry { binding: 0, resource: uniform.as_entire_binding() },
            wgpu::BindGroupEntry { binding: 1, resource: casters.as_binding() },
        ];
        let program = ["enable wgpu_ray_query;\n", include_str!("ray_query.wgsl")];
        let surfaces = Surfaces::new(gpu, program, layout, &entries);
        let (mut mask, render_ms) = stage.forward(gpu, geometry, view, &surfaces, |_| {})?;
        let fragments = mask.iter().filter(|&&verdict| verdict != 0).count() as u64;
        mask.iter_mut().for_each(|verdict| *verdict = if *verdict == 255 { 255 } else { 0 });
        let triangles: u64 = geometry.casters(light).map(|(.., mesh)| u64::from(mesh.casting_len / 3)).sum();
        Ok((mask, Figures { triangles, vertices: 3 * triangles, fragments, passes: 2, planning_ms, render_ms }))
    }
}

/// The tree over all that casts from `light`, relative to the eye; `None` if nothing does.
fn over_all(gpu: &Gpu, geometry: &Geometry, trees: &[Option<Blas>], view: &View, light: &Light) -> Option<Tlas> {
    let mut instances = Vec::new();
    for (_, instance, _) in geometry.casters(light) {
        let tree = trees[instance.mesh].as_ref()?;
        let m = instance.world_from_object.matrix3.transpose();
        let t = instance.world_from_object.translation - view.eye();
        let rows = [m.x_axis.extend(t.x), m.y_axis.extend(t.y), m.z_axis.extend(t.z)].map(|row| row.as_vec4());
        let transform = std::array::from_fn(|i| rows[i / 4][i % 4]);
        instances.push(TlasInstance::new(tree, transform, 0, 0xff));
    }
    if instances.is_empty() {
        return None;
    }
    let mut all = gpu.device.create_tlas(&CreateTlasDescriptor {
        label: Some("casters"),
        max_instances: instances.len() as u32,
        flags: AccelerationStructureFlags::PREFER_FAST_TRACE,
        update_mode: AccelerationStructureUpdateMode::Build,
    });
    for (i, instance) in instances.into_iter().enumerate() {
        all[i] = Some(instance);
    }
    let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    encoder.build_acceleration_structures([], [&all]);
    gpu.queue.submit([encoder.finish()]);
    Some(all)
}

impl RaysUniform {
    fn new(view: &View, light: &Light, bounds: &Bounds) -> Self {
        let at = light.kind.homogeneous();
        // Rays to a light at infinity only need to leave the scene.
        let across = if bounds.is_empty() { 1.0 } else { 4.0 * bounds.half().length() };
        let light = match at.w {
            0.0 => at * across,
            _ => at - view.eye().extend(0.0),
        };
        let eye = match view.projection {
            Projection::Perspective { .. } => [0.0, 0.0, 0.0, 1.0],
            Projection::Orthographic { .. } => view.world_from_view.matrix3.z_axis.as_vec3().extend(0.0).to_array(),
        };
        Self { light: light.as_vec4().to_array(), eye, offset: OFFSET, padding: [0; 3] }
    }
}

fn layout(device: &wgpu::Device) -> BindGroupLayout {
    let entry =
        |binding, ty| wgpu::BindGroupLayoutEntry { binding, visibility: wgpu::ShaderStages::FRAGMENT, ty, count: None };
    let uniform =
        BindingType::Buffer { ty: wgpu::BufferBindingType::Uniform, has_dynamic_offset: false, min_binding_size: None };
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("rays"),
        entries: &[entry(0, uniform), entry(1, BindingType::AccelerationStructure { vertex_return: false })],
    })
}

#[cfg(test)]
mod tests {
    use super::RaysUniform;
    use zfail_testing::{layout, naga::valid::Capabilities, wgsl::validate};

    #[test]
    fn rays_lie_as_their_shader_reads_them() {
        let parts = [include_str!("../stage/surface.wgsl"), include_str!("ray_query.wgsl")];
        let source = ["enable wgpu_ray_query;\n", parts[0], parts[1]].concat();
        let module = validate(&source, Capabilities::RAY_QUERY).expect("WGSL");
        layout!(&module, "Rays", RaysUniform, [light, eye, offset]).expect("agreement");
    }
}
