//! From textures on the device to bytes.

use crate::{Gpu, RenderError};

/// Bytes that one copy takes at most, so that large images need no large buffer.
const BAND: u64 = 64 << 20;

/// The texels of a single-sampled texture of a colour format, rows from top to bottom, without padding.
pub fn texture(gpu: &Gpu, texture: &wgpu::Texture) -> Result<Vec<u8>, RenderError> {
    let size = texture.size();
    let texel = texture.format().block_copy_size(None).unwrap_or(4);
    let row = size.width * texel;
    let padded = row.next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
    let rows = (BAND / u64::from(padded)).clamp(1, u64::from(size.height)) as u32;
    let staging = staging(gpu, u64::from(padded) * u64::from(rows));
    let mut texels = Vec::with_capacity(row as usize * size.height as usize);
    for y in (0..size.height).step_by(rows as usize) {
        let height = rows.min(size.height - y);
        let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        encoder.copy_texture_to_buffer(
            wgpu::TexelCopyTextureInfo { origin: wgpu::Origin3d { x: 0, y, z: 0 }, ..texture.as_image_copy() },
            wgpu::TexelCopyBufferInfo {
                buffer: &staging,
                layout: wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(padded), rows_per_image: None },
            },
            wgpu::Extent3d { width: size.width, height, depth_or_array_layers: 1 },
        );
        gpu.queue.submit([encoder.finish()]);
        map(gpu, &staging, |bytes| {
            for line in bytes.chunks_exact(padded as usize).take(height as usize) {
                texels.extend_from_slice(&line[..row as usize]);
            }
        })?;
    }
    Ok(texels)
}

/// The first four bytes of `buffer`, as a number.
pub fn number(gpu: &Gpu, buffer: &wgpu::Buffer) -> Result<f32, RenderError> {
    let staging = staging(gpu, 4);
    let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    encoder.copy_buffer_to_buffer(buffer, 0, &staging, 0, 4);
    gpu.queue.submit([encoder.finish()]);
    let mut number = 0.0;
    map(gpu, &staging, |bytes| number = bytemuck::pod_read_unaligned(&bytes[..4]))?;
    Ok(number)
}

fn staging(gpu: &Gpu, size: u64) -> wgpu::Buffer {
    gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("read-back"),
        size,
        usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    })
}

/// Waits for the device, then shows the contents of `staging` to `read`.
pub fn map(gpu: &Gpu, staging: &wgpu::Buffer, read: impl FnOnce(&[u8])) -> Result<(), RenderError> {
    // An earlier failure explains more than a failed mapping.
    gpu.check()?;
    let (sender, receiver) = std::sync::mpsc::channel();
    // The receiver outlives the callback, or nobody is interested.
    staging.map_async(wgpu::MapMode::Read, .., move |result| drop(sender.send(result)));
    gpu.device.poll(wgpu::PollType::wait_indefinitely()).map_err(|e| RenderError::Device(e.to_string()))?;
    gpu.check()?;
    match receiver.try_recv() {
        Ok(Ok(())) => {}
        Ok(Err(error)) => return Err(RenderError::Device(error.to_string())),
        Err(error) => return Err(RenderError::Device(error.to_string())),
    }
    let view = staging.get_mapped_range(..).map_err(|e| RenderError::Device(e.to_string()))?;
    read(&view);
    drop(view);
    staging.unmap();
    Ok(())
}
