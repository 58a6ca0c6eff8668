//! The stencil verdict of one light: 0 where it shines, by way of the crate `zfail`.

use crate::Gpu;
use crate::targets::Targets;

/// Pipelines of the pass.
#[derive(Debug)]
pub struct ShadowPass {
    pipelines: zfail::Pipelines,
}

impl ShadowPass {
    pub fn new(gpu: &Gpu, shadows: &zfail::Shadows, samples: u32) -> Self {
        let target = zfail::Target { colors: &[], depth_stencil: gpu.depth_stencil, samples };
        Self { pipelines: shadows.pipelines(&gpu.device, &target) }
    }

    /// Clears the stencil and counts the volumes of light `light` of the frame that `shadows` has prepared.
    pub fn encode(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        targets: &Targets,
        shadows: &zfail::Shadows,
        light: usize,
        timestamp_writes: Option<wgpu::RenderPassTimestampWrites<'_>>,
    ) {
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("shadow"),
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &targets.depth_stencil,
                depth_ops: None,
                stencil_ops: Some(wgpu::Operations {
                    load: wgpu::LoadOp::Clear(shadows.stencil_clear(light)),
                    store: wgpu::StoreOp::Store,
                }),
            }),
            timestamp_writes,
            ..Default::default()
        });
        shadows.draw(&mut pass, &self.pipelines, light);
    }
}
