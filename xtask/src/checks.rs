//! Every check of the workspace, one after the other, with a summary at the end.

use crate::cargo;
use std::env;
use std::process::Stdio;
use std::time::{Duration, Instant};

/// One cargo command.
struct Check {
    name: &'static str,
    /// Rustup component without which it cannot run.
    component: Option<&'static str>,
    arguments: &'static [&'static str],
    environment: &'static [(&'static str, &'static str)],
}

/// In the order in which a newcomer wants to hear of a fault. All of them build the dev profile and share its artefacts.
const CHECKS: [Check; 5] = [
    Check { name: "format", component: Some("fmt"), arguments: &["fmt", "--all", "--check"], environment: &[] },
    Check {
        name: "lints",
        component: Some("clippy"),
        arguments: &["clippy", "--workspace", "--all-targets", "--", "-D", "warnings"],
        environment: &[],
    },
    Check {
        name: "documentation",
        component: None,
        arguments: &["doc", "--workspace", "--no-deps", "--quiet"],
        environment: &[("RUSTDOCFLAGS", "-D warnings")],
    },
    Check {
        // Benches run in criterion's test mode here: each once, without timing.
        name: "tests and benches",
        component: None,
        arguments: &["test", "--workspace", "--all-targets", "--no-fail-fast"],
        environment: &[],
    },
    Check {
        name: "documentation examples",
        component: None,
        arguments: &["test", "--workspace", "--doc"],
        environment: &[],
    },
];

enum Outcome {
    Passed,
    Failed,
    Skipped(&'static str),
}

/// Runs all checks; `browser` says whether pages can be tested, or why not.
///
/// # Errors
/// If one of them fails, or is skipped where `CI` or `ZFAIL_CI` is set.
pub fn run(browser: Result<(), String>) -> Result<(), String> {
    let strict = ["CI", "ZFAIL_CI"].iter().any(|name| env::var_os(name).is_some_and(|value| !value.is_empty()));
    // Not every system packages one: Ubuntu has chromium as a snap alone.
    let without_browser = match browser {
        Err(reason) if strict => return Err(reason),
        Err(reason) => {
            println!("Tests of pages are skipped: {reason}");
            true
        }
        Ok(()) => false,
    };
    let mut summary = Vec::new();
    for check in &CHECKS {
        let start = Instant::now();
        let outcome = check.run(without_browser)?;
        summary.push((check.name, outcome, start.elapsed()));
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
        (n, _) => Err(format!("{n} of {} checks failed", CHECKS.len())),
    }
}

impl Check {
    fn run(&self, without_browser: bool) -> Result<Outcome, String> {
        println!("\n+ cargo {}", self.arguments.join(" "));
        if let Some(component) = self.component
            && !has_component(component)
        {
            println!("cargo {component} is not installed: skipped");
            return Ok(Outcome::Skipped(component));
        }
        let mut command = cargo();
        command.args(self.arguments).envs(self.environment.iter().copied());
        if without_browser {
            command.env("ZFAIL_WITHOUT_BROWSER", "1");
        }
        let status = command.status().map_err(|e| format!("cannot start cargo: {e}"))?;
        Ok(if status.success() { Outcome::Passed } else { Outcome::Failed })
    }
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
    use super::{Outcome, line};
    use std::time::Duration;

    #[test]
    fn the_summary_names_the_outcome_and_the_remedy() {
        let second = Duration::from_secs(1);
        assert_eq!(line("lints", &Outcome::Passed, second), "  lints                       1.0 s  passed");
        assert!(line("lints", &Outcome::Failed, second).ends_with("FAILED"));
        assert!(line("format", &Outcome::Skipped("fmt"), second).contains("rustup component add rustfmt"));
    }
}
