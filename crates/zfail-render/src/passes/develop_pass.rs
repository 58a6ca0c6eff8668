//! From radiance to a picture: exposure, tone mapping, the mean of samples, display encoding.

use crate::passes::pipeline::{Recipe, cleared};
use crate::passes::targets::{HDR, HdrTargets, LDR};
use crate::scene::layouts::{FLOATS, bind, entry, texture, uniform};
use crate::{Gpu, passes::shader};

/// The pipeline of the pass.
#[derive(Debug)]
pub struct DevelopPass {
    layout: wgpu::BindGroupLayout,
    pipeline: wgpu::RenderPipeline,
}

impl DevelopPass {
    pub fn new(gpu: &Gpu, samples: u32) -> Self {
        let fragment = wgpu::ShaderStages::FRAGMENT;
        let layout = gpu.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("develop"),
            entries: &[entry(0, fragment, texture(FLOATS, samples > 1)), entry(1, fragment, uniform::<f32>())],
        });
        let pipeline = Recipe {
            program: shader::develop(samples),
            entry: "develop",
            constants: &[],
            groups: &[&layout],
            targets: &[Some(HDR.into()), Some(LDR.into())],
            depth_stencil: None,
            samples: 1,
        }
        .screen(&gpu.device);
        Self { layout, pipeline }
    }

    /// Fills the HDR and LDR targets.
    pub fn encode(
        &self,
        gpu: &Gpu,
        encoder: &mut wgpu::CommandEncoder,
        hdr: &HdrTargets,
        ldr: &wgpu::TextureView,
        exposure: &wgpu::Buffer,
        timestamp_writes: Option<wgpu::RenderPassTimestampWrites<'_>>,
    ) {
        let group = bind(
            &gpu.device,
            "develop",
            &self.layout,
            &[wgpu::BindingResource::TextureView(&hdr.samples), exposure.as_entire_binding()],
        );
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("develop"),
            color_attachments: &[cleared(&hdr.view, [0.0; 4]), cleared(ldr, [0.0; 4])],
            timestamp_writes,
            ..Default::default()
        });
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &group, &[]);
        pass.draw(0..3, 0..1);
    }
}
