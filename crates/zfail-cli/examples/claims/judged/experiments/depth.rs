//! What a far plane at infinity costs in depth precision (E&K section 3.2.1).
//!
//! The renderer has reversed depth alone. So the conventional depth of the paper is computed here, on the CPU, in the f32
//! arithmetic of a vertex shader and a divider, and rounded to what a depth buffer stores: how many distances it tells apart.

use serde::{Deserialize, Serialize};

/// One kind of depth buffer between two planes.
#[derive(Debug, Deserialize, Serialize)]
pub struct Depth {
    pub buffer: Buffer,
    pub near: f64,
    pub far: f64,
    /// Distances told apart with the far plane at infinity, by those with it at `far`, near one place: the median of places
    /// from `near` to `far`.
    pub median: f64,
    /// The same of all values between `near` and `far`, of buffers with fixed steps.
    pub values: Option<f64>,
}

/// What is stored of a depth.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Buffer {
    /// As OpenGL has it, in 24 bits.
    Conventional24,
    /// The same as f32.
    ConventionalFloat,
    /// 1 at the near plane, 0 at infinity, as f32: what the library draws with.
    ReversedFloat,
}

/// The third row of a projection: depth before division is `a * distance + b`.
#[derive(Clone, Copy)]
struct Row {
    buffer: Buffer,
    a: f32,
    b: f32,
}

impl Row {
    fn new(buffer: Buffer, near: f64, far: Option<f64>) -> Self {
        let (a, b) = match (buffer, far) {
            (Buffer::ReversedFloat, None) => (0.0, near),
            (Buffer::ReversedFloat, Some(far)) => (-near / (far - near), near * far / (far - near)),
            (_, None) => (1.0, -2.0 * near),
            (_, Some(far)) => ((far + near) / (far - near), -2.0 * far * near / (far - near)),
        };
        Self { buffer, a: a as f32, b: b as f32 }
    }

    /// What the buffer holds of a distance.
    fn stored(self, distance: f32) -> u32 {
        let divided = (self.a * distance + self.b) / distance;
        let window = if self.buffer == Buffer::ReversedFloat { divided } else { 0.5 * divided + 0.5 };
        match self.buffer {
            Buffer::Conventional24 => (f64::from(window.clamp(0.0, 1.0)) * f64::from((1 << 24) - 1)).round() as u32,
            _ => window.to_bits(),
        }
    }

    /// Distances from `start` on that are told apart, over a stretch that holds about 1000 steps of 2^-24.
    fn told_apart(self, start: f64, near: f64) -> usize {
        const SAMPLES: usize = 16_384;
        let resolution = if self.buffer == Buffer::ReversedFloat { start } else { start * start / near };
        let stretch = (1000.0 * resolution / f64::from(1 << 24)).min(0.5 * start);
        let distances = (0..SAMPLES).map(|i| (start + stretch * i as f64 / SAMPLES as f64) as f32);
        let mut stored: Vec<u32> = distances.map(|distance| self.stored(distance)).collect();
        stored.sort_unstable();
        stored.dedup();
        stored.len()
    }
}

/// All buffers between planes as games and the paper have them, at so many places.
pub fn measure(places: usize) -> Vec<Depth> {
    let buffers = [Buffer::Conventional24, Buffer::ConventionalFloat, Buffer::ReversedFloat];
    let planes = [(1.0, 100.0), (0.1, 100.0), (0.1, 1000.0)];
    planes.into_iter().flat_map(|(near, far)| buffers.map(|buffer| compare(buffer, near, far, places))).collect()
}

fn compare(buffer: Buffer, near: f64, far: f64, places: usize) -> Depth {
    let [finite, infinite] = [Some(far), None].map(|far| Row::new(buffer, near, far));
    let place = |i: usize| near * (far / near).powf((i as f64 + 0.5) / places as f64);
    let ratio = |i| infinite.told_apart(place(i), near) as f64 / finite.told_apart(place(i), near) as f64;
    let mut ratios: Vec<f64> = (0..places).map(ratio).collect();
    ratios.sort_by(f64::total_cmp);
    let span = |row: Row| f64::from(row.stored(far as f32) - row.stored(near as f32));
    let values = (buffer == Buffer::Conventional24).then(|| span(infinite) / span(finite));
    Depth { buffer, near, far, median: ratios[places / 2], values }
}
