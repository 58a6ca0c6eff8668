//! Vertex buffers that grow to the largest figure seen.

use crate::Error;
use bytemuck::{NoUninit, cast_slice};
use std::ops::Range;
use zfail_render::{Gpu, wgpu};

/// A list of vertices or instances.
#[derive(Debug)]
pub struct Stream {
    buffer: wgpu::Buffer,
    label: &'static str,
    count: u32,
}

impl Stream {
    pub fn new(gpu: &Gpu, label: &'static str) -> Self {
        Self { buffer: create(gpu, label, 1024, wgpu::BufferUsages::VERTEX), label, count: 0 }
    }

    /// Replaces the list.
    pub fn set<T: NoUninit>(&mut self, gpu: &Gpu, list: &[T]) -> Result<(), Error> {
        let bytes: &[u8] = cast_slice(list);
        let (needed, limit) = (bytes.len() as u64, gpu.device.limits().max_buffer_size);
        let Some(count) = u32::try_from(list.len()).ok().filter(|_| needed <= limit) else {
            let message = format!("its lists take {needed} bytes, and this device allows {limit}; choose fewer lights");
            return Err(Error::Unfit(message));
        };
        if needed > self.buffer.size() {
            let size = needed.next_power_of_two().min(limit);
            self.buffer = create(gpu, self.label, size, wgpu::BufferUsages::VERTEX);
        }
        gpu.queue.write_buffer(&self.buffer, 0, bytes);
        self.count = count;
        Ok(())
    }

    /// Draws the list as triangles.
    pub fn draw(&self, pass: &mut wgpu::RenderPass<'_>, pipeline: &wgpu::RenderPipeline) {
        self.draw_part(pass, pipeline, 0..self.count);
    }

    /// Draws a part of the list as triangles.
    pub fn draw_part(&self, pass: &mut wgpu::RenderPass<'_>, pipeline: &wgpu::RenderPipeline, vertices: Range<u32>) {
        if self.bound(pass, pipeline) {
            pass.draw(vertices, 0..1);
        }
    }

    /// Draws a quad for every entry of the list.
    pub fn draw_quads(&self, pass: &mut wgpu::RenderPass<'_>, pipeline: &wgpu::RenderPipeline) {
        if self.bound(pass, pipeline) {
            pass.draw(0..4, 0..self.count);
        }
    }

    fn bound(&self, pass: &mut wgpu::RenderPass<'_>, pipeline: &wgpu::RenderPipeline) -> bool {
        if self.count > 0 {
            pass.set_pipeline(pipeline);
            pass.set_vertex_buffer(0, self.buffer.slice(..));
        }
        self.count > 0
    }
}

/// A buffer that the queue writes.
pub fn create(gpu: &Gpu, label: &str, size: u64, usage: wgpu::BufferUsages) -> wgpu::Buffer {
    gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: Some(label),
        size,
        usage: usage | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    })
}
