//! `zfail bench --host`: what a frame's shadows cost the CPU, however fast the device is.
//!
//! In: how many casters and lights, what moves, by which technique. Out: milliseconds to prepare, encode and submit a frame on
//! wgpu's noop device, which does nothing with it, and what went there: draws, bytes, allocations. Every frame is prepared by
//! each technique before the next one is, so that what drifts in the machine drifts for all alike.

mod crowd;

pub use crowd::{Boxes, Moves};

use super::args::Args;
use super::record::Spread;
use super::table::columns;
use crate::console;
use crate::error::Error;
use crowd::Crowd;
use serde::Serialize;
use std::time::Instant;
use zfail_render::zfail::{Frame, MeshDescriptor, Pipelines, Shadows, Steps, Target, low_level};
use zfail_render::{Technique, wgpu};
use zfail_scene::Mesh;

/// Frames before the clock counts.
const WARM_UP: usize = 3;

/// One crowd by one technique.
#[derive(Debug, Serialize)]
pub struct Line {
    pub casters: usize,
    pub lights: usize,
    pub triangles_per_caster: usize,
    pub moves: Moves,
    pub technique: &'static str,
    pub receivers: Boxes,
    pub prepare_ms: Spread,
    pub encode_ms: Spread,
    pub submit_ms: Spread,
    /// Of the last frame, as the following.
    pub draws: usize,
    pub uploaded_bytes: u64,
    /// On the thread that prepares and encodes.
    pub allocations: u64,
}

/// Measures all that `args` ask for.
///
/// # Errors
/// If there is no noop device, which would be a fault of the build.
pub fn measure(args: &Args) -> Result<Vec<Line>, Error> {
    let (device, queue) = noop()?;
    let body = crowd::body();
    let techniques = super::measure::techniques(&args.techniques);
    let mut cases = Vec::new();
    for &casters in &args.casters {
        for &lights in &args.lights {
            for &boxes in &args.receivers {
                cases.extend(args.moves.iter().map(|&moves| (casters, lights, boxes, moves)));
            }
        }
    }
    let progress = console::progress(cases.len(), args.verbosity.quiet);
    let mut lines = Vec::new();
    for (casters, lights, boxes, moves) in cases {
        progress.set_message(format!("{casters} casters, {lights} lights"));
        let mut players = techniques
            .iter()
            .map(|&technique| Player::new(&device, &queue, &body, technique, [casters, lights], boxes, moves))
            .collect::<Result<Vec<_>, _>>()?;
        for frame in 0..WARM_UP + args.frames as usize {
            for player in &mut players {
                player.play(&device, &queue, frame)?;
            }
        }
        lines.extend(
            players.into_iter().map(|player| player.line([casters, lights, body.triangles.len()], boxes, moves)),
        );
        progress.inc(1);
    }
    progress.finish_and_clear();
    Ok(lines)
}

/// A device that does nothing.
fn noop() -> Result<(wgpu::Device, wgpu::Queue), Error> {
    let backend_options =
        wgpu::BackendOptions { noop: wgpu::NoopBackendOptions::enabled(), ..wgpu::BackendOptions::default() };
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor {
        backends: wgpu::Backends::NOOP,
        backend_options,
        ..wgpu::InstanceDescriptor::new_without_display_handle()
    });
    let failed = |what: &dyn std::fmt::Display| Error::failed(format!("no device for measuring the host: {what}"));
    let adapter = pollster::block_on(instance.request_adapter(&wgpu::RequestAdapterOptions::default()));
    let adapter = adapter.map_err(|e| failed(&e))?;
    let required_features = wgpu::Features::DEPTH32FLOAT_STENCIL8;
    let required_limits = adapter.limits();
    let descriptor = wgpu::DeviceDescriptor { required_features, required_limits, ..wgpu::DeviceDescriptor::default() };
    pollster::block_on(adapter.request_device(&descriptor)).map_err(|e| failed(&e))
}

/// One technique's renderer, and the frames that it has seen.
struct Player {
    technique: Technique,
    crowd: Crowd,
    shadows: Shadows,
    pipelines: Pipelines,
    depth: wgpu::TextureView,
    /// Milliseconds to prepare, encode and submit.
    times: [Vec<f64>; 3],
    draws: usize,
    uploaded: u64,
    allocations: u64,
}

impl Player {
    fn new(
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        body: &Mesh,
        technique: Technique,
        [casters, lights]: [usize; 2],
        boxes: Boxes,
        moves: Moves,
    ) -> Result<Self, Error> {
        let mut shadows = Shadows::new(device, queue);
        let Mesh { positions, triangles, .. } = body;
        let mesh = shadows.add_mesh(&MeshDescriptor { positions, triangles, ..MeshDescriptor::default() })?;
        let crowd = Crowd::new(mesh, casters, lights, moves, boxes);
        let depth_stencil = wgpu::TextureFormat::Depth32FloatStencil8;
        let depth = device.create_texture(&wgpu::TextureDescriptor {
            label: Some("depth"),
            size: wgpu::Extent3d { width: crowd.view.size[0], height: crowd.view.size[1], depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: depth_stencil,
            usage: wgpu::TextureUsages::RENDER_ATTACHMENT,
            view_formats: &[],
        });
        let pipelines = shadows.pipelines(&Target { colors: &[], depth_stencil, samples: 1 });
        let depth = depth.create_view(&wgpu::TextureViewDescriptor::default());
        let times = [Vec::new(), Vec::new(), Vec::new()];
        Ok(Self { technique, crowd, shadows, pipelines, depth, times, draws: 0, uploaded: 0, allocations: 0 })
    }

    fn play(&mut self, device: &wgpu::Device, queue: &wgpu::Queue, frame: usize) -> Result<(), Error> {
        self.crowd.step(frame);
        let Self { crowd, shadows, pipelines, depth, .. } = self;
        let (mut outcome, mut times) = (Ok((0, 0)), [0.0; 3]);
        let counted = allocation_counter::measure(|| {
            outcome = (|| {
                let start = Instant::now();
                let frame = Frame::new(&crowd.view, &crowd.casters, &crowd.lights).receivers(&crowd.receivers);
                let prepared = shadows.prepare(&frame.steps(Steps::from(self.technique)))?;
                times[0] = start.elapsed().as_secs_f64() * 1e3;

                let start = Instant::now();
                let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
                for light in 0..crowd.lights.len() {
                    let mut pass = begin(&mut encoder, depth);
                    prepared.draw(&mut pass, pipelines, light);
                }
                let commands = encoder.finish();
                times[1] = start.elapsed().as_secs_f64() * 1e3;

                let start = Instant::now();
                queue.submit([commands]);
                times[2] = start.elapsed().as_secs_f64() * 1e3;
                Ok((low_level::plan(&prepared).draws.len(), low_level::uploaded_bytes(&prepared)))
            })();
        });
        device.poll(wgpu::PollType::Poll)?;
        let draws: Result<(usize, u64), Error> = outcome;
        (self.draws, self.uploaded) = draws?;
        self.allocations = counted.count_total;
        if frame >= WARM_UP {
            self.times.iter_mut().zip(times).for_each(|(list, time)| list.push(time));
        }
        Ok(())
    }

    fn line(self, [casters, lights, triangles_per_caster]: [usize; 3], receivers: Boxes, moves: Moves) -> Line {
        let [prepare_ms, encode_ms, submit_ms] = self.times.map(|times| Spread::of(times.into_iter()));
        Line {
            casters,
            lights,
            triangles_per_caster,
            moves,
            technique: self.technique.name(),
            receivers,
            prepare_ms,
            encode_ms,
            submit_ms,
            draws: self.draws,
            uploaded_bytes: self.uploaded,
            allocations: self.allocations,
        }
    }
}

/// A pass over depth that has been drawn, with a stencil of its own.
fn begin<'e>(encoder: &'e mut wgpu::CommandEncoder, depth: &wgpu::TextureView) -> wgpu::RenderPass<'e> {
    encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        label: Some("volumes"),
        depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
            view: depth,
            depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(0.0), store: wgpu::StoreOp::Store }),
            stencil_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(0), store: wgpu::StoreOp::Store }),
        }),
        ..wgpu::RenderPassDescriptor::default()
    })
}

/// The lines as a table.
pub fn table(lines: &[Line]) -> String {
    let heading = [
        "casters x lights",
        "boxes",
        "moves",
        "technique",
        "prepare ms",
        "encode ms",
        "submit ms",
        "draws",
        "bytes",
        "allocations",
    ];
    let mut rows = vec![heading.map(str::to_owned).to_vec()];
    let name = |value: clap::builder::PossibleValue| value.get_name().to_owned();
    rows.extend(lines.iter().map(|line| {
        let named = |value: Option<clap::builder::PossibleValue>| value.map_or_else(String::new, name);
        vec![
            format!("{} x {}", line.casters, line.lights),
            named(clap::ValueEnum::to_possible_value(&line.receivers)),
            named(clap::ValueEnum::to_possible_value(&line.moves)),
            line.technique.to_owned(),
            format!("{:.3}", line.prepare_ms.median),
            format!("{:.3}", line.encode_ms.median),
            format!("{:.3}", line.submit_ms.median),
            line.draws.to_string(),
            line.uploaded_bytes.to_string(),
            line.allocations.to_string(),
        ]
    }));
    let about = "Spheres of 256 triangles, 1920x1080, on a device that does nothing. Medians; draws, bytes and allocations of a frame.\n\n";
    about.to_owned() + &columns(&rows)
}
