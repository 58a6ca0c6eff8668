//! The order of passes: verdicts of all lights; forward shading; exposure and tone mapping where the forward pass could
//! not do it (McGuire et al. 2003, section 8).

mod exposed;
mod measured;
mod parts;
mod step;

use crate::device::timing::Timer;
use crate::output::stats::{FrameStats, LightFigures};
use crate::passes::backdrop_pass::BackdropPass;
use crate::passes::develop_pass::DevelopPass;
use crate::passes::exposure::ExposureMeter;
use crate::passes::forward_pass::ForwardPass;
use crate::passes::fragment_counter::FragmentCounter;
use crate::passes::frame::FrameData;
use crate::passes::further_pass::FurtherPass;
use crate::passes::targets::Targets;
use crate::passes::verdict_pass::VerdictPass;
use crate::scene::SceneOnGpu;
use crate::scene::layouts::Layouts;
use crate::scene::lights::{FrameLight, kind_name};
use crate::{Exposure, Gpu, Picture, RenderError, Settings, device::read_back};
use exposed::Exposed;
use half::f16;
use measured::Measured;
use parts::{Finish, Spans, parts};
use std::collections::HashMap;
use std::time::Instant;
use zfail::{Counting, LightStats};
use zfail_plan::view::View;
use zfail_scene::{Pose, Scene};

/// A scene on the device, ready to be rendered from any view.
#[derive(Debug)]
pub struct Renderer<'g> {
    gpu: &'g Gpu,
    layouts: Layouts,
    scene: SceneOnGpu,
    frame: FrameData,
    forward: ForwardPass,
    backdrop: BackdropPass,
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
            backdrop: BackdropPass::default(),
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

    /// Takes ambient light, background, sky and ground of `scene`.
    ///
    /// # Errors
    /// If the ground is no disc. The old surroundings stay then.
    pub fn set_surroundings(&mut self, scene: &Scene) -> Result<(), RenderError> {
        self.scene.set_surroundings(self.gpu, scene)
    }

    /// Takes from `scene`, which otherwise is the one that was uploaded, in its present pose, which instances cast shadows.
    ///
    /// # Errors
    /// If it is another scene, or the device runs out of memory.
    pub fn set_casting(&mut self, scene: &Scene) -> Result<(), RenderError> {
        self.scene.set_casting(scene)
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
        let known = matches!(self.exposed(settings).exposure, Exposure::Ev(_));
        let finish = if known && direct { Finish::Forward } else { Finish::Darkroom };
        self.draw(view, settings, finish)
    }

    /// The stops that automatic exposure gives the picture of `view`, for a series of pictures to share.
    ///
    /// # Errors
    /// As for [`Renderer::render`].
    pub fn metered(&mut self, view: &View, settings: &Settings) -> Result<f32, RenderError> {
        if let Exposure::Ev(stops) = self.exposed(settings).exposure {
            return Ok(stops);
        }
        self.draw(view, settings, Finish::Darkroom)?;
        let (meter, _) = self.darkroom.get(&settings.samples).ok_or_else(no_targets)?;
        let scale = read_back::number(self.gpu, &meter.exposure)?;
        let chosen = self.scene.chosen(settings)?;
        let pre_exposure = Exposed::new(&self.scene, &chosen, settings.exposure, view).pre_exposure;
        Ok((scale * pre_exposure).log2())
    }

    /// With what is known about exposure.
    fn exposed(&self, settings: &Settings) -> Settings {
        let known = self.scene.exposure.filter(|_| settings.exposure == Exposure::Auto);
        Settings { exposure: known.map_or(settings.exposure, Exposure::Ev), ..settings.clone() }
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
            let prepared = self.scene.shadows.prepared().filter(|_| self.shadowed);
            light.fragments = Some(prepared.map_or(Ok(0), |prepared| counter.count(self.gpu, &prepared, l))?);
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
        let settings = &self.exposed(settings);
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
        let ground = self.scene.surroundings.ground(view).map(|visible| *visible.ground).filter(|_| settings.shadows);
        // Where hardly any light is, the ground shows the shadow of even the faintest.
        let frame_light = |&l: &usize| match (&self.scene.lights[l], ground) {
            (light, Some(_)) => FrameLight::new(l, light),
            (light, None) => FrameLight::effective(l, light, &precision),
        };
        let lights: Vec<FrameLight> = chosen.iter().map(frame_light).collect();
        // Positions in `lights` of those that make a difference.
        let active: Vec<usize> = (0..lights.len()).filter(|&i| lights[i].is_visible(view)).collect();

        let start = Instant::now();
        self.shadowed = settings.shadows;
        let readable = self.targets.as_ref().is_some_and(|targets| targets.depth.is_some());
        let figures = if settings.shadows {
            let ground = ground.map(|ground| ground.bounds());
            self.scene.plan(gpu, view, &lights, settings, Counting::Verdict, ground, readable)?
        } else {
            vec![unplanned(view); chosen.len()]
        };
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
            self.step(view, &active, &lights, &exposed, part, number > 0, finish, spans, settings)?;
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
            let kind = kind_name(&self.scene.lights[l].kind);
            let shadow_ms = spans.light(i).and_then(|span| times.pass_ms(span));
            let prepared = self.scene.shadows.prepared().filter(|_| settings.shadows);
            let tiled = prepared.and_then(|prepared| zfail::low_level::tile_stats(&prepared, i));
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
}

fn no_targets() -> RenderError {
    RenderError::Device("no render targets".to_owned())
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
        sections: crate::SectionFigures { considered: figures.sections.considered, cases: figures.sections.cases },
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
    use zfail_plan::light::LightKind;
    use zfail_plan::view::Projection;
    use zfail_scene::{Ground, Instance, Light, LightShape, Material, Mesh, Primitive, Sky};

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
        let instance = Instance {
            name: String::new(),
            mesh: 0,
            world_from_object: DAffine3::IDENTITY,
            casts_shadow: true,
            receives_shadow: true,
        };
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
        let Some(gpu) = zfail_testing::gpu(Gpu::new(&GpuOptions::default())) else { return };
        let projection = Projection::Perspective { yfov: 1.0, near: 0.1, far: None };
        let world_from_view = DAffine3::from_translation(DVec3::new(0.0, 0.0, 2.5));
        let view = View::new(world_from_view, projection, [64, 64]);
        let direct = |renderer: &mut Renderer<'_>, settings: &Settings| {
            renderer.draw(&view, settings, Finish::Forward).expect("a frame");
            read_back::texture(&gpu, &renderer.targets.as_ref().expect("targets").ldr).expect("texels")
        };
        let sky = Some(Sky { zenith: [0.2, 0.4, 0.9], horizon: [1.1, 0.9, 0.8], nadir: [0.2, 0.15, 0.1] });
        let ground = Some(Ground { height: -0.9, center: [0.0; 2], radius: 9.0 });
        let plain = scene(false);
        for scene in [
            scene(true),
            Scene { sky, ..plain.clone() },
            Scene { ground, ..plain.clone() },
            Scene { sky, ground, lights: plain.lights[..1].to_vec(), ..plain.clone() },
            plain,
        ] {
            let mut renderer = Renderer::new(&gpu, &scene).expect("a renderer");
            for shadows in [true, false] {
                let settings = Settings { shadows, exposure: Exposure::Ev(0.5), ..Settings::default() };
                let frame = direct(&mut renderer, &settings);
                let brighter = direct(&mut renderer, &Settings { exposure: Exposure::Ev(0.6), ..settings.clone() });
                let developed = renderer.picture(&view, &settings).expect("a picture").0.rgba8;
                let difference = |a: &[u8]| a.iter().zip(&developed).map(|(a, b)| a.abs_diff(*b)).max();
                // Half floats keep 11 bits of radiance.
                assert!(difference(&frame) <= Some(1), "{:?}", difference(&frame));
                assert!(difference(&brighter) > Some(1), "the comparison can fail");
            }
        }
    }
}
