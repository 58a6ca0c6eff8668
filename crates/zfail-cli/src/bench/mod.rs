//! `zfail bench`: what frames cost, by scene and technique, with shadows and without.
//!
//! In: scenes. Out: a table, or JSON. Data flow: `scenes` (what is played) -> `measure` (samples of every variant,
//! interleaved) -> `record` (their spread) -> `table`. `scaling` is a measurement of its own, of planning
//! alone, and of `extraction`: silhouettes from the CPU and from the device.

mod extraction;
mod measure;
mod record;
mod scaling;
mod scenes;
mod table;

use crate::args;
use crate::console;
use crate::error::Error;
use crate::input;
use measure::{Samples, Setup};
use record::Record;
use scenes::Course;

/// Steps, then prints.
///
/// # Errors
/// If a scene or the device fails, or standard output cannot be written.
pub fn run(args: &args::Bench) -> Result<(), Error> {
    if args.scaling {
        // Planning needs no device.
        let gpu = input::gpu(&args.device).ok();
        let lines = scaling::measure(&scaling::SIZES, gpu.as_ref(), args.verbosity.quiet)?;
        let device = gpu.as_ref().map(|gpu| gpu.info.name.as_str());
        return if args.json {
            console::print(&console::json(&lines)?)
        } else {
            console::print(&scaling::table(&lines, device))
        };
    }
    let names: Vec<&str> = match &args.scenes[..] {
        [] => scenes::DEFAULT.to_vec(),
        names => names.iter().map(String::as_str).collect(),
    };
    // All of them before the first measurement, so that a wrong name costs no minutes.
    let courses: Vec<Course> = names.into_iter().map(|name| Course::new(name, args)).collect::<Result<_, Error>>()?;
    courses.iter().for_each(|course| console::notices(&course.animated.scene.notices, args.verbosity.quiet));

    let gpu = input::gpu(&args.device)?;
    let techniques = measure::techniques(&args.techniques);
    let setup = Setup { gpu: &gpu, techniques: &techniques, samples: args.samples };
    let steps = courses.iter().map(|course| setup.frame_count(course)).sum();
    let progress = console::progress(steps, args.verbosity.quiet);
    let mut records: Vec<Record> = Vec::new();
    for course in &courses {
        progress.set_message(course.name.clone());
        let Samples { on, off } = setup.play(course, &progress)?;
        for (&technique, on) in techniques.iter().zip(&on) {
            for (shadows, frames) in [(true, on), (false, &off)] {
                records.push(Record::new(course, technique, shadows, args.samples, frames));
            }
        }
    }
    progress.finish_and_clear();
    if args.json { console::print(&console::json(&records)?) } else { console::print(&table::text(&gpu, &records)) }
}
