//! The arguments of `zfail bench`.

use super::host::{Boxes, Moves};
use crate::groups::{Device, Loading, Size, Sunlight, Verbosity, parse_fps, parse_samples, technique_parser};
use zfail_render::Technique;

/// `zfail bench`
#[derive(clap::Args, Debug)]
pub struct Args {
    /// .glb, .gltf, .obj, .stl or .ply files, or builtin:NAME; a fixed set of built-in scenes if there is none. The first animation is
    /// played, as the first camera sees it.
    #[arg(value_name = "SCENE")]
    pub scenes: Vec<String>,
    /// Frames to measure, from the start of the animation on.
    #[arg(long, value_name = "N", default_value_t = 60, value_parser = clap::value_parser!(u32).range(1..=100_000))]
    pub frames: u32,
    /// Frames per second of the animation: frame k shows the time k / F, wrapped over its duration.
    #[arg(long, value_name = "F", default_value = "60", value_parser = parse_fps, allow_negative_numbers = true)]
    pub fps: f64,
    /// Size of the frames in pixels.
    #[arg(long, value_name = "WxH", default_value = "1280x720", value_parser = Size::parse)]
    pub size: Size,
    /// Samples per pixel.
    #[arg(long, value_name = "1|4", default_value = "1", value_parser = parse_samples)]
    pub samples: u32,
    /// Compare only these techniques.
    #[arg(long = "technique", value_name = "A,B", value_delimiter = ',', value_parser = technique_parser())]
    pub techniques: Vec<Technique>,
    /// Print JSON instead of a table.
    #[arg(long)]
    pub json: bool,
    /// Instead of frames, measure how planning grows with the number of triangles, up to a million.
    #[arg(long, conflicts_with_all = ["scenes", "frames", "fps", "size", "samples", "techniques"])]
    pub scaling: bool,
    /// Instead of frames, measure what shadows cost the CPU with many casters, on a device that does nothing.
    #[arg(long, conflicts_with_all = ["scenes", "fps", "size", "samples", "scaling"])]
    pub host: bool,
    /// Numbers of casters for --host.
    #[arg(long, value_name = "A,B", value_delimiter = ',', default_values_t = [100, 1000], requires = "host")]
    #[arg(value_parser = clap::value_parser!(usize))]
    pub casters: Vec<usize>,
    /// Numbers of lights for --host.
    #[arg(long, value_name = "A,B", value_delimiter = ',', default_values_t = [1, 4], requires = "host")]
    #[arg(value_parser = clap::value_parser!(usize))]
    pub lights: Vec<usize>,
    /// What is another in every frame, for --host.
    #[arg(long, value_name = "A,B", value_delimiter = ',', requires = "host")]
    #[arg(default_values_t = [Moves::Nothing, Moves::Camera, Moves::Light, Moves::Tenth, Moves::All])]
    #[arg(value_enum)]
    pub moves: Vec<Moves>,
    /// Boxes around what can be seen, for --host: one, or one for each caster.
    #[arg(long, value_name = "A,B", value_delimiter = ',', default_values_t = [Boxes::Scene, Boxes::Each])]
    #[arg(value_enum, requires = "host")]
    pub receivers: Vec<Boxes>,
    #[command(flatten)]
    pub sunlight: Sunlight,
    #[command(flatten)]
    pub loading: Loading,
    #[command(flatten)]
    pub device: Device,
    #[command(flatten)]
    pub verbosity: Verbosity,
}
