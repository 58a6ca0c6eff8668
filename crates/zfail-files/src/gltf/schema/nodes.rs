//! Nodes, what they hold (lights, cameras, skins) and what moves them.

use super::one;
use serde::Deserialize;
use serde_json::Value;
use std::collections::BTreeMap;
use zfail_scene::animate;

#[derive(Debug, Default, Deserialize)]
#[serde(default)]
pub(crate) struct Lights {
    pub lights: Vec<Light>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(default)]
pub(crate) struct SceneRoots {
    pub nodes: Vec<usize>,
    pub extras: Value,
}

#[derive(Debug, Default, Deserialize)]
#[serde(default)]
pub(crate) struct Node {
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
pub(crate) struct NodeExtensions {
    #[serde(rename = "KHR_lights_punctual")]
    pub light: Option<NodeLight>,
    #[serde(rename = "EXT_mesh_gpu_instancing")]
    pub instancing: Option<Instancing>,
    #[serde(rename = "KHR_node_visibility")]
    pub visibility: Visibility,
}

#[derive(Debug, Deserialize)]
pub(crate) struct NodeLight {
    pub light: usize,
}

#[derive(Debug, Deserialize)]
pub(crate) struct Instancing {
    pub attributes: BTreeMap<String, usize>,
}

#[derive(Debug, Deserialize)]
#[serde(default)]
pub(crate) struct Visibility {
    /// If not, nor is what hangs below.
    pub visible: bool,
}

impl Default for Visibility {
    fn default() -> Self {
        Self { visible: true }
    }
}

#[derive(Debug, Default, Deserialize)]
#[serde(default, rename_all = "camelCase")]
pub(crate) struct Skin {
    pub joints: Vec<usize>,
    pub inverse_bind_matrices: Option<usize>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(default)]
pub(crate) struct Camera {
    pub name: Option<String>,
    pub perspective: Option<Perspective>,
    pub orthographic: Option<Orthographic>,
}

#[derive(Debug, Deserialize)]
pub(crate) struct Perspective {
    pub yfov: f64,
    pub znear: f64,
    pub zfar: Option<f64>,
}

#[derive(Debug, Deserialize)]
pub(crate) struct Orthographic {
    pub ymag: f64,
    pub znear: f64,
    pub zfar: f64,
}

#[derive(Debug, Deserialize)]
pub(crate) struct Light {
    pub name: Option<String>,
    /// `None` where nothing is known of the light.
    #[serde(rename = "type")]
    pub kind: Option<LightType>,
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
pub(crate) enum LightType {
    Point,
    Spot,
    Directional,
}

#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(default, rename_all = "camelCase")]
pub(crate) struct Spot {
    pub inner_cone_angle: f64,
    pub outer_cone_angle: f64,
}

impl Default for Spot {
    fn default() -> Self {
        Self { inner_cone_angle: 0.0, outer_cone_angle: std::f64::consts::FRAC_PI_4 }
    }
}

#[derive(Debug, Default, Deserialize)]
#[serde(default)]
pub(crate) struct Animation {
    pub name: Option<String>,
    pub channels: Vec<Channel>,
    pub samplers: Vec<AnimationSampler>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(default)]
pub(crate) struct Channel {
    pub sampler: Option<usize>,
    pub target: ChannelTarget,
}

#[derive(Debug, Default, Deserialize)]
#[serde(default)]
pub(crate) struct ChannelTarget {
    /// Absent where an extension says what is moved.
    pub node: Option<usize>,
    pub path: String,
    pub extensions: TargetExtensions,
}

#[derive(Debug, Default, Deserialize)]
#[serde(default)]
pub(crate) struct TargetExtensions {
    #[serde(rename = "KHR_animation_pointer")]
    pub pointer: Pointer,
}

#[derive(Debug, Default, Deserialize)]
#[serde(default)]
pub(crate) struct Pointer {
    /// A JSON pointer to what is moved.
    pub pointer: String,
}

#[derive(Debug, Default, Deserialize)]
#[serde(default)]
pub(crate) struct AnimationSampler {
    pub input: Option<usize>,
    pub output: Option<usize>,
    pub interpolation: Interpolation,
}

#[derive(Clone, Copy, Debug, Default, Deserialize)]
#[serde(rename_all = "UPPERCASE")]
pub(crate) enum Interpolation {
    Step,
    #[default]
    Linear,
    CubicSpline,
}

impl From<Interpolation> for animate::Interpolation {
    fn from(interpolation: Interpolation) -> Self {
        match interpolation {
            Interpolation::Step => Self::Step,
            Interpolation::Linear => Self::Linear,
            Interpolation::CubicSpline => Self::CubicSpline,
        }
    }
}

fn white() -> [f64; 3] {
    [1.0; 3]
}
