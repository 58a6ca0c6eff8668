//! Pictures that differ by their shadow masks alone.
//!
//! In: a scene, and a mask per light. Out: the picture that these masks give. Light is additive, so one picture without any
//! light and one more per light, all without shadows and under one exposure, are enough for every method: the picture of a
//! method is ambient light plus the light of those lamps whose mask is lit. What no mask decides is the same to the bit.

use crate::error::Error;
use crate::input::Shot;
use indicatif::ProgressBar;
use zfail_render::{Exposure, Gpu, Renderer, Settings, displayed};

/// Linear light of a view, taken apart.
pub struct Studio {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Stops.
    pub exposure: f32,
    /// Exposed radiance with all lights off.
    ambient: Vec<[f32; 3]>,
    /// Per light that shines, what it adds without shadows.
    added: Vec<Vec<[f32; 3]>>,
}

impl Studio {
    /// Renders the parts, a step of `progress` for each light.
    ///
    /// # Errors
    /// If the device fails.
    pub fn new(gpu: &Gpu, shot: &Shot, progress: &ProgressBar) -> Result<Self, Error> {
        let mut renderer = Renderer::new(gpu, &shot.scene)?;
        let mut radiance = |lights: &[usize], shadows, exposure| {
            let settings = Settings { lights: Some(lights.to_vec()), shadows, exposure, ..Settings::default() };
            renderer.picture(&shot.view, &settings).map(|(picture, _)| picture.hdr)
        };
        // The exposure that the finished picture would have.
        let automatic = radiance(&shot.lights, true, Exposure::Auto)?;
        let plain = radiance(&shot.lights, true, Exposure::Ev(0.0))?;
        let exposure = stops(&plain, &automatic);
        let ambient = radiance(&[], false, Exposure::Ev(exposure))?;
        let mut added = Vec::with_capacity(shot.lights.len());
        for &light in &shot.lights {
            let with = radiance(&[light], false, Exposure::Ev(exposure))?;
            added.push(with.iter().zip(&ambient).map(|(w, a)| std::array::from_fn(|c| w[c] - a[c])).collect());
            progress.inc(1);
        }
        Ok(Self { size: shot.view.size, exposure, ambient, added })
    }

    /// What the display shows where each light's mask is 255: 8-bit sRGB, three bytes per pixel.
    pub fn picture(&self, masks: &[Vec<u8>]) -> Vec<u8> {
        let pixel = |(i, &ambient): (usize, &[f32; 3])| {
            let mut radiance = ambient;
            for (mask, added) in masks.iter().zip(&self.added) {
                if mask.get(i) == Some(&255) {
                    radiance = std::array::from_fn(|c| radiance[c] + added[i][c]);
                }
            }
            let [r, g, b, _] = displayed(radiance);
            [r, g, b].map(|c| (c * 255.0).round() as u8)
        };
        self.ambient.iter().enumerate().flat_map(pixel).collect()
    }
}

/// By how many stops `exposed` is brighter than `plain`; 0 where there is no light to tell by.
fn stops(plain: &[[f32; 3]], exposed: &[[f32; 3]]) -> f32 {
    let sum = |picture: &[[f32; 3]]| picture.iter().flatten().map(|&c| f64::from(c)).sum::<f64>();
    let stops = (sum(exposed) / sum(plain)).log2();
    if stops.is_finite() { stops as f32 } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn masks_switch_lights_pixel_by_pixel() {
        let studio = Studio {
            size: [2, 1],
            exposure: 0.0,
            ambient: vec![[0.1; 3]; 2],
            added: vec![vec![[0.2, 0.0, 0.0]; 2], vec![[0.0, 0.3, 0.0]; 2]],
        };
        let shown = |radiance: [f32; 3]| displayed(radiance)[..3].iter().map(|c| (c * 255.0).round() as u8).collect();
        let both: Vec<Vec<u8>> = vec![shown([0.3, 0.1, 0.1]), shown([0.1, 0.4, 0.1])];
        assert_eq!(studio.picture(&[vec![255, 0], vec![0, 255]]), both.concat());
        assert_ne!(studio.picture(&[vec![0, 255], vec![255, 0]]), both.concat());
        assert_eq!(studio.picture(&[]), shown([0.1; 3]).repeat(2));
    }

    #[test]
    fn stops_are_powers_of_two() {
        assert_eq!(stops(&[[1.0, 2.0, 1.0]], &[[4.0, 8.0, 4.0]]), 2.0);
        assert_eq!(stops(&[[0.0; 3]], &[[0.0; 3]]), 0.0);
    }
}
