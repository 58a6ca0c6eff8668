//! A browser for machines that have none: Debian's chromium, with node and npm, which drive it.
//!
//! Only tests of pages need it. What npm installs comes with the test that uses it, in a fixed version.

use crate::setup::{apt_get, is_root};
use std::path::Path;
use std::process::{Command, Stdio};

/// Programs, each with the package that has it.
const PROGRAMS: [(&str, &str); 3] = [("chromium", "chromium"), ("node", "nodejs"), ("npm", "npm")];

/// Makes sure that pages can be tested.
///
/// # Errors
/// If a program is missing and cannot be installed; the message names the one command that does.
pub fn browser() -> Result<(), String> {
    let missing = missing(runs);
    if !cfg!(target_os = "linux") || missing.is_empty() {
        return Ok(());
    }
    let packages = missing.join(" ");
    if !Path::new("/etc/debian_version").exists() {
        return Err(format!("tests of pages need a browser; install {packages} with your package manager"));
    }
    if !is_root() {
        return Err(format!("tests of pages need a browser; run 'sudo apt-get install {packages}' and try again"));
    }
    println!("Tests of pages need a browser: installing {packages}");
    apt_get(&["update"])?;
    apt_get(&[&["install", "--yes", "--no-install-recommends"], &missing[..]].concat())
}

/// The packages of the programs that do not run.
fn missing(runs: impl Fn(&str) -> bool) -> Vec<&'static str> {
    PROGRAMS.iter().filter(|(program, _)| !runs(program)).map(|(_, package)| *package).collect()
}

/// Whether a program is there.
pub fn runs(program: &str) -> bool {
    let probe = Command::new(program).arg("--version").stdout(Stdio::null()).stderr(Stdio::null()).status();
    probe.is_ok_and(|status| status.success())
}

#[cfg(test)]
mod tests {
    use super::missing;

    #[test]
    fn only_what_does_not_run_is_installed() {
        assert_eq!(missing(|program| program == "node"), ["chromium", "npm"]);
        assert!(missing(|_| true).is_empty());
    }
}
