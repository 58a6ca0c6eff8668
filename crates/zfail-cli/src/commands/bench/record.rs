//! What is said of a technique, in the shape of the JSON output.
//!
//! In: what its frames cost. Out: spreads of times, means of counts.

use super::measure::Timing;
use super::scenes::Course;
use serde::Serialize;
use std::time::Duration;
use zfail_render::{FrameStats, LightFigures, Technique};

/// A scene by one technique, with shadows or without. Times are milliseconds per frame, counts means per frame over
/// all lights; what the device cannot measure is null.
#[derive(Serialize)]
pub struct Record {
    pub scene: String,
    pub technique: &'static str,
    pub shadows: bool,
    pub size: [u32; 2],
    pub samples: u32,
    pub frames: usize,
    /// User and system time of the whole process.
    pub cpu_ms: Spread,
    pub wall_ms: Spread,
    pub gpu_ms: Option<Spread>,
    pub planning_ms: Spread,
    /// Submitted for shadow volumes.
    pub triangles: Triangles,
    /// Submitted for shadow volumes.
    pub vertices: f64,
    /// Of shadow volumes.
    pub fragments: Option<f64>,
    /// Casters in case 1 (z-pass), 2 (z-fail without light cap) and 3 (z-fail).
    pub cases: [f64; 3],
}

/// Triangles by part of the volume.
#[derive(Clone, Copy, Serialize)]
pub struct Triangles {
    pub sides: f64,
    pub dark_cap: f64,
    pub light_cap: f64,
}

/// Least, middle and greatest of many values.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Spread {
    pub min: f64,
    pub median: f64,
    pub max: f64,
}

impl Record {
    /// Sums up the frames of one technique.
    pub fn new(course: &Course, technique: Technique, shadows: bool, samples: u32, timings: &[Timing]) -> Self {
        let ms = |time: fn(&Timing) -> Duration| timings.iter().map(move |timing| time(timing).as_secs_f64() * 1e3);
        let gpu_ms: Option<Vec<f64>> = timings.iter().map(|timing| timing.stats.gpu_ms).collect();
        let mean = |count: fn(&LightFigures) -> u32| {
            let lights = timings.iter().flat_map(|timing| &timing.stats.lights);
            lights.map(|light| f64::from(count(light))).sum::<f64>() / timings.len().max(1) as f64
        };
        let fragments: Option<u64> = timings.iter().map(|timing| fragments(&timing.stats)).sum();
        Self {
            scene: course.name.clone(),
            technique: technique.name(),
            shadows,
            size: course.size,
            samples,
            frames: timings.len(),
            cpu_ms: Spread::of(ms(|timing| timing.cpu)),
            wall_ms: Spread::of(ms(|timing| timing.wall)),
            gpu_ms: gpu_ms.map(|times| Spread::of(times.into_iter())),
            planning_ms: Spread::of(timings.iter().map(|timing| timing.stats.planning_ms)),
            triangles: Triangles {
                sides: mean(|light| light.triangles.sides),
                dark_cap: mean(|light| light.triangles.dark_cap),
                light_cap: mean(|light| light.triangles.light_cap),
            },
            vertices: mean(|light| light.vertices),
            fragments: fragments.map(|sum| sum as f64 / timings.len().max(1) as f64),
            cases: [mean(|light| light.cases[0]), mean(|light| light.cases[1]), mean(|light| light.cases[2])],
        }
    }
}

/// Of all lights of a frame, if every one's are known.
fn fragments(stats: &FrameStats) -> Option<u64> {
    stats.lights.iter().map(|light| light.fragments).sum()
}

impl Triangles {
    /// Of all parts.
    pub fn total(&self) -> f64 {
        self.sides + self.dark_cap + self.light_cap
    }
}

impl Spread {
    /// Of `values`; all zero if there are none.
    pub fn of(values: impl Iterator<Item = f64>) -> Self {
        let mut values: Vec<f64> = values.collect();
        values.sort_by(f64::total_cmp);
        let [Some(&min), Some(&max)] = [values.first(), values.last()] else {
            return Self { min: 0.0, median: 0.0, max: 0.0 };
        };
        let middle = values.len() / 2;
        let median = if values.len() % 2 == 1 { values[middle] } else { 0.5 * (values[middle - 1] + values[middle]) };
        Self { min, median, max }
    }
}

#[cfg(test)]
mod tests {
    use super::Spread;

    #[test]
    fn spreads() {
        let of = |values: &[f64]| Spread::of(values.iter().copied());
        assert_eq!(of(&[3.0, 1.0, 2.0]), Spread { min: 1.0, median: 2.0, max: 3.0 });
        assert_eq!(of(&[4.0, 1.0, 2.0, 3.0]), Spread { min: 1.0, median: 2.5, max: 4.0 });
        assert_eq!(of(&[7.0]), Spread { min: 7.0, median: 7.0, max: 7.0 });
        assert_eq!(of(&[]), Spread { min: 0.0, median: 0.0, max: 0.0 });
    }
}
