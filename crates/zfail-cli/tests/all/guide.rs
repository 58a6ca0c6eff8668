//! What the guide shows of methods that go wrong, beside what the tests of `zfail compare` hold.

use crate::support::{has_gpu, zfail};
use serde_json::Value;

/// Wrong pixels of methods on a scene.
fn wrong_pixels(scene: &str, more: &[&str], methods: &[&str]) -> Vec<u64> {
    let folder = tempfile::tempdir().unwrap();
    let methods_option = methods.join(",");
    let args = ["compare", scene, "-q", "-o", "out", "--json", "--size", "160x100", "--method", &methods_option];
    let run = zfail(folder.path(), &[&args, more].concat()).ok();
    let record: Value = serde_json::from_str(&run.stdout).unwrap();
    let rows = record["methods"].as_array().unwrap();
    assert!(rows.iter().map(|row| row["method"].as_str().unwrap()).eq(methods.iter().copied()), "{rows:?}");
    rows.iter().map(|row| row["result"]["wrong_pixels"].as_u64().unwrap()).collect()
}

/// E&K section 2.2.3: "when a light source is arbitrarily close to a single occluder polygon, any finite distance (...) may
/// not extend far enough".
#[test]
fn a_close_lamp_outreaches_finite_volumes() {
    if !has_gpu() {
        return;
    }
    let scene = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/guide/scenes/close-lamp.gltf");
    let methods = ["carmack-preload", "finite-z-fail", "everitt-kilgard", "zfail"];
    let [preload, finite, infinite, ours] = wrong_pixels(scene, &[], &methods)[..] else { panic!("four rows") };
    assert!(preload > 5000 && finite > 5000, "{preload} {finite}");
    assert_eq!([infinite, ours], [0, 0]);
}

/// E&K section 4.1, McGuire et al. section 4: a multiple of 256 layers counts to none, "quite unlikely".
#[test]
fn a_pile_of_256_sheets_wraps() {
    if !has_gpu() {
        return;
    }
    let methods = ["everitt-kilgard", "zfail"];
    // Light 1 shines on the pile of 256.
    let [eight_bits, batches] = wrong_pixels("builtin:stacked", &["--light", "1"], &methods)[..] else {
        panic!("two rows")
    };
    assert!(eight_bits > 50, "{eight_bits}");
    assert_eq!(batches, 0);
}

/// McGuire et al. section 4: "every 256th stair to appear unshadowed".
#[test]
fn the_256th_of_many_steps_wraps() {
    if !has_gpu() {
        return;
    }
    let scene = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/guide/scenes/long-stairs.gltf");
    let [eight_bits, batches] = wrong_pixels(scene, &["--light", "0"], &["everitt-kilgard", "zfail"])[..] else {
        panic!("two rows")
    };
    assert!(eight_bits > 500, "{eight_bits}");
    assert_eq!(batches, 0);
}
