//! Every check of the workspace, one after the other, with a summary at the end.

use crate::{browser, cargo, features, fuzz, oldest, packages, wasm};
use std::env;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

/// One or more cargo commands.
struct Check {
    name: &'static str,
    /// Rustup component without which it cannot run.
    component: Option<&'static str>,
    commands: &'static [&'static [&'static str]],
    environment: &'static [(&'static str, &'static str)],
}

/// In the order in which a newcomer wants to hear of a fault. All of them build the dev profile and share its artefacts.
const CHECKS: [Check; 6] = [
    Check { name: "format", component: Some("fmt"), commands: &[&["fmt", "--all", "--check"]], environment: &[] },
    Check {
        name: "lints",
        component: Some("clippy"),
        commands: &[&["clippy", "--workspace", "--all-targets", "--", "-D", "warnings"]],
        environment: &[],
    },
    Check {
        name: "documentation",
        component: None,
        commands: &[&["doc", "--workspace", "--no-deps", "--quiet"]],
        environment: &[("RUSTDOCFLAGS", "-D warnings")],
    },
    Check { name: TESTS, component: None, commands: &[], environment: &[] },
    Check {
        // In criterion's test mode: each once, without timing.
        name: "benches",
        component: None,
        commands: &[&["test", "--workspace", "--bench", "*"]],
        environment: &[],
    },
    Check {
        name: "documentation examples",
        component: None,
        commands: &[&["test", "--workspace", "--doc"]],
        environment: &[],
    },
];

/// Where there is a C++ compiler, which builds libFuzzer.
const FUZZ: Check = Check {
    name: "fuzz targets",
    component: None,
    commands: &[&["check", "--manifest-path", "fuzz/Cargo.toml", "--all-targets", "--target-dir", "fuzz/target"]],
    environment: &[],
};

/// The commit with which the interface of the published crates is compared.
const LAST_RELEASE: Option<&str> = None;

/// The check that [`tests`] runs.
const TESTS: &str = "tests";

enum Outcome {
    Passed,
    Failed,
    Skipped(&'static str),
}

/// Runs all checks; `pages` says whether pages can be tested, or why not.
///
/// # Errors
/// If one of them fails, or is skipped where `CI` or `ZFAIL_CI` is set.
pub fn run(pages: Result<(), String>) -> Result<(), String> {
    let strict = ["CI", "ZFAIL_CI"].iter().any(|name| env::var_os(name).is_some_and(|value| !value.is_empty()));
    // Not every system packages one: Ubuntu has chromium as a snap alone.
    let without_browser = match pages {
        Err(reason) if strict => return Err(reason),
        Err(reason) => {
            println!("Tests of pages are skipped: {reason}");
            true
        }
        Ok(()) => false,
    };
    let mut summary = Vec::new();
    let mut note = |name, outcome: Outcome, start: Instant| summary.push((name, outcome, start.elapsed()));
    for check in &CHECKS {
        let start = Instant::now();
        let outcome = if check.name == TESTS { tests(without_browser)? } else { check.run()? };
        note(check.name, outcome, start);
    }
    let start = Instant::now();
    note("features", outcome(features::run()), start);

    // What a bare machine may lack and cannot always get is told, and fails nothing.
    let start = Instant::now();
    if oldest::is_installed() {
        note("oldest compiler", outcome(oldest::run()), start);
    } else {
        println!("\nRust {} is not installed: what is promised to build with it is not checked", oldest::VERSION);
    }
    let start = Instant::now();
    if browser::runs("c++") {
        note(FUZZ.name, FUZZ.run()?, start);
    } else {
        println!("\nThere is no C++ compiler: the fuzz targets are not checked");
    }
    let start = Instant::now();
    if wasm::is_possible() {
        note("browser build", outcome(wasm::run()), start);
    } else {
        println!("\nThe target {} cannot be had: the library is not checked for browsers", wasm::TARGET);
    }
    let start = Instant::now();
    note("packages", outcome(packages::run()), start);

    let start = Instant::now();
    if has_component("deny") {
        println!("\n+ cargo deny check");
        let outcome = if passes(cargo().args(["deny", "check"]))? { Outcome::Passed } else { Outcome::Failed };
        note("licences, advisories", outcome, start);
    } else {
        println!("\ncargo deny is not installed: licences and advisories are not checked");
    }
    match LAST_RELEASE {
        None => println!("Nothing has been released yet, so no interface can have been broken"),
        Some(commit) if has_component("semver-checks") => {
            let broken = !passes(cargo().args(["semver-checks", "--baseline-rev", commit]))?;
            note("interface", if broken { Outcome::Failed } else { Outcome::Passed }, start);
        }
        Some(commit) => println!("cargo semver-checks is not installed: nothing is compared with {commit}"),
    }

    println!("\nSummary");
    for (name, outcome, time) in &summary {
        println!("{}", line(name, outcome, *time));
    }
    let count = |wanted: fn(&Outcome) -> bool| summary.iter().filter(|(_, outcome, _)| wanted(outcome)).count();
    let failed = count(|outcome| matches!(outcome, Outcome::Failed));
    let skipped = count(|outcome| matches!(outcome, Outcome::Skipped(_)));
    match (failed, skipped) {
        (0, 0) => Ok(()),
        (0, _) if !strict => Ok(()),
        (0, n) => Err(format!("{n} skipped, and CI must not skip any")),
        (n, _) => Err(format!("{n} of {} checks failed", summary.len())),
    }
}

impl Check {
    fn run(&self) -> Result<Outcome, String> {
        if let Some(component) = self.component
            && !has_component(component)
        {
            println!("cargo {component} is not installed: skipped");
            return Ok(Outcome::Skipped(component));
        }
        for arguments in self.commands {
            println!("\n+ cargo {}", arguments.join(" "));
            if !passes(cargo().args(*arguments).envs(self.environment.iter().copied()))? {
                return Ok(Outcome::Failed);
            }
        }
        Ok(Outcome::Passed)
    }
}

/// All tests, with the time of each: by cargo nextest where that is installed, which runs each in a process of its own, or else
/// by the test programs themselves.
fn tests(without_browser: bool) -> Result<Outcome, String> {
    let mut command = cargo();
    if has_component("nextest") {
        command.args(["nextest", "run", "--workspace", "--lib", "--bins", "--tests", "--examples", "--no-fail-fast"]);
        // Of those that passed, too.
        command.args(["--status-level", "pass", "--final-status-level", "fail"]);
    } else {
        command.args(["test", "--workspace", "--lib", "--bins", "--tests", "--examples", "--no-fail-fast"]);
        if let Some((variable, runner)) = timing() {
            command.env(variable, runner).args(["--", "-Zunstable-options", "--report-time"]);
        }
    }
    if without_browser {
        command.env("ZFAIL_WITHOUT_BROWSER", "1");
    }
    println!("\n+ {command:?}");
    Ok(if passes(&mut command)? { Outcome::Passed } else { Outcome::Failed })
}

/// What makes cargo start test programs so that they may be asked for times, which only nightly ones tell by themselves. The
/// compiler does not see it, so that nothing is built another way. `None` where there is no `env` to start them with.
fn timing() -> Option<(String, &'static str)> {
    let host = fuzz::host().ok().filter(|_| cfg!(unix))?;
    let host = host.to_uppercase().replace('-', "_");
    Some((format!("CARGO_TARGET_{host}_RUNNER"), "env RUSTC_BOOTSTRAP=1"))
}

fn outcome(result: Result<(), String>) -> Outcome {
    match result {
        Ok(()) => Outcome::Passed,
        Err(why) => {
            println!("{why}");
            Outcome::Failed
        }
    }
}

fn passes(command: &mut Command) -> Result<bool, String> {
    command.status().map(|status| status.success()).map_err(|e| format!("cannot start cargo: {e}"))
}

fn has_component(name: &str) -> bool {
    let probe = cargo().args([name, "--version"]).stdout(Stdio::null()).stderr(Stdio::null()).status();
    probe.is_ok_and(|status| status.success())
}

fn line(name: &str, outcome: &Outcome, time: Duration) -> String {
    let outcome = match outcome {
        Outcome::Passed => "passed".to_owned(),
        Outcome::Failed => "FAILED".to_owned(),
        Outcome::Skipped("fmt") => "SKIPPED (rustup component add rustfmt)".to_owned(),
        Outcome::Skipped(component) => format!("SKIPPED (rustup component add {component})"),
    };
    format!("  {name:<24} {:>6.1} s  {outcome}", time.as_secs_f64())
}

#[cfg(test)]
mod tests {
    use super::{CHECKS, Outcome, TESTS, line};
    use std::time::Duration;

    #[test]
    fn every_check_has_something_to_do() {
        assert!(CHECKS.iter().all(|check| check.commands.is_empty() == (check.name == TESTS)));
    }

    #[test]
    fn the_summary_names_the_outcome_and_the_remedy() {
        let second = Duration::from_secs(1);
        assert_eq!(line("lints", &Outcome::Passed, second), "  lints                       1.0 s  passed");
        assert!(line("lints", &Outcome::Failed, second).ends_with("FAILED"));
        assert!(line("format", &Outcome::Skipped("fmt"), second).contains("rustup component add rustfmt"));
    }
}
