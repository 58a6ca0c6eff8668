//! The arguments of `zfail render`, and what follows from them alone.

use super::files::{AovFiles, PictureFile};
use super::numbering::FrameRange;
use super::overlays::OverlayArgs;
use super::steps::StepArgs;
use crate::error::Error;
use crate::groups::{
    Device, Moment, SceneArg, Size, Sunlight, Surroundings, Verbosity, parse_exposure, parse_fps, parse_light,
    parse_samples, parse_terminator, technique_parser,
};
use crate::input;
use std::path::PathBuf;
use zfail_render::{Exposure, Settings, Technique, Terminator};
use zfail_scene::Animated;

/// `zfail render`
#[derive(clap::Args, Clone, Debug)]
pub struct Args {
    #[command(flatten)]
    pub scene: SceneArg,
    /// The picture: .png (tone-mapped, sRGB) or .exr (linear HDR). With --frames the name has a place for the frame's
    /// number: %d, or %04d for at least four digits; %% is a percent sign. The same holds for --aov and --stats.
    #[arg(short, long, value_name = "OUT", value_parser = PictureFile::parse)]
    pub output: PictureFile,
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
    #[arg(long = "aov", value_name = "KIND=PATH", value_parser = AovFiles::parse)]
    pub aovs: Vec<AovFiles>,
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

/// Frames of an animation, each with files of its own.
#[derive(clap::Args, Clone, Debug)]
pub struct Sequence {
    /// Render the frames from A on up to, and without, B. Frames that are there already are kept if they answer the same
    /// command line and scene; so a run that was stopped goes on where it was.
    #[arg(long, value_name = "A..B", value_parser = FrameRange::parse, conflicts_with = "time", allow_hyphen_values = true)]
    pub frames: Option<FrameRange>,
    /// Frames per second: frame k is the picture of --time k/F, at an exposure that all frames share.
    #[arg(long, value_name = "F", default_value = "60", requires = "frames", value_parser = parse_fps)]
    #[arg(allow_negative_numbers = true)]
    pub fps: f64,
}

impl Args {
    /// The scene, completed for the pictures of `moment`, or at rest.
    ///
    /// # Errors
    /// If it cannot be loaded, or has no such animation.
    pub fn load(&self, moment: Option<&Moment>) -> Result<Animated, Error> {
        let setting = self.sunlight.with(&self.surroundings);
        input::complete(&self.scene.scene, &self.scene.loading, moment, self.size.0, &setting)
    }

    /// How the frames are rendered where `lights` shine.
    pub fn settings(&self, lights: &[usize]) -> Settings {
        // Files are the same bytes on every run.
        self.steps.apply(Settings {
            technique: self.technique,
            samples: self.samples,
            shadows: !self.no_shadows,
            lights: Some(lights.to_vec()),
            exposure: self.exposure,
            terminator: self.terminator,
            ..Settings::default()
        })
    }
}
