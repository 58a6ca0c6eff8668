//! `zfail compare` on the machine's adapter: what it writes, and that the papers are right about the old methods.

use crate::support::{Run, files, has_gpu, small_scene, zfail};
use image::ImageReader;
use serde_json::Value;
use std::fs;
use std::path::Path;

fn compare(folder: &Path, args: &[&str]) -> Run {
    zfail(folder, &[&["compare", "-q", "-o", "out"], args].concat())
}

/// The table of a run with `--json`: method and number of wrong pixels, `None` where it does not run.
fn wrong_pixels(run: &Run) -> Vec<(String, Option<u64>)> {
    let record: Value = serde_json::from_str(&run.stdout).unwrap();
    let row = |row: &Value| (row["method"].as_str().unwrap().to_owned(), row["result"]["wrong_pixels"].as_u64());
    record["methods"].as_array().unwrap().iter().map(row).collect()
}

/// Who is wrong on which scene. All methods that are not named must have no wrong pixel at all, shadow maps and ray
/// queries apart: those are wrong by their nature, more or less.
#[test]
fn hard_scenes() {
    if !has_gpu() {
        return;
    }
    const Z_PASS: [&str; 2] = ["heidmann-two-pass", "heidmann-two-sided"];
    let cases: &[(&[&str], &[&str])] = &[
        // The eye is in the light: Heidmann's case, and the control of the next ones.
        (&["builtin:room", "--light", "0"], &[]),
        // The near rectangle is in shadow (E&K section 2.2.2); as deep as the eye, which is all that Moller & Haines need.
        (&["builtin:cathedral", "--light", "1"], &[Z_PASS[0], Z_PASS[1], "inverted-test"]),
        // Volumes cut through the near rectangle: "no uniform adjustment" (McG section 3).
        (&["builtin:nested", "--light", "0"], &[Z_PASS[0], Z_PASS[1], "inverted-test", "eye-count"]),
        // The far plane cuts volumes off: "only moved the problem to the far clipping plane" (McG section 3).
        (
            &["builtin:cathedral", "--light", "0", "--finite", "far=20"],
            &["carmack-preload", "carmack-preload-near", "finite-z-fail"],
        ),
        // 256 layers alias with none (E&K section 4.1), unless counts saturate, as Heidmann's do; saturating from behind, as
        // E&K section 3.3 prints it, what 255 cuts off is missing.
        (
            &["builtin:stacked", "--light", "1"],
            &[
                Z_PASS[1],
                "inverted-test",
                "eye-count",
                "carmack-preload",
                "carmack-preload-near",
                "finite-z-fail",
                "near-caps",
                "everitt-kilgard-two-pass",
                "everitt-kilgard",
            ],
        ),
    ];
    let folder = tempfile::tempdir().unwrap();
    for (args, expected) in cases {
        let run = compare(folder.path(), &[*args, &["--size", "160x100", "--json"]].concat()).ok();
        let rows = wrong_pixels(&run);
        let stencil = rows.iter().filter(|(name, _)| !["shadow-map", "ray-query"].contains(&name.as_str()));
        let wrong: Vec<&str> =
            stencil.filter(|(_, n)| n.is_some_and(|n| n > 0)).map(|(name, _)| name.as_str()).collect();
        assert_eq!(wrong, *expected, "{args:?}: {rows:?}");
        for exact in ["lengyel", "mcguire", "zfail"] {
            assert!(rows.contains(&(exact.to_owned(), Some(0))), "{args:?}: {rows:?}");
        }
    }
}

#[test]
fn methods_are_compared_on_everything_that_is_seen() {
    if !has_gpu() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    small_scene(folder.path());
    let args = ["small.gltf", "--size", "64x48", "--light", "1", "--method", "zfail,everitt-kilgard", "--json"];
    let plain = compare(folder.path(), &args).ok();
    let path = folder.path().join("small.gltf");
    let mut file: Value = serde_json::from_str(&fs::read_to_string(&path).unwrap()).unwrap();
    for node in file["nodes"].as_array_mut().unwrap() {
        node["extras"]["receiveShadow"] = false.into();
    }
    fs::write(&path, file.to_string()).unwrap();
    let exempt = compare(folder.path(), &args).ok();
    let said = zfail(folder.path(), &[&["compare", "-o", "loud"][..], &args].concat()).ok().stderr;
    assert!(said.contains("receive no shadow elsewhere"), "{said}");
    let expected = [("everitt-kilgard".to_owned(), Some(0)), ("zfail".to_owned(), Some(0))];
    assert_eq!((wrong_pixels(&plain), wrong_pixels(&exempt)), (expected.to_vec(), expected.to_vec()));
}

#[test]
fn it_writes_a_page_a_sheet_and_the_table() {
    if !has_gpu() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    small_scene(folder.path());
    let args = ["small.gltf", "--size", "64x48", "--light", "1", "--method", "zfail,everitt-kilgard"];
    let run = compare(folder.path(), &[&args[..], &["--json"]].concat()).ok();
    let out = folder.path().join("out");
    assert_eq!(files(&out), ["compare.json", "contact-sheet.png", "index.html"]);
    assert_eq!(fs::read_to_string(out.join("compare.json")).unwrap(), run.stdout);
    // The order is that of history.
    let expected = [("everitt-kilgard".to_owned(), Some(0)), ("zfail".to_owned(), Some(0))];
    assert_eq!(wrong_pixels(&run), expected);
    let record: Value = serde_json::from_str(&run.stdout).unwrap();
    assert_eq!((&record["camera"], &record["size"]), (&"above".into(), &serde_json::json!([64, 48])));
    assert_eq!(record["lights"].as_array().unwrap().len(), 1);
    assert!(record["verdicts"].as_u64().unwrap() > 2500);
    let result = &record["methods"][0]["result"];
    for key in ["triangles", "vertices", "fragments", "passes"] {
        assert!(result[key].as_u64().unwrap() > 0, "{key}: {result}");
    }
    assert!(result["render_ms"].as_f64().unwrap() > 0.0);
    let sheet = ImageReader::open(out.join("contact-sheet.png")).unwrap().decode().unwrap();
    assert!(sheet.width() > 3 * 240, "three pictures of at least 240 pixels");

    let text = compare(folder.path(), &args).ok().stdout;
    assert!(text.lines().any(|line| line.starts_with("zfail  ")), "{text}");
}

#[test]
fn nothing_is_written_on_failure() {
    let folder = tempfile::tempdir().unwrap();
    small_scene(folder.path());
    fs::write(folder.path().join("file"), "").unwrap();
    let before = files(folder.path());
    compare(folder.path(), &["small.gltf", "--camera", "abov"]).fails(2, &["did you mean 'above'"]);
    compare(folder.path(), &["small.gltf", "--light", "7"]).fails(2, &["'7'", "0 'sun'"]);
    compare(folder.path(), &["small.gltf", "--adapter", "no such thing"]).fails(1, &["no graphics adapter"]);
    zfail(folder.path(), &["compare", "missing.glb", "-o", "file"]).fails(1, &["'file'", "not a folder"]);
    assert_eq!(files(folder.path()), before);
}
