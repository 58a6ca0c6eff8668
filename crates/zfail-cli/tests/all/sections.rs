//! The guide's tables from section to module to test, and of corrections: complete, and every path in them leads somewhere.

#[path = "../../../../xtask/src/figures/sections.rs"]
mod lists;

use crate::support::papers::{EVERITT_KILGARD, MCGUIRE};
use lists::{CHAPTER, CORRECTIONS, List, SECTIONS, rows};
use std::fs;
use std::path::{Path, PathBuf};

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

fn read(path: &str) -> String {
    fs::read_to_string(root().join(path)).unwrap_or_else(|e| panic!("{path}: {e}"))
}

fn list(list: &List) -> String {
    read(&format!("docs/guide/tables/{}", list.file))
}

/// Whether a file of the repository has a test of a name.
fn has_test(test: &str) -> bool {
    let Some((path, function)) = test.split_once("::") else { return false };
    let Ok(text) = fs::read_to_string(root().join(path)) else { return false };
    // An attribute that makes it one, a few lines above the function, in the file or in what proptest makes of it.
    let Some(at) = text.find(&format!("fn {function}(")) else { return false };
    text[..at].lines().rev().take(4).any(|line| line.trim() == "#[test]")
}

/// What is wrong with the lines of the list of sections.
fn faults(sections: &str) -> Vec<String> {
    let mut faults = Vec::new();
    for cells in rows(sections) {
        let [section, module, test, figure, _] = cells[..] else {
            faults.push(format!("not five cells: {}", cells.join(" | ")));
            continue;
        };
        if module != "-" && !root().join(module).is_file() {
            faults.push(format!("{section}: no module {module}"));
        }
        if test != "-" && !has_test(test) {
            faults.push(format!("{section}: no test {test}"));
        }
        if figure != "-" && !root().join(format!("docs/guide/figures/{figure}.png")).is_file() {
            faults.push(format!("{section}: no figure {figure}"));
        }
    }
    for paper in [&EVERITT_KILGARD, &MCGUIRE] {
        for (number, _) in paper.sections {
            let begins = format!("{} {number},", paper.name);
            if !rows(sections).iter().any(|cells| cells[0].starts_with(&begins)) {
                faults.push(format!("nothing of {} {number}", paper.name));
            }
        }
    }
    faults
}

#[test]
fn every_section_has_its_module_its_test_and_its_figure() {
    let sections = list(&SECTIONS);
    assert_eq!(faults(&sections), [""; 0]);
    // The check can fail.
    for (right, wrong, fault) in [
        ("pipelines.rs", "pipeline.rs", "no module"),
        ("::any_number_of_layers_is_shadow", "::any_number_of_layers", "no test"),
        // A helper is no test.
        ("stencil.rs::any_number_of_layers_is_shadow", "stencil.rs::perspective", "no test"),
        ("| compare-nested |", "| compare-nest |", "no figure"),
        ("E&K 4.2, ", "E&K 4.3, ", "nothing of E&K 4.2"),
        ("McG 7, ", "McG 8, ", "nothing of McG 7"),
    ] {
        let found = faults(&sections.replacen(right, wrong, 1));
        assert!(found.iter().any(|found| found.contains(fault)), "{wrong}: {found:?}");
    }
}

/// Headings as links name them, of a chapter that corrects the papers beneath them or mentions them as wrong.
fn anchors(chapter: &str) -> Vec<String> {
    let headings = chapter.lines().filter(|line| line.starts_with("## "));
    let kept = |heading: &str| -> String {
        let heading = heading[3..].to_lowercase();
        heading.chars().filter(|c| c.is_alphanumeric() || " -_".contains(*c)).collect::<String>().replace(' ', "-")
    };
    headings.map(kept).collect()
}

/// What is wrong with the lines of the list of corrections.
fn wrong_corrections(corrections: &str) -> Vec<String> {
    let mut faults = Vec::new();
    for cells in rows(corrections) {
        let (file, heading) = cells[2].split_once('#').unwrap_or((cells[2], ""));
        let chapter = fs::read_to_string(root().join("docs/guide").join(file)).unwrap_or_default();
        if !anchors(&chapter).iter().any(|anchor| anchor == heading) {
            faults.push(format!("{}: no heading {}", cells[0], cells[2]));
        }
        if cells[3] != "-" && !has_test(cells[3]) {
            faults.push(format!("{}: no test {}", cells[0], cells[3]));
        }
    }
    faults
}

#[test]
fn every_correction_has_its_chapter_and_its_test() {
    let corrections = list(&CORRECTIONS);
    assert_eq!(wrong_corrections(&corrections), [""; 0]);
    for (right, wrong) in
        [("#the-fan", "#the-fans"), ("07-doing-less", "07-doing-more"), ("::every_tech", "::any_tech")]
    {
        assert_ne!(wrong_corrections(&corrections.replacen(right, wrong, 1)), [""; 0], "{wrong}");
    }
}

#[test]
fn the_chapter_has_the_tables_of_the_lists() {
    let chapter = read(&format!("docs/guide/{CHAPTER}"));
    for table in [SECTIONS, CORRECTIONS] {
        let made = table.put_into(&chapter, &list(&table)).unwrap();
        assert!(made == chapter, "cargo xtask figures sections: {}", table.heading);
        let other = table.put_into(&chapter, &list(&table).replacen("McG", "E&K", 1)).unwrap();
        assert!(other != chapter, "the check can fail");
        assert!(table.put_into("# No heading", &list(&table)).is_err());
        assert!(table.put_into(&chapter, "C | - | a | b | ").is_err(), "a reason is missing");
        assert!(table.put_into(&chapter, "C | a | b | c | why").is_err(), "nothing is missing");
    }
}
