//! Set-up, demo and tests: `cargo xtask demo` and `cargo xtask test`; fuzzing, `cargo xtask fuzz`; the guide's figures,
//! `cargo xtask figures`; the page of costs, `cargo xtask benchmarks`; that of the papers'
//! claims, `cargo xtask claims`.
//!
//! Only the standard library is used, so that the first of these commands on a new machine starts within seconds.

mod benchmarks;
mod browser;
mod checks;
mod claims;
mod features;
mod figures;
mod fuzz;
mod metadata;
mod oldest;
mod packages;
mod program;
mod setup;
mod wasm;

use std::env;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};

const USAGE: &str = "\
Usage: cargo xtask <COMMAND>

Commands:
  demo   Render the gallery of built-in scenes into ./gallery
  test   Run every check: format, lints, documentation, tests, benches in test mode, features, browser build, packages
  package
         Pack every crate that is published, and build the packages by themselves
  wasm   Check the library for browsers
  fuzz SECONDS [TARGET...]
         Fuzz the loaders, each target for so long; needs a C++ compiler
  figures [NAME]
         Make the figures and the table of docs/guide anew, or those with NAME in their names
  benchmarks [small]
         Measure what docs/benchmarks.md tells and write it anew; 'small' tries all of it on little, into target/benchmarks
  claims [small]
         Measure what the papers claim and write docs/claims.md anew; 'small' tries all of it on little, into target/claims

The first two install a software Vulkan driver first if the machine has no graphics adapter; 'test' also a virtual display
and a browser, for the tests of the viewer and of pages (Debian and Ubuntu, as root).";

fn main() -> ExitCode {
    let arguments: Vec<String> = env::args().skip(1).collect();
    let result = match arguments.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        ["demo"] => setup::graphics_adapter().and_then(|()| demo()),
        ["test"] => setup::graphics_adapter()
            .and_then(|()| setup::virtual_display())
            .and_then(|()| checks::run(browser::browser())),
        ["fuzz", seconds, ref targets @ ..] => fuzz::run(seconds, targets),
        ["package"] => packages::run(),
        ["wasm"] => wasm::run(),
        ["figures"] => setup::graphics_adapter().and_then(|()| figures::run(None)),
        ["figures", name] => setup::graphics_adapter().and_then(|()| figures::run(Some(name))),
        ["benchmarks"] => setup::graphics_adapter().and_then(|()| benchmarks::run(false)),
        ["benchmarks", "small"] => setup::graphics_adapter().and_then(|()| benchmarks::run(true)),
        ["claims"] => setup::graphics_adapter().and_then(|()| claims::run(false)),
        ["claims", "small"] => setup::graphics_adapter().and_then(|()| claims::run(true)),
        ["help" | "-h" | "--help"] => {
            println!("{USAGE}");
            Ok(())
        }
        _ => {
            eprintln!("{USAGE}");
            return ExitCode::from(2);
        }
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("xtask: error: {message}");
            ExitCode::FAILURE
        }
    }
}

/// Renders every built-in scene with a program that has neither the viewer nor decoders, of which the gallery needs none and
/// which take half of the time that a first build takes.
fn demo() -> Result<(), String> {
    let gallery = root().join("gallery");
    let status = cargo()
        .args(["run", "--profile", "demo", "--package", "zfail-cli", "--no-default-features", "--", "gallery"])
        .arg(&gallery)
        .status()
        .map_err(|e| format!("cannot start cargo: {e}"))?;
    if !status.success() {
        return Err(format!("the gallery was not rendered ({status})"));
    }
    println!("\nThe gallery is in {}: open index.html, or look at the pictures.", gallery.display());
    Ok(())
}

/// The cargo that runs this task, in the workspace root.
fn cargo() -> Command {
    let mut command = Command::new(env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    // Without a desktop session, Mesa's device-selection layer complains on everyone's standard error.
    command.current_dir(root()).env("NODEVICE_SELECT", "1");
    command
}

/// Says what it runs, and runs it.
fn succeeds(command: &mut Command) -> Result<(), String> {
    println!("+ {command:?}");
    match command.status() {
        Ok(status) if status.success() => Ok(()),
        Ok(status) => Err(format!("{command:?} failed ({status})")),
        Err(e) => Err(format!("cannot start {command:?}: {e}")),
    }
}

fn root() -> PathBuf {
    let manifest = Path::new(env!("CARGO_MANIFEST_DIR"));
    manifest.parent().unwrap_or(manifest).to_owned()
}
