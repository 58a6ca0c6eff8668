//! `zfail info`: what it says about scenes whose facts are known.

use crate::support::{small_scene, zfail};
use serde_json::Value;

#[test]
fn json_states_the_facts_of_the_small_scene() {
    let folder = tempfile::tempdir().unwrap();
    small_scene(folder.path());
    let report: Value =
        serde_json::from_str(&zfail(folder.path(), &["info", "small.gltf", "--json"]).ok().stdout).unwrap();
    assert_eq!(report["triangles"], 4);
    assert_eq!(report["bounds"], serde_json::json!([[-4.0, 0.0, -4.0], [4.0, 1.0, 4.0]]));
    let mesh = &report["meshes"][0];
    assert_eq!(mesh["name"], "squares");
    assert_eq!((&mesh["vertices"], &mesh["points"], &mesh["triangles"]), (&8.into(), &8.into(), &4.into()));
    assert_eq!((&mesh["closed_share"], &mesh["single_share"]), (&0.0.into(), &0.0.into()));
    assert_eq!((&mesh["boundary_edges"], &mesh["non_manifold_edges"]), (&8.into(), &0.into()));
    assert_eq!(mesh["parts"].as_array().unwrap().len(), 2);
    assert_eq!(mesh["parts"][0]["casting"], "double");
    let kinds: Vec<_> = report["lights"].as_array().unwrap().iter().map(|light| light["kind"].clone()).collect();
    assert_eq!(kinds, ["directional", "point", "spot"]);
    let cameras: Vec<_> = report["cameras"].as_array().unwrap().iter().map(|camera| camera["name"].clone()).collect();
    assert_eq!(cameras, ["above", "aside"]);
    let channels = serde_json::json!({ "nodes": 1, "joints": 0, "weights": 0, "other": 0 });
    let animations = serde_json::json!([
        { "name": "glide", "duration": 2.0, "moves": true, "channels": channels },
        { "name": "sunset", "duration": 2.0, "moves": true, "channels": channels },
    ]);
    assert_eq!(report["animations"], animations);
    let surfaces = serde_json::json!([{ "material": 0, "alpha": "opaque", "casts": true, "triangles": 4 }]);
    assert_eq!(mesh["surfaces"], surfaces);
    let extensions = serde_json::json!([{ "name": "KHR_lights_punctual", "required": false, "treatment": "read" }]);
    assert_eq!(report["extensions"], extensions);
    assert_eq!(report["file"]["version"], "2.0");
    let light = &report["lights"][2];
    assert_eq!(
        (&light["falloff"], &light["cookie"], &light["box"]),
        (&serde_json::json!([]), &Value::Null, &Value::Null)
    );
}

#[test]
fn text_names_everything_that_can_be_chosen() {
    let folder = tempfile::tempdir().unwrap();
    small_scene(folder.path());
    let text = zfail(folder.path(), &["info", "small.gltf"]).ok().stdout;
    for line in [
        "scene 'small': 4 triangles in 1 instance\n",
        "extensions: 1\n  0 KHR_lights_punctual: read\n",
        "  0 'squares': 4 triangles, 8 vertices (8 after welding), 0 % closed\n",
        "      edges: 8 boundary, 0 non-manifold, 0 inconsistently wound\n",
        "      casts double: 4 triangles in 2 parts (it has a border, a fin or\n        inconsistent winding)\n",
        "  1 'lamp': point at (1.5 3 0), 40 cd, colour (1 1 1)\n",
        "  1 'aside': perspective at (0 2 8) towards (0 0 -1), 51.6 degrees high\n",
        "animations: 2\n  0 'glide': 2.000 s, 1 channel of nodes\n  1 'sunset': 2.000 s, 1 channel of nodes\n",
        "materials: 1 (1 opaque, 0 mask, 0 blend)\n  0 'paper': opaque, double-sided\n",
    ] {
        assert!(has_lines(&text, line), "'{line}' is not in:\n{text}");
    }
    assert!(!has_lines(&text, "1 animation\n") && !has_lines("11 wrong\n", "1 wrong\n"), "the comparison can fail");
}

/// Whether whole lines are in a text: "1 light" is not in "11 lights".
fn has_lines(text: &str, lines: &str) -> bool {
    format!("\n{text}").contains(&format!("\n{lines}"))
}

#[test]
fn every_built_in_scene_can_be_described() {
    let folder = tempfile::tempdir().unwrap();
    let listed = zfail(folder.path(), &["info", "builtin:?"]).fails(2, &["there are: "]).stderr;
    let names: Vec<&str> = listed.split("there are: ").nth(1).unwrap().trim().split(", ").collect();
    assert!(names.len() >= 8, "{names:?}");
    for name in names {
        let scene = format!("builtin:{name}");
        let report: Value =
            serde_json::from_str(&zfail(folder.path(), &["info", "--json", &scene]).ok().stdout).unwrap();
        assert!(report["triangles"].as_u64().unwrap() > 0, "{name}");
        assert!(!report["lights"].as_array().unwrap().is_empty(), "{name}");
        assert!(!report["cameras"].as_array().unwrap().is_empty(), "{name}");
        let text = zfail(folder.path(), &["info", &scene]).ok().stdout;
        assert!(text.lines().all(|line| line.chars().count() <= 80), "{text}");
        assert!(text.lines().count() < 150, "{text}");
    }
}

#[test]
fn lights_have_their_shapes() {
    let folder = tempfile::tempdir().unwrap();
    let json = zfail(folder.path(), &["info", "--json", "builtin:lantern"]).ok().stdout;
    let report: Value = serde_json::from_str(&json).unwrap();
    let lights = report["lights"].as_array().unwrap();
    let with = |has: fn(&Value) -> bool| lights.iter().filter(|light| has(light)).count();
    assert!(with(|light| light["falloff"].as_array().unwrap().len() > 1) > 0);
    assert!(with(|light| light["cookie"].is_u64()) > 0);
    assert!(with(|light| light["box"].as_array().is_some_and(|half| half.len() == 3)) > 0);
    let text = zfail(folder.path(), &["info", "builtin:lantern"]).ok().stdout;
    for words in ["falloff by", "cookie texture", ", box ("] {
        assert!(text.split_whitespace().collect::<Vec<_>>().join(" ").contains(words), "'{words}' is not in:\n{text}");
    }
}

#[test]
fn skins_morphs_and_extensions_of_a_file_are_named() {
    let folder = tempfile::tempdir().unwrap();
    let path = small_scene(folder.path());
    let mut gltf: Value = serde_json::from_slice(&std::fs::read(&path).unwrap()).unwrap();
    gltf["skins"] = serde_json::json!([{ "joints": [1, 2] }]);
    gltf["meshes"][0]["primitives"][0]["targets"] = serde_json::json!([{ "NORMAL": 1 }, { "NORMAL": 1 }]);
    gltf["extensionsUsed"] = serde_json::json!(["KHR_lights_punctual", "KHR_materials_anisotropy"]);
    std::fs::write(&path, gltf.to_string()).unwrap();
    let report: Value =
        serde_json::from_str(&zfail(folder.path(), &["info", "small.gltf", "--json"]).ok().stdout).unwrap();
    assert_eq!(report["file"]["skins"], serde_json::json!([{ "joints": 2 }]));
    assert_eq!(report["file"]["morphs"], serde_json::json!([{ "mesh": "squares", "targets": 2 }]));
    // The camera that glides is a joint now, and the sun is not.
    assert_eq!(report["animations"][0]["channels"]["joints"], 1);
    assert_eq!(report["animations"][1]["channels"]["nodes"], 1);
    let treatment = report["extensions"][1]["treatment"].as_str().unwrap();
    assert!(treatment != "read" && treatment.starts_with(char::is_lowercase), "{treatment}");
    let text = zfail(folder.path(), &["info", "small.gltf"]).ok().stdout;
    assert!(has_lines(&text, "1 skin with 2 joints\n1 mesh with 2 morph targets\n"), "{text}");
}

#[test]
fn masked_surfaces_are_cut_unless_told_otherwise() {
    let folder = tempfile::tempdir().unwrap();
    let tree = |masks: &[&str]| -> Value {
        let args = [&["info", "builtin:foliage", "--json"][..], masks].concat();
        let report: Value = serde_json::from_str(&zfail(folder.path(), &args).ok().stdout).unwrap();
        let meshes = report["meshes"].as_array().unwrap();
        meshes.iter().find(|mesh| mesh["name"] == "tree").unwrap().clone()
    };
    let number = |mesh: &Value, what: &str| mesh[what].as_u64().unwrap();
    let (cut, fine) = (tree(&[]), tree(&["--alpha-shadows", "cut=0.25"]));
    let (solid, off) = (tree(&["--alpha-shadows", "solid"]), tree(&["--alpha-shadows", "off"]));
    assert!(number(&fine, "triangles") > number(&cut, "triangles"));
    assert!(number(&cut, "triangles") > 4 * number(&solid, "triangles"));
    assert_eq!(number(&solid, "triangles"), number(&off, "triangles"));
    assert_eq!((number(&cut, "not_casting"), number(&solid, "not_casting")), (0, 0));
    assert!(number(&off, "not_casting") > 100);
}
