//! What criterion leaves of the benches.

use serde::Deserialize;
use std::error::Error;
use std::fs;
use std::path::Path;

/// One of them.
pub struct Bench {
    /// As criterion names it.
    pub name: String,
    /// Mean nanoseconds.
    pub nanoseconds: f64,
}

#[derive(Deserialize)]
struct Named {
    full_id: String,
}

#[derive(Deserialize)]
struct Estimates {
    mean: Estimate,
}

#[derive(Deserialize)]
struct Estimate {
    point_estimate: f64,
}

/// All that a folder of criterion's holds, by name; none if there is no such folder.
///
/// # Errors
/// If a file there is not criterion's.
pub fn read(folder: &Path) -> Result<Vec<Bench>, Box<dyn Error>> {
    let mut benches = Vec::new();
    for entry in fs::read_dir(folder).into_iter().flatten() {
        let path = entry?.path();
        let [named, estimates] = ["benchmark.json", "estimates.json"].map(|name| path.join("new").join(name));
        if named.is_file() {
            let Named { full_id } = serde_json::from_str(&fs::read_to_string(named)?)?;
            let Estimates { mean } = serde_json::from_str(&fs::read_to_string(estimates)?)?;
            benches.push(Bench { name: full_id, nanoseconds: mean.point_estimate });
        } else if path.is_dir() {
            benches.extend(read(&path)?);
        }
    }
    // Numbers in names by their size.
    let key = |bench: &Bench| {
        let (group, rest) = bench.name.split_once('/').unwrap_or((&bench.name, ""));
        (group.to_owned(), rest.parse::<u64>().unwrap_or(0), rest.to_owned())
    };
    benches.sort_by_key(key);
    Ok(benches)
}

/// A row for each.
pub fn table(benches: &[Bench]) -> String {
    let rows = benches.iter().map(|bench| [bench.name.clone(), time(bench.nanoseconds)]);
    format!("Means of the benches, which criterion times.\n\n{}", super::table(["bench", "time"], rows))
}

fn time(nanoseconds: f64) -> String {
    match nanoseconds {
        n if n < 1e6 => format!("{:.1} µs", n / 1e3),
        n => format!("{:.1} ms", n / 1e6),
    }
}
