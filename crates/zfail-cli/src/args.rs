//! The command line: what may be asked, with its help text and the checks that need no scene.

mod device;
mod loading;
mod outputs;
mod setting;
#[cfg(feature = "view")]
mod view;

pub use device::Device;
pub use loading::{AlphaShadows, Loading};
pub use outputs::{Aov, Format, Picture, Size};
pub use setting::{Sunlight, Surroundings};
#[cfg(feature = "view")]
pub use view::View;

use crate::numbering::Frames;
use crate::render::{OverlayArgs, StepArgs};
use crate::{adapters, compare, verify};
use clap::builder::{PossibleValuesParser, TypedValueParser};
use clap::{Args, CommandFactory, Parser, Subcommand};
use std::path::PathBuf;
use zfail_render::{Exposure, Technique, Terminator};

/// Exact stencil shadows of glTF scenes: every shadow boundary to the pixel, without bias and without a shadow map.
#[derive(Debug, Parser)]
#[command(name = "zfail", version, max_term_width = 100, subcommand_required = true, arg_required_else_help = true)]
pub struct Cli {
    /// What to do.
    #[command(subcommand)]
    pub command: Command,
}

impl Cli {
    /// Names of the commands.
    pub fn commands() -> Vec<String> {
        Self::command().get_subcommands().map(|command| command.get_name().to_owned()).collect()
    }
}

/// The commands.
#[derive(Debug, Subcommand)]
#[allow(clippy::large_enum_variant, reason = "there is one of them")]
pub enum Command {
    /// Render a scene to a picture, headless.
    Render(Box<Render>),
    /// Show what is in a scene: meshes and how closed they are, lights, cameras, what is not supported.
    Info(Info),
    /// Measure what frames cost, by technique, with shadows and without.
    Bench(Bench),
    /// Check the picture against a ray-cast oracle, on this machine's adapter and driver.
    Verify(verify::Args),
    /// Show methods of shadows, old and new, on one scene side by side: pictures, a page, and a table of wrong pixels.
    Compare(compare::Args),
    /// List the graphics adapters, in the order in which they are tried.
    Adapters(adapters::Args),
    /// Write the built-in scenes as .glb files with their pictures.
    Gallery(Gallery),
    /// Look at a scene in a window: move eye and lights, play animations, save what you see.
    #[cfg(feature = "view")]
    View(View),
}

/// `zfail render`
#[derive(Args, Clone, Debug)]
pub struct Render {
    #[command(flatten)]
    pub scene: SceneArg,
    /// The picture: .png (tone-mapped, sRGB) or .exr (linear HDR). With --frames the name has a place for the frame's
    /// number: %d, or %04d for at least four digits; %% is a percent sign. The same holds for --aov and --stats.
    #[arg(short, long, value_name = "OUT", value_parser = Picture::parse)]
    pub output: Picture,
    /// Size of the picture in pixels. Its aspect ratio wins over the camera's; the vertical extent is kept.
    #[arg(long, value_name = "WxH", default_value = "1280x720", value_parser = Size::parse)]
    pub size: Size,
    /// Camera by index or name, in depth-first order of the scene's nodes.
    #[arg(long, value_name = "N|NAME", default_value = "0")]
    pub camera: String,
    /// Take camera, lights and casters from a view that was saved in 'zfail view'.
    #[arg(long, value_name = "FILE.json", conflicts_with_all = ["camera", "frames"])]
    pub view: Option<PathBuf>,
    #[command(flatten)]
    pub moment: Moment,
    #[command(flatten)]
    pub sequence: Sequence,
    /// Let only this light shine; repeat it for several. The ambient light stays, and files keep the numbers that the
    /// lights have in the scene.
    #[arg(long = "light", value_name = "N", value_parser = parse_light)]
    pub lights: Vec<usize>,
    /// Samples per pixel.
    #[arg(long, value_name = "1|4", default_value = "1", value_parser = parse_samples)]
    pub samples: u32,
    /// How shadows are determined.
    #[arg(long, value_name = "NAME", default_value = "auto", value_parser = technique_parser())]
    pub technique: Technique,
    #[command(flatten)]
    pub steps: StepArgs,
    /// Light everything, as if nothing cast a shadow.
    #[arg(long)]
    pub no_shadows: bool,
    /// Stops by which radiance is scaled (0 keeps it), or 'auto' to suit the picture, or all frames together.
    #[arg(long, value_name = "EV|auto", default_value = "auto", allow_negative_numbers = true)]
    #[arg(value_parser = parse_exposure)]
    pub exposure: Exposure,
    /// How light ends where smooth surfaces turn away from it: 'soft' fades it before the triangles of a coarse mesh show,
    /// 'exact' leaves it as the normals say. Shadows are the same.
    #[arg(long, value_name = "soft|exact", default_value = "soft", value_parser = parse_terminator)]
    pub terminator: Terminator,
    /// One more result, sampled at pixel centres; repeat it for several. KIND is shadow or stencil (PATH is a folder,
    /// light-<i>.png for each light), depth or position (.exr), normal or albedo (.exr or .png).
    #[arg(long = "aov", value_name = "KIND=PATH", value_parser = Aov::parse)]
    pub aovs: Vec<Aov>,
    /// Counts and times of this run as JSON.
    #[arg(long, value_name = "FILE.json")]
    pub stats: Option<PathBuf>,
    #[command(flatten)]
    pub sunlight: Sunlight,
    #[command(flatten)]
    pub surroundings: Surroundings,
    #[command(flatten)]
    pub overlays: OverlayArgs,
    #[command(flatten)]
    pub device: Device,
    #[command(flatten)]
    pub verbosity: Verbosity,
}

/// `zfail info`
#[derive(Args, Debug)]
pub struct Info {
    #[command(flatten)]
    pub scene: SceneArg,
    /// Print JSON instead of text.
    #[arg(long)]
    pub json: bool,
}

/// `zfail bench`
#[derive(Args, Debug)]
pub struct Bench {
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
    #[command(flatten)]
    pub sunlight: Sunlight,
    #[command(flatten)]
    pub loading: Loading,
    #[command(flatten)]
    pub device: Device,
    #[command(flatten)]
    pub verbosity: Verbosity,
}

/// `zfail gallery`
#[derive(Args, Debug)]
pub struct Gallery {
    /// Folder for NAME.glb, NAME-CAMERA.png and index.html; made if it is missing.
    #[arg(value_name = "DIR")]
    pub folder: PathBuf,
    /// Size of the pictures in pixels.
    #[arg(long, value_name = "WxH", default_value = "1280x720", value_parser = Size::parse)]
    pub size: Size,
    /// Samples per pixel.
    #[arg(long, value_name = "1|4", default_value = "4", value_parser = parse_samples)]
    pub samples: u32,
    #[command(flatten)]
    pub device: Device,
    #[command(flatten)]
    pub verbosity: Verbosity,
}

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

/// The moment of an animation.
#[derive(Args, Clone, Debug)]
pub struct Moment {
    /// Show the scene this many seconds after the start of its animation.
    #[arg(long, value_name = "SECONDS", value_parser = parse_seconds, allow_negative_numbers = true)]
    pub time: Option<f64>,
    /// Animation by index or name; the first one if only --time is given.
    #[arg(long, value_name = "NAME|N")]
    pub animation: Option<String>,
}

impl Moment {
    /// This, if a moment of an animation is asked for and not the scene at rest.
    pub fn shown(&self) -> Option<&Self> {
        Some(self).filter(|moment| moment.animation.is_some() || moment.time.is_some())
    }
}

/// Frames of an animation, each with files of its own.
#[derive(Args, Clone, Debug)]
pub struct Sequence {
    /// Render the frames from A on up to, and without, B. Frames that are there already are kept if they answer the same
    /// command line and scene; so a run that was stopped goes on where it was.
    #[arg(long, value_name = "A..B", value_parser = Frames::parse, conflicts_with = "time", allow_hyphen_values = true)]
    pub frames: Option<Frames>,
    /// Frames per second: frame k is the picture of --time k/F, at an exposure that all frames share.
    #[arg(long, value_name = "F", default_value = "60", requires = "frames", value_parser = parse_fps)]
    #[arg(allow_negative_numbers = true)]
    pub fps: f64,
}

/// What is said besides results.
#[derive(Args, Clone, Debug)]
pub struct Verbosity {
    /// No notices and no progress; errors are still reported.
    #[arg(short, long)]
    pub quiet: bool,
}

fn parse_samples(text: &str) -> Result<u32, String> {
    match text {
        "1" => Ok(1),
        "4" => Ok(4),
        _ => Err("it must be 1 or 4".to_owned()),
    }
}

fn parse_terminator(text: &str) -> Result<Terminator, String> {
    match text {
        "soft" => Ok(Terminator::Soft),
        "exact" => Ok(Terminator::Exact),
        _ => Err("it must be soft or exact".to_owned()),
    }
}

fn parse_exposure(text: &str) -> Result<Exposure, String> {
    if text == "auto" {
        return Ok(Exposure::Auto);
    }
    match text.parse::<f32>() {
        Ok(stops) if (-64.0..=64.0).contains(&stops) => Ok(Exposure::Ev(stops)),
        _ => Err("it must be 'auto' or a number of stops from -64 to 64".to_owned()),
    }
}

fn parse_seconds(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(seconds) if seconds >= 0.0 && seconds.is_finite() => Ok(seconds),
        _ => Err("it must be a number of seconds, 0 or more".to_owned()),
    }
}

fn parse_fps(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(fps) if fps > 0.0 && fps.is_finite() => Ok(fps),
        _ => Err("it must be a number of frames per second, more than 0".to_owned()),
    }
}

fn parse_light(text: &str) -> Result<usize, String> {
    text.parse().map_err(|_| "it must be the number of a light, counted from 0".to_owned())
}

fn technique_parser() -> impl TypedValueParser<Value = Technique> {
    PossibleValuesParser::new(Technique::ALL.map(Technique::name)).try_map(|name| name.parse::<Technique>())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn clap_finds_no_fault_in_the_definitions() {
        Cli::command().debug_assert();
    }

    #[test]
    fn times() {
        assert_eq!(parse_seconds("0"), Ok(0.0));
        assert_eq!(parse_seconds("1.25"), Ok(1.25));
        for wrong in ["", "-1", "nan", "inf", "1s"] {
            assert!(parse_seconds(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn exposures() {
        assert_eq!(parse_exposure("auto"), Ok(Exposure::Auto));
        assert_eq!(parse_exposure("-1.5"), Ok(Exposure::Ev(-1.5)));
        for wrong in ["", "x", "nan", "inf", "65"] {
            assert!(parse_exposure(wrong).is_err(), "{wrong}");
        }
    }
}
