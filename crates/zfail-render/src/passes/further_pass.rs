//! Light on blended surfaces beyond the lights whose verdicts share a texel. What these add has been drawn on black, over
//! itself as the surfaces lie over each other; it is added to the radiance that is there.

use crate::passes::pipeline::{ADD, Recipe, continued};
use crate::passes::targets::RADIANCE;
use crate::scene::layouts::{FLOATS, bind, entry, texture};
use crate::{Gpu, passes::shader};

/// The pipeline of the pass.
#[derive(Debug)]
pub struct FurtherPass {
    layout: wgpu::BindGroupLayout,
    pipeline: wgpu::RenderPipeline,
}

impl FurtherPass {
    pub fn new(gpu: &Gpu, samples: u32) -> Self {
        let layout = gpu.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("further light"),
            entries: &[entry(0, wgpu::ShaderStages::FRAGMENT, texture(FLOATS, samples > 1))],
        });
        // Alpha is no light.
        let target =
            wgpu::ColorTargetState { format: RADIANCE, blend: Some(ADD), write_mask: wgpu::ColorWrites::COLOR };
        let pipeline = Recipe {
            program: shader::further(samples),
            entry: "further",
            constants: &[],
            groups: &[&layout],
            targets: &[Some(target)],
            depth_stencil: None,
            samples,
        }
        .screen(&gpu.device);
        Self { layout, pipeline }
    }

    /// Adds `light` to `radiance`, sample by sample.
    pub fn encode(
        &self,
        gpu: &Gpu,
        encoder: &mut wgpu::CommandEncoder,
        light: &wgpu::TextureView,
        radiance: &wgpu::TextureView,
    ) {
        let group = bind(&gpu.device, "further light", &self.layout, &[wgpu::BindingResource::TextureView(light)]);
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("further light"),
            color_attachments: &[continued(radiance)],
            ..Default::default()
        });
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &group, &[]);
        pass.draw(0..3, 0..1);
    }
}
