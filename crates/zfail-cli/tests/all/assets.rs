//! The program on real and on broken files, where they are at hand: `$ZFAIL_ASSETS`, or `shared/assets` beside the
//! checkout.

use crate::support::{self, Run, has_gpu, zfail};
use std::env;
use std::fs;
use std::path::{Path, PathBuf};

/// The glTF files below `folder` of the assets, or `None`, with a printed reason, where there are none.
fn scenes(folder: &str) -> Option<Vec<PathBuf>> {
    let beside = concat!(env!("CARGO_MANIFEST_DIR"), "/../../../shared/assets");
    let assets = env::var_os("ZFAIL_ASSETS").map_or_else(|| PathBuf::from(beside), PathBuf::from).join(folder);
    let subfolders = fs::read_dir(&assets).into_iter().flatten().flatten().map(|entry| entry.path());
    let files = subfolders.flat_map(|folder| fs::read_dir(folder).into_iter().flatten().flatten());
    let is_scene = |path: &PathBuf| path.extension().is_some_and(|extension| extension == "glb" || extension == "gltf");
    let mut scenes: Vec<_> = files.map(|entry| entry.path()).filter(is_scene).collect();
    scenes.sort();
    if scenes.is_empty() {
        eprintln!("skipped: no scenes in {}", assets.display());
        return None;
    }
    Some(scenes)
}

/// Asserts that a run ends in one of the ways that are allowed for a file nobody vouches for; returns its error line.
fn ends_cleanly(run: Run, scene: &Path) -> Option<String> {
    match run.code {
        Some(0) => None,
        _ => Some(run.fails(1, &[&scene.to_string_lossy()]).stderr),
    }
}

#[test]
fn broken_files_give_a_report_or_one_line() {
    let Some(scenes) = scenes("invalid") else { return };
    let folder = tempfile::tempdir().unwrap();
    let mut refused = 0;
    for scene in &scenes {
        let refusal = ends_cleanly(zfail(folder.path(), &["info", &scene.to_string_lossy()]), scene);
        let must_load = scene.parent().is_some_and(|folder| folder.ends_with("edge-valid"));
        assert!(!must_load || refusal.is_none(), "{}: {refusal:?}", scene.display());
        refused += usize::from(refusal.is_some());
    }
    assert!(refused > 0, "some of {} broken files must be refused", scenes.len());
}

#[test]
fn real_files_render_or_name_the_extension_that_they_need() {
    let Some(scenes) = scenes("") else { return };
    if !has_gpu() {
        return;
    }
    for scene in &scenes {
        let folder = tempfile::tempdir().unwrap();
        let args =
            ["render", &scene.to_string_lossy(), "-o", "a.png", "--size", "64x48", "--quiet", "--aov", "shadow=m"];
        match ends_cleanly(zfail(folder.path(), &args), scene) {
            None => assert!(folder.path().join("a.png").exists() && folder.path().join("m/light-0.png").exists()),
            Some(line) => {
                assert!(line.contains("extension"), "{line}");
                assert!(support::files(folder.path()).is_empty());
            }
        }
    }
}
