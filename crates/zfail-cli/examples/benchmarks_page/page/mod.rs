//! The page: what README repeats of it first, then every table with the command that made it.
//!
//! Counts are the same on every machine, so they stand as they are. Times are not, so they stand as ratios wherever there is
//! something to compare them with.

pub mod benches;
pub mod frames;
pub mod growth;

use serde::Deserialize;
use std::error::Error;

/// Everything that the page tells of.
pub struct Inputs {
    /// That made the frames, the growth and the benches, if there are any.
    pub commands: Vec<String>,
    /// All adapters of the machine.
    pub adapters: Vec<Adapter>,
    /// Processor cores.
    pub cores: usize,
    /// Of `zfail bench`.
    pub frames: Vec<frames::Record>,
    /// Of `zfail bench --scaling`.
    pub growth: Vec<growth::Line>,
    /// Of `cargo bench`.
    pub benches: Vec<benches::Bench>,
}

/// What `zfail adapters` says.
#[derive(Deserialize)]
pub struct Adapter {
    name: String,
    backend: String,
    driver: String,
    default: bool,
}

impl Inputs {
    /// The whole page.
    ///
    /// # Errors
    /// If something is missing.
    pub fn page(&self) -> Result<String, Box<dyn Error>> {
        let adapter = self.adapters.iter().find(|adapter| adapter.default).ok_or("there is no default adapter")?;
        let [frames, growth, benches @ ..] = &self.commands[..] else { return Err("commands are missing".into()) };
        let mut text = format!(
            "# Benchmarks\n\n\
             Made by `cargo xtask benchmarks`, which writes this page anew, on {} ({}, driver {}) with {} processor cores. Counts are \
             the same on every machine but where it says otherwise; times are not, and stand as ratios where there is something to \
             compare them with.\n\n## In short\n\n{}\n{}\n\
             ## Frames\n\n    {frames}\n\n{}\n## Growth\n\n    {growth}\n\n{}",
            adapter.name,
            adapter.backend,
            adapter.driver,
            self.cores,
            frames::in_short(&self.frames)?,
            growth::in_short(&self.growth)?,
            frames::tables(&self.frames)?,
            growth::tables(&self.growth),
        );
        if let [command] = benches
            && !self.benches.is_empty()
        {
            text += &format!("\n## Parts\n\n    {command}\n\n{}", benches::table(&self.benches));
        }
        Ok(text)
    }
}

/// A table: the first column to the left, all others to the right.
fn table<const N: usize>(heading: [&str; N], rows: impl IntoIterator<Item = [String; N]>) -> String {
    let line = |cells: &[String]| format!("| {} |\n", cells.join(" | "));
    let marks: String = (1..N).map(|_| "---:|").collect();
    let rows: String = rows.into_iter().map(|row| line(&row)).collect();
    format!("{}|---|{marks}\n{rows}", line(&heading.map(str::to_owned)))
}

/// Least and greatest of some values, as many digits as asked for.
fn range(values: impl Iterator<Item = f64> + Clone, digits: usize) -> String {
    let least = values.clone().fold(f64::INFINITY, f64::min);
    let most = values.fold(f64::NEG_INFINITY, f64::max);
    let [least, most] = [least, most].map(|value| format!("{value:.digits$}"));
    if least == most { least } else { format!("{least} to {most}") }
}

/// Thousands, as "17 k"; small numbers as they are.
fn thousands(count: f64) -> String {
    if count < 1000.0 { format!("{count:.0}") } else { format!("{:.0} k", count / 1000.0) }
}
