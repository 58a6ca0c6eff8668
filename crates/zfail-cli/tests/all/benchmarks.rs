//! The page of costs: made of what the program says, and quoted by README.

#[path = "../../examples/benchmarks_page/page/mod.rs"]
mod page;

use crate::support::{has_gpu, zfail};
use page::{Inputs, benches, growth};
use std::fs;
use std::path::Path;

fn read(path: &str) -> String {
    fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").join(path)).unwrap()
}

fn joined(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// The paragraphs and tables that README has to repeat.
fn in_short(page: &str) -> Vec<String> {
    let section = page.split("\n## In short\n").nth(1).and_then(|rest| rest.split("\n## ").next()).unwrap();
    section.split("\n\n").map(joined).filter(|part| !part.is_empty()).collect()
}

#[test]
fn readme_says_of_costs_what_the_page_says() {
    let (page, readme) = (read("docs/benchmarks.md"), joined(&read("README.md")));
    let said = in_short(&page);
    assert!(said.len() >= 3, "{said:?}");
    for part in &said {
        assert!(readme.contains(part), "README has not: {part}");
        assert!(
            !readme.replace(" 0.5", " 0.6").replace("---:|---:|", "").replace("CPU time", "time").contains(part),
            "{part}"
        );
    }
}

/// What `zfail bench --scaling` says of three sizes; the whole of it takes too long here.
const GROWTH: &str = r#"[
    {"body": "sphere", "eye": "beside", "case": 1, "triangles": 1000, "sides": 60, "dark_cap": 0, "light_cap": 0,
     "growth": null, "static_ms": 0.001, "moving_ms": 0.1, "bytes_per_triangle": 52.0, "extraction": null},
    {"body": "sphere", "eye": "beside", "case": 1, "triangles": 100000, "sides": 600, "dark_cap": 0, "light_cap": 0,
     "growth": 0.5, "static_ms": 0.002, "moving_ms": 9.0, "bytes_per_triangle": 50.0, "extraction": null},
    {"body": "sphere", "eye": "in shadow", "case": 3, "triangles": 1000, "sides": 60, "dark_cap": 50, "light_cap": 500,
     "growth": null, "static_ms": 0.001, "moving_ms": 0.2, "bytes_per_triangle": 52.0,
     "extraction": {"cpu_ms": 2.0, "device_ms": 3.0, "on_device": 1.0}}
]"#;

#[test]
fn a_page_is_made_of_what_the_program_says() {
    if !has_gpu() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let said = |args: &[&str]| zfail(folder.path(), args).ok().stdout;
    let frames =
        said(&["bench", "builtin:container", "builtin:open", "-q", "--frames", "2", "--size", "48x27", "--json"]);
    // As criterion leaves it.
    let bench = folder.path().join("plan/still/new");
    fs::create_dir_all(&bench).unwrap();
    fs::write(bench.join("benchmark.json"), r#"{"group_id": "plan", "full_id": "plan/still"}"#).unwrap();
    fs::write(bench.join("estimates.json"), r#"{"mean": {"point_estimate": 1234.0, "standard_error": 1.0}}"#).unwrap();
    let mut inputs = Inputs {
        commands: ["zfail bench", "zfail bench --scaling", "cargo bench"].map(str::to_owned).into(),
        adapters: serde_json::from_str(&said(&["adapters", "--json"])).unwrap(),
        cores: 3,
        frames: serde_json::from_str(&frames).unwrap(),
        growth: serde_json::from_str(GROWTH).unwrap(),
        benches: benches::read(folder.path()).unwrap(),
    };
    let page = inputs.page().unwrap();
    for words in [
        "with 3 processor cores",
        "\n| container, `auto` | ",
        "| open | ",
        "48x27, samples per pixel: 1, frames: 2.",
        "| plan/still | 1.2 µs |",
    ] {
        assert!(page.contains(words), "'{words}' is not in {page}");
    }
    assert!(page.contains("power 0.50 of the triangle count") && page.contains("| 1.50 |\n"), "{page}");
    assert_eq!(in_short(&page).len(), 3, "a paragraph, a table, a paragraph");
    // Without a technique there is no row to be quoted.
    inputs.frames.retain(|record| record.technique != "lengyel");
    assert!(inputs.page().is_err());
    let capped: Vec<growth::Line> = inputs.growth.split_off(2);
    assert!(growth::in_short(&capped).is_err(), "nothing in it grows as a silhouette");
}
