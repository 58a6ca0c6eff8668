//! The order of passes: ambient; for every light shadow and illumination; final; exposure and tone mapping
//! (McGuire et al. 2003, section 8).

use crate::ambient_pass::AmbientPass;
use crate::develop_pass::DevelopPass;
use crate::exposure::ExposureMeter;
use crate::final_pass::FinalPass;
use crate::frame::FrameData;
use crate::gpu_data::LightRecord;
use crate::illuminate_pass::IlluminatePass;
use crate::layouts::Layouts;
use crate::mask_pass::{Mask, MaskPass};
use crate::scene::SceneOnGpu;
use crate::shadow_pass::ShadowPass;
use crate::stats::{FrameStats, LightFigures};
use crate::targets::Targets;
use crate::timing::{PassTimes, Timer};
use crate::{AovKind, Aovs, Gpu, Picture, RenderError, Settings, lights, read_back, surface_outputs};
use half::f16;
use std::collections::HashMap;
use std::time::Instant;
use zfail::{Counting, LightStats};
use zfail_plan::scene::{Pose, Scene};
use zfail_plan::view::View;

/// A scene on the device, ready to be rendered from any view.
#[derive(Debug)]
pub struct Renderer<'g> {
    gpu: &'g Gpu,
    layouts: Layouts,
    scene: SceneOnGpu,
    /// By sample count.
    passes: HashMap<u32, Passes>,
    mask: Option<MaskPass>,
    targets: Option<Targets>,
    frame: FrameData,
}

/// Everything that depends on the sample count alone.
#[derive(Debug)]
struct Passes {
    ambient: AmbientPass,
    shadow: ShadowPass,
    illuminate: IlluminatePass,
    last: FinalPass,
    meter: ExposureMeter,
    develop: DevelopPass,
}

impl<'g> Renderer<'g> {
    /// Uploads `scene`.
    ///
    /// # Errors
    /// If the scene is inconsistent or the device runs out of memory.
    pub fn new(gpu: &'g Gpu, scene: &Scene) -> Result<Self, RenderError> {
        let layouts = Layouts::new(&gpu.device);
        let scene = SceneOnGpu::new(gpu, &layouts, scene)?;
        let frame = FrameData::new(gpu, &layouts, scene.instances.len(), scene.lights.len())?;
        Ok(Self { gpu, layouts, scene, passes: HashMap::new(), mask: None, targets: None, frame })
    }

    /// Moves the scene's instances and lights; meshes, materials and everything derived from them stay on the device.
    /// Cameras are the caller's business: every frame is given its own [`View`].
    ///
    /// # Errors
    /// If the pose has another number of instances or lights than the scene, or is not finite. The old pose stays then.
    pub fn set_pose(&mut self, pose: &Pose) -> Result<(), RenderError> {
        self.scene.pose(pose)
    }

    /// Renders one picture: a frame as of [`Renderer::render`], read back.
    ///
    /// # Errors
    /// As for [`Renderer::render`].
    pub fn picture(&mut self, view: &View, settings: &Settings) -> Result<(Picture, FrameStats), RenderError> {
        let stats = self.render(view, settings)?;
        let targets = self.targets.as_ref().ok_or_else(no_targets)?;
        Ok((develop(self.gpu, targets)?, stats))
    }

    /// Renders one frame and waits for the device, but leaves the picture there.
    ///
    /// # Errors
    /// If the settings do not fit the scene or the device, or the device fails.
    pub fn render(&mut self, view: &View, settings: &Settings) -> Result<FrameStats, RenderError> {
        let samples = settings.samples;
        if !matches!(samples, 1 | 4) {
            return Err(RenderError::Samples(samples));
        }
        // wgpu attaches multisampled textures on GL in a way that only render-to-texture extensions know.
        if samples > 1 && self.gpu.info.backend == wgpu::Backend::Gl {
            return Err(RenderError::NoMultisampling { backend: self.gpu.info.backend });
        }
        let chosen = self.scene.chosen(settings)?;
        let targets = reuse(&mut self.targets, self.gpu, &self.layouts, view.size, samples)?;

        let start = Instant::now();
        let figures = if settings.shadows {
            self.scene.plan(self.gpu, view, &chosen, settings, Counting::Verdict)?
        } else {
            vec![unplanned(view); chosen.len()]
        };
        let planning_ms = start.elapsed().as_secs_f64() * 1e3;

        let pre_exposure = update_frame(&mut self.frame, self.gpu, &self.layouts, &self.scene, view, &chosen)?;
        let frame = &self.frame;
        let passes =
            self.passes.entry(samples).or_insert_with(|| Passes::new(self.gpu, &self.layouts, &self.scene, samples));
        let order = PassOrder { lights: chosen.len(), shadows: settings.shadows };
        let timer = Timer::new(self.gpu, order.count());
        let mut encoder = self.gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        let background = self.scene.background.map(|c| half_float(c * pre_exposure));
        passes.ambient.encode(&mut encoder, targets, frame, &self.scene, background, timer.pass(0));
        for (i, figures) in figures.iter().enumerate() {
            if let Some(pass) = order.shadow(i) {
                passes.shadow.encode(&mut encoder, targets, &self.scene.shadows, i, timer.pass(pass));
            }
            let time = timer.pass(order.illuminate(i));
            passes.illuminate.encode(&mut encoder, targets, frame, i as u32, figures.scissor, time);
        }
        passes.last.encode(&mut encoder, targets, frame, &self.scene, timer.pass(order.last()));
        passes.meter.encode(self.gpu, &mut encoder, targets, settings.exposure, pre_exposure);
        let exposure = &passes.meter.exposure;
        passes.develop.encode(self.gpu, &mut encoder, targets, exposure, timer.pass(order.develop()));
        timer.resolve(&mut encoder);
        self.gpu.queue.submit([encoder.finish()]);

        self.gpu.wait()?;
        let times = timer.read(self.gpu)?;
        let lights = chosen
            .iter()
            .zip(figures)
            .enumerate()
            .map(|(i, (&l, figures))| {
                light_figures(lights::kind_name(&self.scene.lights[l].kind), figures, &times, &order, i)
            })
            .collect();
        Ok(FrameStats {
            adapter: self.gpu.info.name.clone(),
            backend: self.gpu.info.backend.to_string(),
            depth_format: format!("{:?}", self.gpu.depth_stencil),
            planning_ms,
            gpu_ms: times.total_ms(),
            lights,
        })
    }

    /// Renders the outputs of `kinds`, always at one sample per pixel.
    ///
    /// # Errors
    /// As for [`Renderer::picture`].
    pub fn aovs(&mut self, view: &View, settings: &Settings, kinds: &[AovKind]) -> Result<Aovs, RenderError> {
        let chosen = self.scene.chosen(settings)?;
        let targets = reuse(&mut self.targets, self.gpu, &self.layouts, view.size, 1)?;
        update_frame(&mut self.frame, self.gpu, &self.layouts, &self.scene, view, &chosen)?;
        let frame = &self.frame;
        let passes = self.passes.entry(1).or_insert_with(|| Passes::new(self.gpu, &self.layouts, &self.scene, 1));
        let mask = self.mask.get_or_insert_with(|| MaskPass::new(self.gpu, &self.layouts));
        let encoder = || self.gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());

        let mut first = encoder();
        passes.ambient.encode(&mut first, targets, frame, &self.scene, [0.0; 3], None);
        self.gpu.queue.submit([first.finish()]);
        let mut out = Aovs { size: view.size, ..Aovs::default() };
        surface_outputs::fill(&mut out, self.gpu, targets, view, kinds)?;

        for (kind, counting, what, images) in [
            (AovKind::Shadow, Counting::Verdict, Mask::Reached, &mut out.shadow),
            (AovKind::Stencil, Counting::Raw, Mask::Count, &mut out.stencil),
        ] {
            if !kinds.contains(&kind) {
                continue;
            }
            if settings.shadows {
                self.scene.plan(self.gpu, view, &chosen, settings, counting)?;
            }
            for light in 0..chosen.len() {
                let mut encoder = encoder();
                if settings.shadows {
                    passes.shadow.encode(&mut encoder, targets, &self.scene.shadows, light, None);
                }
                images.push(mask.read(self.gpu, encoder, targets, frame, light as u32, what)?);
            }
        }
        Ok(out)
    }
}

impl Passes {
    fn new(gpu: &Gpu, layouts: &Layouts, scene: &SceneOnGpu, samples: u32) -> Self {
        Self {
            ambient: AmbientPass::new(gpu, layouts, samples, &scene.draws),
            shadow: ShadowPass::new(gpu, &scene.shadows, samples),
            illuminate: IlluminatePass::new(gpu, layouts, samples),
            last: FinalPass::new(gpu, layouts, samples, &scene.draws),
            meter: ExposureMeter::new(gpu, samples),
            develop: DevelopPass::new(gpu, samples),
        }
    }
}

/// Numbers the passes of a frame in the order of their encoding.
struct PassOrder {
    lights: usize,
    shadows: bool,
}

impl PassOrder {
    fn shadow(&self, light: usize) -> Option<usize> {
        self.shadows.then_some(1 + 2 * light)
    }

    fn illuminate(&self, light: usize) -> usize {
        if self.shadows { 2 + 2 * light } else { 1 + light }
    }

    fn last(&self) -> usize {
        self.illuminate(self.lights) - usize::from(self.shadows)
    }

    fn develop(&self) -> usize {
        self.last() + 1
    }

    fn count(&self) -> usize {
        self.develop() + 1
    }
}

/// The targets of the last frame if they fit, or new ones.
fn reuse<'t>(
    kept: &'t mut Option<Targets>,
    gpu: &Gpu,
    layouts: &Layouts,
    size: [u32; 2],
    samples: u32,
) -> Result<&'t Targets, RenderError> {
    if kept.as_ref().is_none_or(|t| t.size != size || t.samples != samples) {
        // The old ones go first: both together may be more than there is memory.
        *kept = None;
        let targets = Targets::new(gpu, layouts, size, samples)?;
        gpu.check()?;
        *kept = Some(targets);
    }
    kept.as_ref().ok_or_else(no_targets)
}

fn no_targets() -> RenderError {
    RenderError::Device("no render targets".to_owned())
}

/// Uploads view, lights and instances; returns the frame's pre-exposure.
fn update_frame(
    frame: &mut FrameData,
    gpu: &Gpu,
    layouts: &Layouts,
    scene: &SceneOnGpu,
    view: &View,
    chosen: &[usize],
) -> Result<f32, RenderError> {
    let lit = chosen.iter().map(|&l| &scene.lights[l]);
    let pre_exposure =
        lights::pre_exposure(lit.clone(), &scene.bounds, &[scene.ambient, scene.background, scene.emission]);
    let records: Vec<LightRecord> = lit.map(|light| lights::record(light, view, pre_exposure)).collect();
    let ambient = scene.ambient.map(|c| c * pre_exposure);
    if !frame.holds(records.len()) {
        // A light may be chosen more than once.
        *frame = FrameData::new(gpu, layouts, scene.instances.len(), records.len())?;
    }
    frame.update(gpu, view, &scene.instances, &records, ambient, pre_exposure);
    Ok(pre_exposure)
}

/// The nearest finite half float that is not negative.
fn half_float(value: f32) -> f32 {
    f16::from_f32(value.clamp(0.0, 65504.0)).to_f32()
}

/// What is known of a light whose shadows nobody asked for.
fn unplanned(view: &View) -> LightStats {
    LightStats { scissor: [0, 0, view.size[0], view.size[1]], ..LightStats::default() }
}

fn light_figures(
    kind: &'static str,
    figures: LightStats,
    times: &PassTimes,
    order: &PassOrder,
    light: usize,
) -> LightFigures {
    LightFigures {
        kind,
        casters: figures.casters,
        culled: figures.reasons().map(|(reason, count)| (reason.name(), count)).collect(),
        cases: figures.cases,
        triangles: crate::TriangleFigures {
            sides: figures.triangles.sides,
            dark_cap: figures.triangles.dark_cap,
            light_cap: figures.triangles.light_cap,
        },
        vertices: figures.vertices,
        fragments: None,
        scissor: figures.scissor,
        shadow_ms: order.shadow(light).and_then(|pass| times.pass_ms(pass)),
        light_ms: times.pass_ms(order.illuminate(light)),
    }
}

/// Reads the finished picture.
fn develop(gpu: &Gpu, targets: &Targets) -> Result<Picture, RenderError> {
    let texels: Vec<[u16; 4]> = bytemuck::pod_collect_to_vec(&read_back::texture(gpu, &targets.hdr)?);
    let hdr = texels.iter().map(|&[r, g, b, _]| [r, g, b].map(|c| f16::from_bits(c).to_f32())).collect();
    Ok(Picture { size: targets.size, hdr, rgba8: read_back::texture(gpu, &targets.ldr)? })
}
