//! What the program says: results on standard output; notices, progress and errors on standard error.

use crate::args::Cli;
use crate::error::Error;
use crate::names;
use clap::error::{ContextKind, ErrorKind};
use indicatif::{ProgressBar, ProgressFinish, ProgressStyle};
use serde::Serialize;
use std::collections::HashSet;
use std::io::{self, Write};
use std::panic;
use std::sync::{Mutex, PoisonError};

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
    let json =
        serde_json::to_string_pretty(report).map_err(|e| Error::failed(format!("cannot encode the report: {e}")))?;
    Ok(json + "\n")
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

/// Help and version go to standard output; anything else that `clap` reports becomes one line.
///
/// # Errors
/// Whatever was wrong with the command line.
pub fn explain(report: &clap::Error) -> Result<(), Error> {
    let text = report.render().to_string();
    match report.kind() {
        ErrorKind::DisplayHelp | ErrorKind::DisplayVersion => print(&text),
        ErrorKind::DisplayHelpOnMissingArgumentOrSubcommand => {
            Err(Error::usage(format!("no command given; there are: {}", Cli::commands().join(", "))))
        }
        ErrorKind::InvalidSubcommand => {
            let wanted = report.get(ContextKind::InvalidSubcommand).map(ToString::to_string).unwrap_or_default();
            let commands = Cli::commands();
            Err(names::unknown("command", &wanted, &commands.iter().map(String::as_str).collect::<Vec<_>>()))
        }
        _ => {
            let said = |paragraph: &&str| !paragraph.starts_with("Usage:") && !paragraph.starts_with("For more");
            let paragraphs = text.trim_start_matches("error: ").split("\n\n").filter(said).map(str::trim);
            Err(Error::usage(format!("{}; --help explains", paragraphs.collect::<Vec<_>>().join("; "))))
        }
    }
}

/// Runs `work`, and turns a panic in it, which is a bug of ours or of a driver, into an error like any other, so that
/// it cannot be taken for a result and destructors remove what is half done.
pub fn contain_faults(work: impl FnOnce() -> Result<(), Error>) -> Result<(), Error> {
    // Not thread-local: the panic may happen on a worker thread.
    static FAULT: Mutex<Option<String>> = Mutex::new(None);
    let fault = || FAULT.lock().unwrap_or_else(PoisonError::into_inner);
    panic::set_hook(Box::new(move |info| *fault() = Some(info.to_string())));
    let result = panic::catch_unwind(panic::AssertUnwindSafe(work));
    let _ = panic::take_hook();
    result.unwrap_or_else(|_| {
        let fault = fault().take().unwrap_or_else(|| "unknown fault".to_owned());
        Err(Error::failed(format!("internal fault, please report it with this command line: {fault}")))
    })
}

#[cfg(test)]
mod tests {
    use super::contain_faults;
    use crate::error::Error;

    #[test]
    fn a_panic_becomes_one_line() {
        assert_eq!(contain_faults(|| Ok(())), Ok(()));
        assert_eq!(contain_faults(|| Err(Error::usage("x"))), Err(Error::usage("x")));
        let message = contain_faults(|| panic!("index\nout of bounds")).unwrap_err().to_string();
        assert!(message.contains("index out of bounds"), "{message}");
    }
}
