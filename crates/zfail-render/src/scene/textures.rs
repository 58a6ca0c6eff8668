//! Images and samplers on the device. An image is uploaded once per colour space in which materials use it.

use crate::Gpu;
use crate::scene::mip_maps::Level;
use std::collections::HashMap;
use zfail_scene::{Filter, Scene, TextureRef, Wrap};

/// How many texels a sample may spread over on a surface seen at a grazing angle, where there is hardware for it.
const ANISOTROPY: u16 = 8;

/// What a material slot binds.
pub type Binding = (wgpu::TextureView, wgpu::Sampler);

/// Uploads what materials ask for.
pub struct Textures<'a> {
    gpu: &'a Gpu,
    scene: &'a Scene,
    images: HashMap<(usize, bool), wgpu::TextureView>,
    samplers: HashMap<SamplerKey, wgpu::Sampler>,
    neutral: Binding,
}

/// The part of a texture that a sampler depends on.
type SamplerKey = (Wrap, Wrap, Filter, Filter, bool);

impl<'a> Textures<'a> {
    pub fn new(gpu: &'a Gpu, scene: &'a Scene) -> Self {
        let white = Level { width: 1, height: 1, rgba: vec![255; 4] };
        let neutral =
            (upload(gpu, "white", white, false), gpu.device.create_sampler(&wgpu::SamplerDescriptor::default()));
        Self { gpu, scene, images: HashMap::new(), samplers: HashMap::new(), neutral }
    }

    /// The texture that `slot` refers to, its colours decoded from sRGB if `srgb`; white where there is none.
    pub fn get(&mut self, slot: Option<TextureRef>, srgb: bool) -> Binding {
        let Some(texture) = slot.and_then(|slot| self.scene.textures.get(slot.texture)) else {
            return self.neutral.clone();
        };
        let Some(image) = self.scene.images.get(texture.image) else {
            return self.neutral.clone();
        };
        let gpu = self.gpu;
        let view = self.images.entry((texture.image, srgb)).or_insert_with(|| {
            let level = Level { width: image.width, height: image.height, rgba: image.rgba.clone() };
            upload(gpu, &image.name, level, srgb)
        });
        let key = (texture.wrap_u, texture.wrap_v, texture.mag, texture.min, texture.mipmaps);
        let sampler = self.samplers.entry(key).or_insert_with(|| sampler(gpu, key));
        (view.clone(), sampler.clone())
    }
}

/// Uploads an image with all its mip maps; one that is too large for the device starts at a smaller level.
fn upload(gpu: &Gpu, name: &str, mut level: Level, srgb: bool) -> wgpu::TextureView {
    let limit = gpu.device.limits().max_texture_dimension_2d;
    while level.width.max(level.height) > limit {
        level = level.half(srgb);
    }
    let texture = gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: Some(name),
        size: wgpu::Extent3d { width: level.width, height: level.height, depth_or_array_layers: 1 },
        mip_level_count: level.width.max(level.height).ilog2() + 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: if srgb { wgpu::TextureFormat::Rgba8UnormSrgb } else { wgpu::TextureFormat::Rgba8Unorm },
        usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
        view_formats: &[],
    });
    for mip_level in 0.. {
        gpu.queue.write_texture(
            wgpu::TexelCopyTextureInfo { mip_level, ..texture.as_image_copy() },
            &level.rgba,
            wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(level.width * 4), rows_per_image: None },
            wgpu::Extent3d { width: level.width, height: level.height, depth_or_array_layers: 1 },
        );
        if level.is_last() {
            break;
        }
        level = level.half(srgb);
    }
    texture.create_view(&wgpu::TextureViewDescriptor::default())
}

fn sampler(gpu: &Gpu, (u, v, mag, min, mipmaps): SamplerKey) -> wgpu::Sampler {
    let wrap = |wrap| match wrap {
        Wrap::Repeat => wgpu::AddressMode::Repeat,
        Wrap::Mirror => wgpu::AddressMode::MirrorRepeat,
        Wrap::Clamp => wgpu::AddressMode::ClampToEdge,
    };
    let filter = |filter| match filter {
        Filter::Nearest => wgpu::FilterMode::Nearest,
        Filter::Linear => wgpu::FilterMode::Linear,
    };
    let smooth = mipmaps && mag == Filter::Linear && min == Filter::Linear;
    let anisotropic = smooth && gpu.info.device_type != wgpu::DeviceType::Cpu;
    gpu.device.create_sampler(&wgpu::SamplerDescriptor {
        label: None,
        address_mode_u: wrap(u),
        address_mode_v: wrap(v),
        mag_filter: filter(mag),
        min_filter: filter(min),
        mipmap_filter: if mipmaps { wgpu::MipmapFilterMode::Linear } else { wgpu::MipmapFilterMode::Nearest },
        lod_max_clamp: if mipmaps { 32.0 } else { 0.0 },
        anisotropy_clamp: if anisotropic { ANISOTROPY } else { 1 },
        ..Default::default()
    })
}
