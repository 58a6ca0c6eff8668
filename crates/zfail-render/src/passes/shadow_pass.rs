//! The stencil verdict of one light: 0 where it shines, by way of the crate `zfail`.

use crate::Gpu;
use crate::passes::targets::Attributes;

/// Pipelines of the pass.
#[derive(Debug)]
pub struct ShadowPass {
    pipelines: zfail::Pipelines,
}

impl ShadowPass {
    pub fn new(gpu: &Gpu, shadows: &zfail::Shadows) -> Self {
        let target = zfail::Target { colors: &[], depth_stencil: gpu.depth_stencil, samples: 1 };
        Self { pipelines: shadows.pipelines(&target) }
    }

    /// Clears the stencil and counts the volumes of light `light` of a prepared frame.
    pub fn encode(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        targets: &Attributes,
        prepared: &zfail::Prepared<'_>,
        light: usize,
    ) {
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("shadow"),
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &targets.depth_stencil,
                depth_ops: None,
                stencil_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(0), store: wgpu::StoreOp::Store }),
            }),
            ..Default::default()
        });
        prepared.draw(&mut pass, &self.pipelines, light);
    }
}
