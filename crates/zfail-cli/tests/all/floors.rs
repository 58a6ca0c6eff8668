//! The program's floors: each module knows only those below it, and commands do not know one another.

use std::fs;
use std::path::{Path, PathBuf};

/// From the top.
const FLOORS: [&str; 9] = ["main", "cli", "commands", "input", "groups", "output", "console", "names", "error"];

/// What commands share.
const SHARED: &str = "judged";

fn sources() -> Vec<PathBuf> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let (mut folders, mut found) = (vec![root.clone()], Vec::new());
    while let Some(folder) = folders.pop() {
        for path in fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()) {
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|extension| extension == "rs") {
                found.push(path.strip_prefix(&root).unwrap().with_extension(""));
            }
        }
    }
    found
}

/// What a module of this path reaches for and must not.
fn faults(path: &[&str], text: &str) -> Vec<String> {
    let floor = |name: &str| FLOORS.iter().position(|floor| *floor == name);
    let code = text.lines().filter(|line| !line.trim_start().starts_with("//"));
    let reached = code.flat_map(|line| line.split("crate::").skip(1)).filter_map(|rest| {
        let mut names = rest.split(|c: char| !c.is_alphanumeric() && c != '_').filter(|name| !name.is_empty());
        let (name, within) = (names.next()?, names.next()?);
        let is_above = floor(name)? < floor(path[0])?;
        let is_beside = [name, path[0]] == ["commands"; 2] && within != path[1] && within != SHARED;
        (is_above || is_beside).then(|| format!("{name}::{within}"))
    });
    reached.collect()
}

#[test]
fn every_module_knows_only_what_is_below_it() {
    let sources = sources();
    assert!(sources.len() > 50, "{}", sources.len());
    for path in sources {
        let names: Vec<&str> = path.iter().map(|name| name.to_str().unwrap()).collect();
        assert!(FLOORS.contains(&names[0]), "{} has no floor", path.display());
        let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("src").join(&path).with_extension("rs");
        assert_eq!(faults(&names, &fs::read_to_string(file).unwrap()), [""; 0], "{}", path.display());
    }
    assert_eq!(faults(&["groups", "loading"], "use crate::commands::render;\nuse crate::names;"), ["commands::render"]);
    assert_eq!(
        faults(&["commands", "bench", "measure"], "    crate::commands::render::failed(&e)"),
        ["commands::render"]
    );
}
