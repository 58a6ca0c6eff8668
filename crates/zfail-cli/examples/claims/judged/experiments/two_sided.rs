//! z-fail in one pass with two-sided stencil operations, and in two passes with faces culled (E&K sections 3.3 and 4.3).
//!
//! The same volumes, placed beforehand so that a vertex costs next to nothing, counted both ways in turn. Both have to leave the
//! same stencil.

use super::{builtin, casters, plan};
use serde::{Deserialize, Serialize};
use std::error::Error;
use std::time::Instant;
use zfail_plan::glam::{DMat4, DVec3, DVec4};
use zfail_plan::plan::{Planner, Technique};
use zfail_plan::view::View;
use zfail_render::wgpu::util::{BufferInitDescriptor, DeviceExt};
use zfail_render::wgpu::{self, CompareFunction, Face, StencilOperation};
use zfail_render::{Gpu, GpuOptions};
use zfail_scene::Scene;

/// One scene, both ways.
#[derive(Debug, Deserialize, Serialize)]
pub struct TwoSided {
    pub scene: String,
    /// Of the volumes, drawn once.
    pub triangles: usize,
    /// Pixels at which the counts of the two differ.
    pub different: usize,
    /// Milliseconds from an idle device to an idle device, depth pass included: medians.
    pub one_pass_ms: f64,
    pub two_passes_ms: f64,
    /// The same of the depth pass alone.
    pub depth_ms: f64,
}

const SCENES: [&str; 4] = ["container", "room", "cathedral", "jail"];

/// The first light of some scenes, in so many runs in turn.
///
/// # Errors
/// If the device fails.
pub fn measure(size: [u32; 2], runs: usize) -> Result<Vec<TwoSided>, Box<dyn Error>> {
    let gpu = Gpu::new(&GpuOptions::default())?;
    SCENES.into_iter().map(|name| compare(&gpu, name, size, runs)).collect()
}

fn compare(gpu: &Gpu, name: &str, size: [u32; 2], runs: usize) -> Result<TwoSided, Box<dyn Error>> {
    let scene = builtin(name)?;
    let view = scene.cameras[0].view(size, &scene.bounds());
    let volumes = volumes(&scene, &view)?;
    let bench = Bench::new(gpu, size, &surfaces(&scene, &view), &volumes);
    let ways = [Way::Depth, Way::OnePass, Way::TwoPasses];
    let mut times = [(); 3].map(|()| Vec::with_capacity(runs));
    for _ in 0..=runs {
        for (way, times) in ways.into_iter().zip(&mut times) {
            times.push(bench.time(gpu, way)?);
        }
    }
    // The first run of each compiles.
    let [depth_ms, one_pass_ms, two_passes_ms] = times.map(|times| median(&times[1..]));
    let [one, two] = [Way::OnePass, Way::TwoPasses].map(|way| bench.counts(gpu, way));
    let different = one?.iter().zip(&two?).filter(|(a, b)| a != b).count();
    let triangles = volumes.len() / 3;
    Ok(TwoSided { scene: name.to_owned(), triangles, different, one_pass_ms, two_passes_ms, depth_ms })
}

fn median(times: &[f64]) -> f64 {
    let mut times = times.to_vec();
    times.sort_by(f64::total_cmp);
    times[times.len() / 2]
}

/// Corners of all surfaces in clip space.
fn surfaces(scene: &Scene, view: &View) -> Vec<[f32; 4]> {
    let clip = view.clip_from_view() * DMat4::from(view.view_from_world());
    let corners = scene.instances.iter().flat_map(|instance| {
        let mesh = &scene.meshes[instance.mesh];
        let clip = clip * DMat4::from(instance.world_from_object);
        mesh.triangles.as_flattened().iter().map(move |&v| (clip * mesh.position(v).extend(1.0)).as_vec4().to_array())
    });
    corners.collect()
}

/// Corners of the first light's volumes in clip space, outside counter-clockwise.
fn volumes(scene: &Scene, view: &View) -> Result<Vec<[f32; 4]>, Box<dyn Error>> {
    let topologies = scene.topologies()?;
    let casters = casters(scene, &topologies);
    let mut planner = Planner::new();
    let steps = Technique::EverittKilgard.steps();
    let plan = plan(&mut planner, view, &casters, scene.lights[0].kind, steps)?;
    let view_from_world = DMat4::from(view.view_from_world());
    let mut corners = Vec::new();
    for draw in &plan.draws {
        let caster = &casters[draw.caster as usize];
        let clip = view.clip_from_view() * view_from_world * DMat4::from(caster.world_from_object);
        let place = |index: u32| {
            let p: DVec3 = caster.topology.position(index / 2);
            let p: DVec4 = if index.is_multiple_of(2) { p.extend(1.0) } else { draw.extruded(p) };
            (clip * p).as_vec4().to_array()
        };
        for (range, turned) in [(draw.volume.outward(), false), (draw.volume.light_cap_reversed.clone(), true)] {
            for corner in plan.indices[range.start as usize..range.end as usize].chunks_exact(3) {
                let [a, b, c] = [corner[0], corner[1], corner[2]].map(place);
                corners.extend(if turned == draw.mirrored { [a, b, c] } else { [a, c, b] });
            }
        }
    }
    Ok(corners)
}

/// What is drawn after the depth pass.
#[derive(Clone, Copy)]
enum Way {
    Depth,
    OnePass,
    TwoPasses,
}

struct Bench {
    size: [u32; 2],
    target: wgpu::Texture,
    surfaces: wgpu::Buffer,
    volumes: wgpu::Buffer,
    depth: wgpu::RenderPipeline,
    both: wgpu::RenderPipeline,
    /// Back faces, then front faces (E&K section 3.3, steps 6.C.b to f).
    each: [wgpu::RenderPipeline; 2],
}

const SHADER: &str =
    "@vertex fn place(@location(0) clip: vec4f) -> @invariant @builtin(position) vec4f { return clip; }";

impl Bench {
    fn new(gpu: &Gpu, size: [u32; 2], surfaces: &[[f32; 4]], volumes: &[[f32; 4]]) -> Self {
        let buffer = |contents: &[[f32; 4]]| {
            let contents = bytemuck::cast_slice(contents);
            gpu.device.create_buffer_init(&BufferInitDescriptor {
                label: Some("corners"),
                contents,
                usage: wgpu::BufferUsages::VERTEX,
            })
        };
        let target = gpu.device.create_texture(&wgpu::TextureDescriptor {
            label: Some("depth and counts"),
            size: wgpu::Extent3d { width: size[0], height: size[1], depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: gpu.depth_stencil,
            usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
            view_formats: &[],
        });
        let faces = [None, Some(Face::Front), Some(Face::Back)];
        let [both, back, front] = faces.map(|cull| pipeline(gpu, false, cull));
        let depth = pipeline(gpu, true, None);
        Self { size, target, surfaces: buffer(surfaces), volumes: buffer(volumes), depth, both, each: [back, front] }
    }

    fn submit(&self, gpu: &Gpu, way: Way) {
        let view = self.target.create_view(&wgpu::TextureViewDescriptor::default());
        let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("depth and counts"),
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &view,
                depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(0.0), store: wgpu::StoreOp::Store }),
                stencil_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(0), store: wgpu::StoreOp::Store }),
            }),
            ..Default::default()
        });
        let mut draw = |pipeline: &wgpu::RenderPipeline, buffer: &wgpu::Buffer| {
            pass.set_pipeline(pipeline);
            pass.set_vertex_buffer(0, buffer.slice(..));
            pass.draw(0..(buffer.size() / 16) as u32, 0..1);
        };
        draw(&self.depth, &self.surfaces);
        match way {
            Way::Depth => {}
            Way::OnePass => draw(&self.both, &self.volumes),
            Way::TwoPasses => self.each.iter().for_each(|pipeline| draw(pipeline, &self.volumes)),
        }
        drop(pass);
        gpu.queue.submit([encoder.finish()]);
    }

    fn time(&self, gpu: &Gpu, way: Way) -> Result<f64, Box<dyn Error>> {
        gpu.wait()?;
        let start = Instant::now();
        self.submit(gpu, way);
        gpu.wait()?;
        Ok(start.elapsed().as_secs_f64() * 1e3)
    }

    /// The stencil that it leaves.
    fn counts(&self, gpu: &Gpu, way: Way) -> Result<Vec<u8>, Box<dyn Error>> {
        self.submit(gpu, way);
        let [width, height] = self.size;
        let row = width.next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
        let staging = gpu.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("counts"),
            size: u64::from(row) * u64::from(height),
            usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        encoder.copy_texture_to_buffer(
            wgpu::TexelCopyTextureInfo { aspect: wgpu::TextureAspect::StencilOnly, ..self.target.as_image_copy() },
            wgpu::TexelCopyBufferInfo {
                buffer: &staging,
                layout: wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(row), rows_per_image: None },
            },
            self.target.size(),
        );
        gpu.queue.submit([encoder.finish()]);
        staging.map_async(wgpu::MapMode::Read, .., |_| {});
        gpu.wait()?;
        let bytes = staging.get_mapped_range(..)?;
        Ok(bytes.chunks_exact(row as usize).flat_map(|line| line[..width as usize].to_vec()).collect())
    }
}

/// For surfaces, or for volumes counted behind them with counts that wrap.
fn pipeline(gpu: &Gpu, surfaces: bool, cull_mode: Option<Face>) -> wgpu::RenderPipeline {
    let behind = |operation| wgpu::StencilFaceState { depth_fail_op: operation, ..wgpu::StencilFaceState::IGNORE };
    let stencil = wgpu::StencilState {
        front: behind(StencilOperation::DecrementWrap),
        back: behind(StencilOperation::IncrementWrap),
        read_mask: 0xff,
        write_mask: 0xff,
    };
    let module = gpu.device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some("place"),
        source: wgpu::ShaderSource::Wgsl(SHADER.into()),
    });
    gpu.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some("place"),
        layout: None,
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: Some("place"),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            buffers: &[Some(wgpu::VertexBufferLayout {
                array_stride: 16,
                step_mode: wgpu::VertexStepMode::Vertex,
                attributes: &wgpu::vertex_attr_array![0 => Float32x4],
            })],
        },
        primitive: wgpu::PrimitiveState { cull_mode, ..Default::default() },
        depth_stencil: Some(wgpu::DepthStencilState {
            format: gpu.depth_stencil,
            depth_write_enabled: Some(surfaces),
            depth_compare: Some(if surfaces { CompareFunction::GreaterEqual } else { CompareFunction::Greater }),
            stencil: if surfaces { wgpu::StencilState::default() } else { stencil },
            bias: wgpu::DepthBiasState::default(),
        }),
        multisample: wgpu::MultisampleState::default(),
        fragment: None,
        multiview_mask: None,
        cache: None,
    })
}
