//! What a file says about itself, for reports.
//!
//! In: its parsed JSON. Out: facts that loading may have turned into something else or left out.

use crate::gltf::schema::{Channel, Mesh, Root};
use rustc_hash::FxHashSet;
use serde::Serialize;

/// What a file says about itself, beyond the scene that was made of it.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct FileInfo {
    /// The format: `glTF`, `OBJ`, `STL` or `PLY`. Only glTF files fill all of what follows.
    pub format: &'static str,
    /// `asset.version`.
    pub version: String,
    /// The program that wrote the file.
    pub generator: Option<String>,
    /// Extensions that the file uses, required or not.
    pub extensions_used: Vec<String>,
    /// Extensions that the file declares indispensable.
    pub extensions_required: Vec<String>,
    /// Meshes in the file, including those outside the default scene.
    pub meshes: usize,
    /// Nodes in the file, including those outside the default scene.
    pub nodes: usize,
    /// In the order of the file.
    pub skins: Vec<SkinInfo>,
    /// Meshes with morph targets.
    pub morphs: Vec<MorphInfo>,
    /// By animation, what it moves.
    pub channels: Vec<ChannelInfo>,
}

/// A skin.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct SkinInfo {
    /// How many joints it has.
    pub joints: usize,
}

/// A mesh with morph targets.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct MorphInfo {
    /// The mesh's name, if it has one.
    pub mesh: Option<String>,
    /// How many targets there are.
    pub targets: usize,
}

/// How many channels of an animation move what.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct ChannelInfo {
    /// Translation, rotation or scale of nodes that are no joints.
    pub nodes: usize,
    /// Translation, rotation or scale of joints of skins.
    pub joints: usize,
    /// Weights of morph targets.
    pub weights: usize,
    /// Whatever else, such as what extensions add.
    pub other: usize,
}

impl FileInfo {
    pub(crate) fn of(root: &Root) -> Self {
        let joints: FxHashSet<usize> = root.skins.iter().flat_map(|skin| &skin.joints).copied().collect();
        let channels = |animation: &crate::gltf::schema::Animation| {
            let mut counts = ChannelInfo::default();
            animation.channels.iter().for_each(|channel| *counts.of(channel, &joints) += 1);
            counts
        };
        Self {
            format: "glTF",
            version: root.asset.version.clone(),
            generator: root.asset.generator.clone(),
            extensions_used: root.extensions_used.clone(),
            extensions_required: root.extensions_required.clone(),
            meshes: root.meshes.len(),
            nodes: root.nodes.len(),
            skins: root.skins.iter().map(|skin| SkinInfo { joints: skin.joints.len() }).collect(),
            morphs: root.meshes.iter().filter_map(morph).collect(),
            channels: root.animations.iter().map(channels).collect(),
        }
    }
}

fn morph(mesh: &Mesh) -> Option<MorphInfo> {
    let targets =
        mesh.primitives.iter().map(|primitive| primitive.targets.len()).max().filter(|targets| *targets > 0)?;
    Some(MorphInfo { mesh: mesh.name.clone(), targets })
}

impl ChannelInfo {
    /// The count to which `channel` belongs.
    fn of(&mut self, channel: &Channel, joints: &FxHashSet<usize>) -> &mut usize {
        match (&*channel.target.path, channel.target.node) {
            ("translation" | "rotation" | "scale", Some(node)) if joints.contains(&node) => &mut self.joints,
            ("translation" | "rotation" | "scale", Some(_)) => &mut self.nodes,
            ("weights", Some(_)) => &mut self.weights,
            _ => &mut self.other,
        }
    }
}
