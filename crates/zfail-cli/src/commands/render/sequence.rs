//! `zfail render --frames`: an animation as numbered files, which a later run goes on with.
//!
//! In: the command line and numbers. Out: every frame whole or not at all. Nothing but the files themselves is
//! remembered between runs: see [`super::seal`].

use super::args::{Args, Sequence};
use super::destinations::Destinations;
use super::overlays::Overlays;
use super::results::Results;
use super::seal::Request;
use crate::console;
use crate::error::Error;
use crate::input;
use crate::output::{self, Outputs};
use indicatif::ProgressBar;
use rayon::prelude::*;
use std::collections::HashSet;
use std::ops::Range;
use std::path::{Path, PathBuf};
use zfail_plan::bounds::Bounds;
use zfail_plan::view::{Projection, View};
use zfail_render::{Exposure, Renderer, Settings};
use zfail_scene::{Animated, Camera, Pose};

/// A frame to be.
struct Frame {
    seconds: f64,
    view: View,
    picture: PathBuf,
    /// The files beside the picture.
    sides: Vec<PathBuf>,
}

/// Renders the frames of `numbers` that are not there yet, in order.
///
/// # Errors
/// As [`super::run`]. The frames rendered before stay.
pub fn run(args: &Args, numbers: Range<u32>) -> Result<(), Error> {
    let destinations = destinations(args, numbers.clone())?;
    let mut animated = args.load(Some(&args.moment))?;
    let animation = input::animation(&animated, &args.moment)?;
    let camera = input::camera(&animated.scene, &args.camera)?;
    let lights = input::lights(&animated.scene, &args.lights)?;
    let mut settings = args.settings(&lights);
    let stillness = stillness(&animated, animation, args.sequence.fps, &numbers);
    let effort = input::effort(&animated.scene, &lights).filter(|_| settings.shadows);
    let notices: Vec<String> = animated.scene.notices.iter().cloned().chain(stillness).chain(effort).collect();
    console::notices(&notices, args.verbosity.quiet);

    let gpu = args.device.open()?;
    let metered = metered(&animated, animation, camera, args);
    let request = Request::new(&(&gpu.info, &settings, asked(args), animation, &metered), &mut animated);
    let times = numbers.map(|number| f64::from(number) / args.sequence.fps);
    let views = views(&animated, animation, camera, args.size.0, times);
    let frames = views.zip(destinations).map(|((seconds, view), destinations)| {
        let sides = destinations.sides(&args.aovs, &lights);
        Frame { seconds, view, picture: destinations.picture, sides }
    });
    let frames: Vec<Frame> = frames.collect();
    let total = frames.len();
    let missing: Vec<(Frame, Request)> =
        frames.into_par_iter().filter_map(|frame| frame.unless_there(&request, args)).collect();
    if missing.len() < total {
        let kept = format!("{} of {total} frames are there already and are kept", total - missing.len());
        console::notices(&[kept], args.verbosity.quiet);
    }
    if missing.is_empty() {
        return Ok(());
    }

    let mut renderer = Renderer::new(&gpu, &animated.scene)?;
    let mut overlays = Overlays::new(&gpu, &animated.scene, &args.overlays, &lights, args.technique)?;
    let progress = console::progress(missing.len(), args.verbosity.quiet);
    let mut pose = Pose::default();
    let mut stops = Vec::new();
    for (seconds, view) in &metered {
        animated.pose_into(animation, *seconds, &mut pose);
        renderer.set_pose(&pose)?;
        stops.push(renderer.metered(view, &Settings { samples: 1, ..settings.clone() })?);
    }
    if let Some(stops) = mean(&stops) {
        settings.exposure = Exposure::Ev(stops);
    }
    for (frame, request) in &missing {
        progress.set_message(frame.picture.display().to_string());
        animated.pose_into(animation, frame.seconds, &mut pose);
        renderer.set_pose(&pose)?;
        if let Some(overlays) = &mut overlays {
            overlays.set_pose(&pose)?;
        }
        frame.render(&mut renderer, overlays.as_mut(), &settings, request, args)?;
        progress.inc(1);
    }
    Ok(())
}

impl Frame {
    /// The frame and what it is to answer, unless its files do so already.
    fn unless_there(self, request: &Request, args: &Args) -> Option<(Self, Request)> {
        let request = request.clone().with(&(self.seconds, self.view));
        let is_there = request.is_answered(&self.picture, args.output.format, args.size.0, &self.sides);
        (!is_there).then_some((self, request))
    }

    fn render(
        &self,
        renderer: &mut Renderer<'_>,
        overlays: Option<&mut Overlays<'_>>,
        settings: &Settings,
        request: &Request,
        args: &Args,
    ) -> Result<(), Error> {
        let results = Results::new(
            renderer,
            overlays,
            &self.view,
            settings,
            &args.aovs,
            args.stats.is_some(),
            &ProgressBar::hidden(),
        )?;
        let format = args.output.format;
        let (pixels, sides) = (results.pixels(format), results.sides(args)?);
        let seal = request.seal(&pixels, &sides);
        let mut outputs = Outputs::default();
        for (path, bytes) in self.sides.iter().zip(sides) {
            outputs.add(path, bytes);
        }
        // Its seal vouches for the others, so it comes last.
        outputs.add(&self.picture, format.encode(args.size.0, &pixels, Some(&seal))?);
        outputs.commit()
    }
}

/// Where every frame goes; what killed runs have left there is swept away.
fn destinations(args: &Args, numbers: Range<u32>) -> Result<Vec<Destinations>, Error> {
    let (mut taken, mut folders) = (HashSet::new(), HashSet::new());
    let mut all = Vec::with_capacity(numbers.len());
    for number in numbers {
        let destinations = Destinations::new(args, Some(number))?;
        destinations.claim(&args.aovs, &mut taken)?;
        folders.extend(destinations.folders(&args.aovs).map(Path::to_path_buf));
        all.push(destinations);
    }
    if let Some(first) = all.first() {
        first.check(&args.aovs, true)?;
    }
    folders.iter().for_each(|folder| output::sweep(folder));
    Ok(all)
}

/// What the user asks for, without what makes no difference to a frame or is in the request in another form.
fn asked(args: &Args) -> Args {
    let mut asked = args.clone();
    asked.scene.scene.clear();
    asked.camera.clear();
    asked.moment.animation = None;
    asked.sequence = Sequence { frames: None, fps: 0.0 };
    asked.output.path.clear();
    asked.aovs.iter_mut().for_each(|aov| aov.path.clear());
    asked.stats.iter_mut().for_each(PathBuf::clear);
    asked.verbosity.quiet = false;
    asked
}

/// Times and small views at which exposure is measured, once for all frames: over the whole animation, so that every part of
/// it is exposed alike, whichever frames are asked for. Empty if exposure is given.
fn metered(animated: &Animated, animation: usize, camera: usize, args: &Args) -> Vec<(f64, View)> {
    /// Moments, and the longer side of their pictures in pixels.
    const MOMENTS: u32 = 5;
    const SIDE: f64 = 320.0;
    if args.exposure != Exposure::Auto {
        return Vec::new();
    }
    let duration = animated.animations.get(animation).map_or(0.0, |animation| animation.duration);
    let times = (0..MOMENTS).map(|moment| duration * f64::from(moment) / f64::from(MOMENTS));
    let scale = (SIDE / f64::from(args.size.0[0].max(args.size.0[1]))).min(1.0);
    let size = args.size.0.map(|side| ((f64::from(side) * scale).round() as u32).max(1));
    views(animated, animation, camera, size, times).collect()
}

/// The exposure between all of these.
fn mean(stops: &[f32]) -> Option<f32> {
    (!stops.is_empty()).then(|| stops.iter().sum::<f32>() / stops.len() as f32)
}

/// Time and view of each frame.
fn views(
    animated: &Animated,
    animation: usize,
    camera: usize,
    size: [u32; 2],
    times: impl Iterator<Item = f64>,
) -> impl Iterator<Item = (f64, View)> {
    let camera_at_rest = &animated.scene.cameras[camera];
    // Only the far plane of an orthographic view depends on where things are.
    let orthographic = matches!(camera_at_rest.projection, Projection::Orthographic { .. });
    let mut posed = orthographic.then(|| animated.scene.clone());
    let mut pose = Pose::default();
    times.map(move |seconds| {
        animated.pose_into(animation, seconds, &mut pose);
        let bounds = posed.as_mut().map_or(Bounds::EMPTY, |scene| {
            scene.set_pose(&pose);
            scene.bounds()
        });
        let world_from_view = pose.cameras.get(camera).copied().unwrap_or(camera_at_rest.world_from_view);
        (seconds, Camera { world_from_view, ..camera_at_rest.clone() }.view(size, &bounds))
    })
}

/// What to tell a user whose frames are all alike, or some of them.
fn stillness(animated: &Animated, animation: usize, fps: f64, numbers: &Range<u32>) -> Option<String> {
    let Some(animation) = animated.animations.get(animation) else {
        return Some("the scene has no animation: all its frames are alike".to_owned());
    };
    let last = (animation.duration * fps).ceil();
    let beyond = f64::from(numbers.end) - 1.0 > last;
    beyond.then(|| {
        let (name, duration) = (&animation.name, animation.duration);
        format!("the animation '{name}' ends after {duration:.3} s: frames after number {last} are alike")
    })
}
