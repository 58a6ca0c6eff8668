//! `zfail render`: one frame of a scene as files, or many.
//!
//! Data flow: `args` (what is asked for, of which `files`, `steps` and `overlays` are parts) -> `destinations` (where everything
//! goes) -> `results` (a rendered frame, encoded) -> [`crate::output`]. `still` does so for one frame, `sequence` for numbered
//! ones (`numbering`), and `seal` tells it which of them are there already.

mod args;
mod destinations;
mod files;
mod numbering;
mod overlays;
mod results;
mod seal;
mod sequence;
mod steps;
mod still;

pub use args::Args;

use crate::error::Error;

/// Renders what is asked for.
///
/// # Errors
/// If an argument names nothing in the scene, the scene or the device fails, or a file cannot be written.
pub fn run(args: &Args) -> Result<(), Error> {
    args.overlays.check(&args.output)?;
    args.steps.check(args.technique, args.samples)?;
    match &args.sequence.frames {
        Some(range) => sequence::run(args, range.0.clone()),
        None => still::run(args),
    }
}
