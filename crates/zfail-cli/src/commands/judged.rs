//! What the oracle could judge of one light: how many pixels, and whether they prove anything.

use crate::error::Error;
use serde::Serialize;
use std::collections::BTreeMap;
use zfail_oracle::{Doubt, Truth};
use zfail_plan::light::LightKind;
use zfail_scene::Scene;

/// A light and the pixels at which its verdict is known.
#[derive(Clone, Debug, Serialize)]
pub struct JudgedLight {
    /// Its number in the scene.
    pub light: usize,
    pub name: String,
    pub kind: &'static str,
    /// Pixels with a surface within the light's reach that are compared.
    pub checked: usize,
    /// Compared pixels with a surface that the light does not reach, so that it is dark whatever casts shadows.
    pub out_of_reach: usize,
    /// Pixels without one that are compared.
    pub background: usize,
    /// Of the checked ones.
    pub lit: usize,
    /// Of the checked ones.
    pub shadowed: usize,
    /// Pixels left out, by reason.
    pub excluded: BTreeMap<&'static str, usize>,
    /// Why what was compared may hide what is wrong, if more is left out than boundaries explain.
    pub leaves_out: Option<String>,
    /// Why a pass would mean little.
    pub proves_little: Option<String>,
}

impl JudgedLight {
    /// What `truth` says of light number `light`.
    ///
    /// # Errors
    /// If the truth contradicts itself, which is a bug.
    pub fn new(scene: &Scene, light: usize, truth: &Truth) -> Result<Self, Error> {
        // What is left out does not depend on what was rendered.
        let ideal = truth.compare_mask(&truth.mask())?;
        let excluded = Doubt::ALL.into_iter().map(|doubt| (doubt.name(), ideal.excluded[doubt as usize]));
        Ok(Self {
            light,
            name: scene.lights[light].name.clone(),
            kind: match scene.lights[light].kind {
                LightKind::Point { .. } => "point",
                LightKind::Spot { .. } => "spot",
                LightKind::Directional { .. } => "directional",
            },
            checked: ideal.checked - ideal.unreached,
            out_of_reach: ideal.unreached,
            background: ideal.background,
            lit: ideal.lit,
            shadowed: ideal.shadowed,
            excluded: excluded.filter(|(_, pixels)| *pixels > 0).collect(),
            leaves_out: ideal.budget().err().map(|over| over.to_string()),
            proves_little: proves_little(&ideal),
        })
    }
}

/// Why a comparison without mismatch would mean little; `None` if it means much.
fn proves_little(report: &zfail_oracle::Report) -> Option<String> {
    if let Err(over) = report.budget() {
        return Some(format!("{over}; a larger --size leaves out fewer"));
    }
    let few = |share: usize| (share as f64) < 0.001 * (report.checked - report.unreached).max(1) as f64;
    match (few(report.lit), few(report.shadowed)) {
        (true, true) => Some("hardly any pixel is within the light's reach".to_owned()),
        (true, false) => Some("hardly any pixel is lit".to_owned()),
        (false, true) => Some("hardly any pixel is in shadow".to_owned()),
        (false, false) => None,
    }
}

#[cfg(test)]
pub mod tests {
    use super::*;
    use zfail_oracle::{Guards, Pixel};

    /// A row of eight pixels: background, four lit ones, and three in shadow, the last of them doubtful.
    pub fn truth() -> Truth {
        let background =
            Pixel { surface: false, reached: false, lit: false, count: 0, mask_doubt: None, count_doubt: None };
        let lit = Pixel { surface: true, reached: true, lit: true, ..background };
        let dark = Pixel { lit: false, count: 2, ..lit };
        let doubtful = Pixel { mask_doubt: Some(Doubt::Boundary), count_doubt: Some(Doubt::Boundary), ..dark };
        let pixels = vec![background, lit, lit, lit, lit, dark, dark, doubtful];
        Truth { size: [8, 1], guards: Guards::default(), pixels }
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
