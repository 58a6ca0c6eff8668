//! `zfail verify`: the picture of a scene against ray-cast truth, on this machine's adapter and driver.
//!
//! Data flow: `variants` (ways to draw the shadows) -> masks and counts -> `report` (what is wrong with them, judged by
//! [`zfail_oracle`]) -> `suspect` (whose fault that is) -> `text` or JSON, and `pictures`.
//!
//! Beside the picture stands a proof that needs none: every volume is closed ([`zfail_plan::closure`]).

mod pictures;
mod report;
mod suspect;
mod text;
mod variants;

use crate::args::{Device, Subject, Verbosity};
use crate::console;
use crate::error::Error;
use crate::input::{self, Shot};
use crate::render;
use report::{LightReport, Report};
use std::path::PathBuf;
use variants::Variant;
use zfail_oracle::{CastTable, Oracle, Truth};
use zfail_plan::closure::{self, Closure};
use zfail_plan::topology::Topology;
use zfail_render::{AovKind, Aovs, Gpu, RenderError, Renderer};

/// `zfail verify`
#[derive(clap::Args, Debug)]
pub struct Args {
    #[command(flatten)]
    subject: Subject,
    /// Check only these ways to determine shadows; 'all' are all techniques, and auto once more with everything on the
    /// device that can be done there.
    #[arg(long = "technique", value_name = "A,B|all", value_delimiter = ',', default_value = "all")]
    #[arg(value_parser = variants::parser())]
    techniques: Vec<String>,
    /// Print JSON instead of text.
    #[arg(long)]
    json: bool,
    /// Folder for report.json and pictures: what was checked, and of every mismatch what is expected, rendered and wrong.
    /// It must be new or empty. Without it, the pictures of a mismatch go into a new folder among the temporary files.
    #[arg(long, value_name = "DIR")]
    report: Option<PathBuf>,
    #[command(flatten)]
    device: Device,
    #[command(flatten)]
    verbosity: Verbosity,
}

/// Renders, judges, prints, and fails if anything is wrong.
///
/// # Errors
/// If the scene or the device fails, or the picture is wrong.
pub fn run(args: &Args) -> Result<(), Error> {
    if let Some(folder) = &args.report {
        pictures::check_folder(folder)?;
    }
    let quiet = args.verbosity.quiet;
    let shot = input::shot(&args.subject, quiet)?;
    let variants = variants::chosen(&args.techniques);
    let gpu = input::gpu(&args.device)?;
    let progress = console::progress(variants.len() + shot.lights.len(), quiet);
    progress.set_message("rendering");
    let mut renderer = Renderer::new(&gpu, &shot.scene).map_err(|e| render::failed(&e))?;
    let mut images = Vec::with_capacity(variants.len());
    for variant in &variants {
        images.push(draw(&mut renderer, &shot, variant).map_err(|e| render::failed(&e))?);
        progress.inc(1);
    }
    progress.set_message("casting rays");
    let topologies = closure::topologies(&shot.scene)
        .map_err(|e| Error::failed(format!("{}: {}", shot.scene.name, input::chain(&e))))?;
    let oracle = Oracle::new(&shot.scene);
    let (mut truths, mut lights, mut closed) = (Vec::new(), Vec::new(), Closure::default());
    for (i, &light) in shot.lights.iter().enumerate() {
        let truth = truth(&oracle, &shot, &topologies, light);
        lights.push(LightReport::new(&shot.scene, light, &truth, &variants, &images, i)?);
        truths.push(truth);
        closed += closure::of_light(&shot.scene, &topologies, light);
        progress.inc(1);
    }
    progress.finish_and_clear();

    let mut report = Report::new(args.subject.scene.scene.clone(), args.subject.size.0, &gpu, closed, lights);
    if !report.passed {
        report.suspect = Some(suspect::find(&shot, &gpu, &mut renderer, &truths, &report));
    }
    let folder = pictures::write(args.report.as_deref(), &report, &shot, &truths, &variants, &images)?;
    console::print(&if args.json { console::json(&report)? } else { text::text(&report) })?;
    match report.complaint() {
        None => Ok(()),
        Some(complaint) => {
            let place = folder.map(|folder| format!("; the pictures are in '{}'", folder.display()));
            Err(Error::failed(complaint + &place.unwrap_or_default()))
        }
    }
}

/// Masks and counts of the lights that shine.
fn draw(renderer: &mut Renderer<'_>, shot: &Shot, variant: &Variant) -> Result<Aovs, RenderError> {
    renderer.aovs(&shot.view, &variant.settings(&shot.lights), &[AovKind::Shadow, AovKind::Stencil])
}

fn truth(oracle: &Oracle, shot: &Shot, topologies: &[Option<Topology>], light: usize) -> Truth {
    oracle.judge(&shot.view, &shot.scene.lights[light], &CastTable::of_volumes(&shot.scene, topologies, light))
}

/// A device of its own for a second opinion.
fn open(adapter: &zfail_render::Adapter) -> Option<Gpu> {
    Gpu::new(&adapter.options()).ok()
}
