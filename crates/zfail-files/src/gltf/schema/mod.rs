//! The part of the glTF 2.0 schema that a scene is made from, as plain types.
//!
//! In: JSON. Out: values of the right type, nothing more: indices are unchecked until `validate` has run.
//! `nodes` with what hangs on them, `meshes`, `materials` with textures and images, and `data`, the bytes behind it all.
//!
//! The `gltf` crate's own types are not used here because they hold node transforms in single precision, which is
//! 6 cm at 10^6 m, and because their accessors panic on invalid indices.

mod data;
mod materials;
mod meshes;
mod nodes;

pub(crate) use data::*;
pub(crate) use materials::*;
pub(crate) use meshes::*;
pub(crate) use nodes::*;

use serde::Deserialize;

#[derive(Debug, Default, Deserialize)]
#[serde(default, rename_all = "camelCase")]
pub(crate) struct Root {
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
pub(crate) struct Asset {
    pub version: String,
    pub min_version: Option<String>,
    pub generator: Option<String>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(default)]
pub(crate) struct RootExtensions {
    #[serde(rename = "KHR_lights_punctual")]
    pub lights: Option<Lights>,
    #[serde(rename = "KHR_materials_variants")]
    pub variants: Variants,
}

fn one() -> f64 {
    1.0
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
