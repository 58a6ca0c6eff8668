//! Mip maps: an image and its halves, averaged in linear light.

use crate::srgb;
use rayon::prelude::*;
use std::sync::LazyLock;

/// One level: RGBA, 8 bits each, rows from top to bottom.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Level {
    pub width: u32,
    pub height: u32,
    pub rgba: Vec<u8>,
}

impl Level {
    /// The next level, half as wide and high (at least 1); `srgb` says how colour is encoded. Alpha is linear.
    pub fn half(&self, srgb: bool) -> Self {
        let width = (self.width / 2).max(1);
        let height = (self.height / 2).max(1);
        let columns: Vec<Taps> = (0..width).map(|x| Taps::new(x, width, self.width)).collect();
        let mut rgba = vec![0; width as usize * height as usize * 4];
        rgba.par_chunks_mut(width as usize * 4).enumerate().for_each(|(y, row)| {
            let rows = Taps::new(y as u32, height, self.height);
            for (texel, columns) in row.chunks_exact_mut(4).zip(&columns) {
                let mut sum = [0.0; 4];
                for (y, wy) in rows.iter() {
                    for (x, wx) in columns.iter() {
                        let at = (y as usize * self.width as usize + x as usize) * 4;
                        for (sum, (channel, &byte)) in sum.iter_mut().zip(self.rgba[at..at + 4].iter().enumerate()) {
                            *sum += wx * wy * decode(byte, srgb && channel < 3);
                        }
                    }
                }
                for (channel, (byte, sum)) in texel.iter_mut().zip(sum).enumerate() {
                    *byte = encode(sum, srgb && channel < 3);
                }
            }
        });
        Self { width, height, rgba }
    }

    pub fn is_last(&self) -> bool {
        self.width == 1 && self.height == 1
    }
}

/// The source texels under a target texel, and their shares of it: two, or three where the size is odd.
struct Taps {
    first: u32,
    weights: [f32; 3],
}

impl Taps {
    fn new(target: u32, targets: u32, sources: u32) -> Self {
        let scale = f64::from(sources) / f64::from(targets);
        let (from, to) = (f64::from(target) * scale, f64::from(target + 1) * scale);
        let first = from.floor();
        let weights = std::array::from_fn(|i| {
            let texel = first + i as f64;
            ((to.min(texel + 1.0) - from.max(texel)).max(0.0) / scale) as f32
        });
        Self { first: first as u32, weights }
    }

    fn iter(&self) -> impl Iterator<Item = (u32, f32)> {
        let first = self.first;
        (0..).zip(self.weights).map(move |(i, w)| (first + i, w)).filter(|&(_, w)| w > 1e-6)
    }
}

static LINEAR_FROM_SRGB: LazyLock<[f32; 256]> =
    LazyLock::new(|| std::array::from_fn(|i| srgb::linear(i as f32 / 255.0)));

/// Steps of the table from linear to sRGB: fine enough for one step of 8 bits near black, where sRGB is steepest.
const STEPS: usize = 1 << 14;

static SRGB_FROM_LINEAR: LazyLock<Vec<u8>> =
    LazyLock::new(|| (0..=STEPS).map(|i| (srgb::encoded(i as f32 / STEPS as f32) * 255.0).round() as u8).collect());

fn decode(byte: u8, srgb: bool) -> f32 {
    if srgb { LINEAR_FROM_SRGB[usize::from(byte)] } else { f32::from(byte) / 255.0 }
}

fn encode(value: f32, srgb: bool) -> u8 {
    if srgb {
        SRGB_FROM_LINEAR[((value * STEPS as f32).round() as usize).min(STEPS)]
    } else {
        (value * 255.0).round() as u8
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_constant_stays_constant() {
        for (width, height) in [(8, 8), (7, 5), (1, 9), (3, 1)] {
            for srgb in [false, true] {
                let mut level = Level { width, height, rgba: [7, 77, 177, 251].repeat((width * height) as usize) };
                while !level.is_last() {
                    level = level.half(srgb);
                    assert!(level.rgba.chunks_exact(4).all(|t| t == [7, 77, 177, 251]), "{level:?}");
                }
            }
        }
    }

    #[test]
    fn black_and_white_meet_in_linear_light() {
        let level = Level { width: 2, height: 1, rgba: vec![0, 0, 0, 0, 255, 255, 255, 255] };
        // sRGB code of linear 0.5.
        assert_eq!(level.half(true).rgba, [188, 188, 188, 128]);
        assert_eq!(level.half(false).rgba, [128, 128, 128, 128]);
    }

    #[test]
    fn every_texel_of_an_odd_row_has_the_same_weight() {
        let mut weights = [0.0; 7];
        for x in 0..3 {
            for (i, w) in Taps::new(x, 3, 7).iter() {
                weights[i as usize] += w;
            }
        }
        assert!(weights.iter().all(|w| (w - 3.0 / 7.0).abs() < 1e-6), "{weights:?}");
    }
}
