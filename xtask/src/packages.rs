//! The packages of the crates that are published: packed, unpacked somewhere else, and checked there by themselves.
//!
//! In: the workspace. Out: `target/package`, and whether what is in it builds without the rest of the repository. What reaches
//! for a file beside its package does not.

use crate::{cargo, root, succeeds};
use std::path::{Path, PathBuf};
use std::process::{self, Command};
use std::{env, fs, io};

/// In the order in which they are published: each after those that it needs.
pub const PUBLISHED: [&str; 11] = [
    "zfail-plan",
    "zfail",
    "zfail-scene",
    "zfail-builtin",
    "zfail-files",
    "zfail-render",
    "zfail-oracle",
    "zfail-figures",
    "zfail-methods",
    "zfail-view",
    "zfail-cli",
];

/// Packs all of them and checks the packages.
///
/// # Errors
/// If one cannot be packed or does not build on its own.
pub fn run() -> Result<(), String> {
    let packing = PUBLISHED.iter().flat_map(|name| ["--package", name]);
    let mut pack = cargo();
    // Cargo would build each by itself, with all that it depends on; below they are built together, once.
    pack.args(["package", "--no-verify", "--allow-dirty"]).args(packing);
    succeeds(&mut pack)?;

    let fault = |path: &Path, e: &io::Error| format!("cannot write {}: {e}", path.display());
    let scratch = Scratch::new().map_err(|e| format!("cannot make a temporary folder: {e}"))?;
    let scratch = &scratch.0;
    let version = env!("CARGO_PKG_VERSION");
    for name in PUBLISHED {
        let package = root().join("target/package").join(format!("{name}-{version}.crate"));
        succeeds(Command::new("tar").arg("-xzf").arg(&package).arg("-C").arg(scratch))?;
    }
    let workspace =
        fs::read_to_string(root().join("Cargo.toml")).map_err(|e| format!("cannot read Cargo.toml: {e}"))?;
    let manifest = scratch.join("Cargo.toml");
    fs::write(&manifest, scratch_manifest(version, &workspace)).map_err(|e| fault(&manifest, &e))?;
    let lock = scratch.join("Cargo.lock");
    fs::copy(root().join("Cargo.lock"), &lock).map_err(|e| fault(&lock, &e))?;
    let mut check = cargo();
    // What others' crates have been built to is of use here, too; what ours are built to here never is again.
    check.env("CARGO_INCREMENTAL", "0");
    check.args(["check", "--workspace", "--manifest-path"]).arg(&manifest).arg("--target-dir").arg(target());
    succeeds(&mut check)
}

/// A new folder outside of the workspace, gone again when this is dropped.
struct Scratch(PathBuf);

impl Scratch {
    fn new() -> io::Result<Self> {
        let mut number = 0;
        loop {
            let folder = env::temp_dir().join(format!("zfail-packages-{}-{number}", process::id()));
            match fs::create_dir(&folder) {
                Err(e) if e.kind() == io::ErrorKind::AlreadyExists => number += 1,
                made => return made.map(|()| Self(folder)),
            }
        }
    }
}

impl Drop for Scratch {
    fn drop(&mut self) {
        // What is left there is in nobody's way.
        let _ = fs::remove_dir_all(&self.0);
    }
}

/// A workspace of the unpacked packages that takes each from the others, and builds in the profiles of `workspace`.
fn scratch_manifest(version: &str, workspace: &str) -> String {
    let folders = PUBLISHED.map(|name| format!("{name}-{version}"));
    let members = folders.iter().map(|folder| format!("\"{folder}\"")).collect::<Vec<_>>().join(", ");
    let patches: String =
        PUBLISHED.iter().zip(&folders).map(|(name, folder)| format!("{name} = {{ path = \"{folder}\" }}\n")).collect();
    let profiles = workspace.find("[profile.dev]").map_or("", |start| &workspace[start..]);
    let profiles = profiles.replace("[profile.dev.package.xtask]\nopt-level = 1\n", "");
    format!("[workspace]\nresolver = \"3\"\nmembers = [{members}]\n\n[patch.crates-io]\n{patches}\n{profiles}")
}

fn target() -> PathBuf {
    root().join("target")
}

#[cfg(test)]
mod tests {
    use super::{PUBLISHED, Scratch, root, scratch_manifest};
    use std::fs;

    /// The manifests of the workspace's crates by name.
    fn manifests() -> Vec<(String, String)> {
        let crates = fs::read_dir(root().join("crates")).unwrap();
        let read = |entry: fs::DirEntry| {
            let text = fs::read_to_string(entry.path().join("Cargo.toml")).unwrap();
            (entry.file_name().to_string_lossy().into_owned(), text)
        };
        crates.map(|entry| read(entry.unwrap())).collect()
    }

    /// What is wrong with a crate that is published.
    fn faults(name: &str, manifest: &str) -> Vec<&'static str> {
        let has = |what: &str| manifest.contains(what);
        let folder = root().join("crates").join(name);
        [
            (!has("readme = "), "no readme"),
            (!has("keywords = [") || !has("categories = ["), "no keywords or categories"),
            (!has("include = ["), "no list of what is packed"),
            (!has("[package.metadata.docs.rs]"), "nothing for docs.rs"),
            (!folder.join("README.md").is_file(), "its readme is missing"),
            (!["MIT", "APACHE"].iter().all(|l| folder.join(format!("LICENSE-{l}")).is_file()), "no licence"),
        ]
        .into_iter()
        .filter_map(|(wrong, why)| wrong.then_some(why))
        .collect()
    }

    #[test]
    fn every_crate_is_published_with_all_it_needs_or_says_that_it_is_not() {
        for (name, manifest) in manifests() {
            let private = manifest.contains("publish = false");
            assert_ne!(private, PUBLISHED.contains(&name.as_str()), "{name}");
            if !private {
                assert_eq!(faults(&name, &manifest), [""; 0], "{name}");
            }
        }
        assert_eq!(faults("none", "[package]").len(), 6, "faults are found");
    }

    #[test]
    fn each_is_published_after_what_it_needs() {
        // Those of tests as well: a registry wants them where they have a version.
        let needs = |manifest: &str, other: &str| {
            let key = |line: &str| line.strip_prefix(other).is_some_and(|rest| rest.starts_with(['.', ' ']));
            manifest.lines().any(key)
        };
        let in_order = |order: &[&str]| {
            manifests().iter().all(|(name, manifest)| {
                let place = |name: &str| order.iter().position(|other| *other == name);
                order
                    .iter()
                    .all(|other| place(name) >= place(other) || place(name).is_none() || !needs(manifest, other))
            })
        };
        assert!(in_order(&PUBLISHED));
        let mut backwards = PUBLISHED;
        backwards.reverse();
        assert!(!in_order(&backwards));
    }

    #[test]
    fn versions_agree_wherever_they_stand() {
        let read = |path: &str| fs::read_to_string(root().join(path)).unwrap();
        let workspace = read("Cargo.toml");
        let version = env!("CARGO_PKG_VERSION");
        for name in &PUBLISHED[..10] {
            let line = workspace.lines().find(|line| line.starts_with(&format!("{name} = "))).unwrap();
            assert!(line.contains(&format!("version = \"={version}\"")), "{line}");
        }
        let value = |key: &str| {
            let line = workspace.lines().find(|line| line.starts_with(key)).unwrap();
            line.split('"').find(|part| part.starts_with(char::is_numeric)).unwrap().to_owned()
        };
        let minor = version.rsplit_once('.').unwrap().0;
        let row = format!("| {minor} | {} | {} |", value("wgpu = "), value("rust-version = "));
        for table in ["README.md", "crates/zfail/README.md"] {
            assert!(read(table).contains(&row), "{table} has no row {row:?}");
        }
        assert!(!read("CONTRIBUTING.md").contains(&row), "the row is looked for");
    }

    #[test]
    fn every_run_has_a_folder_of_its_own_and_leaves_none() {
        let (a, b) = (Scratch::new().unwrap(), Scratch::new().unwrap());
        assert!(a.0 != b.0 && a.0.is_dir() && !a.0.starts_with(root()));
        fs::write(a.0.join("file"), "").unwrap();
        let gone = a.0.clone();
        drop(a);
        assert!(!gone.exists() && b.0.is_dir());
    }

    #[test]
    fn the_scratch_workspace_has_every_package_and_the_profiles() {
        let manifest = scratch_manifest("1.2.3", "[workspace]\nmembers = [\"x\"]\n[profile.dev]\nopt-level = 2\n");
        assert!(PUBLISHED.iter().all(|name| manifest.contains(&format!("{name} = {{ path = \"{name}-1.2.3\" }}"))));
        assert!(manifest.ends_with("[profile.dev]\nopt-level = 2\n") && !manifest.contains("\"x\""));
    }
}
