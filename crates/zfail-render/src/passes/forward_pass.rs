//! Surfaces with all their light, in one draw each: what McGuire et al. 2003, section 8, do in an ambient pass and one
//! illumination pass per light.

use crate::passes::frame::FrameData;
use crate::passes::pipeline::{ADD, Recipe, depth_test};
use crate::passes::targets::{LDR, RADIANCE};
use crate::scene::SceneOnGpu;
use crate::scene::draw_list::{Alpha, Draw, Look};
use crate::scene::gpu_data::{LightRecord, UNROLLED};
use crate::scene::layouts::Layouts;
use crate::{Gpu, Settings, Terminator, passes::shader};
use std::collections::HashMap;

/// What a pass over the scene does.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Step {
    pub samples: u32,
    /// The picture itself is written, not radiance.
    pub developed: bool,
    /// Lights in use; all numbers that are not unrolled are the same.
    lights: u32,
    /// Some light has a shape of its own.
    pub shaped: bool,
    /// Where the verdicts are, and with them the depth.
    pub shadows: Shadows,
    /// Adds more lights to what an earlier step has drawn.
    pub added: bool,
    /// Light fades at the terminator of coarse meshes.
    pub soft: bool,
    /// There is a sky.
    pub sky: bool,
}

/// How a step learns what is in shadow.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Shadows {
    /// Nothing is.
    None,
    /// From a bit per light in a texture.
    Bits,
    /// From the stencil, which holds the one light's verdict: shadowed and lit pixels are drawn after each other, each with
    /// a test instead of a texture, and the former without the light.
    Stencil,
}

impl Step {
    pub fn new(
        settings: &Settings,
        developed: bool,
        lights: &[LightRecord],
        shadows: Shadows,
        added: bool,
        sky: bool,
    ) -> Self {
        Self {
            samples: settings.samples,
            developed,
            lights: lights.len().min(UNROLLED + 1) as u32,
            shaped: lights.iter().any(|light| light.shape != 0),
            shadows,
            added,
            soft: settings.terminator == Terminator::Soft,
            sky,
        }
    }

    /// What of it matters where no surface is.
    pub fn behind_surfaces(self) -> Self {
        Self { lights: 0, soft: false, ..self }
    }
}

/// What a pipeline depends on: the look, whether it is mirrored, whether its triangles are sorted.
type Key = (Look, bool, bool, Step);

/// Pipelines of the pass, made when they are first needed. Blended surfaces with two sides and no order of triangles have
/// two, inner sides first, transmissive ones have one that filters what is behind and one that adds to it, and surfaces under [`Shadows::Stencil`] have one for lit and one for shadowed pixels.
#[derive(Debug, Default)]
pub struct ForwardPass {
    pipelines: HashMap<Key, Vec<wgpu::RenderPipeline>>,
}

/// Begins the pass.
pub fn begin<'e>(
    encoder: &'e mut wgpu::CommandEncoder,
    color: wgpu::RenderPassColorAttachment<'_>,
    depth_stencil: wgpu::RenderPassDepthStencilAttachment<'_>,
    timestamp_writes: Option<wgpu::RenderPassTimestampWrites<'_>>,
    frame: &FrameData,
) -> wgpu::RenderPass<'e> {
    let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        label: Some("forward"),
        color_attachments: &[Some(color)],
        depth_stencil_attachment: Some(depth_stencil),
        timestamp_writes,
        ..Default::default()
    });
    pass.set_bind_group(0, &frame.bind_group, &[]);
    pass
}

impl ForwardPass {
    /// Makes the pipelines that `draws` lack.
    pub fn prepare<'d>(
        &mut self,
        gpu: &Gpu,
        layouts: &Layouts,
        scene: &SceneOnGpu,
        step: Step,
        draws: impl Iterator<Item = &'d Draw>,
    ) {
        for draw in draws {
            let key = key(scene.draws.parts[draw.part].look, draw, step);
            self.pipelines.entry(key).or_insert_with(|| create(gpu, layouts, key));
        }
    }

    /// Draws surfaces for which [`Self::prepare`] has been called.
    pub fn draw<'d>(
        &self,
        pass: &mut wgpu::RenderPass<'_>,
        verdicts: Option<&wgpu::BindGroup>,
        frame: &FrameData,
        scene: &SceneOnGpu,
        step: Step,
        draws: impl Iterator<Item = &'d Draw>,
    ) {
        if let Some(verdicts) = verdicts {
            pass.set_bind_group(2, verdicts, &[]);
        }
        for draw in draws {
            let part = &scene.draws.parts[draw.part];
            let Some(mesh) = &scene.meshes[part.mesh] else { continue };
            mesh.bind(pass, part.look.vertices(), &frame.instances);
            if draw.sorted.is_some() {
                pass.set_index_buffer(scene.sorted.slice(..), wgpu::IndexFormat::Uint32);
            }
            pass.set_bind_group(1, &scene.materials[part.material], &[]);
            for pipeline in self.pipelines.get(&key(part.look, draw, step)).into_iter().flatten() {
                pass.set_pipeline(pipeline);
                let indices = draw.sorted.clone().unwrap_or(part.indices.clone());
                pass.draw_indexed(indices, 0, draw.slots.clone());
            }
        }
    }
}

fn key(look: Look, draw: &Draw, step: Step) -> Key {
    (look, draw.mirrored, draw.sorted.is_some(), step)
}

fn create(gpu: &Gpu, layouts: &Layouts, (look, mirrored, sorted, step): Key) -> Vec<wgpu::RenderPipeline> {
    let blend = look.alpha == Alpha::Blend;
    let flags = [
        ("ROUGH", look.rough),
        ("SHAPED", step.shaped),
        ("COARSE", look.coarse && step.soft),
        // Masked surfaces have been cut out by the depth pass already.
        ("ALPHA_MASK", look.alpha == Alpha::Mask && step.shadows == Shadows::None),
        ("BLEND", blend),
        ("UNLIT", look.unlit),
        ("ADDED", step.added),
        ("DEVELOPED", step.developed),
        ("SKY", step.sky),
    ]
    .map(|(name, value)| (name, f64::from(u8::from(value))));
    let constants: Vec<_> = look.constants().chain(flags).collect();
    let state = if blend {
        (wgpu::CompareFunction::Greater, false)
    } else if step.shadows != Shadows::None {
        (wgpu::CompareFunction::Equal, false)
    } else {
        (wgpu::CompareFunction::GreaterEqual, true)
    };
    let mut groups = vec![&layouts.frame, &layouts.material];
    let bits = step.shadows == Shadows::Bits;
    if bits {
        groups.push(layouts.verdicts(step.samples));
    }
    let format = if step.developed { LDR } else { RADIANCE };
    let target = |blend| wgpu::ColorTargetState { format, blend, write_mask: wgpu::ColorWrites::ALL };
    // Fragment entry points, and how they meet what is there.
    let entries = match (blend, look.layers.transmission) {
        (true, true) => vec![("filtered", Some(filter())), ("forward", Some(over(look.unlit)))],
        (true, false) => vec![("forward", Some(over(look.unlit)))],
        (false, _) => vec![("forward", step.added.then_some(ADD))],
    };
    let face = wgpu::StencilFaceState { compare: wgpu::CompareFunction::NotEqual, ..wgpu::StencilFaceState::IGNORE };
    let shadowed = wgpu::StencilState { front: face, back: face, read_mask: 0xff, write_mask: 0 };
    let passes: &[(u32, wgpu::StencilState)] = match step.shadows {
        Shadows::Stencil => &[(step.lights, zfail::lit_stencil()), (0, shadowed)],
        Shadows::None | Shadows::Bits => &[(step.lights, wgpu::StencilState::default())],
    };
    let faces: &[Option<wgpu::Face>] = match (blend && !sorted, look.double_sided) {
        (true, true) => &[Some(wgpu::Face::Front), Some(wgpu::Face::Back)],
        (false, true) => &[None],
        (_, false) => &[Some(wgpu::Face::Back)],
    };
    let mut pipelines = Vec::new();
    for ((lights, stencil), &(entry, blend)) in passes.iter().flat_map(|pass| entries.iter().map(move |e| (pass, e))) {
        let mut constants = constants.clone();
        constants.push(("LIGHTS", f64::from(*lights)));
        let depth_stencil = depth_test(gpu.depth_stencil, state.0, state.1);
        for &cull in faces {
            let recipe = Recipe {
                program: shader::forward(look.vertices(), bits.then_some(step.samples)),
                entry,
                constants: &constants,
                groups: &groups,
                targets: &[Some(target(blend))],
                depth_stencil: Some(wgpu::DepthStencilState { stencil: stencil.clone(), ..depth_stencil.clone() }),
                samples: step.samples,
            };
            pipelines.push(recipe.scene(&gpu.device, look.vertices(), mirrored, cull));
        }
    }
    pipelines
}

/// Leaves of what is there the share that passes.
fn filter() -> wgpu::BlendState {
    let filter = |dst_factor| wgpu::BlendComponent {
        src_factor: wgpu::BlendFactor::Zero,
        dst_factor,
        operation: wgpu::BlendOperation::Add,
    };
    wgpu::BlendState { color: filter(wgpu::BlendFactor::Src), alpha: filter(wgpu::BlendFactor::One) }
}

/// Covers what is there. The target's alpha is the share that is shown without exposure: unlit surfaces add to it.
fn over(unlit: bool) -> wgpu::BlendState {
    let over = |src_factor| wgpu::BlendComponent {
        src_factor,
        dst_factor: wgpu::BlendFactor::OneMinusSrcAlpha,
        operation: wgpu::BlendOperation::Add,
    };
    let alpha = over(if unlit { wgpu::BlendFactor::One } else { wgpu::BlendFactor::Zero });
    wgpu::BlendState { color: over(wgpu::BlendFactor::One), alpha }
}
