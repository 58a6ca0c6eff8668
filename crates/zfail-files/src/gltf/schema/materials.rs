//! Materials, and the textures, samplers and images that they refer to.

use super::one;
use serde::Deserialize;
use serde::de::IgnoredAny;

#[derive(Debug, Default, Deserialize)]
#[serde(default, rename_all = "camelCase")]
pub(crate) struct Material {
    pub name: Option<String>,
    pub pbr_metallic_roughness: MetallicRoughness,
    pub normal_texture: Option<TextureInfo>,
    pub occlusion_texture: Option<TextureInfo>,
    pub emissive_texture: Option<TextureInfo>,
    pub emissive_factor: [f64; 3],
    pub alpha_mode: AlphaMode,
    pub alpha_cutoff: Option<f64>,
    pub double_sided: bool,
    pub extensions: MaterialExtensions,
}

#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "UPPERCASE")]
pub(crate) enum AlphaMode {
    #[default]
    Opaque,
    Mask,
    Blend,
}

#[derive(Debug, Deserialize)]
#[serde(default, rename_all = "camelCase")]
pub(crate) struct MetallicRoughness {
    pub base_color_factor: [f64; 4],
    pub base_color_texture: Option<TextureInfo>,
    pub metallic_factor: f64,
    pub roughness_factor: f64,
    pub metallic_roughness_texture: Option<TextureInfo>,
}

impl Default for MetallicRoughness {
    fn default() -> Self {
        Self {
            base_color_factor: [1.0; 4],
            base_color_texture: None,
            metallic_factor: 1.0,
            roughness_factor: 1.0,
            metallic_roughness_texture: None,
        }
    }
}

#[derive(Debug, Default, Deserialize)]
#[serde(default)]
pub(crate) struct MaterialExtensions {
    #[serde(rename = "KHR_materials_unlit")]
    pub unlit: Option<IgnoredAny>,
    #[serde(rename = "KHR_materials_emissive_strength")]
    pub emissive_strength: EmissiveStrength,
    #[serde(rename = "KHR_materials_pbrSpecularGlossiness")]
    pub specular_glossiness: Option<Box<SpecularGlossiness>>,
    #[serde(rename = "KHR_materials_transmission")]
    pub transmission: Option<Box<Transmission>>,
    #[serde(rename = "KHR_materials_volume")]
    pub volume: Volume,
    #[serde(rename = "KHR_materials_ior")]
    pub ior: Ior,
    #[serde(rename = "KHR_materials_specular")]
    pub specular: Option<Box<Specular>>,
    #[serde(rename = "KHR_materials_clearcoat")]
    pub clearcoat: Option<Box<Clearcoat>>,
    #[serde(rename = "KHR_materials_sheen")]
    pub sheen: Option<Box<Sheen>>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(default, rename_all = "camelCase")]
pub(crate) struct Volume {
    pub thickness_factor: f64,
    /// Infinite where absent.
    pub attenuation_distance: Option<f64>,
    pub attenuation_color: Option<[f64; 3]>,
}

#[derive(Debug, Deserialize)]
#[serde(default)]
pub(crate) struct Ior {
    pub ior: f64,
}

impl Default for Ior {
    fn default() -> Self {
        Self { ior: 1.5 }
    }
}

#[derive(Debug, Deserialize)]
#[serde(default, rename_all = "camelCase")]
pub(crate) struct Specular {
    pub specular_factor: f64,
    pub specular_texture: Option<TextureInfo>,
    pub specular_color_factor: [f64; 3],
    pub specular_color_texture: Option<TextureInfo>,
}

impl Default for Specular {
    fn default() -> Self {
        Self {
            specular_factor: 1.0,
            specular_texture: None,
            specular_color_factor: [1.0; 3],
            specular_color_texture: None,
        }
    }
}

#[derive(Debug, Default, Deserialize)]
#[serde(default, rename_all = "camelCase")]
pub(crate) struct Clearcoat {
    pub clearcoat_factor: f64,
    pub clearcoat_texture: Option<TextureInfo>,
    pub clearcoat_roughness_factor: f64,
    pub clearcoat_roughness_texture: Option<TextureInfo>,
    pub clearcoat_normal_texture: Option<TextureInfo>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(default, rename_all = "camelCase")]
pub(crate) struct Sheen {
    pub sheen_color_factor: [f64; 3],
    pub sheen_color_texture: Option<TextureInfo>,
    pub sheen_roughness_factor: f64,
    pub sheen_roughness_texture: Option<TextureInfo>,
}

#[derive(Debug, Deserialize)]
#[serde(default, rename_all = "camelCase")]
pub(crate) struct EmissiveStrength {
    pub emissive_strength: f64,
}

impl Default for EmissiveStrength {
    fn default() -> Self {
        Self { emissive_strength: 1.0 }
    }
}

#[derive(Debug, Deserialize)]
#[serde(default, rename_all = "camelCase")]
pub(crate) struct SpecularGlossiness {
    pub diffuse_factor: [f64; 4],
    pub diffuse_texture: Option<TextureInfo>,
    pub specular_factor: [f64; 3],
    pub glossiness_factor: f64,
    pub specular_glossiness_texture: Option<TextureInfo>,
}

impl Default for SpecularGlossiness {
    fn default() -> Self {
        Self {
            diffuse_factor: [1.0; 4],
            diffuse_texture: None,
            specular_factor: [1.0; 3],
            glossiness_factor: 1.0,
            specular_glossiness_texture: None,
        }
    }
}

#[derive(Debug, Default, Deserialize)]
#[serde(default, rename_all = "camelCase")]
pub(crate) struct Transmission {
    pub transmission_factor: f64,
    pub transmission_texture: Option<TextureInfo>,
}

/// Any of the texture slots; `scale` belongs to normal, `strength` to occlusion textures.
#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct TextureInfo {
    pub index: usize,
    #[serde(default)]
    pub tex_coord: u32,
    #[serde(default = "one")]
    pub scale: f64,
    #[serde(default = "one")]
    pub strength: f64,
    #[serde(default)]
    pub extensions: TextureInfoExtensions,
}

#[derive(Debug, Default, Deserialize)]
#[serde(default)]
pub(crate) struct TextureInfoExtensions {
    #[serde(rename = "KHR_texture_transform")]
    pub transform: Option<TextureTransform>,
}

#[derive(Debug, Deserialize)]
#[serde(default, rename_all = "camelCase")]
pub(crate) struct TextureTransform {
    pub offset: [f64; 2],
    pub rotation: f64,
    pub scale: [f64; 2],
    pub tex_coord: Option<u32>,
}

impl Default for TextureTransform {
    fn default() -> Self {
        Self { offset: [0.0; 2], rotation: 0.0, scale: [1.0; 2], tex_coord: None }
    }
}

#[derive(Debug, Default, Deserialize)]
#[serde(default)]
pub(crate) struct Texture {
    pub sampler: Option<usize>,
    pub source: Option<usize>,
    pub extensions: TextureExtensions,
}

#[derive(Debug, Default, Deserialize)]
#[serde(default)]
pub(crate) struct TextureExtensions {
    #[serde(rename = "KHR_texture_basisu")]
    pub basisu: TextureSource,
    #[serde(rename = "EXT_texture_webp")]
    pub webp: TextureSource,
}

#[derive(Debug, Default, Deserialize)]
#[serde(default)]
pub(crate) struct TextureSource {
    pub source: Option<usize>,
}

impl Texture {
    /// The images that may be shown, best first: an extension's before the one for readers that do not know it.
    pub fn images(&self) -> impl Iterator<Item = usize> {
        [self.extensions.basisu.source, self.extensions.webp.source, self.source].into_iter().flatten()
    }
}

#[derive(Debug, Default, Deserialize)]
#[serde(default, rename_all = "camelCase")]
pub(crate) struct Sampler {
    pub mag_filter: Option<u32>,
    pub min_filter: Option<u32>,
    pub wrap_s: Option<u32>,
    pub wrap_t: Option<u32>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(default, rename_all = "camelCase")]
pub(crate) struct Image {
    pub name: Option<String>,
    pub uri: Option<String>,
    pub buffer_view: Option<usize>,
}
