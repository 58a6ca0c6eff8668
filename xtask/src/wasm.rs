//! Whether the library builds for browsers.

use crate::cargo;
use std::process::Command;

const TARGET: &str = "wasm32-unknown-unknown";

/// Checks planning and library for WebAssembly, for which rustup has the standard library.
///
/// # Errors
/// If that is missing and cannot be installed, or the check fails.
pub fn run() -> Result<(), String> {
    if !has_target() {
        println!("+ rustup target add {TARGET}");
        let added = Command::new("rustup").args(["target", "add", TARGET]).status();
        if !added.is_ok_and(|status| status.success()) {
            return Err(format!("the target {TARGET} is missing; 'rustup target add {TARGET}' installs it"));
        }
    }
    let arguments = ["check", "--target", TARGET, "--package", "zfail", "--package", "zfail-plan"];
    println!("+ cargo {}", arguments.join(" "));
    match cargo().args(arguments).status() {
        Ok(status) if status.success() => Ok(()),
        Ok(status) => Err(format!("zfail does not build for {TARGET} ({status})")),
        Err(e) => Err(format!("cannot start cargo: {e}")),
    }
}

/// Whether the compiler has the target's standard library.
fn has_target() -> bool {
    let arguments = ["--target", TARGET, "--print", "target-libdir"];
    let output = Command::new("rustc").args(arguments).output();
    output.is_ok_and(|output| is_filled(String::from_utf8_lossy(&output.stdout).trim()))
}

fn is_filled(folder: &str) -> bool {
    std::fs::read_dir(folder).is_ok_and(|mut entries| entries.next().is_some())
}

#[cfg(test)]
mod tests {
    use super::is_filled;

    #[test]
    fn a_folder_that_is_missing_holds_no_library() {
        assert!(is_filled(env!("CARGO_MANIFEST_DIR")));
        assert!(!is_filled("no/such/folder") && !is_filled(""));
    }
}
