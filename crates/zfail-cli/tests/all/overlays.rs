//! `zfail render --overlay`: pictures with figures on them.

use crate::support::{self, files, has_gpu, small_scene, zfail};
use std::fs;
use std::path::Path;

const RENDER: [&str; 4] = ["render", "small.gltf", "--size", "64x48"];

fn render(folder: &Path, more: &[&str]) -> support::Run {
    zfail(folder, &[&RENDER[..], more].concat())
}

#[test]
fn kinds_change_the_picture_in_their_own_ways() {
    if !has_gpu() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    small_scene(folder.path());
    let picture = |more: &[&str]| {
        render(folder.path(), &[&["--camera", "aside", "-o", "out.png"][..], more].concat()).ok();
        image::open(folder.path().join("out.png")).unwrap().into_rgb8()
    };
    let mut seen = vec![picture(&[])];
    for kind in ["volumes", "silhouettes", "stencil", "alternate", "clip-space"] {
        let figure = picture(&["--overlay", kind]);
        assert!(!seen.contains(&figure), "{kind}");
        seen.push(figure);
    }
    assert_eq!(picture(&["--overlay", "volumes", "--samples", "4"]).dimensions(), (64, 48));
    let both = picture(&["--overlay", "stencil,wireframe"]);
    assert_eq!(picture(&["--overlay", "stencil", "--overlay", "wireframe"]), both);
    assert!(!seen.contains(&both));
    assert_ne!(picture(&["--overlay", "stencil", "--light", "1"]), seen[3], "the first light chosen counts");
    let one = picture(&["--overlay", "stencil", "--overlay-light", "1"]);
    assert!(one != seen[3] && one != picture(&["--overlay", "stencil", "--light", "1"]), "all shine, and one is shown");
    let usual = picture(&["--overlay", "alternate"]);
    assert_ne!(picture(&["--overlay", "alternate", "--overlay-from=-60,10"]), usual);
}

#[test]
fn overlays_that_cannot_be_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    small_scene(folder.path());
    render(folder.path(), &["-o", "out.exr", "--overlay", "cases"]).fails(2, &["out.exr", ".png", "tone-mapped"]);
    let numbered = ["-o", "%d.exr", "--frames", "0..2", "--overlay", "cases"];
    render(folder.path(), &numbered).fails(2, &[".png"]);
    render(folder.path(), &["-o", "out.png", "--overlay", "volume"]).fails(2, &["volume", "volumes"]);
    render(folder.path(), &["-o", "out.png", "--overlay", "cases", "--overlay-from", "1"]).fails(2, &["YAW"]);
    assert_eq!(files(folder.path()), ["small.bin", "small.gltf"]);
}

#[test]
fn frames_have_overlays_and_are_told_apart_by_them() {
    if !has_gpu() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    small_scene(folder.path());
    let sunset = ["--frames", "0..2", "--fps", "0.5", "--animation", "sunset", "--camera", "aside", "-o", "%d.png"];
    let frames = |overlay: &[&str]| {
        let run = render(folder.path(), &[&sunset[..], overlay].concat()).ok();
        ([0, 1].map(|k| fs::read(folder.path().join(format!("{k}.png"))).unwrap()), run.stderr)
    };
    let (plain, _) = frames(&[]);
    let (drawn, note) = frames(&["--overlay", "silhouettes", "--light", "0"]);
    assert_eq!(note, "", "none is kept");
    assert!(drawn[0] != plain[0] && drawn[1] != plain[1] && drawn[0] != drawn[1]);
    let (again, note) = frames(&["--overlay", "silhouettes", "--light", "0"]);
    assert!(note.contains("2 of 2 frames are there already"), "{note}");
    assert!(again == drawn);
}
