//! A document for a file of a format that has none: .obj, .stl and .ply hold triangles and little else.
//!
//! In: runs of triangles with their materials. Out: a glTF document and its binary chunk, so that whatever the reader
//! promises of glTF files (invariants, limits, repairs and notices) holds of these too.

use super::error::{Fault, Result, malformed};
use super::limits::Budget;
use super::schema::{
    Accessor, Asset, Buffer, BufferExtensions, BufferView, BufferViewExtensions, Component, Image, Material, Mesh,
    MetallicRoughness, Mode, Node, Primitive, Root, SceneRoots, Shape, Texture, TextureExtensions, TextureInfo,
    TextureInfoExtensions,
};
use std::collections::BTreeMap;

/// Triangles of one material. Attributes have the length of `positions`, or are absent.
#[derive(Default)]
pub(super) struct Part {
    pub positions: Vec<[f32; 3]>,
    pub normals: Option<Vec<[f32; 3]>>,
    /// As in glTF: v grows downwards.
    pub uv: Option<Vec<[f32; 2]>>,
    /// Linear RGBA.
    pub colors: Option<Vec<[f32; 4]>>,
    pub triangles: Vec<[u32; 3]>,
    /// Index into [`Plain::materials`].
    pub material: usize,
}

/// What such a file holds, checked: positions are finite and every index is in range.
pub(super) struct Plain {
    /// Name of the format, for reports.
    pub format: &'static str,
    pub parts: Vec<Part>,
    pub materials: Vec<Material>,
    /// Files of the textures that the materials refer to, as URIs.
    pub images: Vec<String>,
    /// World from file, column by column.
    pub world_from_file: [f64; 16],
    pub notices: Vec<String>,
}

/// World from file where the file's y points up.
pub(super) const Y_UP: [f64; 16] = [1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0];
/// World from file where the file's z points up: x stays, z becomes y, y becomes -z.
pub(super) const Z_UP: [f64; 16] = [1.0, 0.0, 0.0, 0.0, 0.0, 0.0, -1.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0];

/// The material of surfaces without one: a grey that shows shading, from both sides, since these formats know no
/// one-sided surfaces.
pub(super) fn grey(name: String) -> Material {
    let pbr_metallic_roughness = MetallicRoughness {
        base_color_factor: [0.8, 0.8, 0.8, 1.0],
        metallic_factor: 0.0,
        roughness_factor: 0.8,
        ..MetallicRoughness::default()
    };
    Material { name: Some(name), pbr_metallic_roughness, double_sided: true, ..Material::default() }
}

/// A material's reference to texture `index`.
pub(super) fn texture(index: usize) -> TextureInfo {
    let extensions = TextureInfoExtensions::default();
    TextureInfo { index, tex_coord: 0, scale: 1.0, strength: 1.0, extensions }
}

/// The linear value of an sRGB-encoded one; vertex colours are stored as they were painted.
pub(super) fn linear(encoded: f32) -> f32 {
    if encoded <= 0.04045 { encoded / 12.92 } else { ((encoded + 0.055) / 1.055).powf(2.4) }
}

impl Plain {
    /// The document, named `name`, and its only buffer.
    pub fn into_document(self, name: &str, budget: &Budget) -> Result<(Root, Vec<u8>)> {
        let mut writer = Writer::default();
        let mut primitives = Vec::new();
        for part in &self.parts {
            budget.charge(part.positions.len() as u64, 64, || self.format.into())?;
            budget.charge(part.triangles.len() as u64, 24, || self.format.into())?;
            primitives.push(writer.primitive(part));
        }
        if primitives.iter().all(|p: &Primitive| p.indices.is_none()) {
            primitives.clear();
        }
        let node =
            Node { name: Some(name.into()), matrix: Some(self.world_from_file), mesh: Some(0), ..Node::default() };
        let image = |uri: &String| Image { uri: Some(uri.clone()), ..Image::default() };
        let textured = |i: usize| Texture { sampler: None, source: Some(i), extensions: TextureExtensions::default() };
        let Writer { bin, views, accessors } = writer;
        let extensions = BufferExtensions::default();
        let root = Root {
            asset: Asset { version: "2.0".into(), ..Asset::default() },
            scenes: vec![SceneRoots { nodes: vec![0], ..SceneRoots::default() }],
            nodes: vec![node],
            meshes: vec![Mesh { name: Some(name.into()), primitives, weights: Vec::new() }],
            images: self.images.iter().map(image).collect(),
            textures: (0..self.images.len()).map(textured).collect(),
            materials: self.materials,
            accessors,
            buffer_views: views,
            buffers: vec![Buffer { uri: None, byte_length: bin.len() as u64, extensions }],
            ..Root::default()
        };
        Ok((root, bin))
    }
}

/// Attributes one after the other in one buffer.
#[derive(Default)]
struct Writer {
    bin: Vec<u8>,
    views: Vec<BufferView>,
    accessors: Vec<Accessor>,
}

impl Writer {
    fn primitive(&mut self, part: &Part) -> Primitive {
        let mut attributes = BTreeMap::new();
        attributes.insert("POSITION".into(), self.floats(&part.positions, Shape::Vec3));
        let normals = part.normals.as_ref().map(|normals| self.floats(normals, Shape::Vec3));
        let uv = part.uv.as_ref().map(|uv| self.floats(uv, Shape::Vec2));
        let colors = part.colors.as_ref().map(|colors| self.floats(colors, Shape::Vec4));
        for (name, accessor) in [("NORMAL", normals), ("TEXCOORD_0", uv), ("COLOR_0", colors)] {
            attributes.extend(accessor.map(|accessor| (name.to_owned(), accessor)));
        }
        let corners = part.triangles.as_flattened();
        let indices = self.push(corners.iter().map(|i| i.to_le_bytes()), Component::U32, Shape::Scalar, corners.len());
        Primitive {
            attributes,
            indices: Some(indices),
            material: Some(part.material),
            mode: Mode::Triangles,
            targets: Vec::new(),
            extensions: Default::default(),
        }
    }

    fn floats<const N: usize>(&mut self, values: &[[f32; N]], shape: Shape) -> usize {
        let bytes = values.iter().flatten().map(|x| x.to_le_bytes());
        self.push(bytes, Component::F32, shape, values.len())
    }

    fn push(
        &mut self,
        words: impl Iterator<Item = [u8; 4]>,
        component_type: Component,
        shape: Shape,
        count: usize,
    ) -> usize {
        let byte_offset = self.bin.len() as u64;
        self.bin.extend(words.flatten());
        let byte_length = self.bin.len() as u64 - byte_offset;
        let extensions = BufferViewExtensions::default();
        self.views.push(BufferView { buffer: 0, byte_offset, byte_length, byte_stride: None, extensions });
        self.accessors.push(Accessor {
            buffer_view: Some(self.views.len() - 1),
            byte_offset: 0,
            component_type,
            normalized: false,
            count: count as u64,
            shape,
            sparse: None,
        });
        self.accessors.len() - 1
    }
}

/// The fault of a vertex or triangle of `format` that is not finite, if there is one among `values`.
pub(super) fn check_finite<const N: usize>(format: &'static str, what: &str, values: &[[f32; N]]) -> Result<()> {
    match values.iter().position(|v| !v.iter().all(|x| x.is_finite())) {
        None => Ok(()),
        Some(i) => Err(malformed(format, format!("{what} {i}"), "has a coordinate that is not finite")),
    }
}

/// The fault of a file of `format` that has no triangles at all.
pub(super) fn nothing_to_draw(format: &'static str, problem: &str) -> Fault {
    malformed(format, "the file", problem)
}
