//! How many fragments a frame's volumes have, counted in passes of their own: no figure of a device's own is the same
//! everywhere, and drawing them with another blend state is.
//!
//! In: a prepared frame. Out: the number of fragments by light.

use crate::passes::pipeline::cleared;
use crate::passes::targets::view;
use crate::{Gpu, RenderError};
use half::f16;

/// Half floats add up to 2048 layers at a pixel without error.
const LAYERS: wgpu::TextureFormat = wgpu::TextureFormat::R16Float;

/// Pipelines and targets of one image size.
#[derive(Debug)]
pub struct FragmentCounter {
    pipelines: zfail::Pipelines,
    layers: wgpu::Texture,
    depth_stencil: wgpu::TextureView,
}

impl FragmentCounter {
    pub fn new(gpu: &Gpu, shadows: &zfail::Shadows, size: [u32; 2]) -> Self {
        let texture = |format, usage| {
            gpu.device.create_texture(&wgpu::TextureDescriptor {
                label: Some("layers of volumes"),
                size: wgpu::Extent3d { width: size[0], height: size[1], depth_or_array_layers: 1 },
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage: wgpu::TextureUsages::RENDER_ATTACHMENT | usage,
                view_formats: &[],
            })
        };
        let target = zfail::Target { colors: &[Some(LAYERS)], depth_stencil: gpu.depth_stencil, samples: 1 };
        Self {
            pipelines: zfail::low_level::fragment_counters(shadows, &target),
            layers: texture(LAYERS, wgpu::TextureUsages::COPY_SRC),
            depth_stencil: view(&texture(gpu.depth_stencil, wgpu::TextureUsages::empty())),
        }
    }

    /// Whether it fits images of `size`.
    pub fn fits(&self, [width, height]: [u32; 2]) -> bool {
        [self.layers.width(), self.layers.height()] == [width, height]
    }

    /// The fragments of light `light` of a prepared frame, all volumes together.
    pub fn count(&self, gpu: &Gpu, prepared: &zfail::Prepared<'_>, light: usize) -> Result<u64, RenderError> {
        let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("fragments"),
            color_attachments: &[cleared(&view(&self.layers), [0.0; 4])],
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &self.depth_stencil,
                depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(0.0), store: wgpu::StoreOp::Discard }),
                stencil_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(0), store: wgpu::StoreOp::Discard }),
            }),
            ..Default::default()
        });
        prepared.draw(&mut pass, &self.pipelines, light);
        drop(pass);
        gpu.queue.submit([encoder.finish()]);
        let texels: Vec<u16> = bytemuck::pod_collect_to_vec(&gpu.read_texture(&self.layers)?);
        Ok(texels.into_iter().map(|bits| f16::from_bits(bits).to_f32() as u64).sum())
    }
}
