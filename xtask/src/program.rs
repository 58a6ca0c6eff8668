//! The program and the examples beside it, built and run.

use crate::cargo;
use std::ffi::OsStr;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

/// The program `zfail`, built.
pub struct Program(PathBuf);

impl Program {
    /// Builds it in a profile that `options` of `cargo build` name, or in the usual one.
    ///
    /// # Errors
    /// If it cannot be built.
    pub fn build(options: &[&str]) -> Result<Self, String> {
        build(&[&["--bin", "zfail"], options].concat()).map(Self)
    }

    /// Runs it in a folder; what it prints.
    ///
    /// # Errors
    /// If it fails.
    pub fn run<'a>(&self, folder: &Path, arguments: impl IntoIterator<Item = &'a str>) -> Result<Vec<u8>, String> {
        let mut command = Command::new(&self.0);
        command.args(arguments).current_dir(folder).env("NODEVICE_SELECT", "1");
        printed(&mut command)
    }
}

/// Runs an example of the program's crate; what it prints.
///
/// # Errors
/// If it fails.
pub fn example(name: &str, arguments: impl IntoIterator<Item = impl AsRef<OsStr>>) -> Result<Vec<u8>, String> {
    printed(Command::new(build(&["--example", name])?).args(arguments).env("NODEVICE_SELECT", "1"))
}

/// Builds one target; the path of what can be run.
fn build(options: &[&str]) -> Result<PathBuf, String> {
    // With the features that tests have, so that nothing is built twice.
    let mut command = cargo();
    command.args(["build", "--workspace", "--message-format", "json-render-diagnostics"]).args(options);
    let output = command.stderr(Stdio::inherit()).output().map_err(|e| format!("cannot start cargo: {e}"))?;
    // The one artefact with an executable is it.
    let text = String::from_utf8_lossy(&output.stdout);
    let path = text.split("\"executable\":\"").nth(1).and_then(|rest| rest.split('"').next());
    let path = path.filter(|_| output.status.success()).map(PathBuf::from);
    path.ok_or_else(|| format!("{command:?} built nothing"))
}

fn printed(command: &mut Command) -> Result<Vec<u8>, String> {
    let Output { status, stdout, stderr } = command.output().map_err(|e| format!("cannot start {command:?}: {e}"))?;
    if status.success() {
        Ok(stdout)
    } else {
        Err(format!("{command:?} failed ({status}): {}", String::from_utf8_lossy(&stderr)))
    }
}

/// Makes a folder where it is missing.
///
/// # Errors
/// If that is not possible.
pub fn create(folder: &Path) -> Result<(), String> {
    fs::create_dir_all(folder).map_err(|e| format!("cannot create {}: {e}", folder.display()))
}
