//! What `zfail bench` says of frames.

use super::{table, thousands};
use serde::Deserialize;
use std::error::Error;

/// A scene by one technique, with shadows or without.
#[derive(Deserialize)]
pub struct Record {
    pub scene: String,
    pub technique: String,
    pub shadows: bool,
    size: [u32; 2],
    samples: u32,
    frames: usize,
    cpu_ms: Spread,
    planning_ms: Spread,
    triangles: Triangles,
    vertices: f64,
    cases: [f64; 3],
}

#[derive(Deserialize)]
struct Spread {
    median: f64,
}

#[derive(Deserialize)]
struct Triangles {
    sides: f64,
    dark_cap: f64,
    light_cap: f64,
}

/// The techniques of the papers, and ours.
const TECHNIQUES: [&str; 4] = ["everitt-kilgard", "lengyel", "mcguire", "auto"];

/// A row for each scene: what each technique costs, and how much the first and the last of them draw.
///
/// # Errors
/// If a technique is missing.
pub fn in_short(records: &[Record]) -> Result<String, Box<dyn Error>> {
    let mut rows = Vec::new();
    for scene in scenes(records) {
        let [ek, lengyel, mcguire, auto] = TECHNIQUES.map(|technique| scene.ratio(technique));
        let [first, _, _, last] =
            TECHNIQUES.map(|technique| Some(thousands(scene.of(technique, true)?.triangles.total())));
        let cells = [Some(scene.name()), ek, lengyel, mcguire, auto, first, last];
        let cells = cells.into_iter().collect::<Option<Vec<_>>>().ok_or_else(|| format!("not all of {}", scene.0))?;
        rows.push(<[String; 7]>::try_from(cells).map_err(|_| "seven columns")?);
    }
    let heading =
        ["scene", "`everitt-kilgard`", "`lengyel`", "`mcguire`", "`auto`", "triangles of E&K", "triangles of `auto`"];
    Ok(format!(
        "CPU time of a frame with shadows, by technique, divided by that of the frame without them; and how many triangles the \
         volumes of a frame have.\n\n{}",
        table(heading, rows)
    ))
}

/// All counts, and all times.
///
/// # Errors
/// If a technique is missing.
pub fn tables(records: &[Record]) -> Result<String, Box<dyn Error>> {
    let first = records.first().ok_or("no frame was measured")?;
    let [width, height] = first.size;
    let drawn = records.iter().filter(|record| record.shadows);
    let counts = drawn.clone().map(|record| {
        let Triangles { sides, dark_cap, light_cap } = record.triangles;
        let numbers = [sides, dark_cap, light_cap, record.vertices].map(|count| format!("{count:.0}"));
        let [sides, dark_cap, light_cap, vertices] = numbers;
        let cases = record.cases.map(|casters| format!("{casters:.0}")).join(" / ");
        [format!("{}, `{}`", name(&record.scene), record.technique), sides, dark_cap, light_cap, vertices, cases]
    });
    let times = drawn.map(|record| {
        let off = Scene(&record.scene, records).of(&record.technique, false).map_or(f64::NAN, |off| off.cpu_ms.median);
        let on = record.cpu_ms.median;
        [
            format!("{}, `{}`", name(&record.scene), record.technique),
            format!("{off:.1}"),
            format!("{on:.1}"),
            format!("{:.2}", on / off),
            format!("{:.3}", record.planning_ms.median),
        ]
    });
    Ok(format!(
        "{width}x{height}, samples per pixel: {}, frames: {}. Counts are means of a frame over all its lights; cases are casters by \
         z-pass, z-fail without light cap and z-fail. Where `auto` lets the device count or find silhouettes is a matter of \
         measured times, so its counts may differ elsewhere.\n\n{}\n\
         Milliseconds are medians of a frame: CPU time of the whole process, user and system, which on a software rasteriser \
         contains the rendering; and planning on the clock.\n\n{}",
        first.samples,
        first.frames,
        table(["scene, technique", "sides", "dark caps", "light caps", "vertices", "cases 1 / 2 / 3"], counts),
        table(["scene, technique", "ms without shadows", "ms with them", "ratio", "ms of planning"], times),
    ))
}

/// The records of one scene among all.
struct Scene<'a>(&'a str, &'a [Record]);

fn scenes(records: &[Record]) -> impl Iterator<Item = Scene<'_>> {
    records.chunk_by(|a, b| a.scene == b.scene).map(|of_scene| Scene(&of_scene[0].scene, of_scene))
}

impl<'a> Scene<'a> {
    fn of(&self, technique: &str, shadows: bool) -> Option<&'a Record> {
        let wanted =
            |record: &&Record| record.scene == self.0 && record.technique == technique && record.shadows == shadows;
        self.1.iter().find(wanted)
    }

    /// Frames with shadows by frames without.
    fn ratio(&self, technique: &str) -> Option<String> {
        let [on, off] = [true, false].map(|shadows| self.of(technique, shadows));
        Some(format!("{:.1}", on?.cpu_ms.median / off?.cpu_ms.median))
    }

    fn name(&self) -> String {
        name(self.0).to_owned()
    }
}

fn name(scene: &str) -> &str {
    scene.trim_start_matches("builtin:")
}

impl Triangles {
    fn total(&self) -> f64 {
        self.sides + self.dark_cap + self.light_cap
    }
}
