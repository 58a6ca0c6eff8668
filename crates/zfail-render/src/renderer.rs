//! The order of passes: verdicts of all lights; forward shading; exposure and tone mapping where the forward pass could
//! not do it (McGuire et al. 2003, section 8).

use crate::attribute_pass::AttributePass;
use crate::develop_pass::DevelopPass;
use crate::exposure::ExposureMeter;
use crate::forward_pass::{Attachments, ForwardPass, Shadows, Step};
use crate::fragment_counter::FragmentCounter;
use crate::frame::{FrameData, Shading};
use crate::further_pass::FurtherPass;
use crate::gpu_data::LightRecord;
use crate::layouts::Layouts;
use crate::mask_pass::{Mask, MaskPass};
use crate::pipeline::{cleared, cleared_depth, continued, read_only};
use crate::scene::SceneOnGpu;
use crate::shadow_pass::ShadowPass;
use crate::stats::{FrameStats, LightFigures};
use crate::targets::{Attributes, Targets};
use crate::timing::Timer;
use crate::verdict_pass::{self, Verdict, VerdictPass, VerdictTargets};
use crate::{
    AovKind, Aovs, Exposure, Gpu, Picture, RenderError, Settings, attribute_outputs, lights, read_back, tone_map,
};
use half::f16;
use std::collections::HashMap;
use std::ops::Range;
use std::time::Instant;
use zfail::{Counting, LightStats};
use zfail_plan::scene::{LightKind, Pose, Scene};
use zfail_plan::view::View;

/// A scene on the device, ready to be rendered from any view.
#[derive(Debug)]
pub struct Renderer<'g> {
    gpu: &'g Gpu,
    layouts: Layouts,
    scene: SceneOnGpu,
    frame: FrameData,
    forward: ForwardPass,
    /// By sample count and whether verdicts become bits.
    verdicts: HashMap<(u32, bool), VerdictPass>,
    /// By sample count.
    darkroom: HashMap<u32, (ExposureMeter, DevelopPass)>,
    /// By sample count.
    further: HashMap<u32, FurtherPass>,
    targets: Option<Targets>,
    timer: Timer,
    measured: Option<Measured>,
    /// Whether the last frame had shadows.
    shadowed: bool,
    fragments: Option<FragmentCounter>,
}

/// What measured outputs need.
#[derive(Debug)]
struct Measured {
    attributes: AttributePass,
    shadow: ShadowPass,
    mask: MaskPass,
    targets: Attributes,
}

/// How a picture is finished.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Finish {
    /// By the forward pass itself.
    Forward,
    /// From radiance.
    Darkroom,
}

impl<'g> Renderer<'g> {
    /// Uploads `scene`.
    ///
    /// # Errors
    /// If the scene is inconsistent or the device runs out of memory.
    pub fn new(gpu: &'g Gpu, scene: &Scene) -> Result<Self, RenderError> {
        let layouts = Layouts::new(&gpu.device);
        let scene = SceneOnGpu::new(gpu, &layouts, scene)?;
        Ok(Self {
            gpu,
            frame: FrameData::new(gpu, &layouts, &scene.shapes.buffer),
            scene,
            layouts,
            forward: ForwardPass::default(),
            verdicts: HashMap::new(),
            darkroom: HashMap::new(),
            further: HashMap::new(),
            targets: None,
            timer: Timer::default(),
            measured: None,
            shadowed: false,
            fragments: None,
        })
    }

    /// Moves the scene's instances and lights, and the vertices of meshes that bend; all else that was made of meshes and
    /// materials stays on the device. Cameras are the caller's business: every frame is given its own [`View`].
    ///
    /// # Errors
    /// If the pose has another number of instances, lights or vertices than the scene, or is not finite. The old pose stays
    /// then.
    pub fn set_pose(&mut self, pose: &Pose) -> Result<(), RenderError> {
        self.scene.pose(self.gpu, pose)
    }

    /// Takes the lights of `scene`, which otherwise is the one that was uploaded: any number of them, with whatever colour,
    /// place, shape and excluded casters. Meshes and textures stay on the device.
    ///
    /// # Errors
    /// If it is another scene, or a light refers to what is not there. The old lights stay then.
    pub fn set_lights(&mut self, scene: &Scene) -> Result<(), RenderError> {
        if self.scene.set_lights(self.gpu, scene)? {
            self.frame.set_shapes(self.gpu, &self.layouts, &self.scene.shapes.buffer);
        }
        Ok(())
    }

    /// Takes from `scene`, which otherwise is the one that was uploaded, in its present pose, which instances cast shadows.
    ///
    /// # Errors
    /// If it is another scene, or the device runs out of memory.
    pub fn set_casting(&mut self, scene: &Scene) -> Result<(), RenderError> {
        self.scene.set_casting(self.gpu, scene)
    }

    /// Renders one picture and reads it back.
    ///
    /// # Errors
    /// As for [`Renderer::render`].
    pub fn picture(&mut self, view: &View, settings: &Settings) -> Result<(Picture, FrameStats), RenderError> {
        let stats = self.draw(view, settings, Finish::Darkroom)?;
        let targets = self.targets.as_mut().ok_or_else(no_targets)?;
        let texels: Vec<[u16; 4]> =
            bytemuck::pod_collect_to_vec(&read_back::texture(self.gpu, &targets.hdr(self.gpu).texture)?);
        let hdr = texels.iter().map(|&[r, g, b, _]| [r, g, b].map(|c| f16::from_bits(c).to_f32())).collect();
        let rgba8 = read_back::texture(self.gpu, &targets.ldr)?;
        Ok((Picture { size: targets.size, hdr, rgba8 }, stats))
    }

    /// Renders one frame and waits for the device, but leaves the picture there. With an [`Exposure::Ev`], one
    /// sample and no blended materials this is cheaper than [`Renderer::picture`] by more than the read-back: no radiance is kept.
    ///
    /// # Errors
    /// If the settings do not fit the scene or the device, or the device fails.
    pub fn render(&mut self, view: &View, settings: &Settings) -> Result<FrameStats, RenderError> {
        // What is blended or averaged has to be radiance.
        let direct = settings.samples == 1 && !self.scene.draws.blends;
        let known = matches!(settings.exposure, Exposure::Ev(_));
        let finish = if known && direct { Finish::Forward } else { Finish::Darkroom };
        self.draw(view, settings, finish)
    }

    /// Counts the fragments of the volumes that the last frame drew, of which `stats` tells, in passes of their own. With
    /// several samples per pixel it counts fragments of one; more than 2048 layers over a pixel count as 2048. Without
    /// shadows there are none.
    ///
    /// # Errors
    /// If the device fails.
    pub fn count_fragments(&mut self, stats: &mut FrameStats) -> Result<(), RenderError> {
        let Some(size) = self.targets.as_ref().map(|targets| targets.size) else { return Ok(()) };
        if self.fragments.as_ref().is_none_or(|counter| !counter.fits(size)) {
            self.fragments = Some(FragmentCounter::new(self.gpu, &self.scene.shadows, size));
        }
        let Some(counter) = &self.fragments else { return Ok(()) };
        for (l, light) in stats.lights.iter_mut().enumerate() {
            let shadows = Some(&self.scene.shadows).filter(|_| self.shadowed);
            light.fragments = Some(shadows.map_or(Ok(0), |shadows| counter.count(self.gpu, shadows, l))?);
        }
        Ok(())
    }

    /// The picture that [`Renderer::render`] or [`Renderer::picture`] left on the device, `Rgba8Unorm` with sRGB encoded
    /// by hand; to be sampled, copied, or drawn onto. Every new size has a texture of its own.
    #[must_use]
    pub fn shown(&self) -> Option<&wgpu::Texture> {
        self.targets.as_ref().map(|targets| &targets.ldr)
    }

    fn draw(&mut self, view: &View, settings: &Settings, finish: Finish) -> Result<FrameStats, RenderError> {
        let gpu = self.gpu;
        let samples = settings.samples;
        if !matches!(samples, 1 | 4) {
            return Err(RenderError::Samples(samples));
        }
        // wgpu attaches multisampled textures on GL in a way that only render-to-texture extensions know.
        if samples > 1 && gpu.info.backend == wgpu::Backend::Gl {
            return Err(RenderError::NoMultisampling { backend: gpu.info.backend });
        }
        let chosen = self.scene.chosen(settings)?;
        if self.targets.as_ref().is_none_or(|t| t.size != view.size || t.samples != samples) {
            // The old ones go first: both together may be more than there is memory.
            self.targets = None;
            self.targets = Some(Targets::new(gpu, view.size, samples)?);
        }

        let exposed = Exposed::new(&self.scene, &chosen, settings.exposure, view);
        let precision = exposed.precision(&self.scene, finish);
        let kinds: Vec<LightKind> =
            chosen.iter().map(|&l| lights::effective(&self.scene.lights[l], &precision)).collect();
        // Positions in `chosen` of the lights that make a difference.
        let active: Vec<usize> = (0..chosen.len()).filter(|&i| lights::is_visible(&kinds[i], view)).collect();

        let start = Instant::now();
        self.shadowed = settings.shadows;
        let figures = if settings.shadows {
            self.scene.plan(gpu, view, &chosen, &kinds, settings, Counting::Verdict)?
        } else {
            vec![unplanned(view); chosen.len()]
        };
        let readable = self.targets.as_ref().is_some_and(|targets| targets.depth.is_some());
        if settings.shadows && readable {
            self.scene.plan_tiles(gpu, settings)?;
        }
        let planning_ms = start.elapsed().as_secs_f64() * 1e3;

        self.scene.arrange(gpu, view);
        let parts = parts(active.len(), settings.shadows, !self.scene.draws.blended.is_empty());
        let finish = if parts.len() > 1 { Finish::Darkroom } else { finish };
        let divided = parts.iter().filter(|part| part.solid).count() > 1;
        let spans = Spans {
            shadows: settings.shadows,
            darkroom: finish == Finish::Darkroom,
            lights: if gpu.timestamps_inside { chosen.len() } else { 0 },
        };
        // Several steps would write the same queries.
        self.timer.begin(gpu, if divided { 0 } else { spans.count() });
        for (number, part) in parts.iter().enumerate() {
            self.step(view, &active, &kinds, &figures, &exposed, part, number > 0, finish, spans, settings)?;
        }
        let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        if finish == Finish::Darkroom {
            let targets = self.targets.as_mut().ok_or_else(no_targets)?;
            let (meter, develop) = self
                .darkroom
                .entry(samples)
                .or_insert_with(|| (ExposureMeter::new(gpu, samples), DevelopPass::new(gpu, samples)));
            let ldr = targets.ldr_view.clone();
            let hdr = targets.hdr(gpu);
            meter.encode(gpu, &mut encoder, &hdr.samples, view.size, settings.exposure, exposed.pre_exposure);
            develop.encode(gpu, &mut encoder, hdr, &ldr, &meter.exposure, self.timer.pass(spans.develop()));
        }
        self.timer.resolve(&mut encoder);
        gpu.queue.submit([encoder.finish()]);
        let times = self.timer.read(gpu)?;

        let shading_ms = times.pass_ms(spans.forward());
        let lights = chosen.iter().zip(figures).enumerate().map(|(i, (&l, figures))| {
            let kind = lights::kind_name(&self.scene.lights[l].kind);
            let shadow_ms = spans.light(i).and_then(|span| times.pass_ms(span));
            let tiled = self.scene.shadows.tile_stats(i).filter(|_| settings.shadows);
            let light_ms = shading_ms.filter(|_| chosen.len() == 1);
            LightFigures {
                tiled: tiled.map_or(0, |tiled| tiled.quads as u64),
                ..figures_of(kind, figures, shadow_ms, light_ms)
            }
        });
        Ok(FrameStats {
            adapter: gpu.info.name.clone(),
            backend: gpu.info.backend.to_string(),
            depth_format: format!("{:?}", gpu.depth_stencil),
            planning_ms,
            gpu_ms: times.total_ms(),
            shading_ms,
            lights: lights.collect(),
        })
    }

    /// Submits one step of a frame.
    #[expect(clippy::too_many_arguments, reason = "what differs between the steps of one frame")]
    fn step(
        &mut self,
        view: &View,
        active: &[usize],
        kinds: &[LightKind],
        figures: &[LightStats],
        exposed: &Exposed,
        part: &Part,
        added: bool,
        finish: Finish,
        spans: Spans,
        settings: &Settings,
    ) -> Result<(), RenderError> {
        let (gpu, samples) = (self.gpu, settings.samples);
        let (scene, layouts, timer) = (&self.scene, &self.layouts, &self.timer);
        let lights = &active[part.lights.clone()];
        let records: Vec<LightRecord> = lights.iter().map(|&l| exposed.lights[l]).collect();
        let shading = Shading { lights: &records, ..exposed.shading() };
        self.frame.update(
            gpu,
            layouts,
            view,
            &shading,
            scene.draws.order.iter().map(|&i| &scene.instances[i].world_from_object),
            |l, slot| lights::reaches(&kinds[lights[l]], &scene.instance_bounds[scene.draws.order[slot]]),
        )?;
        let targets = self.targets.as_mut().ok_or_else(no_targets)?;
        // Blended surfaces have a verdict of their own: that on the nearest of them.
        let layered = spans.shadows && !part.solid;
        let shadowed = spans.shadows && part.solid || layered;
        // Drawing everything twice is cheaper than a texture of verdicts unless there is more to draw than to fill.
        let few = scene.draws.solid_triangles() < view.size[0] * view.size[1] / 8;
        let shadows = match (shadowed, records.len() == 1 && samples == 1 && few && !layered) {
            (false, _) => Shadows::None,
            (true, true) => Shadows::Stencil,
            (true, false) => Shadows::Bits,
        };
        let step = Step::new(settings, finish == Finish::Forward, &records, shadows, part.further);
        let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        let depth_stencil = targets.depth_stencil.clone();
        if shadowed {
            let bits = shadows == Shadows::Bits;
            let volumes = &scene.shadows;
            let pass =
                self.verdicts.entry((samples, bits)).or_insert_with(|| VerdictPass::new(gpu, volumes, samples, bits));
            pass.prepare(gpu, layouts, scene, layered);
            let verdicts = lights.iter().map(|&light| Verdict {
                light,
                scissor: Some(figures[light].scissor).filter(|_| figures[light].has_shadow()),
                span: spans.light(light).filter(|_| part.solid),
            });
            let (view, depth_stencil, depth) = if layered {
                let layer = targets.layer(gpu, layouts);
                (Some(layer.verdicts.view.clone()), layer.depth_stencil.clone(), layer.depth.clone())
            } else {
                let view = bits.then(|| targets.verdicts(gpu, layouts).view.clone());
                (view, depth_stencil.clone(), targets.depth.clone())
            };
            let depth = depth.filter(|_| volumes.counts_tiles());
            let tiles = depth.as_ref().map(|depth| (&gpu.device, depth));
            let targets = VerdictTargets { verdicts: view.as_ref(), depth_stencil: &depth_stencil, tiles, layered };
            pass.encode(&mut encoder, &targets, &self.frame, scene, verdicts, (timer, part.solid.then_some(0)));
        }

        let solid = scene.draws.solid.iter().filter(|_| part.solid);
        let draws = solid.chain(scene.draws.blended.iter().filter(|_| part.blended));
        self.forward.prepare(gpu, layouts, scene, step, draws.clone());
        let verdicts = (shadows == Shadows::Bits).then(|| match layered {
            true => targets.layer(gpu, layouts).verdicts.bind_group.clone(),
            false => targets.verdicts(gpu, layouts).bind_group.clone(),
        });
        let color = match finish {
            Finish::Forward => {
                let [r, g, b] = exposed.background.map(|c| c * exposed.exposure);
                cleared(&targets.ldr_view, tone_map::displayed([r, g, b]))
            }
            // What is blended over itself has to start from black: under more light, what is there stays as visible.
            Finish::Darkroom if part.further && layered => cleared(targets.further(gpu), [0.0; 4]),
            Finish::Darkroom if added => continued(&targets.hdr(gpu).samples),
            Finish::Darkroom => {
                // A negative share to be shown as it is marks what is no surface.
                let [r, g, b] = exposed.background.map(half_float).map(f64::from);
                cleared(&targets.hdr(gpu).samples, [r, g, b, -1.0])
            }
        };
        gpu.check()?;
        let attachments = Attachments {
            color: color.ok_or_else(no_targets)?,
            depth_stencil: if shadowed || added { read_only(&depth_stencil) } else { cleared_depth(&depth_stencil) },
            verdicts: verdicts.as_ref(),
            timestamp_writes: timer.pass(spans.forward()).filter(|_| part.solid),
        };
        self.forward.encode(&mut encoder, attachments, &self.frame, scene, step, draws);
        if part.further && layered {
            let light = targets.further(gpu).clone();
            let pass = self.further.entry(samples).or_insert_with(|| FurtherPass::new(gpu, samples));
            pass.encode(gpu, &mut encoder, &light, &targets.hdr(gpu).samples);
        }
        gpu.queue.submit([encoder.finish()]);
        Ok(())
    }

    /// Renders the outputs of `kinds`, always at one sample per pixel.
    ///
    /// # Errors
    /// As for [`Renderer::picture`].
    pub fn aovs(&mut self, view: &View, settings: &Settings, kinds: &[AovKind]) -> Result<Aovs, RenderError> {
        let gpu = self.gpu;
        let chosen = self.scene.chosen(settings)?;
        if self.measured.as_ref().is_none_or(|m| m.targets.size != view.size) {
            self.measured = None;
            self.measured = Some(Measured {
                attributes: AttributePass::default(),
                shadow: ShadowPass::new(gpu, &self.scene.shadows),
                mask: MaskPass::new(gpu, &self.layouts),
                targets: Attributes::new(gpu, &self.layouts, view.size)?,
            });
            gpu.check()?;
        }
        let Some(Measured { attributes, shadow, mask, targets }) = &mut self.measured else {
            return Err(no_targets());
        };
        self.scene.arrange(gpu, view);
        let exposed = Exposed::new(&self.scene, &chosen, settings.exposure, view);
        let placements = self.scene.draws.order.iter().map(|&i| &self.scene.instances[i].world_from_object);
        self.frame.update(gpu, &self.layouts, view, &exposed.shading(), placements, |_, _| true)?;
        let encoder = || gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());

        let mut first = encoder();
        attributes.encode(gpu, &self.layouts, &mut first, targets, &self.frame, &self.scene);
        gpu.queue.submit([first.finish()]);
        let mut out = Aovs { size: view.size, ..Aovs::default() };
        attribute_outputs::fill(&mut out, gpu, targets, view, kinds)?;

        for (kind, counting, what, images) in [
            (AovKind::Shadow, Counting::Verdict, Mask::Reached, &mut out.shadow),
            (AovKind::Stencil, Counting::Raw, Mask::Count, &mut out.stencil),
        ] {
            if !kinds.contains(&kind) {
                continue;
            }
            if settings.shadows {
                let kinds: Vec<LightKind> = chosen.iter().map(|&l| self.scene.lights[l].kind).collect();
                self.scene.plan(gpu, view, &chosen, &kinds, settings, counting)?;
                if targets.stored_depth.is_some() {
                    self.scene.plan_tiles(gpu, settings)?;
                }
            }
            for light in 0..chosen.len() {
                let mut encoder = encoder();
                if settings.shadows {
                    shadow.encode(&mut encoder, targets, &self.scene.shadows, light, &gpu.device);
                }
                images.push(mask.read(gpu, encoder, targets, &self.frame, light as u32, what)?);
            }
        }
        Ok(out)
    }
}

/// Part of a frame. One is enough unless shadows fall on blended surfaces, or there are more lights than a texel of
/// verdicts has bits.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Part {
    /// Of the frame's lights.
    lights: Range<usize>,
    /// Draws solid surfaces.
    solid: bool,
    /// Draws blended surfaces.
    blended: bool,
    /// Adds lights to surfaces that an earlier part has drawn.
    further: bool,
}

/// The parts of a frame in order.
fn parts(lights: usize, shadows: bool, blends: bool) -> Vec<Part> {
    if !shadows || lights == 0 {
        return vec![Part { lights: 0..lights, solid: true, blended: blends, further: false }];
    }
    let surfaces = [true, false].into_iter().filter(|&solid| solid || blends);
    let groups = |solid| {
        (0..lights).step_by(verdict_pass::LIGHTS).map(move |start| {
            let lights = start..lights.min(start + verdict_pass::LIGHTS);
            Part { lights, solid, blended: !solid, further: start > 0 }
        })
    };
    surfaces.flat_map(groups).collect()
}

/// Light of a frame, scaled to the range of half floats.
#[derive(Debug)]
struct Exposed {
    lights: Vec<LightRecord>,
    ambient: [f32; 3],
    background: [f32; 3],
    pre_exposure: f32,
    /// From pre-exposed radiance to the picture's; meaningless where it is measured.
    exposure: f32,
}

impl Exposed {
    fn new(scene: &SceneOnGpu, chosen: &[usize], exposure: Exposure, view: &View) -> Self {
        let lit = chosen.iter().map(|&l| &scene.lights[l]);
        let constant = [scene.ambient, scene.background, scene.emission];
        let pre_exposure = lights::pre_exposure(lit, &scene.bounds, &constant);
        let record = |&l: &usize| lights::record(&scene.lights[l], view, pre_exposure, scene.shapes.of_light[l]);
        Self {
            lights: chosen.iter().map(record).collect(),
            ambient: scene.ambient.map(|c| c * pre_exposure),
            background: scene.background.map(|c| c * pre_exposure),
            pre_exposure,
            exposure: match exposure {
                Exposure::Auto => 1.0,
                Exposure::Ev(stops) => (stops.exp2() / pre_exposure).clamp(0.0, f32::MAX),
            },
        }
    }

    /// What a picture finished so shows of the scene's lights; each has its share of the error.
    fn precision(&self, scene: &SceneOnGpu, finish: Finish) -> lights::Precision {
        let step = match finish {
            Finish::Forward => lights::DISPLAY_STEP / f64::from(self.exposure),
            Finish::Darkroom => lights::HALF_FLOAT_STEP,
        };
        lights::Precision {
            step: step / self.lights.len().max(1) as f64,
            pre_exposure: self.pre_exposure.into(),
            reflectance: lights::greatest_reflectance(scene.roughness),
        }
    }

    fn shading(&self) -> Shading<'_> {
        let Self { lights, ambient, pre_exposure, exposure, .. } = self;
        Shading { lights, ambient: *ambient, pre_exposure: *pre_exposure, exposure: *exposure }
    }
}

/// Numbers what is timed: verdicts, forward, develop, then each light's volumes.
#[derive(Clone, Copy, Debug)]
struct Spans {
    shadows: bool,
    darkroom: bool,
    /// Lights that are timed.
    lights: usize,
}

impl Spans {
    fn forward(self) -> usize {
        usize::from(self.shadows)
    }

    fn develop(self) -> usize {
        self.forward() + 1
    }

    fn light(self, light: usize) -> Option<usize> {
        (self.shadows && light < self.lights).then_some(self.develop() + usize::from(self.darkroom) + light)
    }

    fn count(self) -> usize {
        self.develop() + usize::from(self.darkroom) + if self.shadows { self.lights } else { 0 }
    }
}

fn no_targets() -> RenderError {
    RenderError::Device("no render targets".to_owned())
}

/// The nearest finite half float that is not negative.
fn half_float(value: f32) -> f32 {
    f16::from_f32(value.clamp(0.0, 65504.0)).to_f32()
}

/// What is known of a light whose shadows nobody asked for.
fn unplanned(view: &View) -> LightStats {
    LightStats { scissor: [0, 0, view.size[0], view.size[1]], ..LightStats::default() }
}

fn figures_of(kind: &'static str, figures: LightStats, shadow_ms: Option<f64>, light_ms: Option<f64>) -> LightFigures {
    LightFigures {
        kind,
        casters: figures.casters,
        culled: figures.reasons().map(|(reason, count)| (reason.name(), count)).collect(),
        cases: figures.cases,
        extracted: figures.extracted,
        tiled: 0,
        triangles: crate::TriangleFigures {
            sides: figures.triangles.sides,
            dark_cap: figures.triangles.dark_cap,
            light_cap: figures.triangles.light_cap,
        },
        vertices: figures.vertices,
        fragments: None,
        scissor: figures.scissor,
        shadow_ms,
        light_ms,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::GpuOptions;
    use zfail_plan::glam::{DAffine3, DVec3};
    use zfail_plan::scene::{Instance, Light, LightShape, Material, Mesh, Primitive};
    use zfail_plan::view::Projection;

    /// A triangle under more than one light, before a background.
    fn scene(unlit: bool) -> Scene {
        let material = Material { unlit, base_color: [0.8, 0.3, 0.05, 1.0], metallic: 0.0, ..Material::default() };
        let mesh = Mesh {
            positions: vec![[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [0.0, 1.0, 0.0]],
            normals: vec![[0.0, 0.0, 1.0]; 3],
            triangles: vec![[0, 1, 2]],
            primitives: vec![Primitive { triangles: 0..1, material: Some(0) }],
            ..Mesh::default()
        };
        let light = |x: f64| Light {
            name: String::new(),
            kind: LightKind::Point { position: DVec3::new(x, 0.5, 0.7), range: 9.0 },
            color: [1.0, 0.9, 0.7],
            intensity: 1.5,
            excluded: Vec::new(),
            shape: LightShape::default(),
        };
        let instance =
            Instance { name: String::new(), mesh: 0, world_from_object: DAffine3::IDENTITY, casts_shadow: true };
        Scene {
            meshes: vec![mesh],
            materials: vec![material],
            instances: vec![instance],
            lights: vec![light(-0.5), light(0.5)],
            ambient: [0.05; 3],
            background: [0.02, 0.3, 1.7],
            ..Scene::default()
        }
    }

    #[test]
    fn a_frame_written_directly_is_the_developed_picture() {
        let gpu = match Gpu::new(&GpuOptions::default()) {
            Ok(gpu) => gpu,
            Err(error) => return eprintln!("skipped: {error}"),
        };
        let projection = Projection::Perspective { yfov: 1.0, near: 0.1, far: None };
        let world_from_view = DAffine3::from_translation(DVec3::new(0.0, 0.0, 2.5));
        let view = View { world_from_view, projection, size: [64, 64] };
        for unlit in [false, true] {
            let mut renderer = Renderer::new(&gpu, &scene(unlit)).expect("a renderer");
            let mut direct = |settings: &Settings| {
                renderer.draw(&view, settings, Finish::Forward).expect("a frame");
                read_back::texture(&gpu, &renderer.targets.as_ref().expect("targets").ldr).expect("texels")
            };
            let settings = Settings { exposure: Exposure::Ev(0.5), ..Settings::default() };
            let frames = [direct(&settings), direct(&Settings { shadows: false, ..settings.clone() })];
            let brighter = direct(&Settings { exposure: Exposure::Ev(0.6), ..settings.clone() });
            let developed = renderer.picture(&view, &settings).expect("a picture").0.rgba8;
            let difference = |a: &[u8]| a.iter().zip(&developed).map(|(a, b)| a.abs_diff(*b)).max();
            // Half floats keep 11 bits of radiance.
            assert!(frames.iter().all(|frame| difference(frame) <= Some(1)), "{:?}", difference(&frames[0]));
            assert!(difference(&brighter) > Some(1), "the comparison can fail");
        }
    }

    #[test]
    fn many_lights_are_divided() {
        let whole = |lights: usize, blended| Part { lights: 0..lights, solid: true, blended, further: false };
        assert_eq!(parts(50, false, true), [whole(50, true)]);
        assert_eq!(parts(32, true, false), [whole(32, false)]);
        assert_eq!(parts(32, true, true), [whole(32, false), Part { solid: false, ..whole(32, true) }]);
        let divided = parts(50, true, true);
        assert_eq!(divided.iter().map(|p| p.lights.clone()).collect::<Vec<_>>(), [0..32, 32..50, 0..32, 32..50]);
        assert_eq!(
            divided.iter().map(|p| [p.solid, p.blended, p.further]).collect::<Vec<_>>(),
            [[true, false, false], [true, false, true], [false, true, false], [false, true, true]]
        );
    }
}
