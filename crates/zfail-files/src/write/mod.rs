//! Scenes to binary glTF 2.0.
//!
//! In: a [`Scene`]. Out: the bytes of a `.glb` file that any viewer opens.
//!
//! Numbers keep their full precision, so that the file's triangles are the scene's bit for bit. Extensions:
//! KHR_lights_punctual, KHR_texture_transform, KHR_materials_emissive_strength and KHR_materials_unlit, each only if
//! needed and none required. What glTF has no word for goes into extras: `castShadow` and `receiveShadow` on the nodes of meshes; `shadowExclude`,
//! `falloff`, `cookie` and `box` on the nodes of lights; `ambient` and `background` on the scene.

mod attributes;
mod buffer;
mod materials;
mod nodes;
mod unskew;

use buffer::Buffer;
use serde_json::{Value, json};
use std::collections::BTreeSet;
use zfail_scene::{Scene, Unsound};

/// Why a scene cannot be written.
#[derive(Debug, thiserror::Error)]
pub enum WriteError {
    /// The scene breaks its own rules, or has what glTF cannot hold.
    #[error("{element} {problem}")]
    Invalid {
        /// Which part of the scene, such as `meshes[2].triangles[7]`.
        element: String,
        /// What is wrong with it.
        problem: String,
    },
    /// An image cannot be encoded.
    #[error("images[{index}] cannot be encoded as PNG")]
    Image {
        /// Index into [`Scene::images`].
        index: usize,
        /// The encoder's reason.
        source: png::EncodingError,
    },
    /// A `.glb` file holds less than 4 GiB.
    #[error("the scene needs {bytes} bytes, a .glb file holds less than 4 GiB")]
    TooLarge {
        /// Length of the file.
        bytes: u64,
    },
}

type Result<T> = std::result::Result<T, WriteError>;

impl From<Unsound> for WriteError {
    fn from(Unsound { element, problem }: Unsound) -> Self {
        Self::Invalid { element, problem }
    }
}

/// The file's JSON in the making.
#[derive(Default)]
struct Document {
    buffer: Buffer,
    meshes: Vec<Value>,
    materials: Vec<Value>,
    textures: Vec<Value>,
    samplers: Vec<Value>,
    images: Vec<Value>,
    nodes: Vec<Value>,
    lights: Vec<Value>,
    cameras: Vec<Value>,
    roots: Vec<usize>,
    extensions: BTreeSet<&'static str>,
}

/// The scene as a `.glb` file.
///
/// # Errors
/// If the scene is not what [`zfail_scene::check`] accepts, an image cannot be encoded, or the file would exceed 4 GiB.
pub fn to_glb(scene: &Scene) -> Result<Vec<u8>> {
    zfail_scene::check(scene)?;
    let mut document = Document::default();
    materials::write(&mut document, scene)?;
    let mesh_of = attributes::write(&mut document, scene);
    nodes::write(&mut document, scene, &mesh_of);
    container(&document.json(scene).to_string(), &document.buffer.bytes)
}

impl Document {
    fn json(&self, scene: &Scene) -> Value {
        let mut root = json!({
            "asset": { "version": "2.0", "generator": concat!("zfail ", env!("CARGO_PKG_VERSION")) },
            "scene": 0,
            "scenes": [{ "extras": { "ambient": scene.ambient, "background": scene.background } }],
        });
        if !scene.name.is_empty() {
            root["scenes"][0]["name"] = json!(scene.name);
        }
        if !self.lights.is_empty() {
            root["extensions"] = json!({ "KHR_lights_punctual": { "lights": self.lights } });
        }
        if !self.buffer.bytes.is_empty() {
            root["buffers"] = json!([{ "byteLength": self.buffer.bytes.len() }]);
        }
        // glTF has no empty arrays.
        let arrays = [
            ("bufferViews", &self.buffer.views),
            ("accessors", &self.buffer.accessors),
            ("meshes", &self.meshes),
            ("materials", &self.materials),
            ("textures", &self.textures),
            ("samplers", &self.samplers),
            ("images", &self.images),
            ("nodes", &self.nodes),
            ("cameras", &self.cameras),
        ];
        for (key, array) in arrays {
            if !array.is_empty() {
                root[key] = json!(array);
            }
        }
        if !self.roots.is_empty() {
            root["scenes"][0]["nodes"] = json!(self.roots);
        }
        if !self.extensions.is_empty() {
            root["extensionsUsed"] = json!(self.extensions);
        }
        root
    }
}

/// Header, JSON chunk padded with spaces, binary chunk padded with zeros.
fn container(json: &str, binary: &[u8]) -> Result<Vec<u8>> {
    let chunks = [(*b"JSON", json.as_bytes(), b' '), (*b"BIN\0", binary, 0)];
    let chunks = chunks.iter().filter(|(kind, data, _)| kind == b"JSON" || !data.is_empty());
    let length = 12 + chunks.clone().map(|(_, data, _)| 8 + data.len().next_multiple_of(4) as u64).sum::<u64>();
    let total = u32::try_from(length).map_err(|_| WriteError::TooLarge { bytes: length })?;

    let mut glb = Vec::with_capacity(total as usize);
    glb.extend(b"glTF");
    glb.extend(2_u32.to_le_bytes());
    glb.extend(total.to_le_bytes());
    for (kind, data, padding) in chunks {
        let padded = data.len().next_multiple_of(4);
        glb.extend((padded as u32).to_le_bytes());
        glb.extend(kind);
        glb.extend(*data);
        glb.resize(glb.len() + padded - data.len(), *padding);
    }
    Ok(glb)
}

#[cfg(test)]
mod tests;
