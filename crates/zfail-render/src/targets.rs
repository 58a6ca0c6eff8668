//! The render targets of one image size and sample count.

use crate::layouts::{Layouts, bind};
use crate::{Gpu, RenderError};

/// Base colour; alpha marks unlit surfaces.
pub const ALBEDO: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8UnormSrgb;
/// Shading normal, roughness, metalness.
pub const SURFACE: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;
/// Geometric normal.
pub const GEOMETRIC_NORMAL: wgpu::TextureFormat = wgpu::TextureFormat::Rg16Float;
/// Distance along the view axis, an `f32` as four bytes, least significant first. A colour target, since sampled depth
/// textures fail on some GL drivers, and of bytes, since these have no multisampled `R32Float`.
pub const DEPTH: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Uint;
/// Sum of what the lights send to the eye.
pub const RADIANCE: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;
/// Exposed radiance.
pub const HDR: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;
/// Display-encoded picture.
pub const LDR: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;

/// What [`DEPTH`] holds where there is no surface.
pub const NO_SURFACE: f32 = f32::MAX;

/// Bytes per sample: albedo, surface, geometric normal, depth, radiance, depth-stencil (padded).
const BYTES_PER_SAMPLE: u64 = 4 + 8 + 4 + 4 + 8 + 8;
/// Bytes per pixel beside its samples: HDR, LDR.
const BYTES_PER_PIXEL: u64 = 8 + 4;
/// All targets together may take this much.
const MEMORY_LIMIT: u64 = 8 << 30;

/// Textures that passes draw to.
#[derive(Debug)]
pub struct Targets {
    pub size: [u32; 2],
    pub samples: u32,
    pub albedo: wgpu::Texture,
    pub surface: wgpu::Texture,
    pub geometric_normal: wgpu::Texture,
    pub depth: wgpu::Texture,
    pub radiance: wgpu::Texture,
    pub depth_stencil: wgpu::TextureView,
    /// Single-sampled.
    pub hdr: wgpu::Texture,
    /// Single-sampled.
    pub ldr: wgpu::Texture,
    /// Albedo, surface, geometric normal and depth for reading.
    pub gbuffer: wgpu::BindGroup,
}

impl Targets {
    /// Creates the targets, after the checks of [`check_size`].
    pub fn new(gpu: &Gpu, layouts: &Layouts, size: [u32; 2], samples: u32) -> Result<Self, RenderError> {
        check_size(size, samples, gpu.device.limits().max_texture_dimension_2d)?;
        let create = |label, format, samples| {
            let mut usage = wgpu::TextureUsages::RENDER_ATTACHMENT;
            if format != gpu.depth_stencil {
                usage |= wgpu::TextureUsages::TEXTURE_BINDING;
                if samples == 1 {
                    usage |= wgpu::TextureUsages::COPY_SRC;
                }
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
        };
        let albedo = create("albedo", ALBEDO, samples);
        let surface = create("surface", SURFACE, samples);
        let geometric_normal = create("geometric normal", GEOMETRIC_NORMAL, samples);
        let depth = create("depth", DEPTH, samples);
        let views = [&albedo, &surface, &geometric_normal, &depth].map(view);
        let resources = views.each_ref().map(wgpu::BindingResource::TextureView);
        let gbuffer = bind(&gpu.device, "G-buffer", layouts.gbuffer(samples), &resources);
        Ok(Self {
            size,
            samples,
            albedo,
            surface,
            geometric_normal,
            depth,
            radiance: create("radiance", RADIANCE, samples),
            depth_stencil: view(&create("depth-stencil", gpu.depth_stencil, samples)),
            hdr: create("HDR", HDR, 1),
            ldr: create("LDR", LDR, 1),
            gbuffer,
        })
    }
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
