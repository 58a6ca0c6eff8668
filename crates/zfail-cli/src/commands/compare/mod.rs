//! `zfail compare`: the methods of [`zfail_methods`] on one scene and camera.
//!
//! Data flow: `measure` (each method's masks, judged by the oracle, and what they cost) and `composite` (pictures that
//! differ by the masks alone) -> `pictures` (PNGs) -> `record` (the table as JSON), `sheet` (a contact sheet) and `page` (a
//! page with a slider and the table). An old method that is wrong is what the page is for; an exact one that is wrong makes
//! the command fail, after everything has been written.

mod composite;
mod measure;
mod options;
mod page;
mod pictures;
mod record;
mod sheet;

use crate::console;
use crate::error::Error;
use crate::groups::{Device, Subject, Verbosity};
use crate::input;
use crate::output::{self, Outputs};
use composite::Studio;
use measure::Course;
use pictures::Pictures;
use record::Record;
use std::path::PathBuf;
use zfail_methods::{FiniteOptions, Method, Options, ShadowMapOptions};
use zfail_scene::Scene;

/// `zfail compare`
#[derive(clap::Args, Debug)]
pub struct Args {
    #[command(flatten)]
    subject: Subject,
    /// Folder for index.html, contact-sheet.png and compare.json; made if it is missing.
    #[arg(short, long, value_name = "DIR")]
    output: PathBuf,
    /// Compare only these methods.
    #[arg(long = "method", value_name = "A,B", value_delimiter = ',', value_parser = options::method_parser())]
    methods: Vec<Method>,
    /// How the shadow map is drawn and read: any of resolution=TEXELS (1024), bias=FRACTION of the light's depth range
    /// (0.001), slope=TEXELS (1), and pcf for the vote of four texels.
    #[arg(long, value_name = "NAME=VALUE,...", default_value = "", hide_default_value = true)]
    #[arg(value_parser = options::shadow_map)]
    shadow_map: ShadowMapOptions,
    /// Where methods of a finite far plane put it, and how far those of finite volumes extrude them, in scene units: far=,
    /// extrusion= or both. Left alone, both are far enough for all that is in the scene.
    #[arg(long, value_name = "NAME=VALUE,...", default_value = "", hide_default_value = true)]
    #[arg(value_parser = options::finite)]
    finite: FiniteOptions,
    /// Print the table as JSON instead of text.
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    device: Device,
    #[command(flatten)]
    verbosity: Verbosity,
}

/// Lets shadows fall on everything, as all methods do; what is to be said about it.
fn let_all_receive(scene: &mut Scene) -> Vec<String> {
    let exempt = scene.instances.iter_mut().filter(|instance| !instance.receives_shadow);
    match exempt.map(|instance| instance.receives_shadow = true).count() {
        0 => Vec::new(),
        count => {
            vec![format!("{count} of the scene's instances receive no shadow elsewhere; here they do, by every method")]
        }
    }
}

/// Measures and photographs, writes everything, prints the table.
///
/// # Errors
/// If the scene or the device fails, a file cannot be written, or a method that promises to be exact is not.
pub fn run(args: &Args) -> Result<(), Error> {
    output::check_folder(&args.output)?;
    let quiet = args.verbosity.quiet;
    let mut shot = input::shot(&args.subject, quiet)?;
    console::notices(&let_all_receive(&mut shot.scene), quiet);
    if shot.lights.is_empty() {
        return Err(Error::failed(format!("{} has no light, and so no shadows to compare", args.subject.scene.scene)));
    }
    let chosen: Vec<Method> =
        Method::ALL.into_iter().filter(|m| args.methods.is_empty() || args.methods.contains(m)).collect();
    let gpu = args.device.open()?;
    let progress = console::progress(shot.lights.len() * (2 + chosen.len()), quiet);
    let options = Options { shadow_map: args.shadow_map, finite: args.finite };
    let course = Course::new(&gpu, &shot, options, &progress);
    let entries = course.run(&chosen, &progress)?;
    progress.set_message("composing");
    let studio = Studio::new(&gpu, &shot, &progress)?;
    let pictures = Pictures::new(&studio, &course.truths, &entries)?;
    let record = Record::new(&args.subject, &shot, &gpu, &options, studio.exposure, &course.truths, &entries)?;

    let json = console::json(&record)?;
    let mut outputs = Outputs::default();
    outputs.add(args.output.join("contact-sheet.png"), sheet::png(&record, &pictures)?);
    outputs.add(args.output.join("compare.json"), json.clone().into_bytes());
    outputs.add(args.output.join("index.html"), page::html(&record, &pictures)?.into_bytes());
    outputs.commit()?;
    progress.finish_and_clear();
    console::print(&if args.json { json } else { record.table() })?;
    match record.broken_promises() {
        promises if promises.is_empty() => Ok(()),
        promises => Err(Error::failed(format!("methods that promise to be exact are not: {}", promises.join(", ")))),
    }
}
