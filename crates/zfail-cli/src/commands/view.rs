//! `zfail view`: the interactive viewer in its window.

use crate::console;
use crate::error::{Error, chain};
use crate::groups::{
    Device, Loading, Size, Sunlight, Surroundings, parse_exposure, parse_samples, parse_terminator, technique_parser,
};
use crate::input;
use crate::output::encode;
use std::path::PathBuf;
use std::sync::Arc;
use zfail_render::{Exposure, Settings, Technique, Terminator};
use zfail_view::{Host, Message, Options};

/// `zfail view`
#[derive(clap::Args, Clone, Debug)]
pub struct Args {
    /// A .glb, .gltf, .obj, .stl or .ply file, or builtin:NAME; without it the window lists what could be opened.
    #[arg(value_name = "SCENE")]
    scene: Option<String>,
    #[command(flatten)]
    loading: Loading,
    /// Size of the window in pixels.
    #[arg(long, value_name = "WxH", default_value = "1280x800", value_parser = Size::parse)]
    size: Size,
    /// Samples per pixel.
    #[arg(long, value_name = "1|4", default_value = "1", value_parser = parse_samples)]
    samples: u32,
    /// How shadows are determined.
    #[arg(long, value_name = "NAME", default_value = "auto", value_parser = technique_parser())]
    technique: Technique,
    /// Stops by which radiance is scaled (0 keeps it), or 'auto' to suit the picture.
    #[arg(long, value_name = "EV|auto", default_value = "auto", allow_negative_numbers = true)]
    #[arg(value_parser = parse_exposure)]
    exposure: Exposure,
    /// How light ends where smooth surfaces turn away from it.
    #[arg(long, value_name = "soft|exact", default_value = "soft", value_parser = parse_terminator)]
    terminator: Terminator,
    #[command(flatten)]
    sunlight: Sunlight,
    #[command(flatten)]
    surroundings: Surroundings,
    /// Begin without panels; H shows them.
    #[arg(long)]
    no_panels: bool,
    /// Folder for pictures and views that are saved. Nothing in it is ever overwritten.
    #[arg(long, value_name = "DIR", default_value = ".")]
    folder: PathBuf,
    #[command(flatten)]
    device: Device,
}

/// Opens the window and stays until it is closed.
///
/// # Errors
/// If there is no display, or no device that can draw on it.
pub fn run(args: &Args) -> Result<(), Error> {
    let (loading, size, setting) = (args.loading.clone(), args.size.0, args.sunlight.with(&args.surroundings));
    let host = Host {
        load: Arc::new(move |scene| input::complete(scene, &loading, None, size, &setting).map_err(|e| e.to_string())),
        encode: |size, rgba| encode::png_picture(size, &encode::rgb8(rgba), None).map_err(|e| e.to_string()),
        explain: chain,
        say,
    };
    let options = Options {
        scene: args.scene.clone(),
        size: args.size.0,
        settings: Settings {
            technique: args.technique,
            samples: args.samples,
            exposure: args.exposure,
            terminator: args.terminator,
            ..Settings::default()
        },
        panels: !args.no_panels,
        folder: args.folder.clone(),
        flags: [args.loading.flags(), args.surroundings.flags(), args.device.flags()].concat(),
        gpu: args.device.options(),
    };
    Ok(zfail_view::run(options, host)?)
}

/// What the window says, on the terminal.
fn say(message: &Message) {
    match message {
        Message::Error(text) => console::error(&Error::failed(text)),
        Message::Note(text) | Message::Done(text) => console::notices(std::slice::from_ref(text), false),
        // With standard output closed there is nobody to read it.
        Message::Command(line) => drop(console::print(&format!("{line}\n"))),
    }
}

#[cfg(test)]
mod tests {
    use super::Args;
    use clap::{Args as _, Command, FromArgMatches};

    #[test]
    fn flags_ask_for_what_was_asked_for() {
        let view = |words: &[&str]| {
            let matches =
                Args::augment_args(Command::new("view")).get_matches_from([&["view", "a.glb"], words].concat());
            let args = Args::from_arg_matches(&matches).unwrap();
            [args.loading.flags(), args.surroundings.flags(), args.device.flags()].concat()
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
