//! `zfail bench`: what frames cost, by scene and technique, with shadows and without.
//!
//! In: `args`. Out: a table, or JSON. Data flow: `scenes` (what is played) -> `measure` (timings of every variant,
//! interleaved) -> `record` (their spread) -> `table`. `scaling` is a measurement of its own, of planning
//! alone, and of `extraction`: silhouettes from the CPU and from the device. `host` is another, of the CPU's part of a frame.

mod args;
mod extraction;
mod host;
mod measure;
mod record;
mod scaling;
mod scenes;
mod table;

pub use args::Args;

use crate::console;
use crate::error::Error;
use measure::{Setup, Timings};
use record::Record;
use scenes::Course;

/// Measures, then prints.
///
/// # Errors
/// If a scene or the device fails, or standard output cannot be written.
pub fn run(args: &Args) -> Result<(), Error> {
    match (args.scaling, args.host) {
        (true, _) => planning(args),
        (_, true) => hosting(args),
        _ => frames(args),
    }
}

/// How planning grows.
fn planning(args: &Args) -> Result<(), Error> {
    // Planning needs no device.
    let gpu = args.device.open().ok();
    let lines = scaling::measure(&scaling::SIZES, gpu.as_ref(), args.verbosity.quiet)?;
    let device = gpu.as_ref().map(|gpu| gpu.info.name.as_str());
    console::print(&if args.json { console::json(&lines)? } else { scaling::table(&lines, device) })
}

/// What shadows cost the CPU.
fn hosting(args: &Args) -> Result<(), Error> {
    let lines = host::measure(args)?;
    console::print(&if args.json { console::json(&lines)? } else { host::table(&lines) })
}

/// What frames cost.
fn frames(args: &Args) -> Result<(), Error> {
    let names: Vec<&str> = match &args.scenes[..] {
        [] => scenes::DEFAULT.to_vec(),
        names => names.iter().map(String::as_str).collect(),
    };
    // All of them before the first measurement, so that a wrong name costs no minutes.
    let courses: Vec<Course> = names.into_iter().map(|name| Course::new(name, args)).collect::<Result<_, Error>>()?;
    courses.iter().for_each(|course| console::notices(&course.animated.scene.notices, args.verbosity.quiet));

    let gpu = args.device.open()?;
    let techniques = measure::techniques(&args.techniques);
    let setup = Setup { gpu: &gpu, techniques: &techniques, samples: args.samples };
    let steps = courses.iter().map(|course| setup.frame_count(course)).sum();
    let progress = console::progress(steps, args.verbosity.quiet);
    let mut records: Vec<Record> = Vec::new();
    for course in &courses {
        progress.set_message(course.name.clone());
        let Timings { on, off } = setup.play(course, &progress)?;
        for (&technique, on) in techniques.iter().zip(&on) {
            for (shadows, timings) in [(true, on), (false, &off)] {
                records.push(Record::new(course, technique, shadows, args.samples, timings));
            }
        }
    }
    progress.finish_and_clear();
    console::print(&if args.json { console::json(&records)? } else { table::text(&gpu, &records) })
}
