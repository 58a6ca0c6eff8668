//! Metallic-roughness materials, textures and images as glTF 2.0 defines them.

/// A surface's appearance.
#[derive(Clone, Debug)]
pub struct Material {
    /// Name in the file, or an invented one.
    pub name: String,
    /// Linear RGBA factor.
    pub base_color: [f32; 4],
    /// sRGB-encoded colour, linear alpha.
    pub base_color_texture: Option<TextureRef>,
    /// 0 dielectric, 1 metal.
    pub metallic: f32,
    /// Perceptual roughness, 0 to 1.
    pub roughness: f32,
    /// Roughness in G, metalness in B, linear.
    pub metallic_roughness_texture: Option<TextureRef>,
    /// Tangent-space normals, linear.
    pub normal_texture: Option<TextureRef>,
    /// Multiplies the x and y of the normal texture.
    pub normal_scale: f32,
    /// Occlusion in R, linear; dims ambient light only.
    pub occlusion_texture: Option<TextureRef>,
    /// 0 ignores the occlusion texture, 1 applies it fully.
    pub occlusion_strength: f32,
    /// Linear RGB radiance, emissive strength included.
    pub emissive: [f32; 3],
    /// sRGB-encoded.
    pub emissive_texture: Option<TextureRef>,
    /// How alpha is used.
    pub alpha: AlphaMode,
    /// Whether back faces are visible. It has no influence on casting.
    pub double_sided: bool,
    /// Base colour is shown as it is, without any light.
    pub unlit: bool,
    /// Replaces metalness, roughness and their texture where it is given (KHR_materials_pbrSpecularGlossiness).
    pub specular_glossiness: Option<SpecularGlossiness>,
    /// Mirror reflection of dielectrics.
    pub specular: Specular,
    /// A layer of varnish.
    pub clearcoat: Option<Clearcoat>,
    /// Fibres.
    pub sheen: Option<Sheen>,
    /// Light passes, whatever `alpha` says.
    pub transmission: Option<Transmission>,
}

/// What is reflected and how smoothly, as a colour (KHR_materials_pbrSpecularGlossiness). The base colour is the diffuse one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpecularGlossiness {
    /// Reflectance at normal incidence, linear RGB.
    pub color: [f32; 3],
    /// 1 less the perceptual roughness.
    pub glossiness: f32,
    /// sRGB-encoded colour, glossiness in A.
    pub texture: Option<TextureRef>,
}

/// Mirror reflection of dielectrics (KHR_materials_ior, KHR_materials_specular).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Specular {
    /// Index of refraction, 1 or more; 0 reflects everything.
    pub ior: f32,
    /// Share of the reflection, 0 to 1.
    pub strength: f32,
    /// Linear RGB, of the reflection at normal incidence.
    pub color: [f32; 3],
    /// sRGB-encoded, multiplies the colour.
    pub color_texture: Option<TextureRef>,
}

impl Default for Specular {
    fn default() -> Self {
        Self { ior: 1.5, strength: 1.0, color: [1.0; 3], color_texture: None }
    }
}

impl Specular {
    /// Reflectance at normal incidence, linear RGB, its strength and texture left out.
    #[must_use]
    pub fn normal_reflectance(&self) -> [f32; 3] {
        let f0 = if self.ior == 0.0 { 1.0 } else { ((self.ior - 1.0) / (self.ior + 1.0)).powi(2) };
        self.color.map(|c| (c * f0).min(1.0))
    }
}

/// A smooth, colourless layer over everything (KHR_materials_clearcoat).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Clearcoat {
    /// 0 none, 1 full.
    pub strength: f32,
    /// Strength in R, linear.
    pub texture: Option<TextureRef>,
    /// Perceptual, 0 to 1.
    pub roughness: f32,
}

/// Light scattered by fibres on the surface (KHR_materials_sheen).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sheen {
    /// Linear RGB.
    pub color: [f32; 3],
    /// sRGB-encoded, multiplies the colour.
    pub texture: Option<TextureRef>,
    /// Perceptual, 0 to 1.
    pub roughness: f32,
}

/// Light that passes instead of being scattered (KHR_materials_transmission, KHR_materials_volume).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Transmission {
    /// Share of the light that is not reflected, 0 to 1.
    pub share: f32,
    /// Share in R, linear.
    pub texture: Option<TextureRef>,
    /// What the body behind the surface leaves of the light, linear RGB.
    pub tint: [f32; 3],
}

impl Material {
    /// Whether what is behind it is seen through it: it is drawn in the final pass, and casts no shadow unless
    /// [`crate::Scene::blended_casts`].
    #[must_use]
    pub fn is_blended(&self) -> bool {
        self.alpha == AlphaMode::Blend || self.transmission.is_some()
    }
}

impl Default for Material {
    fn default() -> Self {
        Self {
            name: String::new(),
            base_color: [1.0; 4],
            base_color_texture: None,
            metallic: 1.0,
            roughness: 1.0,
            metallic_roughness_texture: None,
            normal_texture: None,
            normal_scale: 1.0,
            occlusion_texture: None,
            occlusion_strength: 1.0,
            emissive: [0.0; 3],
            emissive_texture: None,
            alpha: AlphaMode::Opaque,
            double_sided: false,
            unlit: false,
            specular_glossiness: None,
            specular: Specular::default(),
            clearcoat: None,
            sheen: None,
            transmission: None,
        }
    }
}

/// How a material's alpha is used.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum AlphaMode {
    /// Alpha is ignored.
    Opaque,
    /// A point is there where alpha is at least the cutoff.
    Mask(f32),
    /// Drawn in the final pass over the opaque image; casts no shadow unless [`crate::Scene::blended_casts`].
    Blend,
}

/// What triangles with a mask ([`AlphaMode::Mask`]) are to light. Volumes know triangles only, not what a texture leaves
/// of them; to cast shadows of the mask's shape, triangles are cut along it beforehand and made opaque.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum MaskCasting {
    /// They block light as a whole.
    #[default]
    Solid,
    /// They let all light through.
    Off,
}

/// A texture as a material uses it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TextureRef {
    /// Index into [`crate::Scene::textures`].
    pub texture: usize,
    /// 0 or 1: [`crate::Mesh::uv0`] or [`crate::Mesh::uv1`].
    pub uv_set: u8,
    /// Rows of the 2x3 matrix that takes a mesh UV to the texture's UV (KHR_texture_transform).
    pub uv_from_mesh: [[f32; 3]; 2],
}

impl TextureRef {
    /// `texture` with the first UV set, untransformed.
    #[must_use]
    pub const fn new(texture: usize) -> Self {
        Self { texture, uv_set: 0, uv_from_mesh: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]] }
    }
}

/// An image and how it is sampled.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Texture {
    /// Index into [`crate::Scene::images`].
    pub image: usize,
    /// Horizontal wrapping.
    pub wrap_u: Wrap,
    /// Vertical wrapping.
    pub wrap_v: Wrap,
    /// Magnification.
    pub mag: Filter,
    /// Minification within a level; levels are always blended when mip maps are on.
    pub min: Filter,
    /// Whether mip maps are used.
    pub mipmaps: bool,
}

/// What happens outside the unit square.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Wrap {
    /// Tiles.
    Repeat,
    /// Tiles, every second one mirrored.
    Mirror,
    /// The border texel goes on.
    Clamp,
}

/// Texel interpolation.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Filter {
    /// None.
    Nearest,
    /// Bilinear.
    Linear,
}

/// A decoded image: 8 bits per channel, RGBA, rows from top to bottom. Colour space is the material slot's.
#[derive(Clone, Debug)]
pub struct Image {
    /// Name or path, for reports.
    pub name: String,
    /// Pixels, at least 1.
    pub width: u32,
    /// Pixels, at least 1.
    pub height: u32,
    /// `width * height * 4` bytes.
    pub rgba: Vec<u8>,
}
