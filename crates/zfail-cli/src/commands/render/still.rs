//! `zfail render` without `--frames`: one picture, and the files beside it.

use super::args::Args;
use super::destinations::Destinations;
use super::overlays::Overlays;
use super::results::Results;
use crate::console;
use crate::error::Error;
use crate::input;
use crate::output::{self, Outputs};
use zfail_render::Renderer;

/// Checks everything that can be checked, renders, encodes, and only then writes.
///
/// # Errors
/// As [`super::run`].
pub fn run(args: &Args) -> Result<(), Error> {
    let destinations = Destinations::new(args, None)?;
    destinations.check(&args.aovs, false)?;
    destinations.folders(&args.aovs).for_each(output::sweep);
    let animated = args.load(args.moment.shown())?;
    let mut scene = input::at_moment(animated, &args.moment)?;
    console::notices(&scene.notices, args.verbosity.quiet);
    let camera = input::eye(&mut scene, &args.camera, args.view.as_deref())?;
    let view = camera.view(args.size.0, &scene.bounds());
    let lights = input::lights(&scene, &args.lights)?;
    let settings = args.settings(&lights);
    let effort = input::effort(&scene, &lights).filter(|_| settings.shadows);
    console::notices(effort.as_slice(), args.verbosity.quiet);

    let progress = console::progress(4, args.verbosity.quiet || args.aovs.is_empty());
    let gpu = args.device.open()?;
    let mut renderer = Renderer::new(&gpu, &scene)?;
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
    let picture = format.encode(args.size.0, &results.pixels(format), None)?;
    outputs.add(destinations.picture, picture);
    outputs.commit()
}
