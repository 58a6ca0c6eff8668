//! How work grows with the number of triangles: the O(s) of the papers, s being the edges of the silhouette.
//!
//! In: bodies of 10^3 to 10^6 triangles, a light, and an eye in each of the three cases of McGuire et al. 2003,
//! section 7. Out: submitted triangles, their growth, and what planning costs; where there is a device, also what silhouettes
//! cost on the CPU and on the device.
//!
//! The steps are those of the default technique but for the near count.

use super::extraction::{self, Extraction};
use super::record::Spread;
use super::table::columns;
use crate::console;
use crate::error::Error;
use serde::Serialize;
use std::time::Instant;
use zfail_builtin::shapes;
use zfail_plan::glam::{DAffine3, DMat3, DVec3};
use zfail_plan::light::LightKind;
use zfail_plan::plan::{Caster, Counting, Input, LightStats, Planner, ShadowLight, Steps, Technique};
use zfail_plan::topology::Topology;
use zfail_plan::view::{Projection, View};
use zfail_render::Gpu;
use zfail_scene::Mesh;

/// Triangles, about.
pub const SIZES: [usize; 4] = [1_000, 10_000, 100_000, 1_000_000];

/// A body of one size, seen from one place.
#[derive(Debug, Serialize)]
pub struct Line {
    pub body: &'static str,
    pub eye: &'static str,
    /// The case in which the caster was drawn: 1 is z-pass, 2 z-fail without light cap, 3 z-fail; 0 if it was not.
    pub case: usize,
    pub triangles: usize,
    pub sides: u32,
    pub dark_cap: u32,
    pub light_cap: u32,
    /// Exponent with which the submitted triangles have grown since the size before: 1 is as fast as the mesh.
    pub growth: Option<f64>,
    /// Milliseconds to plan a frame like the one before.
    pub static_ms: f64,
    /// Milliseconds to plan a frame whose light has moved.
    pub moving_ms: f64,
    /// Of topology.
    pub bytes_per_triangle: f64,
    /// Distinct points: each is on the device once, 12 bytes, however often its triangles are drawn.
    pub unique_vertices: usize,
    /// Bytes of index lists that a frame uploads whose light has moved, for each triangle that it draws.
    pub uploaded_per_triangle: f64,
    /// Silhouettes of the CPU beside those of the device, where everything is drawn.
    pub extraction: Option<Extraction>,
}

const LIGHT: DVec3 = DVec3::new(3.0, 5.0, 2.0);

/// Where the eye is and where it looks; bodies have a radius of about 1.
const EYES: [(&str, DVec3, DVec3); 3] = [
    ("beside", DVec3::new(-4.0, 1.0, 5.0), DVec3::ZERO),
    ("in shadow, looking away", DVec3::new(-1.2, -2.0, -0.8), DVec3::new(-2.4, -4.0, -1.6)),
    ("in shadow, looking at it", DVec3::new(-1.2, -2.0, -0.8), DVec3::ZERO),
];

/// A body of about as many triangles as it is told.
type Body = (&'static str, fn(usize) -> Mesh);

const BODIES: [Body; 3] = [("sphere", sphere), ("torus knot", knot), ("city of boxes", city)];

fn sphere(triangles: usize) -> Mesh {
    let rows = root(triangles, 4.0) + 1;
    shapes::uv_sphere(1.0, 2 * rows, rows)
}

fn knot(triangles: usize) -> Mesh {
    const LONG: usize = 12;
    let sides = root(triangles, 2.0 * LONG as f64).max(3);
    shapes::torus_knot([2, 3], 0.6, 0.25, 0.12, LONG * sides, sides)
}

/// Nine by nine boxes, whose faces are divided further and further.
fn city(triangles: usize) -> Mesh {
    const BLOCKS: i32 = 9;
    let cells = root(triangles, f64::from(BLOCKS * BLOCKS * 12));
    let boxes = (0..BLOCKS * BLOCKS).map(|i| {
        let at = DVec3::new(f64::from(i % BLOCKS - 4), 0.0, f64::from(i / BLOCKS - 4)) * 0.22;
        let height = 0.2 + 0.05 * f64::from(i * 7 % 5);
        shapes::divided_cuboid(at - DVec3::new(0.07, 0.0, 0.07), at + DVec3::new(0.07, height, 0.07), cells)
    });
    shapes::merged("city", boxes)
}

/// The n for which n^2 * `each` is about `triangles`; at least 1.
fn root(triangles: usize, each: f64) -> usize {
    ((triangles as f64 / each).sqrt().round() as usize).max(1)
}

/// Measures all bodies at all `sizes`.
///
/// # Errors
/// If a body cannot cast shadows, which would be a fault of ours, or the device fails.
pub fn measure(sizes: &[usize], gpu: Option<&Gpu>, quiet: bool) -> Result<Vec<Line>, Error> {
    let progress = console::progress(BODIES.len() * sizes.len(), quiet);
    let mut lines: Vec<Line> = Vec::new();
    for (body, make) in BODIES {
        for &size in sizes {
            progress.set_message(format!("{body} of {size} triangles"));
            let mesh = make(size);
            let topology = Topology::new(&mesh.positions, &mesh.triangles, |_| true)
                .map_err(|e| Error::failed(format!("{body}: {e}")))?;
            for eye in EYES {
                let mut line = plan(body, eye, &topology)?;
                let before = lines.iter().rev().find(|before| (before.body, before.eye) == (body, eye.0));
                line.growth = before.and_then(|before| growth(before, &line));
                if let Some(gpu) = gpu.filter(|_| line.case == 3) {
                    line.extraction = Some(extraction::measure(gpu, &mesh, &view(eye.1, eye.2), LIGHT)?);
                }
                lines.push(line);
            }
            progress.inc(1);
        }
    }
    progress.finish_and_clear();
    lines.sort_by_key(|line| (BODIES.map(|body| body.0).iter().position(|b| *b == line.body), eye_index(line.eye)));
    Ok(lines)
}

fn eye_index(name: &str) -> Option<usize> {
    EYES.iter().position(|eye| eye.0 == name)
}

/// The slope between two sizes in a plot with logarithmic axes.
fn growth(before: &Line, line: &Line) -> Option<f64> {
    let submitted = |line: &Line| f64::from(line.sides + line.dark_cap + line.light_cap);
    let slope = (submitted(line) / submitted(before)).ln() / (line.triangles as f64 / before.triangles as f64).ln();
    slope.is_finite().then_some(slope)
}

fn plan(
    body: &'static str,
    (name, eye, target): (&'static str, DVec3, DVec3),
    topology: &Topology,
) -> Result<Line, Error> {
    const STATIC_FRAMES: usize = 21;
    const MOVING_FRAMES: usize = 5;
    let casters = [Caster { topology, mesh: 0, world_from_object: DAffine3::IDENTITY }];
    let view = view(eye, target);
    let mut planner = Planner::new();
    let mut stats = LightStats::default();
    let uploaded = std::cell::Cell::new(0);
    let mut time = |light: DVec3| {
        let kind = LightKind::Point { position: light, range: f64::INFINITY };
        let lights = [ShadowLight::new(kind)];
        let frame = Input {
            view: &view,
            casters: &casters,
            lights: &lights,
            receivers: &[],
            // The near count would make a z-pass of almost everything, and two of the three cases would not be seen.
            steps: Steps { near_count: false, ..Technique::default().steps() },
            counting: Counting::Verdict,
        };
        let start = Instant::now();
        let plan = planner.plan(&frame).map_err(|e| Error::failed(format!("{body}: {e}")))?;
        let elapsed = start.elapsed().as_secs_f64() * 1e3;
        stats = plan.lights[0].stats;
        uploaded.set(plan.changed.iter().map(|range| range.len() * size_of::<u32>()).sum::<usize>());
        Ok::<f64, Error>(elapsed)
    };
    let moving: Vec<f64> =
        (1..=MOVING_FRAMES).rev().map(|k| time(LIGHT * (1.0 + 1e-3 * k as f64))).collect::<Result<_, _>>()?;
    time(LIGHT)?;
    let moved = uploaded.get();
    let still: Vec<f64> = (0..STATIC_FRAMES).map(|_| time(LIGHT)).collect::<Result<_, _>>()?;
    let triangles = topology.triangles().len();
    Ok(Line {
        body,
        eye: name,
        case: stats.cases.iter().position(|&count| count > 0).map_or(0, |case| case + 1),
        triangles,
        sides: stats.triangles.sides,
        dark_cap: stats.triangles.dark_cap,
        light_cap: stats.triangles.light_cap,
        growth: None,
        static_ms: Spread::of(still.into_iter()).median,
        moving_ms: Spread::of(moving.into_iter()).median,
        bytes_per_triangle: topology.bytes() as f64 / triangles.max(1) as f64,
        unique_vertices: topology.positions().len(),
        uploaded_per_triangle: moved as f64 / f64::from(stats.triangles.total().max(1)),
        extraction: None,
    })
}

fn view(eye: DVec3, target: DVec3) -> View {
    let back = (eye - target).normalize();
    let right = DVec3::Y.cross(back).normalize();
    View::new(
        DAffine3 { matrix3: DMat3::from_cols(right, back.cross(right), back), translation: eye },
        Projection::Perspective { yfov: 1.0, near: 0.05, far: None },
        [1280, 720],
    )
}

/// The lines as a table; `device` found silhouettes.
pub fn table(lines: &[Line], device: Option<&str>) -> String {
    let heading = [
        "eye",
        "case",
        "triangles",
        "sides",
        "dark cap",
        "light cap",
        "growth",
        "static ms",
        "moving ms",
        "bytes/triangle",
        "vertices",
        "uploaded",
        "on CPU ms",
        "on device ms",
    ];
    let mut text = String::from(
        "Triangles submitted for one caster and one light, and the exponent with which they grow with the mesh: about 0.5 \
         is as the silhouette, 1 as the mesh.\nPlanning time per frame: nothing moved, the light moved. Bytes of \
         topology per triangle; distinct vertices; bytes uploaded for each triangle drawn when the light has moved, where \
         McGuire et al. (section 7) have 36 without and 6 with 16-bit indices into what is on the device.\n",
    );
    if let Some(device) = device {
        text += &format!(
            "Finding silhouettes and caps of a moving light on the CPU and on {device}, where all are drawn; in parentheses \
             the share of frames that did not go back to the CPU.\n"
        );
    }
    for body in lines.chunk_by(|a, b| a.body == b.body) {
        let mut rows = vec![heading.map(str::to_owned).to_vec()];
        rows.extend(body.iter().map(|line| {
            vec![
                line.eye.to_owned(),
                line.case.to_string(),
                line.triangles.to_string(),
                line.sides.to_string(),
                line.dark_cap.to_string(),
                line.light_cap.to_string(),
                line.growth.map_or_else(String::new, |growth| format!("{growth:.2}")),
                format!("{:.4}", line.static_ms),
                format!("{:.3}", line.moving_ms),
                format!("{:.1}", line.bytes_per_triangle),
                line.unique_vertices.to_string(),
                format!("{:.1}", line.uploaded_per_triangle),
                line.extraction.map_or_else(String::new, |found| format!("{:.3}", found.cpu_ms)),
                line.extraction.map_or_else(String::new, |found| {
                    format!("{:.3} ({:.0} %)", found.device_ms, 100.0 * found.on_device)
                }),
            ]
        }));
        text += &format!("\n{}\n", body[0].body);
        text += &columns(&rows);
        text += &crossover(body).map_or_else(String::new, |text| text + "\n");
    }
    text
}

/// From which size on the device is quicker.
fn crossover(body: &[Line]) -> Option<String> {
    let found: Vec<_> = body.iter().filter_map(|line| Some((line.triangles, line.extraction?))).collect();
    let &(most, _) = found.last()?;
    let slower = found.iter().rposition(|(_, found)| found.on_device < 0.5 || found.device_ms >= found.cpu_ms);
    Some(match slower.map_or(found.first(), |i| found.get(i + 1)) {
        Some((triangles, _)) => format!("The device is quicker from {triangles} triangles on."),
        None => format!("The CPU is quicker up to {most} triangles at least."),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bodies_have_the_size_that_was_asked_for() {
        for (name, make) in BODIES {
            for size in [1_000, 10_000] {
                let triangles = make(size).triangles.len();
                assert!((0.8..1.3).contains(&(triangles as f64 / size as f64)), "{name}: {triangles} for {size}");
            }
        }
    }

    #[test]
    fn a_sphere_seen_from_beside_grows_as_its_silhouette() {
        let lines = measure(&[1_000, 16_000], None, true).unwrap();
        assert_eq!(lines.len(), BODIES.len() * EYES.len() * 2);
        let beside: Vec<_> = lines.iter().filter(|line| (line.body, line.eye) == ("sphere", "beside")).collect();
        let growth = beside[1].growth.unwrap();
        assert!((0.4..0.6).contains(&growth), "{growth}");
        // The negative control: where the light cap has to be drawn, work grows as the mesh.
        let capped: Vec<_> = lines.iter().filter(|line| line.body == "sphere" && line.case == 3).collect();
        assert!(capped.iter().any(|line| line.growth.is_some_and(|growth| growth > 0.8)), "{lines:?}");
        assert!(table(&lines, None).contains("torus knot"));
    }

    #[test]
    fn the_crossover_is_where_the_device_stays_ahead() {
        let lines = measure(&[1_000, 2_000, 4_000], None, true).unwrap();
        let mut sphere: Vec<Line> =
            lines.into_iter().filter(|line| (line.body, line.eye) == ("sphere", EYES[2].0)).collect();
        assert_eq!(crossover(&sphere), None);
        let mut say = |device_ms: [f64; 3]| {
            for (line, device_ms) in sphere.iter_mut().zip(device_ms) {
                line.extraction = Some(Extraction { cpu_ms: 1.0, device_ms, on_device: 1.0 });
            }
            crossover(&sphere).unwrap()
        };
        assert!(say([0.5, 2.0, 2.0]).contains("CPU"));
        let middle = say([0.5, 2.0, 0.5]);
        assert!(middle.contains("device") && middle == say([2.0, 1.0, 0.9]), "{middle}");
        assert_ne!(middle, say([2.0, 0.9, 0.9]));
    }
}
