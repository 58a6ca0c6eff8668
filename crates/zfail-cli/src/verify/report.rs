//! What was found, in the shape of `--json`.
//!
//! In: the truth of each light, and the masks and counts that each variant rendered. Out: numbers and a verdict. Nothing
//! here renders, so that tests can judge masks that no driver would draw.

use super::closure::Closed;
use super::proof::Proof;
use super::variants::Variant;
use crate::error::Error;
use crate::judged::JudgedLight;
use serde::Serialize;
use zfail_oracle::{SizeMismatch, Truth, Wrong};
use zfail_plan::closure::Closure;
use zfail_plan::view::View;
use zfail_render::{Aovs, Gpu};
use zfail_scene::Scene;

/// Wrong pixels that a report lists.
const LISTED: usize = 16;

/// The whole report.
#[derive(Debug, Serialize)]
pub struct Report {
    pub scene: String,
    pub size: [u32; 2],
    pub adapter: String,
    pub backend: String,
    pub driver: String,
    pub depth_format: String,
    pub closure: ClosureReport,
    /// In the picture that was asked for.
    pub lights: Vec<LightReport>,
    /// Further views, of the lights of which more had to be seen.
    pub closeups: Vec<Closeup>,
    /// How much all of it proves.
    pub proof: Proof,
    /// Whether nothing is wrong.
    pub passed: bool,
    /// Whose fault it seems to be, if it has not passed.
    pub suspect: Option<Opinion>,
}

/// The proof that volumes are closed.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct ClosureReport {
    pub volumes: usize,
    pub triangles: u64,
    pub open_edges: u64,
    /// Pairs of caster and light that were not examined, because there are too many.
    pub left_out: usize,
}

/// A view from somewhere else.
#[derive(Debug, Serialize)]
pub struct Closeup {
    /// World space.
    pub eye: [f64; 3],
    /// The way that it looks.
    pub towards: [f64; 3],
    pub lights: Vec<LightReport>,
}

impl Closeup {
    /// What was found in `view`.
    pub fn new(view: &View, lights: Vec<LightReport>) -> Self {
        let axes = view.world_from_view;
        Self { eye: axes.translation.to_array(), towards: (-axes.matrix3.z_axis).to_array(), lights }
    }
}

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

/// Whose fault a mismatch seems to be.
#[derive(Debug, PartialEq, Serialize)]
pub struct Opinion {
    pub points_to: Suspect,
    /// A sentence.
    pub because: String,
}

/// Who may be at fault.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Suspect {
    Driver,
    Zfail,
    Unknown,
}

impl Report {
    pub fn new(
        scene: String,
        size: [u32; 2],
        gpu: &Gpu,
        closed: Closed,
        lights: Vec<LightReport>,
        closeups: Vec<Closeup>,
        proof: Proof,
    ) -> Self {
        let driver = [gpu.info.driver.as_str(), gpu.info.driver_info.as_str()].join(" ").trim().to_owned();
        let Closed { closure: Closure { volumes, triangles, open_edges }, left_out } = closed;
        let mut report = Self {
            scene,
            size,
            adapter: gpu.info.name.clone(),
            backend: gpu.info.backend.to_string(),
            driver,
            depth_format: format!("{:?}", gpu.depth_stencil),
            closure: ClosureReport { volumes, triangles, open_edges, left_out },
            lights,
            closeups,
            proof,
            passed: false,
            suspect: None,
        };
        report.passed = open_edges == 0 && report.rows().all(TechniqueReport::passes);
        report
    }

    /// Wrong verdicts of all lights and techniques together.
    pub fn wrong_pixels(&self) -> usize {
        self.rows().map(|row| row.wrong_pixels).sum()
    }

    /// Wrong counts of all lights and techniques together.
    pub fn wrong_counts(&self) -> usize {
        self.rows().map(|row| row.wrong_counts).sum()
    }

    /// Names of the techniques that are wrong anywhere, each once.
    pub fn wrong_techniques(&self) -> Vec<&'static str> {
        let mut names: Vec<_> = self.rows().filter(|row| !row.passes()).map(|row| row.technique).collect();
        names.sort_unstable();
        names.dedup();
        names
    }

    /// What is wrong, in a sentence.
    pub fn complaint(&self) -> Option<String> {
        if self.passed {
            return None;
        }
        let mut faults = Vec::new();
        for (number, what) in [
            (self.wrong_pixels() as u64, "wrong pixels"),
            (self.wrong_counts() as u64, "wrong counts"),
            (self.closure.open_edges, "open edges of volumes"),
        ] {
            if number > 0 {
                faults.push(format!("{number} {what}"));
            }
        }
        Some(faults.join(", "))
    }

    fn rows(&self) -> impl Iterator<Item = &TechniqueReport> {
        let closer = self.closeups.iter().flat_map(|closeup| &closeup.lights);
        self.lights.iter().chain(closer).flat_map(|light| &light.techniques)
    }
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
    use crate::judged::tests::truth;

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
