//! What was found, in the shape of `--json`.
//!
//! In: the truth of each light, and the masks and counts that each variant rendered. Out: numbers and a verdict. Nothing
//! here renders, so that tests can judge masks that no driver would draw.

use super::variants::Variant;
use crate::error::Error;
use serde::Serialize;
use std::collections::BTreeMap;
use zfail_oracle::{Doubt, SizeMismatch, Truth, Wrong};
use zfail_plan::closure::Closure;
use zfail_plan::scene::{LightKind, Scene};
use zfail_render::{Aovs, Gpu};

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
    pub lights: Vec<LightReport>,
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
}

/// One light.
#[derive(Debug, Serialize)]
pub struct LightReport {
    /// Its number in the scene.
    pub light: usize,
    pub name: String,
    pub kind: &'static str,
    /// Pixels with a surface that were compared.
    pub checked: usize,
    /// Pixels without one that were compared.
    pub background: usize,
    /// Of the checked ones.
    pub lit: usize,
    /// Of the checked ones.
    pub shadowed: usize,
    /// Pixels left out, by reason.
    pub excluded: BTreeMap<&'static str, usize>,
    /// Why a pass would mean little.
    pub proves_little: Option<String>,
    pub techniques: Vec<TechniqueReport>,
}

/// One light, drawn in one way.
#[derive(Debug, PartialEq, Serialize)]
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
    pub fn new(scene: String, size: [u32; 2], gpu: &Gpu, closed: Closure, lights: Vec<LightReport>) -> Self {
        let driver = [gpu.info.driver.as_str(), gpu.info.driver_info.as_str()].join(" ").trim().to_owned();
        let passed = closed.open_edges == 0 && lights.iter().flat_map(|l| &l.techniques).all(TechniqueReport::passes);
        let Closure { volumes, triangles, open_edges } = closed;
        Self {
            scene,
            size,
            adapter: gpu.info.name.clone(),
            backend: gpu.info.backend.to_string(),
            driver,
            depth_format: format!("{:?}", gpu.depth_stencil),
            closure: ClosureReport { volumes, triangles, open_edges },
            lights,
            passed,
            suspect: None,
        }
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
        self.lights.iter().flat_map(|light| &light.techniques)
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
        // Only pixels that are left out, and those do not depend on what was rendered.
        let ideal = truth.compare_mask(&truth.mask()).map_err(|e| Error::failed(e.to_string()))?;
        let excluded = Doubt::ALL.into_iter().map(|doubt| (doubt.name(), ideal.excluded[doubt as usize]));
        let mut techniques = Vec::with_capacity(variants.len());
        for (variant, images) in variants.iter().zip(images) {
            let of_light = |kind: &[Vec<u8>]| kind.get(i).cloned().unwrap_or_default();
            let row = TechniqueReport::new(variant.name, truth, &of_light(&images.shadow), &of_light(&images.stencil));
            techniques.push(row.map_err(|e| Error::failed(format!("light {light}, {}: {e}", variant.name)))?);
        }
        Ok(Self {
            light,
            name: scene.lights[light].name.clone(),
            kind: match scene.lights[light].kind {
                LightKind::Point { .. } => "point",
                LightKind::Spot { .. } => "spot",
                LightKind::Directional { .. } => "directional",
            },
            checked: ideal.checked,
            background: ideal.background,
            lit: ideal.lit,
            shadowed: ideal.shadowed,
            excluded: excluded.filter(|(_, pixels)| *pixels > 0).collect(),
            proves_little: proves_little(&ideal),
            techniques,
        })
    }
}

/// Why a comparison without mismatch would mean little; `None` if it means much.
fn proves_little(report: &zfail_oracle::Report) -> Option<String> {
    if let Err(over) = report.budget() {
        return Some(over.to_string());
    }
    let few = |share: usize| (share as f64) < 0.001 * report.checked.max(1) as f64;
    match (few(report.lit), few(report.shadowed)) {
        (true, true) => Some("hardly any pixel is within the light's reach".to_owned()),
        (true, false) => Some("hardly any pixel is lit".to_owned()),
        (false, true) => Some("hardly any pixel is in shadow".to_owned()),
        (false, false) => None,
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
    use zfail_oracle::{Guards, Pixel};

    /// A row of eight pixels: background, four lit ones, and three in shadow, the last of them doubtful.
    fn truth() -> Truth {
        let background =
            Pixel { surface: false, reached: false, lit: false, count: 0, mask_doubt: None, count_doubt: None };
        let lit = Pixel { surface: true, reached: true, lit: true, ..background };
        let dark = Pixel { lit: false, count: 2, ..lit };
        let doubtful = Pixel { mask_doubt: Some(Doubt::Boundary), count_doubt: Some(Doubt::Boundary), ..dark };
        let pixels = vec![background, lit, lit, lit, lit, dark, dark, doubtful];
        Truth { size: [8, 1], guards: Guards::default(), pixels }
    }

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

    #[test]
    fn what_proves_little_says_why() {
        let mut plenty = truth();
        plenty.pixels = [vec![plenty.pixels[1]; 300], vec![plenty.pixels[5]; 100]].concat();
        plenty.size = [400, 1];
        let why = |truth: &Truth| proves_little(&truth.compare_mask(&truth.mask()).unwrap());
        assert_eq!(why(&plenty), None);
        let only = |pixel: Pixel| Truth { pixels: vec![pixel; 400], ..plenty.clone() };
        assert_eq!(why(&only(plenty.pixels[0])), Some("hardly any pixel is in shadow".to_owned()));
        assert_eq!(why(&only(plenty.pixels[399])), Some("hardly any pixel is lit".to_owned()));
        assert!(why(&only(truth().pixels[7])).unwrap().contains("left out"));
    }
}
