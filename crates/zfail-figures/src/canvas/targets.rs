//! Textures of one image size.

use zfail_render::{Gpu, wgpu};

/// The picture.
pub const PICTURE: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;
/// Optical depth times colour, and optical depth.
pub const GLASS: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;
/// Premultiplied colour.
pub const INK: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;
/// Count, and whether there is a surface. Half floats hold whole numbers up to 2048.
pub const COUNT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;
/// Depth of a figure.
pub const DEPTH: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;

/// Layers of a figure.
#[derive(Debug)]
pub struct Targets {
    pub size: [u32; 2],
    pub depth: wgpu::TextureView,
    pub glass: Layer,
    pub ink: Layer,
    /// The opaque part of a figure that replaces the picture; `None` if that is drawn directly.
    pub paper: Option<wgpu::TextureView>,
    pub counts: Option<Counts>,
}

/// Something drawn with several samples per pixel.
#[derive(Debug)]
pub struct Layer {
    pub samples: wgpu::TextureView,
    /// `None` if there is one sample per pixel.
    pub resolved: Option<wgpu::TextureView>,
}

/// Stencil counts at pixel centres.
#[derive(Debug)]
pub struct Counts {
    pub depth: wgpu::TextureView,
    pub counts: wgpu::TextureView,
}

impl Targets {
    pub fn new(gpu: &Gpu, size: [u32; 2], samples: u32) -> Self {
        let make = |label, format, samples| texture(gpu, label, format, size, samples);
        let layer = |label, format| Layer {
            samples: make(label, format, samples),
            resolved: (samples > 1).then(|| make(label, format, 1)),
        };
        Self {
            size,
            depth: make("figure depth", DEPTH, samples),
            glass: layer("glass", GLASS),
            ink: layer("ink", INK),
            paper: (samples > 1).then(|| make("paper", PICTURE, samples)),
            counts: None,
        }
    }

    /// What counting needs, made by the first figure that counts.
    pub fn counts(&mut self, gpu: &Gpu) -> &Counts {
        let size = self.size;
        self.counts.get_or_insert_with(|| Counts {
            depth: texture(gpu, "counting depth", DEPTH, size, 1),
            counts: texture(gpu, "counts", COUNT, size, 1),
        })
    }
}

impl Layer {
    /// As the target of a pass; several samples are averaged at its end.
    pub fn attachment(&self) -> Option<wgpu::RenderPassColorAttachment<'_>> {
        Some(wgpu::RenderPassColorAttachment {
            view: &self.samples,
            depth_slice: None,
            resolve_target: self.resolved.as_ref(),
            ops: wgpu::Operations { load: wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT), store: wgpu::StoreOp::Store },
        })
    }

    /// For reading.
    pub fn view(&self) -> &wgpu::TextureView {
        self.resolved.as_ref().unwrap_or(&self.samples)
    }
}

fn texture(gpu: &Gpu, label: &str, format: wgpu::TextureFormat, size: [u32; 2], samples: u32) -> wgpu::TextureView {
    let mut usage = wgpu::TextureUsages::RENDER_ATTACHMENT;
    if samples == 1 && format != DEPTH {
        usage |= wgpu::TextureUsages::TEXTURE_BINDING;
    }
    let texture = gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: Some(label),
        size: wgpu::Extent3d { width: size[0], height: size[1], depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: samples,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage,
        view_formats: &[],
    });
    texture.create_view(&wgpu::TextureViewDescriptor::default())
}
