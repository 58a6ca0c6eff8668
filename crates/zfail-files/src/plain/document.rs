//! Parts as a glTF document with one buffer.

use super::{Part, Picture, Plain, Texture, Up};
use crate::gltf::schema::{
    self, Accessor, Asset, Buffer, BufferExtensions, BufferView, BufferViewExtensions, Component, Image, Mesh, Mode,
    Node, Primitive, Root, Sampler, SceneRoots, Shape, TextureExtensions,
};
use crate::shared::error::Result;
use crate::shared::limits::Budget;
use std::collections::BTreeMap;

impl Plain {
    /// The document, named `name`, and its only buffer.
    pub(crate) fn into_document(self, name: &str, budget: &Budget) -> Result<(Root, Vec<u8>)> {
        let Self { format, parts, materials, textures, pictures, up, origin, notices: _ } = self;
        let mut writer = Writer::default();
        let mut primitives = Vec::new();
        for part in parts {
            budget.charge(part.positions.len() as u64, 64, || format.into())?;
            budget.charge(part.triangles.len() as u64, 24, || format.into())?;
            primitives.push(writer.primitive(&part));
        }
        let mut images = Vec::new();
        for Picture { name, bytes } in pictures {
            budget.charge(bytes.len() as u64, 1, || name.clone())?;
            let buffer_view = Some(writer.view(&bytes));
            images.push(Image { name: Some(name), uri: None, buffer_view });
        }
        let matrix = Some(world_from_file(up, origin));
        let node = Node { name: Some(name.into()), matrix, mesh: Some(0), ..Node::default() };
        let sampled = |texture: Texture| schema::Texture {
            sampler: texture.clamped.then_some(0),
            source: Some(texture.picture),
            extensions: TextureExtensions::default(),
        };
        let Writer { bin, views, accessors } = writer;
        let extensions = BufferExtensions::default();
        let root = Root {
            asset: Asset { version: "2.0".into(), ..Asset::default() },
            scenes: vec![SceneRoots { nodes: vec![0], ..SceneRoots::default() }],
            nodes: vec![node],
            meshes: vec![Mesh { name: Some(name.into()), primitives, weights: Vec::new() }],
            images,
            samplers: vec![clamping()],
            textures: textures.into_iter().map(sampled).collect(),
            materials,
            accessors,
            buffer_views: views,
            buffers: vec![Buffer { uri: None, byte_length: bin.len() as u64, extensions }],
            ..Root::default()
        };
        Ok((root, bin))
    }
}

/// The matrix, column by column, that takes what lies about `origin` to the world. Where z is up, x stays, z becomes y, and y
/// becomes -z.
fn world_from_file(up: Up, origin: [f64; 3]) -> [f64; 16] {
    let [x, y, z] = origin;
    match up {
        Up::Y => [1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, x, y, z, 1.0],
        Up::Z => [1.0, 0.0, 0.0, 0.0, 0.0, 0.0, -1.0, 0.0, 0.0, 1.0, 0.0, 0.0, x, z, 0.0 - y, 1.0],
    }
}

/// Of a picture that ends at its edges.
fn clamping() -> Sampler {
    const CLAMP_TO_EDGE: u32 = 33071;
    Sampler { wrap_s: Some(CLAMP_TO_EDGE), wrap_t: Some(CLAMP_TO_EDGE), ..Sampler::default() }
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
        let start = self.bin.len();
        words.for_each(|word| self.bin.extend_from_slice(&word));
        let buffer_view = Some(self.view_from(start));
        let count = count as u64;
        let accessor = Accessor {
            buffer_view,
            byte_offset: 0,
            component_type,
            normalized: false,
            count,
            shape,
            sparse: None,
            fault: None,
        };
        self.accessors.push(accessor);
        self.accessors.len() - 1
    }

    /// A view of `bytes`, which may have any length: nothing but the like comes after them.
    fn view(&mut self, bytes: &[u8]) -> usize {
        let start = self.bin.len();
        self.bin.extend(bytes);
        self.view_from(start)
    }

    /// A view of all from `start` on.
    fn view_from(&mut self, start: usize) -> usize {
        let (byte_offset, byte_length) = (start as u64, (self.bin.len() - start) as u64);
        let extensions = BufferViewExtensions::default();
        self.views.push(BufferView { buffer: 0, byte_offset, byte_length, byte_stride: None, extensions, fault: None });
        self.views.len() - 1
    }
}
