//! How close to an ambiguity a pixel may be before it is left out.

/// Sizes of the guards; computed from geometry alone, never from what a GPU drew.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Guards {
    /// Pixels: the answer must be the same wherever the pixel's centre is moved within this radius.
    pub epsilon: f64,
    /// Units in the last place of a 24-bit depth buffer by which the surface may move along the view ray.
    pub kappa: f64,
}

impl Default for Guards {
    /// For rasterisers with 8 bits of sub-pixel precision.
    fn default() -> Self {
        Self { epsilon: 1.0 / 16.0, kappa: 8.0 }
    }
}

/// Relative error of a position that went through one matrix in f32.
pub(crate) const ROUNDING: f64 = 1.0 / (1 << 22) as f64;

/// Relative height over a triangle's plane below which the light may count as lying in it.
pub(crate) const FACING: f64 = 1.0 / (1 << 19) as f64;

/// Pixels by which a rasteriser may move the outline of a polygon.
pub(crate) const SNAP: f64 = 1.0 / 128.0;

/// The centre and the offsets at which a pixel is probed, from the inside outwards.
pub(crate) const PROBES: usize = 1 + 6 * 8;

impl Guards {
    /// Offsets from the pixel's centre, in pixels: 0, then 8 directions at `epsilon / 32` to `epsilon`.
    pub(crate) fn offsets(&self) -> [[f64; 2]; PROBES] {
        std::array::from_fn(|i| match i.checked_sub(1) {
            None => [0.0; 2],
            Some(i) => {
                let radius = self.epsilon / f64::from(1 << (5 - i / 8));
                // Not along the axes, where scenes on integer grids have their edges.
                let (sin, cos) = ((i % 8) as f64 * std::f64::consts::FRAC_PI_4 + 0.1).sin_cos();
                [radius * cos, radius * sin]
            }
        })
    }
}

/// Why a pixel is left out.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Doubt {
    /// E1: which surface is seen, or the answers of those that may be seen, differ within the guard.
    Surface,
    /// E2: the boundary of a shadow passes within the guard.
    Boundary,
    /// E3: the answer changes with the depth by as much as depth and positions are rounded.
    Depth,
    /// The surface is edge-on to the light, so that sides of volumes lie in it; shading leaves it dark either way.
    EdgeOn,
    /// The end of the light's range or cone passes within the guard.
    Reach,
    /// An alpha-tested surface is seen or would be seen; the oracle reads no textures.
    Alpha,
}

impl Doubt {
    /// Every reason, in the order of their discriminants.
    pub const ALL: [Self; 6] = [Self::Surface, Self::Boundary, Self::Depth, Self::EdgeOn, Self::Reach, Self::Alpha];

    /// What to call it in a report.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Surface => "surface",
            Self::Boundary => "boundary",
            Self::Depth => "depth",
            Self::EdgeOn => "edge-on",
            Self::Reach => "reach",
            Self::Alpha => "alpha",
        }
    }

    /// Whether what was left out for this reason is limited: the others are whole surfaces, not lines.
    #[must_use]
    pub const fn is_budgeted(self) -> bool {
        !matches!(self, Self::EdgeOn | Self::Alpha)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn offsets_grow_to_epsilon() {
        let offsets = Guards::default().offsets();
        let radius = |i: usize| offsets[i][0].hypot(offsets[i][1]);
        assert_eq!(offsets[0], [0.0; 2]);
        assert!((radius(1) - 1.0 / 512.0).abs() < 1e-15);
        assert!((radius(PROBES - 1) - 1.0 / 16.0).abs() < 1e-15);
        assert!((1..PROBES).all(|i| radius(i - 1) <= radius(i) + 1e-15));
    }
}
