//! The part of the glTF 2.0 schema that a scene is made from, as plain types.
//!
//! In: JSON. Out: values of the right type, nothing more: indices are unchecked until `validate` has run.
//!
//! The `gltf` crate's own types are not used here because they hold node transforms in single precision, which is
//! 6 cm at 10^6 m, and because their accessors panic on invalid indices.

use crate::animate::Interpolation;
use serde::Deserialize;
use serde::de::IgnoredAny;
use serde_json::Value;
use std::collections::BTreeMap;

#[derive(Debug, Default, Deserialize)]
#[serde(default, rename_all = "camelCase")]
pub(super) struct Root {
    pub asset: Asset,
    pub extensions_used: Vec<String>,
    pub extensions_required: Vec<String>,
    pub scene: Option<usize>,
    pub scenes: Vec<SceneRoots>,
    pub nodes: Vec<Node>,
    pub meshes: Vec<Mesh>,
    pub skins: Vec<Skin>,
    pub cameras: Vec<Camera>,
    pub materials: Vec<Material>,
    pub textures: Vec<Texture>,
    pub samplers: Vec<Sampler>,
    pub images: Vec<Image>,
    pub accessors: Vec<Accessor>,
    pub buffer_views: Vec<BufferView>,
    pub buffers: Vec<Buffer>,
    pub animations: Vec<Animation>,
    pub extensions: RootExtensions,
}

#[derive(Debug, Default, Deserialize)]
#[serde(default, rename_all = "camelCase")]
pub(super) struct Asset {
    pub version: String,
    pub min_version: Option<String>,
    pub generator: Option<String>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(default)]
pub(super) struct RootExtensions {
    #[serde(rename = "KHR_lights_punctual")]
    pub lights: Option<Lights>,
    #[serde(rename = "KHR_materials_variants")]
    pub variants: Variants,
}

#[derive(Debug, Default, Deserialize)]
#[serde(default)]
pub(super) struct Variants {
    pub variants: Vec<Variant>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(default)]
pub(super) struct Variant {
    pub name: String,
}

#[derive(Debug, Deserialize)]
pub(super) struct Lights {
    pub lights: Vec<Light>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(default)]
pub(super) struct SceneRoots {
    pub nodes: Vec<usize>,
    pub extras: Value,
}

#[derive(Debug, Default, Deserialize)]
#[serde(default)]
pub(super) struct Node {
    pub name: Option<String>,
    pub children: Vec<usize>,
    pub matrix: Option<[f64; 16]>,
    pub translation: Option<[f64; 3]>,
    pub rotation: Option<[f64; 4]>,
    pub scale: Option<[f64; 3]>,
    pub mesh: Option<usize>,
    pub skin: Option<usize>,
    pub camera: Option<usize>,
    pub weights: Option<Vec<f64>>,
    pub extensions: NodeExtensions,
    pub extras: Value,
}

#[derive(Debug, Default, Deserialize)]
#[serde(default)]
pub(super) struct NodeExtensions {
    #[serde(rename = "KHR_lights_punctual")]
    pub light: Option<NodeLight>,
    #[serde(rename = "EXT_mesh_gpu_instancing")]
    pub instancing: Option<Instancing>,
}

#[derive(Debug, Deserialize)]
pub(super) struct NodeLight {
    pub light: usize,
}

#[derive(Debug, Deserialize)]
pub(super) struct Instancing {
    pub attributes: BTreeMap<String, usize>,
}

#[derive(Debug, Deserialize)]
pub(super) struct Mesh {
    pub name: Option<String>,
    pub primitives: Vec<Primitive>,
    #[serde(default)]
    pub weights: Vec<f64>,
}

#[derive(Debug, Deserialize)]
pub(super) struct Primitive {
    pub attributes: BTreeMap<String, usize>,
    pub indices: Option<usize>,
    pub material: Option<usize>,
    #[serde(default)]
    pub mode: Mode,
    #[serde(default)]
    pub targets: Vec<BTreeMap<String, usize>>,
    #[serde(default)]
    pub extensions: PrimitiveExtensions,
}

#[derive(Debug, Default, Deserialize)]
#[serde(default)]
pub(super) struct PrimitiveExtensions {
    #[serde(rename = "KHR_materials_variants")]
    pub variants: VariantMappings,
    #[serde(rename = "KHR_draco_mesh_compression")]
    pub draco: Option<Draco>,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Draco {
    pub buffer_view: usize,
    /// Unique ids of the stream's attributes.
    pub attributes: BTreeMap<String, u32>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(default)]
pub(super) struct VariantMappings {
    pub mappings: Vec<VariantMapping>,
}

#[derive(Debug, Deserialize)]
pub(super) struct VariantMapping {
    pub material: usize,
    /// Indices of the document's variants.
    pub variants: Vec<usize>,
}

#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq, Eq)]
#[serde(try_from = "u32")]
pub(super) enum Mode {
    Points,
    Lines,
    LineLoop,
    LineStrip,
    #[default]
    Triangles,
    TriangleStrip,
    TriangleFan,
}

impl TryFrom<u32> for Mode {
    type Error = String;
    fn try_from(mode: u32) -> Result<Self, String> {
        Ok(match mode {
            0 => Self::Points,
            1 => Self::Lines,
            2 => Self::LineLoop,
            3 => Self::LineStrip,
            4 => Self::Triangles,
            5 => Self::TriangleStrip,
            6 => Self::TriangleFan,
            _ => return Err(format!("{mode} is not a primitive mode (0 to 6)")),
        })
    }
}

#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Skin {
    pub joints: Vec<usize>,
    pub inverse_bind_matrices: Option<usize>,
}

#[derive(Debug, Deserialize)]
pub(super) struct Camera {
    pub name: Option<String>,
    pub perspective: Option<Perspective>,
    pub orthographic: Option<Orthographic>,
}

#[derive(Debug, Deserialize)]
pub(super) struct Perspective {
    pub yfov: f64,
    pub znear: f64,
    pub zfar: Option<f64>,
}

#[derive(Debug, Deserialize)]
pub(super) struct Orthographic {
    pub ymag: f64,
    pub znear: f64,
    pub zfar: f64,
}

#[derive(Debug, Deserialize)]
pub(super) struct Light {
    pub name: Option<String>,
    #[serde(rename = "type")]
    pub kind: LightType,
    #[serde(default = "white")]
    pub color: [f64; 3],
    #[serde(default = "one")]
    pub intensity: f64,
    pub range: Option<f64>,
    #[serde(default)]
    pub spot: Spot,
}

#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(super) enum LightType {
    Point,
    Spot,
    Directional,
}

#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(default, rename_all = "camelCase")]
pub(super) struct Spot {
    pub inner_cone_angle: f64,
    pub outer_cone_angle: f64,
}

impl Default for Spot {
    fn default() -> Self {
        Self { inner_cone_angle: 0.0, outer_cone_angle: std::f64::consts::FRAC_PI_4 }
    }
}

#[derive(Debug, Default, Deserialize)]
#[serde(default, rename_all = "camelCase")]
pub(super) struct Material {
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
pub(super) enum AlphaMode {
    #[default]
    Opaque,
    Mask,
    Blend,
}

#[derive(Debug, Deserialize)]
#[serde(default, rename_all = "camelCase")]
pub(super) struct MetallicRoughness {
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
pub(super) struct MaterialExtensions {
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
pub(super) struct Volume {
    pub thickness_factor: f64,
    /// Infinite where absent.
    pub attenuation_distance: Option<f64>,
    pub attenuation_color: Option<[f64; 3]>,
}

#[derive(Debug, Deserialize)]
#[serde(default)]
pub(super) struct Ior {
    pub ior: f64,
}

impl Default for Ior {
    fn default() -> Self {
        Self { ior: 1.5 }
    }
}

#[derive(Debug, Deserialize)]
#[serde(default, rename_all = "camelCase")]
pub(super) struct Specular {
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
pub(super) struct Clearcoat {
    pub clearcoat_factor: f64,
    pub clearcoat_texture: Option<TextureInfo>,
    pub clearcoat_roughness_factor: f64,
    pub clearcoat_roughness_texture: Option<TextureInfo>,
    pub clearcoat_normal_texture: Option<TextureInfo>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(default, rename_all = "camelCase")]
pub(super) struct Sheen {
    pub sheen_color_factor: [f64; 3],
    pub sheen_color_texture: Option<TextureInfo>,
    pub sheen_roughness_factor: f64,
    pub sheen_roughness_texture: Option<TextureInfo>,
}

#[derive(Debug, Deserialize)]
#[serde(default, rename_all = "camelCase")]
pub(super) struct EmissiveStrength {
    pub emissive_strength: f64,
}

impl Default for EmissiveStrength {
    fn default() -> Self {
        Self { emissive_strength: 1.0 }
    }
}

#[derive(Debug, Deserialize)]
#[serde(default, rename_all = "camelCase")]
pub(super) struct SpecularGlossiness {
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
pub(super) struct Transmission {
    pub transmission_factor: f64,
    pub transmission_texture: Option<TextureInfo>,
}

/// Any of the texture slots; `scale` belongs to normal, `strength` to occlusion textures.
#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct TextureInfo {
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
pub(super) struct TextureInfoExtensions {
    #[serde(rename = "KHR_texture_transform")]
    pub transform: Option<TextureTransform>,
}

#[derive(Debug, Deserialize)]
#[serde(default, rename_all = "camelCase")]
pub(super) struct TextureTransform {
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
pub(super) struct Texture {
    pub sampler: Option<usize>,
    pub source: Option<usize>,
    pub extensions: TextureExtensions,
}

#[derive(Debug, Default, Deserialize)]
#[serde(default)]
pub(super) struct TextureExtensions {
    #[serde(rename = "KHR_texture_basisu")]
    pub basisu: TextureSource,
    #[serde(rename = "EXT_texture_webp")]
    pub webp: TextureSource,
}

#[derive(Debug, Default, Deserialize)]
#[serde(default)]
pub(super) struct TextureSource {
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
pub(super) struct Sampler {
    pub mag_filter: Option<u32>,
    pub min_filter: Option<u32>,
    pub wrap_s: Option<u32>,
    pub wrap_t: Option<u32>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(default, rename_all = "camelCase")]
pub(super) struct Image {
    pub name: Option<String>,
    pub uri: Option<String>,
    pub buffer_view: Option<usize>,
}

#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Accessor {
    pub buffer_view: Option<usize>,
    #[serde(default)]
    pub byte_offset: u64,
    pub component_type: Component,
    #[serde(default)]
    pub normalized: bool,
    pub count: u64,
    #[serde(rename = "type")]
    pub shape: Shape,
    pub sparse: Option<Sparse>,
}

#[derive(Debug, Deserialize)]
pub(super) struct Sparse {
    pub count: u64,
    pub indices: SparseIndices,
    pub values: SparseValues,
}

#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct SparseIndices {
    pub buffer_view: usize,
    #[serde(default)]
    pub byte_offset: u64,
    pub component_type: Component,
}

#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct SparseValues {
    pub buffer_view: usize,
    #[serde(default)]
    pub byte_offset: u64,
}

#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
#[serde(try_from = "u32")]
pub(super) enum Component {
    I8,
    U8,
    I16,
    U16,
    U32,
    F32,
}

impl TryFrom<u32> for Component {
    type Error = String;
    fn try_from(code: u32) -> Result<Self, String> {
        Ok(match code {
            5120 => Self::I8,
            5121 => Self::U8,
            5122 => Self::I16,
            5123 => Self::U16,
            5125 => Self::U32,
            5126 => Self::F32,
            _ => return Err(format!("{code} is not a component type (5120 to 5123, 5125, 5126)")),
        })
    }
}

impl Component {
    /// Bytes.
    pub fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::U32 | Self::F32 => 4,
        }
    }
}

#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "UPPERCASE")]
pub(super) enum Shape {
    Scalar,
    Vec2,
    Vec3,
    Vec4,
    Mat2,
    Mat3,
    Mat4,
}

impl Shape {
    /// Number of components.
    pub fn components(self) -> usize {
        match self {
            Self::Scalar => 1,
            Self::Vec2 => 2,
            Self::Vec3 => 3,
            Self::Vec4 | Self::Mat2 => 4,
            Self::Mat3 => 9,
            Self::Mat4 => 16,
        }
    }

    /// Bytes of one element; the columns of small-component matrices are padded to four bytes.
    pub fn element_size(self, component: Component) -> usize {
        let column = |rows: usize| (rows * component.size()).next_multiple_of(4);
        match self {
            Self::Mat2 => 2 * column(2),
            Self::Mat3 => 3 * column(3),
            _ => self.components() * component.size(),
        }
    }
}

#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct BufferView {
    pub buffer: usize,
    #[serde(default)]
    pub byte_offset: u64,
    pub byte_length: u64,
    pub byte_stride: Option<u64>,
    #[serde(default)]
    pub extensions: BufferViewExtensions,
}

#[derive(Debug, Default, Deserialize)]
#[serde(default)]
pub(super) struct BufferViewExtensions {
    #[serde(rename = "EXT_meshopt_compression")]
    ext: Option<Meshopt>,
    #[serde(rename = "KHR_meshopt_compression")]
    khr: Option<Meshopt>,
}

impl BufferViewExtensions {
    /// The compressed form of the view with the name of the extension that says so.
    pub fn meshopt(&self) -> Option<(&'static str, &Meshopt)> {
        let khr = self.khr.as_ref().map(|m| ("KHR_meshopt_compression", m));
        khr.or(self.ext.as_ref().map(|m| ("EXT_meshopt_compression", m)))
    }
}

#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Meshopt {
    pub buffer: usize,
    #[serde(default)]
    pub byte_offset: u64,
    pub byte_length: u64,
    pub byte_stride: u64,
    pub count: u64,
    pub mode: MeshoptMode,
    #[serde(default)]
    pub filter: MeshoptFilter,
}

#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "UPPERCASE")]
pub(super) enum MeshoptMode {
    Attributes,
    Triangles,
    Indices,
}

#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "UPPERCASE")]
pub(super) enum MeshoptFilter {
    #[default]
    None,
    Octahedral,
    Quaternion,
    Exponential,
    /// KHR_meshopt_compression only.
    Color,
}

#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Buffer {
    pub uri: Option<String>,
    pub byte_length: u64,
    #[serde(default)]
    pub extensions: BufferExtensions,
}

#[derive(Debug, Default, Deserialize)]
#[serde(default)]
pub(super) struct BufferExtensions {
    #[serde(rename = "EXT_meshopt_compression")]
    ext: Fallback,
    #[serde(rename = "KHR_meshopt_compression")]
    khr: Fallback,
}

#[derive(Debug, Default, Deserialize)]
#[serde(default)]
struct Fallback {
    fallback: bool,
}

impl Buffer {
    /// Whether the buffer serves only readers without meshopt; it may then have no bytes at all.
    pub fn is_fallback(&self) -> bool {
        self.extensions.ext.fallback || self.extensions.khr.fallback
    }
}

#[derive(Debug, Default, Deserialize)]
#[serde(default)]
pub(super) struct Animation {
    pub name: Option<String>,
    pub channels: Vec<Channel>,
    pub samplers: Vec<AnimationSampler>,
}

#[derive(Debug, Deserialize)]
pub(super) struct Channel {
    pub sampler: usize,
    pub target: ChannelTarget,
}

#[derive(Debug, Deserialize)]
pub(super) struct ChannelTarget {
    /// Absent where an extension says what is moved.
    pub node: Option<usize>,
    pub path: String,
}

#[derive(Debug, Deserialize)]
pub(super) struct AnimationSampler {
    pub input: usize,
    pub output: usize,
    #[serde(default)]
    pub interpolation: Interpolation,
}

fn one() -> f64 {
    1.0
}

fn white() -> [f64; 3] {
    [1.0; 3]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What the reader charges for each object in the JSON covers the types that it becomes.
    #[test]
    fn no_object_is_larger_than_its_charge() {
        let sizes = [
            size_of::<Node>(),
            size_of::<Material>(),
            size_of::<Accessor>(),
            size_of::<Primitive>(),
            size_of::<BufferView>(),
        ];
        assert!(sizes.iter().all(|&size| size <= 1024), "{sizes:?}");
    }
}
