//! What changes every frame on the GPU: the index list and one record per draw.

use crate::error::Error;
use bytemuck::{Pod, Zeroable};
use glam::Mat4;
use wgpu::{Buffer, BufferDescriptor, BufferUsages, Device, Queue};
use zfail_plan::plan::{Draw, FramePlan};

/// `Draw` of `volume.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(crate) struct DrawRecord {
    clip_from_object: [[f32; 4]; 4],
    light: [f32; 4],
    reach: f32,
    _pad: [f32; 3],
}

impl DrawRecord {
    /// Of a draw whose caster is drawn with a matrix.
    pub fn new(draw: &Draw, clip_from_object: Mat4) -> Self {
        Self {
            clip_from_object: clip_from_object.to_cols_array_2d(),
            light: draw.light.to_array(),
            reach: draw.reach,
            _pad: [0.0; 3],
        }
    }
}

/// Buffers that grow to the largest frame seen.
#[derive(Debug)]
pub(crate) struct FrameBuffers {
    pub indices: Buffer,
    pub draws: Buffer,
    records: Vec<DrawRecord>,
    /// Bytes that the last frame wrote.
    pub uploaded: u64,
}

impl FrameBuffers {
    pub fn new(device: &Device) -> Self {
        Self {
            indices: buffer(device, "volume indices", BufferUsages::INDEX, 4096),
            draws: buffer(device, "volume draws", BufferUsages::STORAGE, size_of::<DrawRecord>() as u64),
            records: Vec::new(),
            uploaded: 0,
        }
    }

    /// Uploads a plan; returns whether the draw buffer is a new one.
    pub fn upload(
        &mut self,
        device: &Device,
        queue: &Queue,
        plan: &FramePlan,
        clip_from_object: impl Fn(u32) -> Mat4,
    ) -> Result<bool, Error> {
        let record = |draw: &Draw| DrawRecord::new(draw, clip_from_object(draw.caster));
        self.records.clear();
        self.records.extend(plan.draws.iter().map(record));

        let limits = device.limits();
        let indices: &[u8] = bytemuck::cast_slice(&plan.indices);
        let size = indices.len() as u64;
        if grow(device, &mut self.indices, "volume indices", size, BufferUsages::INDEX, limits.max_buffer_size)? {
            queue.write_buffer(&self.indices, 0, indices);
            self.uploaded = size;
        } else {
            self.uploaded = 0;
            // Everything else is there from earlier frames.
            for range in &plan.changed {
                let bytes = bytemuck::cast_slice(&plan.indices[range.start as usize..range.end as usize]);
                queue.write_buffer(&self.indices, u64::from(range.start) * size_of::<u32>() as u64, bytes);
                self.uploaded += bytes.len() as u64;
            }
        }
        let records: &[u8] = bytemuck::cast_slice(&self.records);
        let limit = limits.max_buffer_size.min(limits.max_storage_buffer_binding_size);
        let size = records.len() as u64;
        let new = grow(device, &mut self.draws, "volume draws", size, BufferUsages::STORAGE, limit)?;
        if !records.is_empty() {
            queue.write_buffer(&self.draws, 0, records);
            self.uploaded += size;
        }
        Ok(new)
    }
}

/// Makes `target` a larger buffer if `size` bytes do not fit; returns whether it is a new one.
fn grow(
    device: &Device,
    target: &mut Buffer,
    what: &'static str,
    size: u64,
    usage: BufferUsages,
    limit: u64,
) -> Result<bool, Error> {
    if size > limit {
        return Err(Error::TooLarge { what, bytes: size, limit });
    }
    let grow = size > target.size();
    if grow {
        *target = buffer(device, what, usage, (size + size / 2).min(limit) & !3);
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

#[cfg(test)]
mod tests {
    use super::DrawRecord;
    use zfail_testing::{layout, naga::valid::Capabilities, wgsl::validate};

    #[test]
    fn a_draw_lies_as_its_shader_reads_it() {
        let module = validate(include_str!("volume.wgsl"), Capabilities::MULTISAMPLED_SHADING).expect("WGSL");
        layout!(&module, "Draw", DrawRecord, [clip_from_object, light, reach]).expect("agreement");
    }
}
