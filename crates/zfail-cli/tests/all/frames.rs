//! `zfail render --frames`: whatever happens to a run, the next one ends with the files of an undisturbed one.

use crate::support::{self, command, files, has_gpu, small_scene, zfail};
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::process::Stdio;
use std::thread::sleep;
use std::time::Instant;

const COUNT: usize = 6;

/// A command whose every frame has a picture and two masks.
const RENDER: [&str; 14] = [
    "render",
    "small.gltf",
    "--fps",
    "3",
    "--size",
    "64x48",
    "--light",
    "0",
    "--light",
    "1",
    "-o",
    "frames/%04d.png",
    "--aov",
    "shadow=masks/%d",
];
const ALL: [&str; 2] = ["--frames", "0..6"];

fn render(folder: &Path, more: &[&str]) -> support::Run {
    zfail(folder, &[&RENDER[..], more].concat()).ok()
}

/// Every file below `folder` by path, with its bytes and the time of its last change.
fn contents(folder: &Path) -> BTreeMap<String, (Vec<u8>, std::time::SystemTime)> {
    let mut found = BTreeMap::new();
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        let name = entry.file_name().to_string_lossy().into_owned();
        if entry.path().is_dir() {
            found.extend(contents(&entry.path()).into_iter().map(|(inner, file)| (format!("{name}/{inner}"), file)));
        } else {
            found.insert(name, (fs::read(entry.path()).unwrap(), entry.metadata().unwrap().modified().unwrap()));
        }
    }
    found
}

fn bytes(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    contents(folder).into_iter().map(|(name, (bytes, _))| (name, bytes)).collect()
}

#[test]
fn a_frame_is_the_picture_of_its_time() {
    if !has_gpu() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    small_scene(folder.path());
    assert_eq!(render(folder.path(), &[&ALL[..], &["--exposure", "0.5"]].concat()).stderr, "");
    let pixels = |file: &str| image::open(folder.path().join(file)).unwrap().into_rgb8();
    let mut distinct = Vec::new();
    for (k, time) in ["0", "0.3333333333333333", "0.6666666666666666", "1", "1.3333333333333333", "1.6666666666666667"]
        .into_iter()
        .enumerate()
    {
        let args =
            ["--size", "64x48", "--light", "0", "--light", "1", "-o", "still.png", "--time", time, "--exposure", "0.5"];
        zfail(folder.path(), &[&["render", "small.gltf"][..], &args].concat()).ok();
        let frame = pixels(&format!("frames/{k:04}.png"));
        assert_eq!(frame, pixels("still.png"), "frame {k}");
        assert_eq!(files(&folder.path().join(format!("masks/{k}"))), ["light-0.png", "light-1.png"]);
        assert!(!distinct.contains(&frame), "frame {k} is like one before");
        distinct.push(frame);
    }
    assert_eq!(files(&folder.path().join("frames")).len(), COUNT);

    // Beyond the end of the animation the last moment stays, as with --time.
    let more = ["render", "small.gltf", "--frames", "5..8", "--fps", "3", "--size", "8x8", "-o", "late-%d.png"];
    let note = zfail(folder.path(), &more).ok().stderr;
    assert_eq!(note, "zfail: note: the animation 'glide' ends after 2.000 s: frames after number 6 are alike\n");
    assert_eq!(pixels("late-6.png"), pixels("late-7.png"));
}

#[test]
fn frames_are_exposed_alike_whichever_are_asked_for() {
    if !has_gpu() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    small_scene(folder.path());
    let scene = ["render", "small.gltf", "--animation", "sunset", "--camera", "1", "--light", "0", "--size", "64x48"];
    let run = |more: &[&str]| zfail(folder.path(), &[&scene[..], more].concat()).ok();
    // The sky, above the scene.
    let color = |file: &str| image::open(folder.path().join(file)).unwrap().into_rgb8().get_pixel(0, 0).0;
    let frames = |range: &str| run(&["--frames", range, "--fps", "2.5", "-o", "frames/%d.png"]);
    frames("0..6");
    let whole = bytes(&folder.path().join("frames"));
    let colors: Vec<[u8; 3]> = (0..COUNT).map(|k| color(&format!("frames/{k}.png"))).collect();
    assert!(colors.iter().all(|color| *color == colors[0]), "{colors:?}");
    assert_ne!(whole["0.png"], whole["5.png"], "the sun has gone down");
    // Stills are exposed each by itself.
    let still = |time: &str| {
        run(&["--time", time, "-o", "still.png"]);
        color("still.png")
    };
    assert_ne!(still("0"), still("2"), "the comparison can fail");
    // A run that is asked for the last frames alone makes the same ones.
    fs::remove_dir_all(folder.path().join("frames")).unwrap();
    frames("4..6");
    for name in ["4.png", "5.png"] {
        assert_eq!(fs::read(folder.path().join("frames").join(name)).unwrap(), whole[name], "{name}");
    }
}

#[test]
fn a_run_killed_at_any_moment_is_completed_by_the_next() {
    if !has_gpu() {
        return;
    }
    let (calm, stormy) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
    small_scene(calm.path());
    small_scene(stormy.path());
    let start = Instant::now();
    render(calm.path(), &ALL);
    let whole = start.elapsed();
    // From before the first file to near the end.
    let mut unfinished = 0;
    for kill in 1..=6 {
        let mut run = command(stormy.path(), &[&RENDER[..], &ALL].concat());
        let mut run = run.stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
        sleep(whole * kill / 7);
        let _ = run.kill();
        run.wait().unwrap();
        let pictures = files(stormy.path()).contains(&"frames".to_owned());
        let pictures = if pictures { files(&stormy.path().join("frames")).len() } else { 0 };
        unfinished += usize::from(pictures < COUNT);
        // Nothing half done has a name that somebody could take for a result.
        for (name, bytes) in bytes(stormy.path()).iter().filter(|(name, _)| name.ends_with(".png")) {
            assert!(image::load_from_memory(bytes).is_ok(), "{name}");
        }
    }
    assert!(unfinished > 0, "no run was killed before its end");
    render(stormy.path(), &ALL);
    assert_eq!(bytes(stormy.path()), bytes(calm.path()));
}

#[test]
fn only_whole_answers_to_the_same_request_are_kept() {
    if !has_gpu() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    small_scene(folder.path());
    render(folder.path(), &ALL);
    let first = contents(folder.path());
    let file = |name: &str| folder.path().join(name);
    // Runs again; returns which pictures changed on the disk.
    let again = |more: &[&str]| -> Vec<usize> {
        let before = contents(folder.path());
        render(folder.path(), more);
        let after = contents(folder.path());
        (0..COUNT).filter(|k| after[&format!("frames/{k:04}.png")] != before[&format!("frames/{k:04}.png")]).collect()
    };
    let note = render(folder.path(), &ALL).stderr;
    assert_eq!(note, "zfail: note: 6 of 6 frames are there already and are kept\n");
    assert_eq!(again(&ALL), [0; 0]);

    let picture = first["frames/0002.png"].0.clone();
    fs::write(file("frames/0002.png"), &picture[..picture.len() - 1]).unwrap();
    fs::write(file("frames/0003.png"), &picture).unwrap();
    assert_eq!(again(&ALL), [2, 3], "one is cut off, and one is another frame");
    fs::write(file("masks/1/light-1.png"), &first["masks/1/light-0.png"].0).unwrap();
    fs::remove_file(file("masks/4/light-0.png")).unwrap();
    fs::write(file("masks/4/.zfail-abcdef.part"), "left behind").unwrap();
    assert_eq!(again(&ALL), [1, 4], "what lies beside the picture counts");
    assert_eq!(bytes(folder.path()), first.iter().map(|(n, (b, _))| (n.clone(), b.clone())).collect());

    assert_eq!(again(&["--frames", "3..9"]), [0; 0], "other frames of the same animation");
    assert_eq!(files(&file("frames")).len(), 9);
    assert_eq!(again(&[&ALL[..], &["--technique", "everitt-kilgard"]].concat()), [0, 1, 2, 3, 4, 5], "another command");
    let scene = fs::read_to_string(file("small.gltf")).unwrap();
    fs::write(file("small.gltf"), scene.replace("\"intensity\":2.0", "\"intensity\":3.0")).unwrap();
    assert_eq!(again(&[&ALL[..], &["--technique", "everitt-kilgard"]].concat()), [0, 1, 2, 3, 4, 5], "another scene");
}
