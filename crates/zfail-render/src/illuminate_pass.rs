//! One light's contribution, added where the stencil says lit (McGuire et al. 2003, section 8).

use crate::frame::FrameData;
use crate::layouts::Layouts;
use crate::pipeline::{Recipe, continued, read_only};
use crate::targets::{RADIANCE, Targets, view};
use crate::{Gpu, shader};

/// The pipeline of the pass.
#[derive(Debug)]
pub struct IlluminatePass {
    pipeline: wgpu::RenderPipeline,
}

impl IlluminatePass {
    pub fn new(gpu: &Gpu, layouts: &Layouts, samples: u32) -> Self {
        let add = wgpu::BlendComponent {
            src_factor: wgpu::BlendFactor::One,
            dst_factor: wgpu::BlendFactor::One,
            operation: wgpu::BlendOperation::Add,
        };
        let pipeline = Recipe {
            program: shader::illuminate(samples),
            entry: "illuminate",
            constants: &[],
            groups: &[&layouts.frame, layouts.gbuffer(samples)],
            targets: &[Some(wgpu::ColorTargetState {
                format: RADIANCE,
                blend: Some(wgpu::BlendState { color: add, alpha: add }),
                write_mask: wgpu::ColorWrites::COLOR,
            })],
            depth_stencil: Some(lit(gpu)),
            samples,
        }
        .screen(&gpu.device);
        Self { pipeline }
    }

    /// Adds light `light` of the frame within `scissor` (x, y, width, height).
    pub fn encode(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        targets: &Targets,
        frame: &FrameData,
        light: u32,
        scissor: [u32; 4],
        timestamp_writes: Option<wgpu::RenderPassTimestampWrites<'_>>,
    ) {
        let radiance = view(&targets.radiance);
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("illuminate"),
            color_attachments: &[continued(&radiance)],
            depth_stencil_attachment: Some(read_only(&targets.depth_stencil)),
            timestamp_writes,
            ..Default::default()
        });
        let [x, y, width, height] = scissor;
        if width == 0 || height == 0 {
            return;
        }
        pass.set_scissor_rect(x, y, width, height);
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &frame.bind_group, &[]);
        pass.set_bind_group(1, &targets.gbuffer, &[]);
        pass.draw(0..3, light..light + 1);
    }
}

/// Depth-stencil state of a screen pass that goes through where the stencil says lit.
pub fn lit(gpu: &Gpu) -> wgpu::DepthStencilState {
    wgpu::DepthStencilState {
        format: gpu.depth_stencil,
        depth_write_enabled: Some(false),
        depth_compare: Some(wgpu::CompareFunction::Always),
        stencil: zfail::lit_stencil(),
        bias: wgpu::DepthBiasState::default(),
    }
}
