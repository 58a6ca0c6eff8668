//! The render targets of one image size and sample count.

use crate::scene::layouts::{Layouts, bind};
use crate::{Gpu, RenderError};

/// The light verdicts: a bit per light, set where it is blocked.
pub const VERDICTS: wgpu::TextureFormat = zfail::VerdictBits::FORMAT;
/// Sum of what the lights send to the eye.
pub const RADIANCE: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;
/// Exposed radiance.
pub const HDR: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;
/// The picture, encoded for the display by the shaders: target formats that encode cost software rasterisers more.
pub const LDR: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;

/// Distance along the view axis, an `f32` as four bytes, least significant first: sampled depth textures fail on some
/// GL drivers.
pub const DEPTH: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Uint;
/// Shading normal.
pub const NORMAL: wgpu::TextureFormat = wgpu::TextureFormat::Rg16Float;
/// Base colour.
pub const ALBEDO: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8UnormSrgb;

/// What [`DEPTH`] holds where there is no surface.
pub const NO_SURFACE: f32 = f32::MAX;

/// Bytes per sample: verdicts, radiance or picture, depth-stencil (padded), and for blended surfaces all of them once more.
const BYTES_PER_SAMPLE: u64 = 2 * (4 + 8 + 8);
/// Bytes per pixel beside its samples: HDR, LDR, and the attributes' depth, normal, albedo and depth-stencil.
const BYTES_PER_PIXEL: u64 = 8 + 4 + 4 + 4 + 4 + 8;
/// All targets together may take this much.
const MEMORY_LIMIT: u64 = 8 << 30;

/// Textures that pictures are drawn to. Those that not every frame needs are made by the first that does.
#[derive(Debug)]
pub struct Targets {
    pub size: [u32; 2],
    pub samples: u32,
    pub depth_stencil: wgpu::TextureView,
    /// Its depth, for reading; `None` where that is not possible.
    pub depth: Option<wgpu::TextureView>,
    /// The picture, single-sampled.
    pub ldr: wgpu::Texture,
    pub ldr_view: wgpu::TextureView,
    hdr: Option<HdrTargets>,
    verdicts: Option<Verdicts>,
    layer: Option<Layer>,
    further: Option<wgpu::TextureView>,
}

/// What frames with shadows on blended surfaces need.
#[derive(Debug)]
pub struct Layer {
    /// Of the nearest surface, blended ones included.
    pub depth_stencil: wgpu::TextureView,
    /// Its depth, for reading; `None` where that is not possible.
    pub depth: Option<wgpu::TextureView>,
    pub verdicts: Verdicts,
}

/// What frames need that do not write the picture directly.
#[derive(Debug)]
pub struct HdrTargets {
    /// Radiance before exposure.
    pub samples: wgpu::TextureView,
    /// Exposed radiance, single-sampled.
    pub texture: wgpu::Texture,
    pub view: wgpu::TextureView,
}

/// What frames with shadows need.
#[derive(Debug)]
pub struct Verdicts {
    pub view: wgpu::TextureView,
    /// For reading.
    pub bind_group: wgpu::BindGroup,
}

impl Targets {
    /// Creates what every frame needs, after a check of the size.
    pub fn new(gpu: &Gpu, size: [u32; 2], samples: u32) -> Result<Self, RenderError> {
        check_size(size, samples, gpu.device.limits().max_texture_dimension_2d)?;
        let ldr = create(gpu, "picture", LDR, size, 1);
        let depth_stencil = create(gpu, "depth-stencil", gpu.depth_stencil, size, samples);
        Ok(Self {
            size,
            samples,
            depth: depth_view(gpu, &depth_stencil),
            depth_stencil: view(&depth_stencil),
            ldr_view: view(&ldr),
            ldr,
            hdr: None,
            verdicts: None,
            layer: None,
            further: None,
        })
    }

    pub fn hdr(&mut self, gpu: &Gpu) -> &HdrTargets {
        let (size, samples) = (self.size, self.samples);
        self.hdr.get_or_insert_with(|| {
            let texture = create(gpu, "HDR", HDR, size, 1);
            HdrTargets {
                samples: view(&create(gpu, "radiance", RADIANCE, size, samples)),
                view: view(&texture),
                texture,
            }
        })
    }

    pub fn verdicts(&mut self, gpu: &Gpu, layouts: &Layouts) -> &Verdicts {
        let (size, samples) = (self.size, self.samples);
        self.verdicts.get_or_insert_with(|| Verdicts::new(gpu, layouts, size, samples))
    }

    pub fn layer(&mut self, gpu: &Gpu, layouts: &Layouts) -> &Layer {
        let (size, samples) = (self.size, self.samples);
        self.layer.get_or_insert_with(|| {
            let depth_stencil = create(gpu, "nearest layer", gpu.depth_stencil, size, samples);
            Layer {
                depth: depth_view(gpu, &depth_stencil),
                depth_stencil: view(&depth_stencil),
                verdicts: Verdicts::new(gpu, layouts, size, samples),
            }
        })
    }

    /// Radiance that is drawn apart, of lights on blended surfaces whose verdicts did not fit the layer's texel.
    pub fn further(&mut self, gpu: &Gpu) -> &wgpu::TextureView {
        let (size, samples) = (self.size, self.samples);
        self.further.get_or_insert_with(|| view(&create(gpu, "further light", RADIANCE, size, samples)))
    }
}

impl Verdicts {
    fn new(gpu: &Gpu, layouts: &Layouts, size: [u32; 2], samples: u32) -> Self {
        let view = view(&create(gpu, "verdicts", VERDICTS, size, samples));
        let resources = [wgpu::BindingResource::TextureView(&view)];
        Self { bind_group: bind(&gpu.device, "verdicts", layouts.verdicts(samples), &resources), view }
    }
}

/// Textures that the measured outputs are drawn to, single-sampled.
#[derive(Debug)]
pub struct Attributes {
    pub size: [u32; 2],
    pub depth: wgpu::Texture,
    pub normal: wgpu::Texture,
    pub albedo: wgpu::Texture,
    pub depth_stencil: wgpu::TextureView,
    /// Depth as the tile pass reads it; `None` where that is not possible.
    pub stored_depth: Option<wgpu::TextureView>,
    /// The distance for reading.
    pub bind_group: wgpu::BindGroup,
}

impl Attributes {
    /// Creates them, after a check of the size.
    pub fn new(gpu: &Gpu, layouts: &Layouts, size: [u32; 2]) -> Result<Self, RenderError> {
        check_size(size, 1, gpu.device.limits().max_texture_dimension_2d)?;
        let depth = create(gpu, "depth", DEPTH, size, 1);
        let depth_stencil = create(gpu, "depth-stencil", gpu.depth_stencil, size, 1);
        let resources = [wgpu::BindingResource::TextureView(&view(&depth))];
        Ok(Self {
            size,
            bind_group: bind(&gpu.device, "attributes", &layouts.attributes, &resources),
            depth,
            normal: create(gpu, "normal", NORMAL, size, 1),
            albedo: create(gpu, "albedo", ALBEDO, size, 1),
            stored_depth: depth_view(gpu, &depth_stencil),
            depth_stencil: view(&depth_stencil),
        })
    }
}

fn create(gpu: &Gpu, label: &str, format: wgpu::TextureFormat, size: [u32; 2], samples: u32) -> wgpu::Texture {
    let mut usage = wgpu::TextureUsages::RENDER_ATTACHMENT;
    if format != gpu.depth_stencil {
        usage |= wgpu::TextureUsages::TEXTURE_BINDING;
        if samples == 1 {
            usage |= wgpu::TextureUsages::COPY_SRC;
        }
    } else if has_readable_depth(gpu, samples) {
        usage |= wgpu::TextureUsages::TEXTURE_BINDING;
    }
    gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: Some(label),
        size: wgpu::Extent3d { width: size[0], height: size[1], depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: samples,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage,
        view_formats: &[],
    })
}

/// Whether shaders may fetch from the depth buffer: some GL drivers fail there, and samples are not told apart.
fn has_readable_depth(gpu: &Gpu, samples: u32) -> bool {
    samples == 1 && gpu.info.backend != wgpu::Backend::Gl
}

/// The depth aspect of a depth-stencil texture.
fn depth_view(gpu: &Gpu, texture: &wgpu::Texture) -> Option<wgpu::TextureView> {
    has_readable_depth(gpu, texture.sample_count()).then(|| {
        texture.create_view(&wgpu::TextureViewDescriptor {
            aspect: wgpu::TextureAspect::DepthOnly,
            ..wgpu::TextureViewDescriptor::default()
        })
    })
}

/// A view of the whole texture.
pub fn view(texture: &wgpu::Texture) -> wgpu::TextureView {
    texture.create_view(&wgpu::TextureViewDescriptor::default())
}

fn check_size(size: [u32; 2], samples: u32, max_side: u32) -> Result<(), RenderError> {
    if size.contains(&0) {
        return Err(RenderError::EmptySize { size });
    }
    if size.iter().any(|&side| side > max_side) {
        return Err(RenderError::TooLarge { size, limit: format!("this device allows {max_side} pixels a side") });
    }
    let pixels = u64::from(size[0]) * u64::from(size[1]);
    let bytes = pixels * (u64::from(samples) * BYTES_PER_SAMPLE + BYTES_PER_PIXEL);
    if bytes > MEMORY_LIMIT {
        const GIB: f64 = (1_u64 << 30) as f64;
        let (needed, allowed) = (bytes as f64 / GIB, MEMORY_LIMIT as f64 / GIB);
        let limit =
            format!("at {samples} samples per pixel it needs {needed:.1} GiB, and {allowed:.0} GiB are allowed");
        return Err(RenderError::TooLarge { size, limit });
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_have_limits() {
        assert!(check_size([1, 1], 4, 8192).is_ok());
        assert!(check_size([8192, 8192], 1, 8192).is_ok());
        assert!(matches!(check_size([0, 1], 1, 8192), Err(RenderError::EmptySize { .. })));
        let wide = check_size([8193, 1], 1, 8192).unwrap_err().to_string();
        assert!(wide.contains("8193x1") && wide.contains("8192"), "{wide}");
        let heavy = check_size([16384, 16384], 4, 16384).unwrap_err().to_string();
        assert!(heavy.contains("GiB"), "{heavy}");
    }
}
