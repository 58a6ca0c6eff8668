//! The tile pass's lists on the GPU.
//!
//! Quads and entries lie in textures, row by row, because software devices fetch a texel four times as fast as they load
//! as much from a buffer.

use super::bins::{LANES, TILE};
use super::quad::Quad;
use crate::error::Error;
use bytemuck::{Pod, Zeroable};
use wgpu::{
    BindGroupEntry, BindingResource, Buffer, BufferDescriptor, BufferUsages, Device, Extent3d, Limits, Origin3d, Queue,
    TexelCopyBufferLayout, TexelCopyTextureInfo, Texture, TextureAspect, TextureDescriptor, TextureDimension,
    TextureFormat, TextureUsages, TextureView, TextureViewDescriptor,
};

/// Texels in a row of either texture, as `count.wgsl` has it.
const ROW: usize = 2048;
/// Texels of a quad.
const QUAD: usize = 4;
/// Workgroups in one dimension of a dispatch.
const WORKGROUPS: usize = 65535;

/// `Group` of `count.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(super) struct GroupRecord {
    pub first: u32,
    pub length: u32,
    pub row: u32,
    pub base: i32,
}

/// Whether a device can hold lists of these lengths and so many rows of tiles.
pub(super) fn fit(limits: &Limits, quads: usize, entries: usize, rows: usize) -> bool {
    let lists = [(quads * QUAD).div_ceil(ROW), entries.div_ceil(ROW), rows];
    lists.iter().all(|&rows| rows <= limits.max_texture_dimension_2d as usize)
}

/// The dispatch that has at least as many workgroups as there are groups.
pub(super) fn workgroups(groups: usize) -> [u32; 2] {
    let rows = groups.div_ceil(WORKGROUPS).max(1);
    [groups.div_ceil(rows) as u32, rows as u32]
}

/// Buffers and textures that grow to the largest frame seen.
#[derive(Debug)]
pub(super) struct Buffers {
    image: Buffer,
    groups: Buffer,
    places: Buffer,
    entries: TextureView,
    quads: TextureView,
    shadowed: TextureView,
    /// Texels to upload, filled up to whole rows.
    rows: Vec<u8>,
}

impl Buffers {
    pub fn new(device: &Device) -> Self {
        Self {
            image: buffer(device, BufferUsages::UNIFORM, 16),
            groups: buffer(device, BufferUsages::STORAGE, size_of::<GroupRecord>() as u64),
            places: buffer(device, BufferUsages::STORAGE, (LANES * size_of::<u32>()) as u64),
            entries: list(device, TextureFormat::R32Uint, 1),
            quads: list(device, TextureFormat::Rgba32Float, 1),
            shadowed: shadowed(device, [1; 2]),
            rows: Vec::new(),
        }
    }

    /// One bit a pixel: whether it is in shadow, one light below the other.
    pub fn shadowed(&self) -> &TextureView {
        &self.shadowed
    }

    /// What `count.wgsl` binds.
    pub fn entries<'a>(&'a self, depth: &'a TextureView) -> [BindGroupEntry<'a>; 7] {
        let texture = |binding, view| BindGroupEntry { binding, resource: BindingResource::TextureView(view) };
        let buffer = |binding, buffer: &'a Buffer| BindGroupEntry { binding, resource: buffer.as_entire_binding() };
        [
            buffer(0, &self.image),
            buffer(1, &self.groups),
            buffer(2, &self.places),
            texture(3, &self.entries),
            texture(4, &self.quads),
            texture(5, depth),
            texture(6, &self.shadowed),
        ]
    }

    /// Uploads a frame's lists, and for each of `bases` whether tiles without a list are in shadow.
    #[expect(clippy::too_many_arguments, reason = "one for each buffer")]
    pub fn upload(
        &mut self,
        device: &Device,
        queue: &Queue,
        size: [u32; 2],
        groups: &[GroupRecord],
        places: &[u32],
        entries: &[u32],
        quads: &[Quad],
        bases: impl ExactSizeIterator<Item = i32>,
    ) -> Result<(), Error> {
        if groups.is_empty() && bases.len() == 0 {
            return Ok(());
        }
        queue.write_buffer(&self.image, 0, bytemuck::cast_slice(&[size[0], size[1], 0, 0]));
        // Surplus workgroups find neither list nor place.
        let [x, y] = workgroups(groups.len());
        let all = (x * y) as usize;
        write(device, queue, &mut self.groups, groups, all, 0)?;
        write(device, queue, &mut self.places, places, all * LANES, 0xff)?;
        self.write_rows(device, queue, TextureFormat::R32Uint, bytemuck::cast_slice(entries));
        self.write_rows(device, queue, TextureFormat::Rgba32Float, bytemuck::cast_slice(quads));

        let [across, down] = size.map(|n| n.div_ceil(TILE));
        let wanted = [across * 2, down * bases.len() as u32];
        let texture = self.shadowed.texture();
        if texture.width() != wanted[0] || texture.height() < wanted[1] {
            self.shadowed = shadowed(device, wanted);
        }
        let light = (wanted[0] * down) as usize * size_of::<u32>();
        self.rows.clear();
        for base in bases {
            self.rows.resize(self.rows.len() + light, if base == 0 { 0 } else { 0xff });
        }
        copy(queue, self.shadowed.texture(), wanted, &self.rows);
        Ok(())
    }

    /// Writes a list of texels into the texture of its format.
    fn write_rows(&mut self, device: &Device, queue: &Queue, format: TextureFormat, texels: &[u8]) {
        let target = if format == TextureFormat::R32Uint { &mut self.entries } else { &mut self.quads };
        let row = ROW * format.block_copy_size(None).unwrap_or(4) as usize;
        let rows = texels.len().div_ceil(row).max(1);
        if target.texture().height() < rows as u32 {
            let most = device.limits().max_texture_dimension_2d;
            *target = list(device, format, (rows as u32).next_power_of_two().min(most));
        }
        self.rows.clear();
        self.rows.extend_from_slice(texels);
        self.rows.resize(rows * row, 0);
        copy(queue, target.texture(), [ROW as u32, rows as u32], &self.rows);
    }
}

/// Writes `list` and fills it up to `len` elements with bytes of `filler`.
fn write<T: Pod>(
    device: &Device,
    queue: &Queue,
    target: &mut Buffer,
    list: &[T],
    len: usize,
    filler: u8,
) -> Result<(), Error> {
    let bytes = (len * size_of::<T>()) as u64;
    let limits = device.limits();
    let limit = limits.max_buffer_size.min(limits.max_storage_buffer_binding_size);
    if bytes > limit {
        return Err(Error::TooLarge { what: "tile lists", bytes, limit });
    }
    if bytes > target.size() {
        *target = buffer(device, BufferUsages::STORAGE, bytes.next_power_of_two().min(limit));
    }
    let list: &[u8] = bytemuck::cast_slice(list);
    queue.write_buffer(target, 0, list);
    if list.len() < bytes as usize {
        queue.write_buffer(target, list.len() as u64, &vec![filler; bytes as usize - list.len()]);
    }
    Ok(())
}

fn copy(queue: &Queue, texture: &Texture, [width, height]: [u32; 2], texels: &[u8]) {
    let texel = texture.format().block_copy_size(None).unwrap_or(4);
    queue.write_texture(
        TexelCopyTextureInfo { texture, mip_level: 0, origin: Origin3d::ZERO, aspect: TextureAspect::All },
        texels,
        TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(width * texel), rows_per_image: None },
        Extent3d { width, height, depth_or_array_layers: 1 },
    );
}

fn buffer(device: &Device, usage: BufferUsages, size: u64) -> Buffer {
    device.create_buffer(&BufferDescriptor {
        label: Some("tile lists"),
        size,
        usage: usage | BufferUsages::COPY_DST,
        mapped_at_creation: false,
    })
}

fn list(device: &Device, format: TextureFormat, rows: u32) -> TextureView {
    texture(device, "tile lists", format, [ROW as u32, rows], TextureUsages::COPY_DST)
}

fn shadowed(device: &Device, size: [u32; 2]) -> TextureView {
    let usage = TextureUsages::STORAGE_BINDING | TextureUsages::COPY_DST;
    texture(device, "tile verdicts", TextureFormat::R32Uint, size, usage)
}

fn texture(
    device: &Device,
    label: &str,
    format: TextureFormat,
    [width, height]: [u32; 2],
    usage: TextureUsages,
) -> TextureView {
    let texture = device.create_texture(&TextureDescriptor {
        label: Some(label),
        size: Extent3d { width, height, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: TextureDimension::D2,
        format,
        usage: usage | TextureUsages::TEXTURE_BINDING,
        view_formats: &[],
    });
    texture.create_view(&TextureViewDescriptor::default())
}

#[cfg(test)]
mod tests {
    use super::GroupRecord;
    use zfail_testing::{layout, naga::valid::Capabilities, wgsl::validate};

    #[test]
    fn a_group_lies_as_its_shader_reads_it() {
        let module = validate(include_str!("count.wgsl"), Capabilities::empty()).expect("WGSL");
        layout!(&module, "Group", GroupRecord, [first, length, row, base]).expect("agreement");
    }
}
