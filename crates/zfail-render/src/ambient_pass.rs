//! Depth, surface attributes, and ambient and emitted light: the first pass of McGuire et al. 2003, section 8.

use crate::draw_list::{Alpha, DrawList, DrawState};
use crate::frame::FrameData;
use crate::layouts::Layouts;
use crate::pipeline::{Recipe, cleared};
use crate::scene::SceneOnGpu;
use crate::targets::{self, Targets, view};
use crate::{Gpu, shader};
use std::collections::HashMap;

/// Pipelines of the pass, one per state that the scene needs.
#[derive(Debug)]
pub struct AmbientPass {
    pipelines: HashMap<DrawState, wgpu::RenderPipeline>,
}

impl AmbientPass {
    pub fn new(gpu: &Gpu, layouts: &Layouts, samples: u32, list: &DrawList) -> Self {
        let formats = [targets::ALBEDO, targets::SURFACE, targets::GEOMETRIC_NORMAL, targets::DEPTH, targets::RADIANCE];
        let recipe = |state: DrawState| {
            let mask = f64::from(u8::from(state.alpha == Alpha::Mask));
            let cull = if state.double_sided { None } else { Some(wgpu::Face::Back) };
            Recipe {
                program: shader::AMBIENT,
                entry: "ambient",
                constants: &[("ALPHA_MASK", mask)],
                groups: &[&layouts.frame, &layouts.instance, &layouts.material],
                targets: &formats.map(|format| Some(format.into())),
                depth_stencil: Some(wgpu::DepthStencilState {
                    format: gpu.depth_stencil,
                    depth_write_enabled: Some(true),
                    depth_compare: Some(wgpu::CompareFunction::GreaterEqual),
                    stencil: wgpu::StencilState::default(),
                    bias: wgpu::DepthBiasState::default(),
                }),
                samples,
            }
            .scene(&gpu.device, state, cull)
        };
        let mut pipelines = HashMap::new();
        for draw in &list.solid {
            for state in draw.state.poses() {
                pipelines.entry(state).or_insert_with(|| recipe(state));
            }
        }
        Self { pipelines }
    }

    /// Draws solid surfaces over `background` (pre-exposed radiance). Leaves the stencil at 0: lit.
    pub fn encode(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        targets: &Targets,
        frame: &FrameData,
        scene: &SceneOnGpu,
        background: [f32; 3],
        timestamp_writes: Option<wgpu::RenderPassTimestampWrites<'_>>,
    ) {
        let views =
            [&targets.albedo, &targets.surface, &targets.geometric_normal, &targets.depth, &targets.radiance].map(view);
        let [r, g, b] = background.map(f64::from);
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("ambient"),
            color_attachments: &[
                cleared(&views[0], [0.0; 4]),
                cleared(&views[1], [0.0; 4]),
                cleared(&views[2], [0.0; 4]),
                cleared(&views[3], targets::NO_SURFACE.to_le_bytes().map(f64::from)),
                cleared(&views[4], [r, g, b, 0.0]),
            ],
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &targets.depth_stencil,
                depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(0.0), store: wgpu::StoreOp::Store }),
                stencil_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(0), store: wgpu::StoreOp::Store }),
            }),
            timestamp_writes,
            ..Default::default()
        });
        frame.draw(&mut pass, &scene.draws.solid, &scene.meshes, &scene.materials, |state| self.pipelines.get(&state));
    }
}
