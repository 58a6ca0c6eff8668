//! One step of a frame: verdicts of some lights, then surfaces under these lights.

use super::exposed::Exposed;
use super::parts::{Finish, Part, Spans};
use super::{Renderer, no_targets};
use crate::passes::backdrop_pass::Behind;
use crate::passes::forward_pass::{self, Shadows, Step};
use crate::passes::frame::Shading;
use crate::passes::further_pass::FurtherPass;
use crate::passes::pipeline::{cleared, cleared_depth, continued, read_only};
use crate::passes::verdict_pass::{Verdict, VerdictPass, VerdictTargets};
use crate::scene::gpu_data::LightRecord;
use crate::{RenderError, Settings, output::tone_map, scene::lights::FrameLight};
use half::f16;
use zfail_plan::view::View;

impl Renderer<'_> {
    /// Submits one step of a frame.
    #[expect(clippy::too_many_arguments, reason = "what differs between the steps of one frame")]
    pub(super) fn step(
        &mut self,
        view: &View,
        active: &[usize],
        frame_lights: &[FrameLight],
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
        let record = |lights: &[usize]| lights.iter().map(|&l| exposed.lights[l]).collect::<Vec<LightRecord>>();
        let records = record(lights);
        let others = [record(&active[..part.lights.start]), record(&active[part.lights.end..])].concat();
        let ground = scene.surroundings.ground(view).filter(|_| spans.shadows && part.solid);
        let shading = Shading {
            lights: &records,
            other_lights: if ground.is_some() { &others } else { &[] },
            ground: ground.map(|visible| visible.ground),
            ..exposed.shading()
        };
        self.frame.update(
            gpu,
            layouts,
            view,
            &shading,
            scene.draws.order.iter().map(|&i| &scene.instances[i]),
            |l, slot| frame_lights[lights[l]].reaches(&scene.instance_bounds[scene.draws.order[slot]]),
        )?;
        let targets = self.targets.as_mut().ok_or_else(no_targets)?;
        // Blended surfaces have a verdict of their own: that on the nearest of them.
        let layered = spans.shadows && !part.solid;
        let shadowed = spans.shadows && part.solid || layered;
        // Drawing everything twice is cheaper than a texture of verdicts unless there is more to draw than to fill.
        let few = scene.draws.solid_triangles() < view.size[0] * view.size[1] / 8;
        // What is lit whatever stands in the way passes over the bits; it cannot pass over the stencil.
        let stencil = records.len() == 1 && samples == 1 && few && !layered && !scene.has_exempt();
        let shadows = match (shadowed, stencil) {
            (false, _) => Shadows::None,
            (true, true) => Shadows::Stencil,
            (true, false) => Shadows::Bits,
        };
        let sky = scene.surroundings.sky.is_some();
        let step = Step::new(settings, finish == Finish::Forward, &records, shadows, part.further, sky);
        let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        let depth_stencil = targets.depth_stencil.clone();
        if shadowed {
            let bits = shadows == Shadows::Bits;
            let pass = self.verdicts.entry((samples, bits));
            let pass = pass.or_insert_with(|| VerdictPass::new(gpu, &scene.shadows, samples, bits));
            pass.prepare(gpu, layouts, scene, layered);
            let verdicts =
                lights.iter().map(|&light| Verdict { light, span: spans.light(light).filter(|_| part.solid) });
            let (view, depth_stencil, depth) = if layered {
                let layer = targets.layer(gpu, layouts);
                (Some(layer.verdicts.view.clone()), layer.depth_stencil.clone(), layer.depth.clone())
            } else {
                let view = bits.then(|| targets.verdicts(gpu, layouts).view.clone());
                (view, depth_stencil.clone(), targets.depth.clone())
            };
            let prepared = scene.shadows.prepared().ok_or_else(no_targets)?;
            let depth = depth.as_ref().filter(|_| prepared.has_tiles());
            let targets =
                VerdictTargets { verdicts: view.as_ref(), depth_stencil: &depth_stencil, depth, layered, ground };
            let timer = (timer, part.solid.then_some(0));
            pass.encode(&mut encoder, &targets, &self.frame, scene, prepared, verdicts, timer);
        }

        let solid = scene.draws.solid.iter().filter(|_| part.solid);
        let blended = scene.draws.blended.iter().filter(|_| part.blended);
        self.forward.prepare(gpu, layouts, scene, step, solid.clone().chain(blended.clone()));
        let drawn = Behind { sky: part.solid && !step.added && (sky || ground.is_some()), ground };
        self.backdrop.prepare(gpu, layouts, step, &drawn);
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
        let depth = if shadowed || added { read_only(&depth_stencil) } else { cleared_depth(&depth_stencil) };
        let timestamps = timer.pass(spans.forward()).filter(|_| part.solid);
        let color = color.ok_or_else(no_targets)?;
        let mut pass = forward_pass::begin(&mut encoder, color, depth, timestamps, &self.frame);
        self.forward.draw(&mut pass, verdicts.as_ref(), &self.frame, scene, step, solid);
        self.backdrop.draw(&mut pass, verdicts.as_ref(), &self.frame, scene, step, &drawn);
        self.forward.draw(&mut pass, verdicts.as_ref(), &self.frame, scene, step, blended);
        drop(pass);
        if part.further && layered {
            let light = targets.further(gpu).clone();
            let pass = self.further.entry(samples).or_insert_with(|| FurtherPass::new(gpu, samples));
            pass.encode(gpu, &mut encoder, &light, &targets.hdr(gpu).samples);
        }
        gpu.queue.submit([encoder.finish()]);
        Ok(())
    }
}

/// The nearest finite half float that is not negative.
fn half_float(value: f32) -> f32 {
    f16::from_f32(value.clamp(0.0, 65504.0)).to_f32()
}
