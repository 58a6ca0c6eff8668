//! What is wrong with one light, in one view, by every way to draw it.
//!
//! In: the truth, and the masks and counts that each variant rendered. Out: numbers. Nothing here renders, so that tests can
//! judge masks that no driver would draw.

use super::variants::Variant;
use crate::commands::judged::JudgedLight;
use crate::error::Error;
use serde::Serialize;
use zfail_oracle::{SizeMismatch, Truth, Wrong};
use zfail_render::Aovs;
use zfail_scene::Scene;

/// Wrong pixels that a report lists.
const LISTED: usize = 16;

/// One light.
#[derive(Clone, Debug, Serialize)]
pub struct LightReport {
    #[serde(flatten)]
    pub judged: JudgedLight,
    pub techniques: Vec<TechniqueReport>,
}

/// One light, drawn in one way.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct TechniqueReport {
    pub technique: &'static str,
    /// Verdicts, lit or not, that are wrong.
    pub wrong_pixels: usize,
    /// Stencil counts that are wrong.
    pub wrong_counts: usize,
    /// The first wrong verdicts, or counts where all verdicts are right.
    pub examples: Vec<Example>,
}

/// A wrong pixel.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Example {
    pub x: u32,
    pub y: u32,
    pub expected: u8,
    pub found: u8,
}

impl LightReport {
    /// Judges what every variant made of light number `light`, which is the `i`-th in the images.
    ///
    /// # Errors
    /// If an image is missing or has another size than the truth.
    pub fn new(
        scene: &Scene,
        light: usize,
        truth: &Truth,
        variants: &[Variant],
        images: &[Aovs],
        i: usize,
    ) -> Result<Self, Error> {
        let judged = JudgedLight::new(scene, light, truth)?;
        let mut techniques = Vec::with_capacity(variants.len());
        for (variant, images) in variants.iter().zip(images) {
            let of_light = |kind: &[Vec<u8>]| kind.get(i).cloned().unwrap_or_default();
            let row = TechniqueReport::new(variant.name, truth, &of_light(&images.shadow), &of_light(&images.stencil));
            techniques.push(row.map_err(|e| Error::failed(format!("light {light}, {}: {e}", variant.name)))?);
        }
        Ok(Self { judged, techniques })
    }
}

impl TechniqueReport {
    /// Judges a mask and counts.
    ///
    /// # Errors
    /// If one of them has another size than the truth.
    pub fn new(technique: &'static str, truth: &Truth, mask: &[u8], counts: &[u8]) -> Result<Self, SizeMismatch> {
        let (mask, counts) = (truth.compare_mask(mask)?, truth.compare_count(counts)?);
        let example = |&Wrong { x, y, expected, found }: &Wrong| Example { x, y, expected, found };
        let wrong = if mask.wrong.is_empty() { &counts.wrong } else { &mask.wrong };
        Ok(Self {
            technique,
            wrong_pixels: mask.wrong.len(),
            wrong_counts: counts.wrong.len(),
            examples: wrong.iter().take(LISTED).map(example).collect(),
        })
    }

    /// Whether nothing is wrong.
    pub fn passes(&self) -> bool {
        self.wrong_pixels == 0 && self.wrong_counts == 0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::commands::judged::tests::truth;

    #[test]
    fn a_right_mask_passes_and_every_corrupted_one_does_not() {
        let truth = truth();
        let judge = |mask: &[u8], counts: &[u8]| TechniqueReport::new("auto", &truth, mask, counts).unwrap();
        let (mask, counts) = (truth.mask(), truth.counts());
        let right = judge(&mask, &counts);
        assert!(right.passes() && right.examples.is_empty());
        for x in 0..8 {
            let mut corrupted = mask.clone();
            corrupted[x] ^= 255;
            // The last pixel is left out.
            let found = judge(&corrupted, &counts);
            assert_eq!((found.wrong_pixels, found.wrong_counts), (usize::from(x < 7), 0), "pixel {x}");
            assert_eq!(found.examples.first().map(|e| (e.x, e.found)), (x < 7).then_some((x as u32, corrupted[x])));
        }
        let mut corrupted = counts.clone();
        corrupted[5] = 3;
        let found = judge(&mask, &corrupted);
        assert_eq!((found.wrong_pixels, found.wrong_counts), (0, 1));
        assert_eq!(found.examples, [Example { x: 5, y: 0, expected: 2, found: 3 }]);
        assert!(TechniqueReport::new("auto", &truth, &mask[1..], &counts).is_err());
    }
}
