//! The stage on which every stencil method plays: depth of the scene, counting, verdict.
//!
//! In: a [`Procedure`]. Out: the mask of pixels whose stencil came back to 0, and figures. Depth is reversed for all
//! methods, also for those older than the idea: that moves no plane, it only rounds better, so that what goes wrong is
//! the method and not the depth buffer.

mod pipelines;
mod targets;

pub use pipelines::Surfaces;
pub use targets::Counters;

use crate::geometry::{Geometry, Placement};
use crate::procedure::{Pass, Procedure};
use crate::volumes::{Draw, Volumes};
use crate::{Error, Figures};
use pipelines::Pipelines;
use std::time::Instant;
use targets::Targets;
use wgpu::util::{BufferInitDescriptor, DeviceExt};
use wgpu::{Buffer, BufferUsages, CommandEncoder, Device, RenderPass, RenderPipeline};
use zfail_plan::view::View;
use zfail_render::{Gpu, RenderError};

/// Depth kept free in front of the near plane where a procedure wants a ledge ("cedes a small amount of depth buffer
/// precision for the ledge", E&K 2.2.2).
const LEDGE: f32 = 1.0 / 1024.0;
/// Plain runs, of whose times the median is taken.
const RUNS: usize = 3;

/// Pipelines and targets of one device.
#[derive(Debug)]
pub struct Stage {
    pipelines: Pipelines,
    targets: Option<Targets>,
}

/// Volumes on the device.
struct Uploaded<'v> {
    vertices: Buffer,
    indices: Buffer,
    draws: &'v [Draw],
}

/// A pass over uploaded volumes, in whose draws each has its pipeline.
struct Ready<'v> {
    pass: Pass,
    draws: Vec<(&'v Uploaded<'v>, &'v Draw, [RenderPipeline; 2])>,
}

impl Stage {
    pub fn new(gpu: &Gpu) -> Self {
        Self { pipelines: Pipelines::new(&gpu.device, gpu.depth_stencil), targets: None }
    }

    /// Carries out `procedure`, to make which took since `start`.
    pub fn carry_out(
        &mut self,
        gpu: &Gpu,
        geometry: &Geometry,
        procedure: &Procedure,
        start: Instant,
    ) -> Result<(Vec<u8>, Figures), Error> {
        let lists: Vec<Uploaded<'_>> = procedure.lists.iter().map(|list| upload(&gpu.device, list)).collect();
        let placements = placements(&gpu.device, &geometry.placements(&procedure.view));
        let planning_ms = start.elapsed().as_secs_f64() * 1e3;
        let passes: Vec<Ready<'_>> =
            procedure.passes.iter().map(|pass| self.ready(gpu, &lists, *pass, false)).collect();
        let ledge = if procedure.ledge { LEDGE } else { 0.0 };
        let (mut mask, render_ms) =
            self.play(gpu, geometry, &procedure.view, procedure.start, ledge, &placements, |render_pass| {
                for ready in &passes {
                    ready.encode(render_pass, procedure, ledge);
                }
            })?;
        if procedure.inverted {
            // As `NotEqual` for `Equal` would have it; what is no surface is left out afterwards.
            mask.iter_mut().for_each(|verdict| *verdict = 255 - *verdict);
        }
        let counted: Vec<Ready<'_>> =
            procedure.passes.iter().map(|pass| self.ready(gpu, &lists, *pass, true)).collect();
        let fragments = self.count(gpu, procedure.view.size, &placements, |render_pass| {
            for ready in &counted {
                ready.encode(render_pass, procedure, 0.0);
            }
        })?;
        let triangles = procedure.passes.iter().map(|pass| procedure.lists[pass.list].triangles()).sum();
        let passes = procedure.passes.len() as u32 + 2;
        Ok((mask, Figures { triangles, vertices: 3 * triangles, fragments, passes, planning_ms, render_ms }))
    }

    /// Depth, then what `count` draws over it into a stencil that starts at `start`, then the verdict. The mask, and
    /// milliseconds of a plain run.
    #[expect(clippy::too_many_arguments, reason = "what a run consists of")]
    pub fn play(
        &mut self,
        gpu: &Gpu,
        geometry: &Geometry,
        view: &View,
        start: u32,
        ledge: f32,
        placements: &Buffer,
        count: impl Fn(&mut RenderPass<'_>),
    ) -> Result<(Vec<u8>, f64), Error> {
        let targets = Targets::fit(&mut self.targets, gpu, view.size)?;
        let pipelines = &self.pipelines;
        let run = || {
            let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
            let mut pass = targets.begin(&mut encoder, start);
            set_depth_range(&mut pass, view.size, 0.0..1.0 - ledge);
            pass.set_vertex_buffer(1, placements.slice(..));
            draw_surfaces(&mut pass, geometry, &pipelines.surfaces);
            count(&mut pass);
            drop(pass);
            verdict(&mut encoder, targets, pipelines);
            gpu.queue.submit([encoder.finish()]);
        };
        let render_ms = timed(gpu, run)?;
        Ok((gpu.read_texture(&targets.mask)?, render_ms))
    }

    /// What `before` encodes, then depth, then every visible surface once more with `surfaces`, which write the verdict. What
    /// they wrote, and milliseconds of a plain run.
    pub fn forward(
        &mut self,
        gpu: &Gpu,
        geometry: &Geometry,
        view: &View,
        surfaces: &Surfaces,
        before: impl Fn(&mut CommandEncoder),
    ) -> Result<(Vec<u8>, f64), Error> {
        let placements = placements(&gpu.device, &geometry.placements(view));
        let targets = Targets::fit(&mut self.targets, gpu, view.size)?;
        let pipelines = &self.pipelines;
        let run = || {
            let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
            before(&mut encoder);
            let mut pass = targets.begin(&mut encoder, 0);
            pass.set_vertex_buffer(1, placements.slice(..));
            draw_surfaces(&mut pass, geometry, &pipelines.surfaces);
            drop(pass);
            let mut pass = targets.begin_verdict(&mut encoder);
            pass.set_vertex_buffer(1, placements.slice(..));
            pass.set_bind_group(0, &surfaces.bind_group, &[]);
            draw_surfaces(&mut pass, geometry, &surfaces.pipelines);
            drop(pass);
            gpu.queue.submit([encoder.finish()]);
        };
        let render_ms = timed(gpu, run)?;
        Ok((gpu.read_texture(&targets.mask)?, render_ms))
    }

    /// Draws what casts, from both sides, to a depth of `format` and nothing else.
    pub fn map_pipeline(&self, device: &Device, format: wgpu::TextureFormat) -> RenderPipeline {
        self.pipelines.map(device, format)
    }

    /// Counters, and a pipeline that counts what casts as it is drawn to a depth of `format`.
    pub fn counting_surfaces(&self, device: &Device, format: wgpu::TextureFormat) -> (Counters, RenderPipeline) {
        let counters = Counters::new(device, &self.pipelines.counters);
        (counters, self.pipelines.counting_surfaces(device, format))
    }

    /// How many fragments `draw` makes with pipelines that count.
    fn count(
        &mut self,
        gpu: &Gpu,
        size: [u32; 2],
        placements: &Buffer,
        draw: impl Fn(&mut RenderPass<'_>),
    ) -> Result<u64, Error> {
        let targets = Targets::fit(&mut self.targets, gpu, size)?;
        let counters = Counters::new(&gpu.device, &self.pipelines.counters);
        let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        let mut pass = targets.begin(&mut encoder, 0);
        pass.set_vertex_buffer(1, placements.slice(..));
        pass.set_bind_group(0, &counters.bind_group, &[]);
        draw(&mut pass);
        drop(pass);
        counters.read(gpu, encoder)
    }

    /// How many fragments all of `volumes` make, drawn once.
    pub fn fragments(&mut self, gpu: &Gpu, geometry: &Geometry, view: &View, volumes: &Volumes) -> Result<u64, Error> {
        let lists = [upload(&gpu.device, volumes)];
        let placements = placements(&gpu.device, &geometry.placements(view));
        let ready = self.ready(gpu, &lists, Pass::Z_PASS, true);
        self.count(gpu, view.size, &placements, |render_pass| ready.draw(render_pass, view.size))
    }

    fn ready<'v>(&mut self, gpu: &Gpu, lists: &'v [Uploaded<'v>], pass: Pass, counting: bool) -> Ready<'v> {
        let list = &lists[pass.list];
        let draws = list.draws.iter().map(|draw| {
            let pipelines = [draw.mirrored, !draw.mirrored].map(|clockwise| match counting {
                true => self.pipelines.counting(&gpu.device, pass.cull, clockwise).clone(),
                false => self.pipelines.volume(&gpu.device, &pass, clockwise).clone(),
            });
            (list, draw, pipelines)
        });
        Ready { pass, draws: draws.collect() }
    }
}

impl Ready<'_> {
    fn encode(&self, render_pass: &mut RenderPass<'_>, procedure: &Procedure, ledge: f32) {
        let range = if self.pass.on_ledge { 1.0 - ledge..1.0 } else { 0.0..1.0 - ledge };
        set_depth_range(render_pass, procedure.view.size, range);
        self.draw(render_pass, procedure.view.size);
    }

    fn draw(&self, render_pass: &mut RenderPass<'_>, size: [u32; 2]) {
        for (list, draw, [outward, inward]) in &self.draws {
            let [x, y, width, height] = draw.scissor.unwrap_or([0, 0, size[0], size[1]]);
            render_pass.set_scissor_rect(x, y, width, height);
            render_pass.set_vertex_buffer(0, list.vertices.slice(..));
            render_pass.set_index_buffer(list.indices.slice(..), wgpu::IndexFormat::Uint32);
            for (pipeline, range) in [(outward, &draw.outward), (inward, &draw.inward)] {
                if !range.is_empty() {
                    render_pass.set_pipeline(pipeline);
                    render_pass.draw_indexed(range.clone(), draw.first_vertex, draw.placement..draw.placement + 1);
                }
            }
        }
        render_pass.set_scissor_rect(0, 0, size[0], size[1]);
    }
}

/// Draws all that is visible, with the pipelines for each winding and for one or two sides.
fn draw_surfaces(pass: &mut RenderPass<'_>, geometry: &Geometry, pipelines: &[[RenderPipeline; 2]; 2]) {
    for (number, instance) in (0..).zip(&geometry.instances) {
        let Some(mesh) = &geometry.meshes[instance.mesh] else { continue };
        let mirrored = instance.world_from_object.matrix3.determinant() < 0.0;
        pass.set_vertex_buffer(0, mesh.positions.slice(..));
        pass.set_index_buffer(mesh.triangles.slice(..), wgpu::IndexFormat::Uint32);
        for (range, double_sided) in &mesh.visible {
            pass.set_pipeline(&pipelines[usize::from(mirrored)][usize::from(*double_sided)]);
            pass.draw_indexed(range.clone(), 0, number..number + 1);
        }
    }
}

/// Milliseconds of `run` until the device is idle, from when it is; the median of [`RUNS`].
pub fn timed(gpu: &Gpu, run: impl Fn()) -> Result<f64, RenderError> {
    let mut times = [0.0; RUNS];
    gpu.wait()?;
    for time in &mut times {
        let start = Instant::now();
        run();
        gpu.wait()?;
        *time = start.elapsed().as_secs_f64() * 1e3;
    }
    times.sort_by(f64::total_cmp);
    Ok(times[RUNS / 2])
}

/// Matrices of instances as a vertex buffer.
pub fn placements(device: &Device, placements: &[Placement]) -> Buffer {
    let contents = bytemuck::cast_slice(placements);
    device.create_buffer_init(&BufferInitDescriptor {
        label: Some("placements"),
        contents,
        usage: BufferUsages::VERTEX,
    })
}

fn upload<'v>(device: &Device, volumes: &'v Volumes) -> Uploaded<'v> {
    // Empty buffers cannot be bound.
    const NOTHING: [u8; 4] = [0; 4];
    let buffer = |contents: &[u8], usage| {
        let contents = if contents.is_empty() { &NOTHING } else { contents };
        device.create_buffer_init(&BufferInitDescriptor { label: Some("volumes"), contents, usage })
    };
    Uploaded {
        vertices: buffer(bytemuck::cast_slice(&volumes.vertices), BufferUsages::VERTEX),
        indices: buffer(bytemuck::cast_slice(&volumes.indices), BufferUsages::INDEX),
        draws: &volumes.draws,
    }
}

fn set_depth_range(pass: &mut RenderPass<'_>, size: [u32; 2], range: std::ops::Range<f32>) {
    let [width, height] = size.map(|side| side as f32);
    pass.set_viewport(0.0, 0.0, width, height, range.start, range.end);
}

/// Lit where the stencil is 0.
fn verdict(encoder: &mut CommandEncoder, targets: &Targets, pipelines: &Pipelines) {
    let mut pass = targets.begin_verdict(encoder);
    pass.set_stencil_reference(0);
    pass.set_pipeline(&pipelines.verdict);
    pass.draw(0..3, 0..1);
}

#[cfg(test)]
mod tests {
    use zfail_testing::{naga::valid::Capabilities, wgsl::validate};

    /// Also those that few devices can run.
    #[test]
    fn every_program_is_valid() {
        let rays = ["enable wgpu_ray_query;\n", SURFACE, include_str!("../ray_query/ray_query.wgsl")].concat();
        let map = [SURFACE, include_str!("../shadow_map.wgsl")].concat();
        for source in [include_str!("stage.wgsl"), &map, &rays] {
            validate(source, Capabilities::RAY_QUERY).unwrap_or_else(|message| panic!("{message}"));
            let faulty = format!("{source}fn wrong() -> f32 {{ return 1u; }}");
            assert!(validate(&faulty, Capabilities::RAY_QUERY).is_err());
        }
    }

    const SURFACE: &str = include_str!("surface.wgsl");
}
