//! `zfail render`: one frame of a scene as files, or many.
//!
//! Data flow: `destinations` (where everything goes) -> `results` (a rendered frame, encoded) -> [`crate::output`].
//! `steps` says who does the work, `overlays` draws on the picture. `sequence` does so for numbered frames, and `seal` tells it which of them are there already.

mod destinations;
mod overlays;
mod results;
mod seal;
mod sequence;
mod steps;

pub use overlays::OverlayArgs;
pub use results::picture_file;
pub use steps::StepArgs;

use crate::args;
use crate::console;
use crate::error::Error;
use crate::input;
use crate::output::{self, Outputs};
use destinations::Destinations;
use overlays::Overlays;
use results::Results;
use zfail_render::{RenderError, Renderer, Settings};
use zfail_scene::Animated;

/// Renders what is asked for.
///
/// # Errors
/// If an argument names nothing in the scene, the scene or the device fails, or a file cannot be written.
pub fn run(args: &args::Render) -> Result<(), Error> {
    args.overlays.check(&args.output)?;
    args.steps.check(args.technique, args.samples)?;
    match &args.sequence.frames {
        Some(frames) => sequence::run(args, frames.0.clone()),
        None => still(args),
    }
}

/// Checks everything that can be checked, renders, encodes, and only then writes.
fn still(args: &args::Render) -> Result<(), Error> {
    let destinations = Destinations::new(args, None)?;
    destinations.check(&args.aovs, false)?;
    destinations.folders(&args.aovs).for_each(output::sweep);
    let animated = load(args, args.moment.shown())?;
    let mut scene = input::at_moment(animated, &args.moment)?;
    console::notices(&scene.notices, args.verbosity.quiet);
    let camera = input::eye(&mut scene, &args.camera, args.view.as_deref())?;
    let view = camera.view(args.size.0, &scene.bounds());
    let lights = input::lights(&scene, &args.lights)?;
    let settings = settings(args, &lights);
    let effort = input::effort(&scene, &lights).filter(|_| settings.shadows);
    console::notices(effort.as_slice(), args.verbosity.quiet);

    let progress = console::progress(4, args.verbosity.quiet || args.aovs.is_empty());
    let gpu = input::gpu(&args.device)?;
    let mut renderer = Renderer::new(&gpu, &scene).map_err(|e| failed(&e))?;
    let mut overlays = Overlays::new(&gpu, &scene, &args.overlays, &lights, args.technique)?;
    progress.inc(1);
    progress.set_message("rendering");
    let results =
        Results::new(&mut renderer, overlays.as_mut(), &view, &settings, &args.aovs, args.stats.is_some(), &progress)?;
    progress.set_message("writing");

    let mut outputs = Outputs::default();
    for (path, bytes) in destinations.sides(&args.aovs, &lights).into_iter().zip(results.sides(args)?) {
        outputs.add(path, bytes);
    }
    let format = args.output.format;
    let picture = results::encode_pixels(args.size.0, &results.pixels(format), format, None)?;
    outputs.add(destinations.picture, picture);
    outputs.commit()
}

/// The scene, completed for the pictures of `moment`, or at rest.
fn load(args: &args::Render, moment: Option<&args::Moment>) -> Result<Animated, Error> {
    let setting = args.sunlight.with(&args.surroundings);
    input::complete(&args.scene.scene, &args.scene.loading, moment, args.size.0, &setting)
}

fn settings(args: &args::Render, lights: &[usize]) -> Settings {
    // Files are the same bytes on every run.
    args.steps.apply(Settings {
        technique: args.technique,
        samples: args.samples,
        shadows: !args.no_shadows,
        lights: Some(lights.to_vec()),
        exposure: args.exposure,
        terminator: args.terminator,
        ..Settings::default()
    })
}

/// What the renderer says, as the program says it.
pub fn failed(error: &RenderError) -> Error {
    Error::failed(input::chain(error))
}
