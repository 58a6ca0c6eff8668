//! What the stage draws to.

use super::pipelines::MASK;
use crate::Error;
use std::sync::mpsc;
use wgpu::util::DeviceExt;
use wgpu::{
    BindGroup, BindGroupLayout, Buffer, BufferUsages, CommandEncoder, Device, LoadOp, Operations, RenderPass, StoreOp,
    Texture, TextureFormat, TextureUsages, TextureView,
};
use zfail_render::{Gpu, RenderError};

/// Targets of one size.
#[derive(Debug)]
pub struct Targets {
    size: [u32; 2],
    depth_stencil: TextureView,
    pub mask: Texture,
    mask_view: TextureView,
}

impl Targets {
    /// The targets in `slot`, made anew if they have another size.
    pub fn fit<'s>(slot: &'s mut Option<Self>, gpu: &Gpu, size: [u32; 2]) -> Result<&'s Self, RenderError> {
        if size.contains(&0) {
            return Err(RenderError::EmptySize { size });
        }
        let most = gpu.device.limits().max_texture_dimension_2d;
        if size.iter().any(|&side| side > most) {
            return Err(RenderError::TooLarge {
                size,
                limit: format!("no side may exceed {most} pixels on this device"),
            });
        }
        let kept = slot.take().filter(|targets| targets.size == size);
        Ok(slot.insert(kept.unwrap_or_else(|| Self::new(gpu, size))))
    }

    fn new(gpu: &Gpu, size: [u32; 2]) -> Self {
        let texture = |format: TextureFormat, usage| {
            gpu.device.create_texture(&wgpu::TextureDescriptor {
                label: Some("stage"),
                size: wgpu::Extent3d { width: size[0], height: size[1], depth_or_array_layers: 1 },
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage,
                view_formats: &[],
            })
        };
        let view = |texture: &Texture| texture.create_view(&wgpu::TextureViewDescriptor::default());
        let depth_stencil = view(&texture(gpu.depth_stencil, TextureUsages::RENDER_ATTACHMENT));
        let mask = texture(MASK, TextureUsages::RENDER_ATTACHMENT | TextureUsages::COPY_SRC);
        Self { size, depth_stencil, mask_view: view(&mask), mask }
    }

    /// A pass that starts with nothing in sight and `stencil` everywhere.
    pub fn begin<'e>(&self, encoder: &'e mut CommandEncoder, stencil: u32) -> RenderPass<'e> {
        encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("depth and volumes"),
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &self.depth_stencil,
                depth_ops: Some(Operations { load: LoadOp::Clear(0.0), store: StoreOp::Store }),
                stencil_ops: Some(Operations { load: LoadOp::Clear(stencil % 256), store: StoreOp::Store }),
            }),
            ..Default::default()
        })
    }

    /// A pass that starts with a black mask, over depth and stencil as they are.
    pub fn begin_verdict<'e>(&self, encoder: &'e mut CommandEncoder) -> RenderPass<'e> {
        let depth_stencil =
            wgpu::RenderPassDepthStencilAttachment { view: &self.depth_stencil, depth_ops: None, stencil_ops: None };
        encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("verdict"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &self.mask_view,
                depth_slice: None,
                resolve_target: None,
                ops: Operations { load: LoadOp::Clear(wgpu::Color::BLACK), store: StoreOp::Store },
            })],
            depth_stencil_attachment: Some(depth_stencil),
            ..Default::default()
        })
    }
}

/// What the instrumented run counts with.
pub struct Counters {
    buffer: Buffer,
    pub bind_group: BindGroup,
}

impl Counters {
    /// Bytes of the array in `stage.wgsl`.
    const SIZE: u64 = 256 * 4;

    pub fn new(device: &Device, layout: &BindGroupLayout) -> Self {
        let buffer = device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: Some("counters"),
            contents: &[0; Self::SIZE as usize],
            usage: BufferUsages::STORAGE | BufferUsages::COPY_SRC,
        });
        let bind_group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("counters"),
            layout,
            entries: &[wgpu::BindGroupEntry { binding: 0, resource: buffer.as_entire_binding() }],
        });
        Self { buffer, bind_group }
    }

    /// Submits `encoder` and adds up what was counted.
    pub fn read(&self, gpu: &Gpu, mut encoder: CommandEncoder) -> Result<u64, Error> {
        let staging = gpu.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("counters"),
            size: Self::SIZE,
            usage: BufferUsages::MAP_READ | BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        encoder.copy_buffer_to_buffer(&self.buffer, 0, &staging, 0, Self::SIZE);
        gpu.queue.submit([encoder.finish()]);
        let (sender, receiver) = mpsc::channel();
        // The receiver outlives the callback, or nobody is interested.
        staging.map_async(wgpu::MapMode::Read, .., move |result| drop(sender.send(result)));
        gpu.wait()?;
        let failed = |message: String| Error::Render(RenderError::Device(message));
        let mapped = receiver.try_recv().map_err(|e| failed(e.to_string()))?;
        mapped.map_err(|e| failed(e.to_string()))?;
        let bytes = staging.get_mapped_range(..).map_err(|e| failed(e.to_string()))?;
        Ok(bytemuck::cast_slice::<u8, u32>(&bytes).iter().map(|&count| u64::from(count)).sum())
    }
}
