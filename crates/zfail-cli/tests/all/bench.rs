//! `zfail bench`: a record for every variant, in the shape of the contract.

use crate::support::{has_gpu, small_scene, zfail};
use serde_json::Value;

const TINY: [&str; 4] = ["--size", "48x27", "--frames", "3"];

fn records(args: &[&str]) -> Vec<Value> {
    let folder = tempfile::tempdir().unwrap();
    small_scene(folder.path());
    let run = zfail(folder.path(), &[&["bench", "--json"][..], &TINY, args].concat()).ok();
    serde_json::from_str(&run.stdout).unwrap()
}

fn number(record: &Value, pointer: &str) -> f64 {
    record.pointer(pointer).and_then(Value::as_f64).unwrap_or_else(|| panic!("{pointer} of {record}"))
}

#[test]
fn every_variant_has_a_record_of_the_contracts_shape() {
    if !has_gpu() {
        return;
    }
    let records = records(&["small.gltf", "builtin:container"]);
    let keys = [
        "scene",
        "technique",
        "shadows",
        "size",
        "samples",
        "frames",
        "cpu_ms",
        "wall_ms",
        "gpu_ms",
        "planning_ms",
        "triangles",
        "vertices",
        "fragments",
        "cases",
    ];
    let mut variants = Vec::new();
    for record in &records {
        let mut found: Vec<&str> = record.as_object().unwrap().keys().map(String::as_str).collect();
        let mut expected = keys.to_vec();
        found.sort_unstable();
        expected.sort_unstable();
        assert_eq!(found, expected);
        assert_eq!(
            (&record["size"], &record["samples"], &record["frames"]),
            (&[48, 27][..].into(), &1.into(), &3.into())
        );
        for time in ["cpu_ms", "wall_ms", "planning_ms"] {
            let [min, median, max] = ["min", "median", "max"].map(|which| number(record, &format!("/{time}/{which}")));
            assert!(0.0 <= min && min <= median && median <= max, "{record}");
        }
        assert!(number(record, "/cpu_ms/min") > 0.0 && number(record, "/wall_ms/min") > 0.0);
        // Shadows are drawn where they are on and only there.
        let on = record["shadows"].as_bool().unwrap();
        assert_eq!(number(record, "/vertices") > 0.0, on, "{record}");
        assert_eq!(number(record, "/triangles/sides") > 0.0, on);
        let casters: f64 = (0..3).map(|case| number(record, &format!("/cases/{case}"))).sum();
        assert_eq!(casters > 0.0, on);
        variants.push((record["scene"].clone(), record["technique"].clone(), on));
    }
    let count = variants.len();
    assert!(count >= 8 && count.is_multiple_of(4), "{count}");
    for (scene, technique, on) in &variants {
        assert!(variants.contains(&(scene.clone(), technique.clone(), !on)));
    }
    variants.dedup();
    assert_eq!(variants.len(), count);
    assert!(variants.iter().any(|v| v.0 == "small.gltf") && variants.iter().any(|v| v.0 == "builtin:container"));
}

#[test]
fn chosen_techniques_in_their_order() {
    if !has_gpu() {
        return;
    }
    let records = records(&["small.gltf", "--technique", "everitt-kilgard,auto", "--samples", "4", "--fps", "30"]);
    let found: Vec<_> = records.iter().map(|r| (r["technique"].as_str().unwrap(), r["shadows"] == true)).collect();
    assert_eq!(found, [("everitt-kilgard", true), ("everitt-kilgard", false), ("auto", true), ("auto", false)]);
    assert!(records.iter().all(|record| record["samples"] == 4));
}

#[test]
fn the_table_names_scene_techniques_and_columns() {
    if !has_gpu() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let run = zfail(folder.path(), &[&["bench", "builtin:open", "--technique", "auto"][..], &TINY].concat()).ok();
    assert!(run.stderr.contains("builtin:open has no animation"), "{}", run.stderr);
    let lines: Vec<&str> = run.stdout.lines().collect();
    assert!(lines[0].starts_with("48x27, 1 samples per pixel, 3 frames, on "), "{}", lines[0]);
    let heading = lines.iter().position(|line| line.starts_with("builtin:open ")).unwrap();
    for column in ["cpu on", "cpu off", "shadows", "wall on", "planning", "triangles", "vertices", "cases 1/2/3"] {
        assert!(lines[heading].contains(column), "{column}");
    }
    assert!(lines[heading + 1].starts_with("  auto "), "{}", lines[heading + 1]);
    assert_eq!(lines.len(), heading + 2);
    let quiet =
        zfail(folder.path(), &[&["bench", "builtin:open", "--quiet", "--technique", "auto"][..], &TINY].concat());
    assert_eq!(quiet.ok().stderr, "");
}

/// Needs no device: it measures on one that does nothing.
#[test]
fn the_hosts_part_has_records_of_the_contracts_shape() {
    let folder = tempfile::tempdir().unwrap();
    let args =
        ["bench", "--host", "--casters", "9,20", "--lights", "1,2", "--frames", "2", "--technique", "auto,mcguire"];
    let run = zfail(folder.path(), &[&args[..], &["--json", "--quiet"]].concat()).ok();
    let records: Vec<Value> = serde_json::from_str(&run.stdout).unwrap();
    assert_eq!(records.len(), 2 * 2 * 5 * 2 * 2);
    for record in &records {
        for times in ["prepare_ms", "encode_ms", "submit_ms"] {
            let [min, median, max] = ["min", "median", "max"].map(|part| number(record, &format!("/{times}/{part}")));
            assert!(0.0 < min && min <= median && median <= max, "{record}");
        }
        let keys = ["casters", "lights", "triangles_per_caster", "draws", "uploaded_bytes", "allocations"];
        assert!(keys.iter().all(|key| record[key].is_u64()), "{record}");
        assert!(["auto", "mcguire"].contains(&record["technique"].as_str().unwrap()), "{record}");
        assert!(["scene", "each"].contains(&record["receivers"].as_str().unwrap()), "{record}");
        // Nothing goes to the device while nothing moves, and something whenever anything does.
        assert_eq!(record["uploaded_bytes"] == 0, record["moves"] == "nothing", "{record}");
    }
    let moves: Vec<&str> = records.iter().step_by(2).take(5).map(|record| record["moves"].as_str().unwrap()).collect();
    assert_eq!(moves, ["nothing", "camera", "light", "tenth", "all"]);
    let table = zfail(folder.path(), &[&args[..], &["--moves", "all", "--quiet"]].concat()).ok().stdout;
    assert_eq!(table.lines().filter(|line| line.contains("mcguire")).count(), 8, "{table}");
    let wrong = zfail(folder.path(), &["bench", "--host", "--moves", "sideways"]);
    assert!(wrong.stderr.contains("tenth"), "{}", wrong.stderr);
}
