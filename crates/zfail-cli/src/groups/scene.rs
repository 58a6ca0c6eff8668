//! The scene that a command works on, and one picture of it.

use super::loading::Loading;
use super::moment::Moment;
use super::surroundings::Sunlight;
use super::values::{Size, parse_light};
use clap::Args;

/// The scene that a command works on.
#[derive(Args, Clone, Debug)]
pub struct SceneArg {
    /// A .glb, .gltf, .obj, .stl or .ply file, or builtin:NAME.
    #[arg(value_name = "SCENE")]
    pub scene: String,
    #[command(flatten)]
    pub loading: Loading,
}

/// One picture of a scene, for commands that judge it.
#[derive(Args, Clone, Debug)]
pub struct Subject {
    #[command(flatten)]
    pub scene: SceneArg,
    /// Size of the picture in pixels.
    #[arg(long, value_name = "WxH", default_value = "640x360", value_parser = Size::parse)]
    pub size: Size,
    /// Camera by index or name, in depth-first order of the scene's nodes.
    #[arg(long, value_name = "N|NAME", default_value = "0")]
    pub camera: String,
    #[command(flatten)]
    pub moment: Moment,
    /// Let only this light shine; repeat it for several.
    #[arg(long = "light", value_name = "N", value_parser = parse_light)]
    pub lights: Vec<usize>,
    #[command(flatten)]
    pub sunlight: Sunlight,
}
