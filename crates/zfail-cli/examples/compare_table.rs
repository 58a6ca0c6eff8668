//! Wrong pixels of every method on several scenes, as a Markdown table: `compare_table DIR/compare.json...`.
//!
//! In: what `zfail compare` writes for programs. Out, on the standard output: a row for each method, a column for each scene.

use serde::Deserialize;
use std::error::Error;
use std::fmt::Write;
use std::fs;

/// What the table needs of compare.json.
#[derive(Deserialize)]
struct Comparison {
    scene: String,
    size: [u32; 2],
    adapter: String,
    driver: String,
    verdicts: usize,
    methods: Vec<Row>,
}

#[derive(Deserialize)]
struct Row {
    method: String,
    result: Option<Counts>,
}

#[derive(Deserialize)]
struct Counts {
    wrong_pixels: usize,
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut comparisons = Vec::new();
    for path in std::env::args_os().skip(1) {
        let text = fs::read_to_string(&path).map_err(|e| format!("{}: {e}", path.display()))?;
        comparisons.push(serde_json::from_str(&text).map_err(|e| format!("{}: {e}", path.display()))?);
    }
    print!("{}", table(&comparisons)?);
    Ok(())
}

/// # Errors
/// If there is nothing to compare, or the comparisons are not of the same methods.
fn table(comparisons: &[Comparison]) -> Result<String, Box<dyn Error>> {
    let first = comparisons.first().ok_or("name at least one compare.json")?;
    let [width, height] = first.size;
    let mut text = format!(
        "# Wrong pixels\n\nBy method and scene, all lights of the scene together, from its first camera at {width}x{height}; on {} \
         ({}). Made by `cargo xtask figures`.\n\n| method |",
        first.adapter, first.driver
    );
    let mut verdicts = "| *verdicts checked* |".to_owned();
    for comparison in comparisons {
        write!(text, " {} |", name(&comparison.scene))?;
        write!(verdicts, " {} |", comparison.verdicts)?;
    }
    writeln!(text, "\n|---|{}\n{verdicts}", "---:|".repeat(comparisons.len()))?;
    for (i, row) in first.methods.iter().enumerate() {
        write!(text, "| `{}` |", row.method)?;
        for comparison in comparisons {
            let same = comparison.methods.get(i).filter(|other| other.method == row.method);
            let same = same.ok_or_else(|| format!("{} was compared by other methods", comparison.scene))?;
            match &same.result {
                Some(counts) => write!(text, " {} |", counts.wrong_pixels)?,
                None => write!(text, " |")?,
            }
        }
        text.push('\n');
    }
    text.push_str("\nAn empty place: the method cannot run on this device or under this camera.\n");
    Ok(text)
}

/// A scene's name without where it is from.
fn name(scene: &str) -> &str {
    let file = scene.rsplit('/').next().unwrap_or(scene);
    file.split_once('.').map_or(file, |(stem, _)| stem).trim_start_matches("builtin:")
}
