//! Blended materials, from back to front over the opaque image, lit without shadows.

use crate::draw_list::{DrawList, DrawState};
use crate::frame::FrameData;
use crate::layouts::Layouts;
use crate::pipeline::{Recipe, continued, read_only};
use crate::scene::SceneOnGpu;
use crate::targets::{RADIANCE, Targets, view};
use crate::{Gpu, shader};
use std::collections::HashMap;

/// Pipelines of the pass, one or two per state that the scene needs: inner sides of double-sided surfaces come first.
#[derive(Debug)]
pub struct FinalPass {
    pipelines: HashMap<DrawState, Vec<wgpu::RenderPipeline>>,
}

impl FinalPass {
    pub fn new(gpu: &Gpu, layouts: &Layouts, samples: u32, list: &DrawList) -> Self {
        let over = |src_factor| wgpu::BlendComponent {
            src_factor,
            dst_factor: wgpu::BlendFactor::OneMinusSrcAlpha,
            operation: wgpu::BlendOperation::Add,
        };
        let create = |state: DrawState, cull| {
            // The target's alpha is the share that is shown without exposure: unlit surfaces add to it, others cover it.
            let alpha = over(if state.unlit { wgpu::BlendFactor::One } else { wgpu::BlendFactor::Zero });
            Recipe {
                program: shader::FINAL,
                entry: "blend",
                constants: &[("UNLIT", f64::from(u8::from(state.unlit)))],
                groups: &[&layouts.frame, &layouts.instance, &layouts.material],
                targets: &[Some(wgpu::ColorTargetState {
                    format: RADIANCE,
                    blend: Some(wgpu::BlendState { color: over(wgpu::BlendFactor::One), alpha }),
                    write_mask: wgpu::ColorWrites::ALL,
                })],
                depth_stencil: Some(wgpu::DepthStencilState {
                    format: gpu.depth_stencil,
                    depth_write_enabled: Some(false),
                    depth_compare: Some(wgpu::CompareFunction::Greater),
                    stencil: wgpu::StencilState::default(),
                    bias: wgpu::DepthBiasState::default(),
                }),
                samples,
            }
            .scene(&gpu.device, state, Some(cull))
        };
        let mut pipelines = HashMap::new();
        for draw in &list.blended {
            let faces: &[wgpu::Face] =
                if draw.state.double_sided { &[wgpu::Face::Front, wgpu::Face::Back] } else { &[wgpu::Face::Back] };
            for state in draw.state.poses() {
                pipelines.entry(state).or_insert_with(|| faces.iter().map(|&cull| create(state, cull)).collect());
            }
        }
        Self { pipelines }
    }

    /// Draws every blended primitive.
    pub fn encode(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        targets: &Targets,
        frame: &FrameData,
        scene: &SceneOnGpu,
        timestamp_writes: Option<wgpu::RenderPassTimestampWrites<'_>>,
    ) {
        let radiance = view(&targets.radiance);
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("final"),
            color_attachments: &[continued(&radiance)],
            depth_stencil_attachment: Some(read_only(&targets.depth_stencil)),
            timestamp_writes,
            ..Default::default()
        });
        frame.draw(&mut pass, frame.blended(&scene.draws), &scene.meshes, &scene.materials, |state| {
            self.pipelines.get(&state).into_iter().flatten()
        });
    }
}
