//! `zfail info`: what is in a scene, and how each mesh will cast.
//!
//! Data flow: `report` and `mesh` (the facts) -> `text` on a `page`, or JSON.

mod mesh;
mod page;
mod report;
mod text;

use crate::console;
use crate::error::Error;
use crate::groups::SceneArg;
use crate::input;
use report::Report;

/// `zfail info`
#[derive(clap::Args, Debug)]
pub struct Args {
    #[command(flatten)]
    scene: SceneArg,
    /// Print JSON instead of text.
    #[arg(long)]
    json: bool,
}

/// Prints the report as text or JSON. Notices are part of it, not said besides.
///
/// # Errors
/// If the scene cannot be loaded or standard output cannot be written.
pub fn run(args: &Args) -> Result<(), Error> {
    let (animated, file) = input::read(&args.scene.scene, &args.scene.loading)?;
    let report = Report::new(&animated, file)?;
    if args.json { console::print(&console::json(&report)?) } else { console::print(&text::text(&report)) }
}
