//! What the program says: results on standard output; notices, progress and errors on standard error.

mod faults;
pub mod mesa;

pub use faults::contain_faults;

use crate::error::Error;
use indicatif::{ProgressBar, ProgressFinish, ProgressStyle};
use serde::Serialize;
use std::collections::HashSet;
use std::io::{self, Write};

/// Prints a result. A reader that has seen enough (`zfail info ... | head`) is no error.
///
/// # Errors
/// If standard output cannot be written for another reason.
pub fn print(text: &str) -> Result<(), Error> {
    let mut out = io::stdout().lock();
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Err(e) if e.kind() != io::ErrorKind::BrokenPipe => {
            Err(Error::failed(format!("cannot write to standard output: {e}")))
        }
        _ => Ok(()),
    }
}

/// A report for machines, as [`print`] wants it.
///
/// # Errors
/// If the report cannot be encoded, which is a bug.
pub fn json(report: &impl Serialize) -> Result<String, Error> {
    Ok(serde_json::to_string_pretty(report)? + "\n")
}

/// Prints each distinct notice of a scene once, unless `quiet`.
pub fn notices(notices: &[String], quiet: bool) {
    let mut seen = HashSet::new();
    for notice in notices.iter().filter(|notice| !quiet && seen.insert(notice.as_str())) {
        say("note", notice);
    }
}

/// Prints the one line of an error.
pub fn error(error: &Error) {
    say("error", &error.to_string());
}

fn say(what: &str, text: &str) {
    // With standard error closed there is nobody left to tell.
    let _ = writeln!(io::stderr(), "zfail: {what}: {text}");
}

/// A progress bar for `steps` steps of long work; invisible if `quiet` or not on a terminal.
pub fn progress(steps: usize, quiet: bool) -> ProgressBar {
    let bar = if quiet { ProgressBar::hidden() } else { ProgressBar::new(steps as u64) };
    let style =
        ProgressStyle::with_template("{bar:40} {pos}/{len} {msg}").unwrap_or_else(|_| ProgressStyle::default_bar());
    bar.with_style(style).with_finish(ProgressFinish::AndClear)
}
