//! The command line: what may be asked, with its help text and the checks that need no scene.

#[cfg(feature = "view")]
mod view;

#[cfg(feature = "view")]
pub use view::View;

use crate::names;
use crate::numbering::Frames;
use crate::render::{MeasureArgs, OverlayArgs};
use crate::{adapters, compare, verify};
use clap::builder::{PossibleValuesParser, TypedValueParser};
use clap::{Args, CommandFactory, Parser, Subcommand, ValueEnum};
use std::ops::RangeInclusive;
use std::path::{Path, PathBuf};
use zfail_render::wgpu::Backends;
use zfail_render::{AovKind, Exposure, Technique, Terminator};
use zfail_scene::Limits;

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
    pub measures: MeasureArgs,
    /// Light everything, as if nothing cast a shadow.
    #[arg(long)]
    pub no_shadows: bool,
    /// Stops by which radiance is scaled (0 keeps it), or 'auto' to suit the picture.
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

/// Frames of an animation, each with files of its own.
#[derive(Args, Clone, Debug)]
pub struct Sequence {
    /// Render the frames from A on up to, and without, B. Frames that are there already are kept if they answer the same
    /// command line and scene; so a run that was stopped goes on where it was.
    #[arg(long, value_name = "A..B", value_parser = Frames::parse, conflicts_with = "time", allow_hyphen_values = true)]
    pub frames: Option<Frames>,
    /// Frames per second: frame k is the picture of --time k/F.
    #[arg(long, value_name = "F", default_value = "60", requires = "frames", value_parser = parse_fps)]
    #[arg(allow_negative_numbers = true)]
    pub fps: f64,
}

/// What is made of a scene's file, and what that may cost.
#[derive(Args, Clone, Debug)]
pub struct Loading {
    /// Refuse scenes beyond this; repeat it for several. memory=SIZE is what all data of a scene may take while it is
    /// loaded, such as 512MiB or 16GiB (8GiB unless given), image-side=PIXELS the width and height of an image (16384).
    #[arg(help_heading = "Loading", long = "limit", value_name = "NAME=VALUE", value_parser = Limit::parse)]
    limits: Vec<Limit>,
    /// Shadows of masked surfaces (foliage, fences): off (none), solid (of their whole triangles), or cut=PIXELS (of the
    /// mask's shape: triangles are cut along the contour of alpha on load, at most PIXELS of the texture's pixels off).
    #[arg(help_heading = "Loading", long, value_name = "off|solid|cut=PIXELS", default_value = "cut=1", value_parser = AlphaShadows::parse)]
    pub alpha_shadows: AlphaShadows,
    /// Let blended and transmissive surfaces cast shadows as if they were solid.
    #[arg(help_heading = "Loading", long)]
    pub blended_shadows: bool,
    /// Show the file with the materials of this variant, by name or index, instead of its default ones.
    #[arg(help_heading = "Loading", long, value_name = "NAME|N")]
    pub variant: Option<String>,
}

impl Loading {
    /// The limits; of two of a kind the later one holds.
    pub fn limits(&self) -> Limits {
        let mut limits = Limits::default();
        for limit in &self.limits {
            match *limit {
                Limit::Memory(bytes) => limits.bytes = bytes,
                Limit::ImageSide(pixels) => limits.image_side = pixels,
            }
        }
        limits
    }
}

/// A bound on what loading a scene may cost.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Limit {
    /// Bytes.
    Memory(u64),
    /// Pixels.
    ImageSide(u32),
}

impl Limit {
    const NAMES: [&str; 2] = ["memory", "image-side"];

    fn parse(text: &str) -> Result<Self, String> {
        let Some((name, value)) = text.split_once('=') else {
            return Err("write it as NAME=VALUE, such as memory=16GiB".to_owned());
        };
        match name {
            "memory" => parse_bytes(value).map(Self::Memory).ok_or("write memory as 512MiB or 16GiB".to_owned()),
            "image-side" => match value.parse() {
                Ok(pixels @ 1..) => Ok(Self::ImageSide(pixels)),
                _ => Err("image-side must be a number of pixels, 1 or more".to_owned()),
            },
            _ => {
                let hint = names::nearest(name, &Self::NAMES).map(|name| format!(" (did you mean '{name}'?)"));
                let names = Self::NAMES.join(", ");
                Err(format!("unknown limit '{name}'{}; there are: {names}", hint.unwrap_or_default()))
            }
        }
    }
}

/// How masked surfaces cast shadows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum AlphaShadows {
    /// Not at all.
    Off,
    /// As whole triangles.
    Solid,
    /// Cut along the contour of alpha, at most so many texels from it.
    Cut(f64),
}

impl AlphaShadows {
    fn parse(text: &str) -> Result<Self, String> {
        const TOLERANCES: RangeInclusive<f64> = 0.02..=1000.0;
        match (text, text.strip_prefix("cut=").map(str::parse)) {
            ("off", _) => Ok(Self::Off),
            ("solid", _) => Ok(Self::Solid),
            (_, Some(Ok(pixels))) if TOLERANCES.contains(&pixels) => Ok(Self::Cut(pixels)),
            (_, Some(_)) => Err(format!(
                "PIXELS must be a number from {} to {}, such as cut=1",
                TOLERANCES.start(),
                TOLERANCES.end()
            )),
            _ => Err("it must be off, solid or cut=PIXELS, such as cut=1".to_owned()),
        }
    }
}

/// Which GPU does the work.
#[derive(Args, Clone, Debug)]
pub struct Device {
    /// Graphics interface.
    #[arg(long, value_name = "NAME")]
    pub backend: Option<Backend>,
    /// Use the first adapter whose name contains NAME.
    #[arg(long, value_name = "NAME")]
    pub adapter: Option<String>,
}

/// What is said besides results.
#[derive(Args, Clone, Debug)]
pub struct Verbosity {
    /// No notices and no progress; errors are still reported.
    #[arg(short, long)]
    pub quiet: bool,
}

/// Width and height in pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Size(pub [u32; 2]);

impl Size {
    /// No GPU of today makes larger images; the renderer knows what the one at hand can do.
    const MAX_SIDE: u32 = 16_384;

    fn parse(text: &str) -> Result<Self, String> {
        let parsed = text.split_once(['x', 'X']).and_then(|(w, h)| Some([w.parse().ok()?, h.parse().ok()?]));
        let Some([width, height]) = parsed else {
            return Err("write it as WIDTHxHEIGHT, such as 1280x720".to_owned());
        };
        let side = 1..=Self::MAX_SIDE;
        if !side.contains(&width) || !side.contains(&height) {
            return Err(format!("each side must be from 1 to {} pixels", Self::MAX_SIDE));
        }
        Ok(Self([width, height]))
    }
}

/// File formats for images.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// 8 bits per channel.
    Png,
    /// 32-bit float.
    Exr,
}

impl Format {
    /// As the extension says; `None` for any other, and for the name of a folder.
    fn of(path: &Path) -> Option<Self> {
        if path.as_os_str().to_string_lossy().ends_with(std::path::is_separator) {
            return None;
        }
        match path.extension()?.to_str()?.to_ascii_lowercase().as_str() {
            "png" => Some(Self::Png),
            "exr" => Some(Self::Exr),
            _ => None,
        }
    }
}

/// Where the picture goes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Picture {
    /// The file.
    pub path: PathBuf,
    /// As its extension says.
    pub format: Format,
}

impl Picture {
    fn parse(text: &str) -> Result<Self, String> {
        let path = PathBuf::from(text);
        let format = Format::of(&path).ok_or("the name must end in .png or .exr")?;
        Ok(Self { path, format })
    }
}

/// A result other than the picture, and where it goes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Aov {
    /// What.
    pub kind: AovKind,
    /// The file, or the folder for results that come per light.
    pub path: PathBuf,
    /// Of the file, or of each file in the folder.
    pub format: Format,
}

impl Aov {
    fn parse(text: &str) -> Result<Self, String> {
        let Some((name, path)) = text.split_once('=') else {
            return Err("write it as KIND=PATH, such as shadow=masks".to_owned());
        };
        let Ok(kind) = name.parse() else {
            let kinds = AovKind::ALL.map(AovKind::name);
            let hint = names::nearest(name, &kinds).map(|kind| format!(" (did you mean '{kind}'?)"));
            return Err(format!("unknown kind '{name}'{}; there are: {}", hint.unwrap_or_default(), kinds.join(", ")));
        };
        if path.is_empty() {
            return Err(format!("nothing follows '{name}='; name a file or a folder"));
        }
        let path = PathBuf::from(path);
        let format = match (kind, Format::of(&path)) {
            (AovKind::Shadow | AovKind::Stencil, _) => Format::Png,
            (AovKind::Depth | AovKind::Position, Some(Format::Exr)) => Format::Exr,
            (AovKind::Depth | AovKind::Position, _) => return Err(format!("the file for {name} must end in .exr")),
            (AovKind::Normal | AovKind::Albedo, Some(format)) => format,
            (AovKind::Normal | AovKind::Albedo, None) => {
                return Err(format!("the file for {name} must end in .exr or .png"));
            }
        };
        Ok(Self { kind, path, format })
    }

    /// Whether there is a file per light in a folder.
    pub fn is_folder(&self) -> bool {
        matches!(self.kind, AovKind::Shadow | AovKind::Stencil)
    }
}

/// Graphics interfaces.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Backend {
    /// Vulkan.
    Vulkan,
    /// Metal.
    Metal,
    /// Direct3D 12.
    Dx12,
    /// OpenGL and OpenGL ES.
    Gl,
}

impl Backend {
    /// As wgpu's set.
    pub fn backends(self) -> Backends {
        match self {
            Self::Vulkan => Backends::VULKAN,
            Self::Metal => Backends::METAL,
            Self::Dx12 => Backends::DX12,
            Self::Gl => Backends::GL,
        }
    }
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

/// A number with one of the units B, KiB, MiB, GiB and TiB, or without.
fn parse_bytes(text: &str) -> Option<u64> {
    const UNITS: [(&str, u32); 5] = [("KiB", 10), ("MiB", 20), ("GiB", 30), ("TiB", 40), ("B", 0)];
    let unit = UNITS.iter().find_map(|(unit, shift)| Some((text.strip_suffix(unit)?, *shift)));
    let (number, shift) = unit.unwrap_or((text, 0));
    number.trim_end().parse::<u64>().ok()?.checked_mul(1 << shift)
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
    fn sizes() {
        assert_eq!(Size::parse("640x480"), Ok(Size([640, 480])));
        assert_eq!(Size::parse("1X16384"), Ok(Size([1, 16_384])));
        for wrong in ["", "640", "640x", "x480", "0x480", "640x0", "16385x1", "1x100000", "-1x5", "1x2x3"] {
            assert!(Size::parse(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn formats_follow_the_extension() {
        assert_eq!(Picture::parse("a/b.PNG").unwrap().format, Format::Png);
        assert_eq!(Picture::parse("b.exr").unwrap().format, Format::Exr);
        for wrong in ["b.jpg", "png", ".png", "a.png/", "b"] {
            assert!(Picture::parse(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn aov_kinds_and_their_formats() {
        let parse = |text| Aov::parse(text).map(|aov| (aov.kind, aov.format, aov.is_folder()));
        assert_eq!(parse("shadow=masks"), Ok((AovKind::Shadow, Format::Png, true)));
        assert_eq!(parse("stencil=a.b"), Ok((AovKind::Stencil, Format::Png, true)));
        assert_eq!(parse("depth=d.exr"), Ok((AovKind::Depth, Format::Exr, false)));
        assert_eq!(parse("normal=n.png"), Ok((AovKind::Normal, Format::Png, false)));
        assert_eq!(parse("albedo=a=b.exr"), Ok((AovKind::Albedo, Format::Exr, false)));
        for wrong in ["depth=d.png", "position=p", "normal=n", "albedo=a.jpg", "shadow=", "shadow", "=x", "dept=d.exr"]
        {
            assert!(parse(wrong).is_err(), "{wrong}");
        }
        assert!(parse("dept=d.exr").unwrap_err().contains("did you mean 'depth'"));
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
    fn alpha_shadows() {
        assert_eq!(AlphaShadows::parse("off"), Ok(AlphaShadows::Off));
        assert_eq!(AlphaShadows::parse("solid"), Ok(AlphaShadows::Solid));
        assert_eq!(AlphaShadows::parse("cut=0.5"), Ok(AlphaShadows::Cut(0.5)));
        for wrong in ["", "cut", "cut=", "cut=0", "cut=-1", "cut=nan", "cut=inf", "cut=1px", "on", "Solid"] {
            assert!(AlphaShadows::parse(wrong).is_err(), "{wrong}");
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

    #[test]
    fn limits() {
        assert_eq!(Limit::parse("memory=16GiB"), Ok(Limit::Memory(16 << 30)));
        assert_eq!(Limit::parse("memory=512 MiB"), Ok(Limit::Memory(512 << 20)));
        assert_eq!(Limit::parse("memory=1000"), Ok(Limit::Memory(1000)));
        assert_eq!(Limit::parse("image-side=64"), Ok(Limit::ImageSide(64)));
        for wrong in ["", "memory", "memory=", "memory=-1", "memory=8GB", "memory=99999999TiB", "image-side=0", "x=1"] {
            assert!(Limit::parse(wrong).is_err(), "{wrong}");
        }
        let limits = vec![Limit::Memory(1), Limit::ImageSide(2), Limit::Memory(3)];
        let loading = Loading { limits, alpha_shadows: AlphaShadows::Solid, blended_shadows: false, variant: None };
        let Limits { bytes, image_side, .. } = loading.limits();
        assert_eq!((bytes, image_side), (3, 2));
    }
}
