//! `zfail info`: what it says about scenes whose facts are known.

mod support;

use serde_json::Value;
use support::{small_scene, zfail};

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
    let animations = serde_json::json!([
        { "name": "glide", "duration": 2.0, "moves": true },
        { "name": "sunset", "duration": 2.0, "moves": true },
    ]);
    assert_eq!(report["animations"], animations);
}

#[test]
fn text_names_everything_that_can_be_chosen() {
    let folder = tempfile::tempdir().unwrap();
    small_scene(folder.path());
    let text = zfail(folder.path(), &["info", "small.gltf"]).ok().stdout;
    for line in [
        "scene 'small': 4 triangles in 1 instance\n",
        "    0  'squares': 4 triangles, 8 vertices (8 distinct points), 0 % closed; 8 boundary, 0 non-manifold",
        "       casts double: 4 triangles in 2 parts",
        "    1  'lamp': point at (1.5 3 0), 40 cd, colour (1 1 1)",
        "    1  'aside': perspective at (0 2 8) towards (0 0 -1), 51.6 degrees high",
        "animations: 2\n    0  'glide': 2.000 s\n    1  'sunset': 2.000 s\n",
        "materials: 1 (1 opaque, 0 mask, 0 blend)",
    ] {
        assert!(text.contains(line), "'{line}' is not in:\n{text}");
    }
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
    }
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
