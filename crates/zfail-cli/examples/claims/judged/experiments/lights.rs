//! How many lights an accumulation buffer of 8 bits bears (McG section 8).
//!
//! An area light is imitated by many dim ones, each of which adds its light to a smooth floor; every addition is rounded to 8
//! bits, as blending into such a buffer does. What differs from the exact sum is banding.

use serde::{Deserialize, Serialize};
use zfail_plan::glam::DVec3;
use zfail_testing::Random;

/// A floor under so many lights.
#[derive(Debug, Deserialize, Serialize)]
pub struct Bands {
    pub lights: usize,
    /// The greatest error of the sum along a line on the floor, in levels of 255, median over placements of the lights.
    pub eight_bits: f64,
    /// The same where 32-bit floats are added and only the sum is rounded.
    pub floats: f64,
}

/// 1 to 64 lights, over so many points of the floor.
pub fn measure(points: usize) -> Vec<Bands> {
    [1, 2, 5, 10, 15, 20, 25, 30, 40, 64].into_iter().map(|lights| bands(lights, points)).collect()
}

fn bands(lights: usize, points: usize) -> Bands {
    const PLACEMENTS: u64 = 31;
    let mut errors: Vec<[f64; 2]> = (0..PLACEMENTS).map(|seed| worst(lights, points, seed)).collect();
    let mut median = |which: usize| {
        errors.sort_by(|a, b| a[which].total_cmp(&b[which]));
        errors[errors.len() / 2][which]
    };
    Bands { lights, eight_bits: median(0), floats: median(1) }
}

/// The greatest errors in 8 bits and in floats.
fn worst(lights: usize, points: usize, seed: u64) -> [f64; 2] {
    /// What the brightest point would have, of 255.
    const PEAK: f64 = 200.0;
    let mut random = Random(seed);
    let places: Vec<DVec3> =
        (0..lights).map(|_| DVec3::new(random.real(-0.5, 0.5), 2.0, random.real(-0.5, 0.5))).collect();
    // Lambert's law and the inverse square, scaled so that right under the light is 1.
    let arriving = |at: DVec3, place: &DVec3| {
        let way = *place - at;
        way.y.powi(4) / way.length_squared().powi(2) * PEAK / lights as f64
    };
    let mut errors = [0.0_f64; 2];
    for i in 0..points {
        let at = DVec3::new(6.0 * i as f64 / points as f64 - 3.0, 0.0, 0.0);
        let exact: f64 = places.iter().map(|place| arriving(at, place)).sum();
        let rounded: f64 = places.iter().map(|place| arriving(at, place).round()).sum();
        let floats: f32 = places.iter().map(|place| arriving(at, place) as f32).sum();
        let found = [rounded, f64::from(floats).round()];
        errors.iter_mut().zip(found).for_each(|(error, found)| *error = error.max((found - exact).abs()));
    }
    errors
}
