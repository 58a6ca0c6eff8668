//! Outputs that are measured instead of looked at.

use super::exposed::Exposed;
use super::{Renderer, no_targets};
use crate::passes::attribute_pass::AttributePass;
use crate::passes::mask_pass::{Mask, MaskPass};
use crate::passes::shadow_pass::ShadowPass;
use crate::passes::targets::Attributes;
use crate::scene::lights::FrameLight;
use crate::{AovKind, Aovs, RenderError, Settings, output::attribute_outputs};
use zfail::Counting;
use zfail_plan::view::View;

/// What measured outputs need.
#[derive(Debug)]
pub struct Measured {
    pub attributes: AttributePass,
    pub shadow: ShadowPass,
    pub mask: MaskPass,
    pub targets: Attributes,
}

impl Renderer<'_> {
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
                shadow: ShadowPass::new(gpu, &self.layouts, &self.scene.shadows),
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
        let instances = self.scene.draws.order.iter().map(|&i| &self.scene.instances[i]);
        self.frame.update(gpu, &self.layouts, view, &exposed.shading(), instances, |_, _| true)?;
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
                let lights: Vec<_> = chosen.iter().map(|&l| FrameLight::new(l, &self.scene.lights[l])).collect();
                let readable = targets.stored_depth.is_some();
                self.scene.plan(gpu, view, &lights, settings, counting, None, readable)?;
            }
            let mut prepared = self.scene.shadows.prepared().filter(|_| settings.shadows);
            for (light, &of_scene) in chosen.iter().enumerate() {
                let mut encoder = encoder();
                if let (Some(frame), Some(depth), 0) = (prepared, &targets.stored_depth, light) {
                    prepared = Some(frame.count_tiles(&mut encoder, depth));
                }
                if let Some(prepared) = &prepared {
                    let exempt = (counting == Counting::Verdict).then_some((&self.frame, &self.scene));
                    shadow.encode(&mut encoder, targets, prepared, light, exempt);
                }
                let casting = settings.shadows.then_some((&self.scene, of_scene));
                images.push(mask.read(gpu, encoder, targets, &self.frame, light as u32, what, casting)?);
            }
        }
        Ok(out)
    }
}
