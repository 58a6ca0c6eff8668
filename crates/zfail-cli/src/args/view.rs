//! `zfail view`

use super::loading::Limit;
use super::{
    AlphaShadows, Device, Loading, Size, Sunlight, Surroundings, parse_exposure, parse_samples, parse_terminator,
    technique_parser,
};
use clap::Args;
use std::path::PathBuf;
use zfail_render::{Exposure, Technique, Terminator};
use zfail_scene::GroundChoice;

/// `zfail view`
#[derive(Args, Clone, Debug)]
pub struct View {
    /// A .glb, .gltf, .obj, .stl or .ply file, or builtin:NAME; without it the window lists what could be opened.
    #[arg(value_name = "SCENE")]
    pub scene: Option<String>,
    #[command(flatten)]
    pub loading: Loading,
    /// Size of the window in pixels.
    #[arg(long, value_name = "WxH", default_value = "1280x800", value_parser = Size::parse)]
    pub size: Size,
    /// Samples per pixel.
    #[arg(long, value_name = "1|4", default_value = "1", value_parser = parse_samples)]
    pub samples: u32,
    /// How shadows are determined.
    #[arg(long, value_name = "NAME", default_value = "auto", value_parser = technique_parser())]
    pub technique: Technique,
    /// Stops by which radiance is scaled (0 keeps it), or 'auto' to suit the picture.
    #[arg(long, value_name = "EV|auto", default_value = "auto", allow_negative_numbers = true)]
    #[arg(value_parser = parse_exposure)]
    pub exposure: Exposure,
    /// How light ends where smooth surfaces turn away from it.
    #[arg(long, value_name = "soft|exact", default_value = "soft", value_parser = parse_terminator)]
    pub terminator: Terminator,
    #[command(flatten)]
    pub sunlight: Sunlight,
    #[command(flatten)]
    pub surroundings: Surroundings,
    /// Begin without panels; H shows them.
    #[arg(long)]
    pub no_panels: bool,
    /// Folder for pictures and views that are saved. Nothing in it is ever overwritten.
    #[arg(long, value_name = "DIR", default_value = ".")]
    pub folder: PathBuf,
    #[command(flatten)]
    pub device: Device,
}

impl Loading {
    /// The flags that another command needs to load a scene in the same way.
    pub fn flags(&self) -> Vec<String> {
        let mut flags = Vec::new();
        for limit in &self.limits {
            flags.push("--limit".to_owned());
            flags.push(match limit {
                Limit::Memory(bytes) => format!("memory={bytes}B"),
                Limit::ImageSide(pixels) => format!("image-side={pixels}"),
            });
        }
        match self.alpha_shadows {
            AlphaShadows::Off => flags.push("--alpha-shadows=off".to_owned()),
            AlphaShadows::Solid => flags.push("--alpha-shadows=solid".to_owned()),
            AlphaShadows::Cut(1.0) => {}
            AlphaShadows::Cut(pixels) => flags.push(format!("--alpha-shadows=cut={pixels}")),
        }
        flags.extend(self.blended_shadows.then(|| "--blended-shadows".to_owned()));
        flags.extend(self.variant.iter().flat_map(|variant| ["--variant".to_owned(), variant.clone()]));
        flags
    }
}

impl Surroundings {
    /// The flags without which a saved view does not fit the scene: it holds what catches shadows, but no surfaces.
    pub fn flags(&self) -> Vec<String> {
        match self.ground {
            GroundChoice::Height(height) => vec![format!("--ground={height}")],
            GroundChoice::Auto | GroundChoice::None => Vec::new(),
        }
    }
}

impl Device {
    /// The flags that choose this device.
    pub fn flags(&self) -> Vec<String> {
        use clap::ValueEnum;
        let backend = self.backend.as_ref().and_then(ValueEnum::to_possible_value);
        let backend = backend.into_iter().flat_map(|name| ["--backend".to_owned(), name.get_name().to_owned()]);
        backend.chain(self.adapter.iter().flat_map(|name| ["--adapter".to_owned(), name.clone()])).collect()
    }
}

#[cfg(test)]
mod tests {
    use crate::args::{Cli, Command};
    use clap::Parser;

    #[test]
    fn flags_ask_for_what_was_asked_for() {
        let view = |words: &[&str]| match Cli::try_parse_from([&["zfail", "view", "a.glb"], words].concat()) {
            Ok(Cli { command: Command::View(view) }) => {
                [view.loading.flags(), view.surroundings.flags(), view.device.flags()].concat()
            }
            other => panic!("{other:?}"),
        };
        assert!(view(&[]).is_empty());
        for words in [
            &["--limit", "memory=3GiB", "--alpha-shadows=cut=0.5", "--blended-shadows", "--variant", "2"][..],
            &["--ground=-0.25"],
            &["--limit", "image-side=9", "--alpha-shadows=off", "--backend", "vulkan", "--adapter", "x y"],
        ] {
            let flags = view(words);
            let again: Vec<&str> = flags.iter().map(String::as_str).collect();
            assert_eq!(view(&again), flags);
            assert_eq!(flags.len(), words.len());
        }
    }
}
