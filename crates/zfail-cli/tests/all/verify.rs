//! `zfail verify` and `zfail adapters` on the machine's adapter.

use crate::support::{files, has_gpu, small_scene, zfail};
use serde_json::Value;
use std::fs;

const TECHNIQUES: [&str; 5] = ["everitt-kilgard", "lengyel", "mcguire", "auto", "auto-on-device"];

#[test]
fn hard_scenes_pass_and_say_what_was_checked() {
    if !has_gpu() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    for (scene, lights) in [("builtin:jail", 2), ("builtin:nested", 3), ("builtin:open", 2)] {
        let run = zfail(folder.path(), &["verify", scene, "--size", "96x54", "--json", "-q"]).ok();
        let report: Value = serde_json::from_str(&run.stdout).unwrap();
        assert_eq!((&report["passed"], &report["suspect"]), (&true.into(), &Value::Null), "{scene}");
        assert_eq!(report["closure"]["open_edges"], 0, "{scene}");
        assert!(report["closure"]["volumes"].as_u64().unwrap() > 10, "{scene}");
        let found = report["lights"].as_array().unwrap();
        assert_eq!(found.len(), lights, "{scene}");
        for light in found {
            let number = |key: &str| light[key].as_u64().unwrap();
            let excluded: u64 = light["excluded"].as_object().unwrap().values().map(|n| n.as_u64().unwrap()).sum();
            let all = number("checked") + number("out_of_reach") + number("background") + excluded;
            assert_eq!(all, 96 * 54, "{scene}");
            assert!(number("lit") > 50 && number("shadowed") > 50, "{scene}: {light}");
            let rows = light["techniques"].as_array().unwrap();
            assert_eq!(rows.iter().map(|row| row["technique"].as_str().unwrap()).collect::<Vec<_>>(), TECHNIQUES);
            assert!(rows.iter().all(|row| row["wrong_pixels"] == 0 && row["wrong_counts"] == 0), "{scene}");
        }
    }
    assert!(files(folder.path()).is_empty());
}

#[test]
fn reports_go_into_folders_of_their_own() {
    if !has_gpu() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    small_scene(folder.path());
    let verify =
        ["verify", "small.gltf", "--size", "64x48", "--technique", "auto", "--light", "1", "--report", "new/r"];
    let run = zfail(folder.path(), &verify).ok();
    let last = run.stdout.lines().last().unwrap();
    assert!(last.starts_with("proved: 0 wrong among "), "{}", run.stdout);
    assert!(run.stdout.contains("light 1 'lamp', point: ") && !run.stdout.contains("light 0"), "{}", run.stdout);
    let report = folder.path().join("new/r");
    assert_eq!(files(&report), ["light-1-checked.png", "light-1-expected.png", "report.json"]);
    let before = fs::read(report.join("report.json")).unwrap();
    zfail(folder.path(), &verify).fails(1, &["'new/r'", "not empty"]);
    assert_eq!(fs::read(report.join("report.json")).unwrap(), before);

    // A camera that is not there is found before anything is written.
    zfail(folder.path(), &["verify", "small.gltf", "--camera", "abov", "--report", "other"]).fails(2, &["'above'"]);
    assert!(!folder.path().join("other").exists());
}

#[test]
fn what_one_picture_does_not_prove_closer_ones_do() {
    if !has_gpu() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let verify = |more: &[&str]| {
        let all =
            [&["verify", "builtin:jail", "--size", "24x14", "--technique", "auto", "--json", "-q"], more].concat();
        zfail(folder.path(), &all)
    };
    let report: Value = serde_json::from_str(&verify(&[]).ok().stdout).unwrap();
    let closeups = report["closeups"].as_array().unwrap();
    assert!(!closeups.is_empty() && closeups.len() < 40, "{}", closeups.len());
    assert_eq!((&report["passed"], &report["proof"]["enough"]), (&true.into(), &true.into()));
    assert_eq!(report["proof"]["views"], 1 + closeups.len());
    for light in report["proof"]["lights"].as_array().unwrap() {
        assert!(light["lit"].as_u64().unwrap() >= 100 && light["shadowed"].as_u64().unwrap() >= 100, "{light}");
    }

    // The picture alone proves too little, which is no success unless that is what was asked for.
    let alone = verify(&["--no-closeups"]);
    assert_eq!(alone.code, Some(1));
    assert!(alone.stderr.starts_with("zfail: error: too little is proved: 0 wrong among "), "{}", alone.stderr);
    let report: Value = serde_json::from_str(&alone.stdout).unwrap();
    assert_eq!((&report["passed"], &report["proof"]["enough"]), (&true.into(), &false.into()));
    verify(&["--no-closeups", "--allow-little-proof"]).ok();
}

#[test]
fn a_picture_without_shadows_proves_too_little_and_says_so() {
    if !has_gpu() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    // A floor that nothing stands on, seen from above, lit from there; closer views would see that it is dark below.
    fs::write(folder.path().join("floor.obj"), "v -1 0 1\nv 1 0 1\nv 1 0 -1\nv -1 0 -1\nf 1 2 3 4\n").unwrap();
    let run =
        zfail(folder.path(), &["verify", "floor.obj", "--size", "64x36", "--technique", "auto", "-q", "--no-closeups"]);
    assert_eq!(run.code, Some(1), "{}", run.stdout);
    let last = run.stdout.lines().last().unwrap();
    assert!(last.starts_with("too little is proved: 0 wrong among "), "{last}");
}

/// 280 discs over a floor, each of 200 triangles around its middle: more layers than 8 bits can count.
#[test]
fn deep_stacks_of_fans_are_right() {
    if !has_gpu() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let (mut vertices, mut faces) =
        (String::from("v -4 -1 4\nv 4 -1 4\nv 4 -1 -4\nv -4 -1 -4\n"), String::from("f 1 2 3 4\n"));
    for disc in 0..280 {
        let (height, first) = (f64::from(disc) * 0.005, 5 + disc * 201);
        vertices += &format!("v 0 {height} 0\n");
        for i in 0..200 {
            let (sin, cos) = (std::f64::consts::TAU * f64::from(i) / 200.0).sin_cos();
            vertices += &format!("v {cos} {height} {sin}\n");
            faces += &format!("f {first} {} {}\n", first + 1 + (i + 1) % 200, first + 1 + i);
        }
    }
    fs::write(folder.path().join("discs.obj"), vertices + &faces).unwrap();
    let verify = ["verify", "discs.obj", "--size", "96x60", "--technique", "everitt-kilgard,auto", "--json", "-q"];
    let report: Value = serde_json::from_str(&zfail(folder.path(), &verify).ok().stdout).unwrap();
    assert_eq!((&report["passed"], &report["proof"]["enough"]), (&true.into(), &true.into()));
}

#[test]
fn adapters_are_listed_in_the_order_of_preference() {
    if !has_gpu() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let list: Value = serde_json::from_str(&zfail(folder.path(), &["adapters", "--json"]).ok().stdout).unwrap();
    let list = list.as_array().unwrap();
    let defaults: Vec<bool> = list.iter().map(|adapter| adapter["default"].as_bool().unwrap()).collect();
    assert!(defaults[0] && defaults[1..].iter().all(|default| !default), "{defaults:?}");
    let text = zfail(folder.path(), &["adapters"]).ok().stdout;
    let name = list[0]["name"].as_str().unwrap();
    assert!(text.starts_with(&format!("{name}  (default)\n  {}", list[0]["backend"].as_str().unwrap())), "{text}");

    // What is listed first is what is used.
    zfail(folder.path(), &["render", "builtin:open", "-o", "a.png", "--size", "8x8", "--stats", "s.json"]).ok();
    let stats: Value = serde_json::from_slice(&fs::read(folder.path().join("s.json")).unwrap()).unwrap();
    assert_eq!((&stats["adapter"], &stats["backend"]), (&list[0]["name"], &list[0]["backend"]));
    zfail(folder.path(), &["adapters", "--adapter", "no such thing"]).fails(1, &["no graphics adapter"]);
}
