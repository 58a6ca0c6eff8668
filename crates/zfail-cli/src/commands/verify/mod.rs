//! `zfail verify`: the picture of a scene against ray-cast truth, on this machine's adapter and driver.
//!
//! Data flow: `variants` (ways to draw the shadows) -> `examined` (masks and counts of a view) -> `light` (what is wrong
//! with them, judged by [`zfail_oracle`]) -> `proof` (whether that is enough) -> `closeup` (where else to look), and so on until
//! it is -> `report` (the whole) -> `suspect` (whose fault a wrong pixel is) -> `text` or JSON, and `pictures`.
//!
//! Beside the picture stands a proof that needs none: every volume is closed ([`zfail_plan::closure`]).

mod closeup;
mod closure;
mod examined;
mod light;
mod pictures;
mod proof;
mod report;
mod suspect;
mod text;
mod variants;

use crate::console;
use crate::error::{Error, chain};
use crate::groups::{Device, Subject, Verbosity};
use crate::input;
use closeup::Scout;
use examined::{Examined, Judge};
use proof::Proof;
use report::{Closeup, Report};
use std::path::PathBuf;
use zfail_oracle::Oracle;
use zfail_render::Renderer;

/// Views beside the one that is asked for.
const CLOSEUPS: usize = 48;

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
    /// Succeed also where nothing is wrong but too little is proved: where hardly anything is certainly lit and certainly in
    /// shadow.
    #[arg(long)]
    allow_little_proof: bool,
    /// Check this picture alone, and no closer views where it proves too little.
    #[arg(long)]
    no_closeups: bool,
    #[command(flatten)]
    device: Device,
    #[command(flatten)]
    verbosity: Verbosity,
}

/// Renders, judges, looks closer until enough is proved, prints, and fails if anything is wrong.
///
/// # Errors
/// If the scene or the device fails, the picture is wrong, or too little is proved.
pub fn run(args: &Args) -> Result<(), Error> {
    if let Some(folder) = &args.report {
        pictures::check_folder(folder)?;
    }
    let quiet = args.verbosity.quiet;
    let mut shot = input::shot(&args.subject, quiet)?;
    console::notices(input::effort(&shot.scene, &shot.lights).as_slice(), quiet);
    let variants = variants::chosen(&args.techniques);
    let gpu = args.device.open()?;
    let progress = console::progress(variants.len() + shot.lights.len(), quiet);
    let mut renderer = Renderer::new(&gpu, &shot.scene)?;
    let topologies =
        shot.scene.topologies().map_err(|e| Error::failed(format!("{}: {}", shot.scene.name, chain(&e))))?;
    let oracle = Oracle::new(&shot.scene);
    let judge = Judge { oracle: &oracle, topologies: &topologies, progress: &progress };
    judge.foresee(&shot, quiet)?;

    let mut proof = Proof::new(&shot.scene, &shot.lights);
    let mut closeups = Vec::new();
    let first = judge.examine(&mut renderer, &shot, &variants)?;
    proof.add(&first.lights);
    // Of the view that is wrong.
    let mut wrong = None;
    let (scene, view) = (shot.scene.clone(), shot.view);
    let mut scout = Scout::new(&oracle, &scene, &view);
    while first.passes() && !args.no_closeups && closeups.len() < CLOSEUPS {
        progress.set_message("looking closer");
        let Some(view) = proof.lacking().iter().find_map(|&light| scout.next(proof.of(light)?)) else { break };
        (shot.view, shot.lights) = (view, proof.lacking());
        progress.inc_length((variants.len() + shot.lights.len()) as u64);
        let closer = judge.examine(&mut renderer, &shot, &variants)?;
        proof.add(&closer.lights);
        let passes = closer.passes();
        closeups.push(Closeup::new(&view, closer.lights.clone()));
        if !passes {
            wrong = Some(closer);
            break;
        }
    }
    proof.conclude();
    progress.set_message("closing volumes");
    let closed = closure::of(&scene, &topologies, first.shone());
    progress.finish_and_clear();

    let Examined { lights, truths, images } = first;
    let shown = wrong.unwrap_or_else(|| Examined { lights: lights.clone(), truths, images });
    let named = args.subject.scene.scene.clone();
    let mut report = Report::new(named, args.subject.size.0, &gpu, closed, lights, closeups, proof);
    if !report.passed {
        report.suspect = Some(suspect::find(&shot, &gpu, &mut renderer, &shown.truths, &report));
    }
    let folder = pictures::write(args.report.as_deref(), &report, &shot, &shown, &variants)?;
    console::print(&if args.json { console::json(&report)? } else { text::text(&report) })?;
    match report.complaint() {
        Some(complaint) => {
            let place = folder.map(|folder| format!("; the pictures are in '{}'", folder.display()));
            Err(Error::failed(complaint + &place.unwrap_or_default()))
        }
        None if report.proof.enough || args.allow_little_proof => Ok(()),
        None => Err(Error::failed(report.proof.sentence() + "; --allow-little-proof takes that for a pass")),
    }
}
