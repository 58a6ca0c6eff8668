//! The oldest compiler that is promised, on the packages that promise it.

use crate::metadata::{self, Package};
use crate::{root, succeeds};
use std::process::{Command, Stdio};

/// The version that `Cargo.toml` states for the workspace.
pub const VERSION: &str = env!("CARGO_PKG_RUST_VERSION");

/// Whether rustup has it.
pub fn is_installed() -> bool {
    let probe = toolchain(VERSION).arg("--version").stdout(Stdio::null()).stderr(Stdio::null()).status();
    probe.is_ok_and(|status| status.success())
}

/// Checks the published packages that promise to build with it.
///
/// # Errors
/// If they do not.
pub fn run() -> Result<(), String> {
    let packages = metadata::packages()?;
    let chosen = promised(&packages, VERSION).flat_map(|name| ["--package", name]);
    // Where it does not take the place of what the usual compiler has built.
    succeeds(toolchain(VERSION).args(["check", "--target-dir", "target/oldest"]).args(chosen))
}

fn toolchain(version: &str) -> Command {
    let mut command = Command::new("rustup");
    command.args(["run", version, "cargo"]).current_dir(root());
    // They name the programs of the toolchain that runs this one.
    command.env_remove("CARGO").env_remove("RUSTC").env_remove("RUSTUP_TOOLCHAIN");
    command
}

/// The published packages that state `version`.
fn promised<'a>(packages: &'a [Package], version: &str) -> impl Iterator<Item = &'a str> {
    let states = move |package: &&Package| package.is_published && package.rust_version.as_deref() == Some(version);
    packages.iter().filter(states).map(|package| package.name.as_str())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn those_that_promise_more_or_go_nowhere_are_left_out() {
        let packages = metadata::packages().unwrap();
        let names: Vec<&str> = promised(&packages, VERSION).collect();
        assert!(names.contains(&"zfail") && names.contains(&"zfail-files"), "{names:?}");
        assert!(!names.contains(&"zfail-view") && !names.contains(&"zfail-exact"), "{names:?}");
        assert_eq!(promised(&packages, "1.0").count(), 0);
    }
}
