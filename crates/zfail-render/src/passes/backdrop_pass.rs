//! What is seen where no surface is: the sky, and shadows on a ground that is otherwise not there.

use crate::Gpu;
use crate::passes::forward_pass::{Shadows, Step};
use crate::passes::frame::FrameData;
use crate::passes::pipeline::{ADD, Recipe, depth_test};
use crate::passes::shader;
use crate::passes::targets::{LDR, RADIANCE};
use crate::scene::SceneOnGpu;
use crate::scene::geometry::Vertices;
use crate::scene::layouts::Layouts;
use crate::scene::surroundings::VisibleGround;
use std::collections::HashMap;

/// Pipelines of what is drawn between solid and blended surfaces, made when they are first needed.
#[derive(Debug, Default)]
pub struct BackdropPass {
    sky: HashMap<Step, wgpu::RenderPipeline>,
    /// Under [`Shadows::Stencil`] one for what is lit and one for what is in shadow.
    ground: HashMap<Step, Vec<wgpu::RenderPipeline>>,
}

/// What is to be drawn behind a step's surfaces.
#[derive(Clone, Copy, Debug)]
pub struct Behind<'s> {
    /// The sky; or one colour, where a ground shows it too, so that both are of one shader.
    pub sky: bool,
    /// Its verdicts and its depth are there.
    pub ground: Option<VisibleGround<'s>>,
}

impl BackdropPass {
    /// Makes the pipelines that are missing.
    pub fn prepare(&mut self, gpu: &Gpu, layouts: &Layouts, step: Step, behind: &Behind<'_>) {
        let step = step.behind_surfaces();
        if behind.sky {
            self.sky.entry(step).or_insert_with(|| sky(gpu, layouts, step));
        }
        if behind.ground.is_some() {
            self.ground.entry(step).or_insert_with(|| ground(gpu, layouts, step));
        }
    }

    /// Draws to `pass`, which has the solid surfaces and group 0.
    pub fn draw(
        &self,
        pass: &mut wgpu::RenderPass<'_>,
        verdicts: Option<&wgpu::BindGroup>,
        frame: &FrameData,
        scene: &SceneOnGpu,
        step: Step,
        behind: &Behind<'_>,
    ) {
        let step = step.behind_surfaces();
        if let Some(pipeline) = self.sky.get(&step).filter(|_| behind.sky) {
            pass.set_pipeline(pipeline);
            pass.draw(0..3, 0..1);
        }
        let Some(visible) = behind.ground else { return };
        if let Some(verdicts) = verdicts {
            pass.set_bind_group(1, verdicts, &[]);
        }
        for pipeline in self.ground.get(&step).into_iter().flatten() {
            pass.set_pipeline(pipeline);
            visible.draw(pass, Vertices::Plain, &frame.instances, scene.draws.order.len() as u32);
        }
    }
}

/// Override constants.
fn flags(step: Step) -> [(&'static str, f64); 2] {
    [("SKY", step.sky), ("DEVELOPED", step.developed)].map(|(name, value)| (name, f64::from(u8::from(value))))
}

fn sky(gpu: &Gpu, layouts: &Layouts, step: Step) -> wgpu::RenderPipeline {
    Recipe {
        program: shader::OPEN_SKY,
        entry: "open",
        constants: &flags(step),
        groups: &[&layouts.frame],
        targets: &[Some(if step.developed { LDR } else { RADIANCE }.into())],
        // Infinitely far.
        depth_stencil: Some(depth_test(gpu.depth_stencil, wgpu::CompareFunction::Equal, false)),
        samples: step.samples,
    }
    .screen(&gpu.device)
}

fn ground(gpu: &Gpu, layouts: &Layouts, step: Step) -> Vec<wgpu::RenderPipeline> {
    let more = [("SHAPED", step.shaped), ("ADDED", step.added)].map(|(name, value)| (name, f64::from(u8::from(value))));
    let face = wgpu::StencilFaceState { compare: wgpu::CompareFunction::NotEqual, ..wgpu::StencilFaceState::IGNORE };
    let shadowed = wgpu::StencilState { front: face, back: face, read_mask: 0xff, write_mask: 0 };
    let both = [&layouts.frame, layouts.verdicts(step.samples)];
    let (entries, groups) = match step.shadows {
        Shadows::None => (vec![], &both[..1]),
        Shadows::Stencil => (vec![("lit", zfail::lit_stencil()), ("dark", shadowed)], &both[..1]),
        Shadows::Bits => (vec![("judged", wgpu::StencilState::default())], &both[..]),
    };
    let format = if step.developed { LDR } else { RADIANCE };
    let write_mask = wgpu::ColorWrites::ALL;
    let target = wgpu::ColorTargetState { format, blend: step.added.then_some(ADD), write_mask };
    let create = |(entry, stencil)| {
        let recipe = Recipe {
            program: shader::ground(step.samples),
            entry,
            constants: &[flags(step), more].concat(),
            groups,
            targets: &[Some(target.clone())],
            depth_stencil: Some(wgpu::DepthStencilState {
                stencil,
                ..depth_test(gpu.depth_stencil, wgpu::CompareFunction::Equal, false)
            }),
            samples: step.samples,
        };
        recipe.scene(&gpu.device, Vertices::Plain, false, Some(wgpu::Face::Back))
    };
    entries.into_iter().map(create).collect()
}
