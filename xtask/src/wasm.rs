//! Whether the library builds for browsers.

use crate::{cargo, succeeds};
use std::process::Command;

/// What the compiler calls a browser.
pub const TARGET: &str = "wasm32-unknown-unknown";

/// Whether the compiler has the target's standard library, or rustup could get it.
pub fn is_possible() -> bool {
    if !has_target() {
        println!("+ rustup target add {TARGET}");
        // Whether that went well, the library tells.
        let _ = Command::new("rustup").args(["target", "add", TARGET]).status();
    }
    has_target()
}

/// Checks planning and library for WebAssembly.
///
/// # Errors
/// If the target is missing and cannot be installed, or the check fails.
pub fn run() -> Result<(), String> {
    if !is_possible() {
        return Err(format!("the target {TARGET} is missing; 'rustup target add {TARGET}' installs it"));
    }
    succeeds(cargo().args(["check", "--target", TARGET, "--package", "zfail", "--package", "zfail-plan"]))
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
