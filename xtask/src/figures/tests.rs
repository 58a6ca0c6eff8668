//! The guide holds together: links lead somewhere, and its figures are made by the commands beneath them.

use super::{FIGURES, guide};
use crate::root;
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

/// The guide's chapters by file.
fn chapters() -> Vec<(PathBuf, String)> {
    let mut chapters: Vec<_> = fs::read_dir(guide())
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|extension| extension == "md"))
        .map(|path| (path.clone(), fs::read_to_string(path).unwrap()))
        .collect();
    chapters.sort();
    assert!(chapters.len() > 10, "chapters and contents");
    chapters
}

/// Targets of the links and pictures in a Markdown text.
fn links(text: &str) -> impl Iterator<Item = &str> {
    text.split("](").skip(1).filter_map(|rest| rest.split(')').next())
}

/// The anchors of a text's headings, as code hosts make them.
fn anchors(text: &str) -> BTreeSet<String> {
    let headings = text.lines().filter_map(|line| line.strip_prefix("##").map(|rest| rest.trim_start_matches('#')));
    headings.map(anchor).collect()
}

fn anchor(heading: &str) -> String {
    let kept = heading.trim().chars().filter(|c| c.is_alphanumeric() || matches!(c, ' ' | '-' | '_'));
    kept.map(|c| if c == ' ' { '-' } else { c.to_ascii_lowercase() }).collect()
}

/// What is wrong with a link from the file `from`, if anything.
fn fault(from: &Path, text: &str, link: &str) -> Option<String> {
    if link.starts_with("https://") {
        return None;
    }
    let (path, anchor) = link.split_once('#').unwrap_or((link, ""));
    let target = if path.is_empty() { from.to_owned() } else { from.parent().unwrap().join(path) };
    let fault = |what: &str| Some(format!("{}: {link} {what}", from.display()));
    if !target.exists() {
        return fault("does not exist");
    }
    let read = || if path.is_empty() { text.to_owned() } else { fs::read_to_string(&target).unwrap() };
    if !anchor.is_empty() && !anchors(&read()).contains(anchor) {
        return fault("has no such heading");
    }
    None
}

#[test]
fn every_link_leads_somewhere() {
    let chapters = chapters();
    let faults: Vec<_> =
        chapters.iter().flat_map(|(path, text)| links(text).filter_map(move |link| fault(path, text, link))).collect();
    assert!(faults.is_empty(), "{faults:#?}");
    let (path, text) = &chapters[0];
    assert!(fault(path, text, "../../crates/nothing.rs").is_some());
    assert!(fault(path, text, "#no-such-heading").is_some());
}

/// Paths of the repository's sources, with slashes.
fn sources(folder: &Path, found: &mut Vec<String>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            sources(&path, found);
        } else if is_source(&path.to_string_lossy()) {
            found.push(path.to_string_lossy().replace('\\', "/"));
        }
    }
}

fn is_source(name: &str) -> bool {
    name.ends_with(".rs") || name.ends_with(".wgsl")
}

#[test]
fn every_module_named_is_there() {
    let mut found = Vec::new();
    sources(&root().join("crates"), &mut found);
    let exists = |name: &str| found.iter().any(|path| path.ends_with(&format!("/{name}")));
    let mut named = 0;
    for (path, text) in chapters() {
        for name in text.split('`').skip(1).step_by(2).filter(|name| is_source(name)) {
            assert!(exists(name), "{}: there is no {name}", path.display());
            named += 1;
        }
    }
    assert!(named > 50, "{named} modules are named");
    assert!(!exists("no_such_module.rs"));
}

/// Words, so that a line break in a command does not matter.
fn squeezed(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

#[test]
fn figures_are_made_by_the_commands_beneath_them() {
    let text: String = chapters().into_iter().map(|(_, text)| text).collect();
    let shown: BTreeSet<&str> = links(&text).filter(|link| link.starts_with("figures/")).collect();
    let files: Vec<String> = FIGURES.iter().map(|figure| format!("figures/{}.png", figure.name)).collect();
    let made: BTreeSet<&str> = files.iter().map(String::as_str).collect();
    assert_eq!(made.len(), FIGURES.len(), "a name for each");
    assert_eq!(shown, made, "left: shown in the guide, right: made by the script");
    for (figure, file) in FIGURES.iter().zip(&files) {
        assert!(guide().join(file).is_file(), "{file} is missing: cargo xtask figures {}", figure.name);
        let after = squeezed(text.split_once(&format!("({file})")).unwrap().1);
        let command = after.split("`zfail ").nth(1).and_then(|rest| rest.split('`').next());
        assert_eq!(command, Some(figure.command), "beneath {file}");
    }
}

#[test]
fn pictures_stay_small() {
    let folder = guide().join("figures");
    let mut total = 0;
    for entry in fs::read_dir(folder).unwrap() {
        let entry = entry.unwrap();
        let bytes = entry.metadata().unwrap().len();
        assert!(bytes < 120_000, "{} has {bytes} bytes", entry.path().display());
        assert!(FIGURES.iter().any(|f| entry.path().file_stem().unwrap() == f.name), "{:?}", entry.path());
        total += bytes;
    }
    assert!(total < 1_300_000, "{total} bytes in all");
}
