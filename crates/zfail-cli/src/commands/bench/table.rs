//! Measurements as a person reads them: a line per scene and technique, shadows on beside off.

use super::record::{Record, Spread};
use zfail_render::Gpu;

/// Columns right-aligned under their headings, the first one left-aligned, with two spaces between.
pub fn columns(rows: &[Vec<String>]) -> String {
    let count = rows.iter().map(Vec::len).max().unwrap_or(0);
    let width = |c: usize| rows.iter().filter_map(|row| row.get(c)).map(|cell| cell.chars().count()).max().unwrap_or(0);
    let widths: Vec<usize> = (0..count).map(width).collect();
    let mut text = String::new();
    for row in rows {
        let cells = row.iter().zip(&widths).enumerate();
        let padded = cells.map(|(c, (cell, &width))| match c {
            0 => format!("{cell:<width$}"),
            _ => format!("{cell:>width$}"),
        });
        text += padded.collect::<Vec<_>>().join("  ").trim_end();
        text.push('\n');
    }
    text
}

/// The table of all records, with what it was measured on and how to read it.
pub fn text(gpu: &Gpu, records: &[Record]) -> String {
    let Some(first) = records.first() else { return String::new() };
    let [width, height] = first.size;
    let mut text = format!(
        "{}x{}, {} samples per pixel, {} frames, on {} ({})\n\
         Milliseconds per frame: median of CPU time (user and system, whole process); its cost of shadows is on minus \
         off.\nTriangles, vertices and casters per case are of shadow volumes, means per frame.\n",
        width, height, first.samples, first.frames, gpu.info.name, gpu.info.backend
    );
    let scenes = records.chunk_by(|a, b| a.scene == b.scene);
    for scene in scenes {
        let heading = [
            &scene[0].scene,
            "cpu on",
            "cpu off",
            "shadows",
            "wall on",
            "gpu on",
            "planning",
            "triangles",
            "vertices",
            "cases 1/2/3",
        ]
        .map(str::to_owned);
        let mut rows = vec![heading.to_vec()];
        for on in scene.iter().filter(|record| record.shadows) {
            let off = scene.iter().find(|record| !record.shadows && record.technique == on.technique);
            rows.push(row(on, off));
        }
        text += "\n";
        text += &columns(&rows);
    }
    text
}

fn row(on: &Record, off: Option<&Record>) -> Vec<String> {
    let median = |spread: &Spread| format!("{:.2}", spread.median);
    let unknown = || "-".to_owned();
    vec![
        format!("  {}", on.technique),
        median(&on.cpu_ms),
        off.map_or_else(unknown, |off| median(&off.cpu_ms)),
        off.map_or_else(unknown, |off| format!("{:.2}", on.cpu_ms.median - off.cpu_ms.median)),
        median(&on.wall_ms),
        on.gpu_ms.as_ref().map_or_else(unknown, median),
        format!("{:.3}", on.planning_ms.median),
        format!("{:.0}", on.triangles.total()),
        format!("{:.0}", on.vertices),
        on.cases.map(|count| format!("{count:.0}")).join("/"),
    ]
}

#[cfg(test)]
mod tests {
    use super::columns;

    #[test]
    fn columns_line_up() {
        let rows = [["name", "ms"], ["a", "12.5"], ["longer", "1"]].map(|row| row.map(str::to_owned).to_vec());
        assert_eq!(columns(&rows), "name      ms\na       12.5\nlonger     1\n");
    }
}
