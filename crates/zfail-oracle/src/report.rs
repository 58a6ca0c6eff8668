//! Comparing an image with the truth, and guarding against leaving out too much.
//!
//! In: a mask or counts that a renderer made. Out: which pixels are wrong, how many were checked and why the others
//! were not, and whether their number is within the budget.

use crate::{
    guard::Doubt,
    truth::{Pixel, Truth},
};

/// The result of comparing one image.
#[derive(Clone, Debug, PartialEq)]
pub struct Report {
    /// Pixels that show a surface or may do so.
    pub surfaces: usize,
    /// Pixels with a surface that were compared.
    pub checked: usize,
    /// Of those, how many the light does not reach, so that they are dark whatever blocks it.
    pub unreached: usize,
    /// Pixels without a surface that were compared.
    pub background: usize,
    /// Compared pixels that are not right.
    pub wrong: Vec<Wrong>,
    /// Pixels left out, by [`Doubt::ALL`].
    pub excluded: [usize; Doubt::ALL.len()],
    /// Checked pixels that are lit.
    pub lit: usize,
    /// Checked pixels within the light's reach that are in shadow.
    pub shadowed: usize,
    /// Largest count among checked pixels.
    pub max_count: i32,
    /// Pixels of which one of the four neighbours has another value.
    pub boundary: usize,
    /// Pixels left out for [`Doubt::Surface`] or [`Doubt::Boundary`] together with all eight neighbours.
    pub thick: usize,
    /// The guard's radius in pixels.
    pub epsilon: f64,
}

/// A pixel that is not as it should be.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Wrong {
    /// Column from the left.
    pub x: u32,
    /// Row from the top.
    pub y: u32,
    /// What is right.
    pub expected: u8,
    /// What the image has.
    pub found: u8,
}

/// An image that does not have as many pixels as the truth.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the image has {found} pixels, the truth {expected}")]
pub struct SizeMismatch {
    /// Pixels of the truth.
    pub expected: usize,
    /// Pixels of the image.
    pub found: usize,
}

/// A comparison that left out more than boundaries explain.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum OverBudget {
    /// Too many.
    #[error("{share:.3} of the pixels are left out, {allowed:.3} are allowed")]
    Share {
        /// What was left out, of all pixels with a surface.
        share: f64,
        /// What the length of the boundaries allows.
        allowed: f64,
    },
    /// Areas instead of lines.
    #[error("{pixels} pixels are left out with all their neighbours: the scene is too fine for the image")]
    Thick {
        /// How many.
        pixels: usize,
    },
}

impl Report {
    /// Pixels left out that the budget limits: alpha-tested surfaces and those edge-on to the light are counted apart.
    #[must_use]
    pub fn excluded_total(&self) -> usize {
        Doubt::ALL.iter().filter(|d| d.is_budgeted()).map(|d| self.excluded[*d as usize]).sum()
    }

    /// [`Report::excluded_total`] as a share of all pixels with a surface.
    #[must_use]
    pub fn excluded_share(&self) -> f64 {
        self.excluded_total() as f64 / self.surfaces.max(1) as f64
    }

    /// The share that may be left out: 0.5 % and the guard's width along all boundaries.
    #[must_use]
    pub fn allowed_share(&self) -> f64 {
        0.005 + 2.0 * self.epsilon * self.boundary as f64 / self.surfaces.max(1) as f64
    }

    /// Whether what was left out is a thin line along boundaries, so that it cannot hide errors.
    ///
    /// # Errors
    /// If it is more.
    pub fn budget(&self) -> Result<(), OverBudget> {
        let (share, allowed) = (self.excluded_share(), self.allowed_share());
        match () {
            () if share > allowed => Err(OverBudget::Share { share, allowed }),
            () if self.thick > 0 => Err(OverBudget::Thick { pixels: self.thick }),
            () => Ok(()),
        }
    }

    /// Whether at least `share` of the checked pixels are lit, and as many in shadow: a test of shadows needs both.
    #[must_use]
    pub fn has_both(&self, share: f64) -> bool {
        self.lit.min(self.shadowed) as f64 >= share * self.checked as f64
    }
}

impl Truth {
    /// Compares a shadow mask: 255 lit, 0 everywhere else.
    ///
    /// # Errors
    /// If the sizes differ.
    pub fn compare_mask(&self, mask: &[u8]) -> Result<Report, SizeMismatch> {
        self.compare(mask, |p| p.mask_doubt, |p| Some(p.mask()), |p| i32::from(p.mask()))
    }

    /// Compares stencil counts modulo 256, where a surface is within the light's reach.
    ///
    /// # Errors
    /// If the sizes differ.
    pub fn compare_count(&self, counts: &[u8]) -> Result<Report, SizeMismatch> {
        let expected = |p: &Pixel| (p.surface && p.reached).then(|| p.count.rem_euclid(256) as u8);
        self.compare(counts, |p| p.count_doubt, expected, |p| if p.reached { p.count } else { -1 })
    }

    fn compare(
        &self,
        image: &[u8],
        doubt: fn(&Pixel) -> Option<Doubt>,
        expected: impl Fn(&Pixel) -> Option<u8>,
        value: fn(&Pixel) -> i32,
    ) -> Result<Report, SizeMismatch> {
        if image.len() != self.pixels.len() {
            return Err(SizeMismatch { expected: self.pixels.len(), found: image.len() });
        }
        let mut report = Report {
            surfaces: 0,
            checked: 0,
            unreached: 0,
            background: 0,
            wrong: Vec::new(),
            excluded: [0; Doubt::ALL.len()],
            lit: 0,
            shadowed: 0,
            max_count: 0,
            boundary: self.boundary(|p| p.surface.then(|| value(p))),
            thick: self.thick(doubt),
            epsilon: self.guards.epsilon,
        };
        for (i, (pixel, &found)) in self.pixels.iter().zip(image).enumerate() {
            report.surfaces += usize::from(pixel.surface || doubt(pixel).is_some());
            if let Some(doubt) = doubt(pixel) {
                report.excluded[doubt as usize] += 1;
                continue;
            }
            let Some(expected) = expected(pixel) else { continue };
            if pixel.surface {
                report.checked += 1;
                report.unreached += usize::from(!pixel.reached);
                report.lit += usize::from(pixel.reached && pixel.lit);
                report.shadowed += usize::from(pixel.reached && !pixel.lit);
                report.max_count = report.max_count.max(pixel.count);
            } else {
                report.background += 1;
            }
            if found != expected {
                let (x, y) = (i as u32 % self.size[0], i as u32 / self.size[0]);
                report.wrong.push(Wrong { x, y, expected, found });
            }
        }
        Ok(report)
    }

    /// The pixel `(dx, dy)` away from pixel `i`, if it is in the image.
    fn neighbour(&self, i: usize, dx: i64, dy: i64) -> Option<&Pixel> {
        let width = i64::from(self.size[0]);
        let (x, y) = (i as i64 % width + dx, i as i64 / width + dy);
        let inside = (0..width).contains(&x) && (0..i64::from(self.size[1])).contains(&y);
        inside.then(|| &self.pixels[(y * width + x) as usize])
    }

    fn boundary<T: PartialEq>(&self, value: impl Fn(&Pixel) -> T) -> usize {
        const CROSS: [(i64, i64); 4] = [(1, 0), (-1, 0), (0, 1), (0, -1)];
        let differs = |&i: &usize| {
            let here = value(&self.pixels[i]);
            CROSS.iter().any(|&(dx, dy)| self.neighbour(i, dx, dy).is_some_and(|p| value(p) != here))
        };
        (0..self.pixels.len()).filter(differs).count()
    }

    fn thick(&self, doubt: fn(&Pixel) -> Option<Doubt>) -> usize {
        let thin = |p: &Pixel| !matches!(doubt(p), Some(Doubt::Surface | Doubt::Boundary));
        let surrounded = |&i: &usize| {
            let around = (-1..=1).flat_map(|dy| (-1..=1).map(move |dx| (dx, dy)));
            !around.into_iter().any(|(dx, dy)| self.neighbour(i, dx, dy).is_none_or(thin))
        };
        (0..self.pixels.len()).filter(surrounded).count()
    }

    /// A picture of a comparison of masks, 3 bytes a pixel: grey levels are lit, shadow and background, blue was left
    /// out, red is lit but should not be, green is dark but should not be.
    ///
    /// # Errors
    /// If the sizes differ.
    pub fn diff_image(&self, mask: &[u8]) -> Result<Vec<u8>, SizeMismatch> {
        if mask.len() != self.pixels.len() {
            return Err(SizeMismatch { expected: self.pixels.len(), found: mask.len() });
        }
        let color = |(pixel, &found): (&Pixel, &u8)| match pixel.mask_doubt {
            Some(_) => [40, 80, 255],
            None if pixel.mask() == found => match (pixel.surface, found) {
                (false, _) => [0, 0, 0],
                (true, 0) => [70, 70, 70],
                (true, _) => [220, 220, 220],
            },
            None if found == 0 => [0, 230, 60],
            None => [255, 30, 30],
        };
        Ok(self.pixels.iter().zip(mask).flat_map(color).collect())
    }
}
