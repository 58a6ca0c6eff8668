//! Lettered sheets on the picture: all in one texture, one below the other.

use super::bind;
use super::buffers::Stream;
use crate::Error;
use crate::legend::Sticker;
use bytemuck::{Pod, Zeroable};
use zfail_render::{Gpu, wgpu};

/// The sheets of a figure.
#[derive(Debug)]
pub struct Stickers {
    shown: Vec<Sticker>,
    places: Stream,
    sheets: Option<wgpu::BindGroup>,
}

/// `Place` of `composite.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct PlaceRecord {
    rectangle: [f32; 4],
    offset: [i32; 2],
    size: [f32; 2],
}

const _: () = assert!(size_of::<PlaceRecord>() as u64 == super::pipelines::STICKER_BYTES);

impl Stickers {
    pub fn new(gpu: &Gpu) -> Self {
        Self { shown: Vec::new(), places: Stream::new(gpu, "stickers"), sheets: None }
    }

    /// Replaces all stickers on an image of `size`; those that are as they were stay on the device.
    pub fn set(
        &mut self,
        gpu: &Gpu,
        layout: &wgpu::BindGroupLayout,
        stickers: &[Sticker],
        size: [u32; 2],
    ) -> Result<(), Error> {
        let mut below = 0;
        let places: Vec<PlaceRecord> = stickers
            .iter()
            .map(|Sticker { at: [x, y], sheet }| {
                let [width, height] = sheet.size.map(|side| side as f32);
                let offset = [-x, below - y];
                below += sheet.size[1] as i32;
                PlaceRecord {
                    rectangle: [*x as f32, *y as f32, width, height],
                    offset,
                    size: size.map(|side| side as f32),
                }
            })
            .collect();
        self.places.set(gpu, &places)?;
        if !stickers.iter().map(|s| &s.sheet).eq(self.shown.iter().map(|s| &s.sheet)) {
            self.sheets = upload(gpu, layout, stickers);
            self.shown = stickers.to_vec();
        }
        Ok(())
    }

    pub fn draw(&self, pass: &mut wgpu::RenderPass<'_>, pipeline: &wgpu::RenderPipeline) {
        if let Some(sheets) = &self.sheets {
            pass.set_bind_group(0, sheets, &[]);
            self.places.draw_quads(pass, pipeline);
        }
    }
}

fn upload(gpu: &Gpu, layout: &wgpu::BindGroupLayout, stickers: &[Sticker]) -> Option<wgpu::BindGroup> {
    let width = stickers.iter().map(|s| s.sheet.size[0]).max()?;
    let height = stickers.iter().map(|s| s.sheet.size[1]).sum();
    let texture = gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: Some("sheets"),
        size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: wgpu::TextureFormat::Rgba8Unorm,
        usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
        view_formats: &[],
    });
    let mut y = 0;
    for Sticker { sheet, .. } in stickers {
        let [width, height] = sheet.size;
        gpu.queue.write_texture(
            wgpu::TexelCopyTextureInfo { origin: wgpu::Origin3d { x: 0, y, z: 0 }, ..texture.as_image_copy() },
            &sheet.rgba,
            wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(4 * width), rows_per_image: None },
            wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
        );
        y += height;
    }
    let view = texture.create_view(&wgpu::TextureViewDescriptor::default());
    Some(bind(gpu, layout, &[(4, wgpu::BindingResource::TextureView(&view))]))
}
