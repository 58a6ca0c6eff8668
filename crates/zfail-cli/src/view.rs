//! `zfail view`: the interactive viewer in its window.

use crate::args;
use crate::console;
use crate::encode;
use crate::error::Error;
use crate::input;
use std::sync::Arc;
use zfail_render::Settings;
use zfail_view::{Host, Message, Options};

/// Opens the window and stays until it is closed.
///
/// # Errors
/// If there is no display, or no device that can draw on it.
pub fn run(args: &args::View) -> Result<(), Error> {
    let (loading, size, setting) = (args.loading.clone(), args.size.0, args.sunlight.with(&args.surroundings));
    let host = Host {
        load: Arc::new(move |scene| input::complete(scene, &loading, None, size, &setting).map_err(|e| e.to_string())),
        encode: |size, rgba| encode::png_picture(size, &encode::rgb8(rgba), None).map_err(|e| e.to_string()),
        explain: input::chain,
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
        gpu: input::gpu_options(&args.device),
    };
    zfail_view::run(options, host).map_err(|e| Error::failed(input::chain(&e)))
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
