//! What changes every frame on the GPU: the index list and one record per draw.

use crate::error::Error;
use bytemuck::{Pod, Zeroable};
use glam::DAffine3;
use wgpu::{Buffer, BufferDescriptor, BufferUsages, Device, Queue};
use zfail_plan::plan::{Draw, FramePlan};
use zfail_plan::view::View;

/// `Draw` of `volume.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(crate) struct DrawRecord {
    clip_from_object: [[f32; 4]; 4],
    light: [f32; 4],
    cap: [f32; 4],
}

/// Buffers that grow to the largest frame seen.
#[derive(Debug)]
pub(crate) struct FrameBuffers {
    pub indices: Buffer,
    pub draws: Buffer,
    records: Vec<DrawRecord>,
}

impl FrameBuffers {
    pub fn new(device: &Device) -> Self {
        Self {
            indices: buffer(device, "volume indices", BufferUsages::INDEX, 4096),
            draws: buffer(device, "volume draws", BufferUsages::STORAGE, size_of::<DrawRecord>() as u64),
            records: Vec::new(),
        }
    }

    /// Uploads a plan; returns whether the draw buffer is a new one.
    pub fn upload(
        &mut self,
        device: &Device,
        queue: &Queue,
        plan: &FramePlan,
        view: &View,
        world_from_object: impl Fn(u32) -> DAffine3,
    ) -> Result<bool, Error> {
        let record = |draw: &Draw| DrawRecord {
            clip_from_object: view.clip_from_object(&world_from_object(draw.caster)).to_cols_array_2d(),
            light: draw.light.to_array(),
            cap: draw.cap.to_array(),
        };
        self.records.clear();
        self.records.extend(plan.draws.iter().map(record));

        let limits = device.limits();
        write(device, queue, &mut self.indices, &plan.indices, BufferUsages::INDEX, limits.max_buffer_size)?;
        let limit = limits.max_buffer_size.min(limits.max_storage_buffer_binding_size);
        write(device, queue, &mut self.draws, &self.records, BufferUsages::STORAGE, limit)
    }
}

/// Writes `data`, into a larger buffer if need be; returns whether it is a new one.
fn write<T: Pod>(
    device: &Device,
    queue: &Queue,
    target: &mut Buffer,
    data: &[T],
    usage: BufferUsages,
    limit: u64,
) -> Result<bool, Error> {
    let bytes: &[u8] = bytemuck::cast_slice(data);
    let size = bytes.len() as u64;
    let what = if usage.contains(BufferUsages::INDEX) { "volume indices" } else { "volume draws" };
    if size > limit {
        return Err(Error::TooLarge { what, bytes: size, limit });
    }
    let grow = size > target.size();
    if grow {
        *target = buffer(device, what, usage, (size + size / 2).min(limit) & !3);
    }
    if !bytes.is_empty() {
        queue.write_buffer(target, 0, bytes);
    }
    Ok(grow)
}

fn buffer(device: &Device, label: &str, usage: BufferUsages, size: u64) -> Buffer {
    device.create_buffer(&BufferDescriptor {
        label: Some(label),
        size,
        usage: usage | BufferUsages::COPY_DST,
        mapped_at_creation: false,
    })
}
