//! What `zfail bench --scaling` says of growing meshes.

use super::{range, table};
use serde::Deserialize;
use std::error::Error;

/// A body of one size, seen from one place.
#[derive(Clone, Deserialize)]
pub struct Line {
    body: String,
    eye: String,
    case: usize,
    triangles: usize,
    sides: u32,
    dark_cap: u32,
    light_cap: u32,
    static_ms: f64,
    moving_ms: f64,
    bytes_per_triangle: f64,
    extraction: Option<Extraction>,
}

#[derive(Clone, Deserialize)]
struct Extraction {
    cpu_ms: f64,
    device_ms: f64,
}

/// How what is drawn grows, and what planning costs, in sentences.
///
/// # Errors
/// If nothing was drawn.
pub fn in_short(lines: &[Line]) -> Result<String, Box<dyn Error>> {
    let courses: Vec<&[Line]> = courses(lines).collect();
    let by_silhouette = courses.iter().filter(|course| course.iter().all(|line| [1, 2].contains(&line.case)));
    let powers: Vec<f64> = by_silhouette.filter_map(|course| power(course)).collect();
    let largest: Vec<&Line> = courses.iter().filter_map(|course| course.last()).collect();
    if powers.is_empty() || largest.is_empty() {
        return Err("nothing was drawn in cases 1 and 2".into());
    }
    let still = range(largest.iter().map(|line| 1e3 * line.static_ms), 1);
    Ok(format!(
        "Over a sphere, a torus knot and a city of boxes with 10^3 to 10^6 triangles, what is drawn in cases 1 and 2 of McGuire et \
         al. grows with the power {} of the triangle count. With a million triangles in one caster, planning takes {still} \
         microseconds while nothing moves and {} ms when the light does; topology takes {} bytes a triangle.\n",
        range(powers.iter().copied(), 2),
        range(largest.iter().map(|line| line.moving_ms), 0),
        range(lines.iter().map(|line| line.bytes_per_triangle), 0),
    ))
}

/// What is drawn of each size, and what finding it costs.
pub fn tables(lines: &[Line]) -> String {
    let drawn = courses(lines).map(|course| {
        let count = |i: usize| course.get(i).map_or_else(String::new, |line| line.drawn().to_string());
        let power = power(course).map_or_else(String::new, |power| format!("{power:.2}"));
        [place(&course[0]), course[0].case.to_string(), count(0), count(1), count(2), count(3), power]
    });
    let times = courses(lines).filter_map(|course| course.last()).map(|line| {
        let ratio = line.extraction.as_ref().map(|found| format!("{:.2}", found.device_ms / found.cpu_ms));
        [
            place(line),
            line.triangles.to_string(),
            format!("{:.4}", line.static_ms),
            format!("{:.1}", line.moving_ms),
            format!("{:.1}", line.bytes_per_triangle),
            ratio.unwrap_or_default(),
        ]
    });
    format!(
        "Triangles drawn for one caster of about 10^3, 10^4, 10^5 and 10^6 triangles under one light, and the power with which they \
         grow: about 0.5 is as the silhouette, 1 as the mesh.\n\n{}\n\
         Of the largest: planning while nothing moves and while the light does, and memory of topology. Where everything is drawn, \
         the last column is the time that the device takes to find silhouettes, by the time that the CPU takes.\n\n{}",
        table(["body, eye", "case", "10^3", "10^4", "10^5", "10^6", "power"], drawn),
        table(["body, eye", "triangles", "ms still", "ms moving", "bytes a triangle", "device by CPU"], times),
    )
}

/// The sizes of a body seen from one place, from the least on.
fn courses(lines: &[Line]) -> impl Iterator<Item = &[Line]> {
    lines.chunk_by(|a, b| (&a.body, &a.eye) == (&b.body, &b.eye))
}

fn place(line: &Line) -> String {
    format!("{}, {}", line.body, line.eye)
}

/// The exponent from the least to the greatest size.
fn power(course: &[Line]) -> Option<f64> {
    let [first, .., last] = course else { return None };
    let grown = |of: fn(&Line) -> f64| (of(last) / of(first)).ln();
    let power = grown(|line| f64::from(line.drawn())) / grown(|line| line.triangles as f64);
    power.is_finite().then_some(power)
}

impl Line {
    fn drawn(&self) -> u32 {
        self.sides + self.dark_cap + self.light_cap
    }
}
