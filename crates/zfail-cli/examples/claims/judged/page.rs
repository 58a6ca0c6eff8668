//! The page: verdicts in short, then every claim with its figures and the rule that judges them.

use super::Inputs;
use super::claim::{Claim, Verdict, digits};
use super::claims;
use std::error::Error;
use std::fmt::Write;

/// The whole page.
///
/// # Errors
/// If an experiment has nothing to say to a claim.
pub fn page(inputs: &Inputs) -> Result<String, Box<dyn Error>> {
    let themes = claims::themes();
    let (mut rows, mut details, mut verdicts) = (String::new(), String::new(), Vec::new());
    for (title, claims) in &themes {
        write!(details, "## {title}\n\n")?;
        for claim in claims {
            let (verdict, figures) = judged(claim, inputs)?;
            verdicts.push(verdict);
            let number = verdicts.len();
            let Claim { source, quote, .. } = claim;
            writeln!(rows, "| {number} | \"{quote}\" | {source} | {} |", verdict.name())?;
            write!(details, "**{number}. \"{quote}\"** ({source}): **{}.** ", verdict.name())?;
            write!(
                details,
                "{}: {figures}. Confirmed if {}. Experiment: {}.",
                claim.measured, claim.rule, claim.experiment
            )?;
            let remark = (claim.remark)(inputs);
            write!(details, "{}{remark}\n\n", if remark.is_empty() { "" } else { " " })?;
        }
    }
    let counts: Vec<String> = Verdict::ALL
        .map(|verdict| format!("{} {}", verdicts.iter().filter(|v| **v == verdict).count(), verdict.name()))
        .into();
    let commands: String =
        inputs.commands.iter().map(|[name, command]| format!("| {name} | `{command}` |\n")).collect();
    Ok(format!(
        "# The papers' claims, judged\n\n\
         Made by `cargo xtask claims`, which measures all of it and writes this page anew, on {} ({}). What is quantitative or \
         compares in *C*, *E&K* and *McG* (the [guide](guide/README.md) has their titles) stands beside what was measured, and a \
         rule stated with it decides; no number and no verdict here is typed. Counts are the same on every machine. Times are not; \
         where a claim is about units of a graphics processor and the device is a program on the main processor, the verdict is \
         \"{}\", whatever the figures.\n\n\
         ## In short\n\n{} of {} claims.\n\n| | claim | of | verdict |\n|---:|---|---|---|\n{rows}\n{details}\
         ## The experiments\n\n| name | command |\n|---|---|\n{commands}",
        inputs.adapter.name,
        inputs.adapter.driver,
        Verdict::NotHere.name(),
        counts.join(", "),
        verdicts.len(),
    ))
}

/// The verdict, and the figures in words.
fn judged(claim: &Claim, inputs: &Inputs) -> Result<(Verdict, String), Box<dyn Error>> {
    let figures = (claim.figures)(inputs);
    let values: Vec<f64> = figures.iter().map(|figure| figure.value).collect();
    let verdict = claim.verdict(&values, inputs.software());
    let verdict = verdict.ok_or_else(|| format!("nothing was measured of \"{}\" ({})", claim.quote, claim.source))?;
    let words: Vec<String> = figures.iter().map(|figure| format!("{} {}", figure.name, digits(figure.value))).collect();
    Ok((verdict, words.join(", ")))
}
