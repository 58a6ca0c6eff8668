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
    /// Drawn in the final pass over the opaque image; casts no shadow.
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
    /// Index into [`super::Scene::textures`].
    pub texture: usize,
    /// 0 or 1: [`super::Mesh::uv0`] or [`super::Mesh::uv1`].
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
    /// Index into [`super::Scene::images`].
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
