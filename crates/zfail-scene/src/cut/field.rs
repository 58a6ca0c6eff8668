//! Alpha as a function on the plane of a texture's largest level.
//!
//! In: an image, its wrapping and its filter. Out: alpha, in units of a texel's byte, at the centres of texels (nodes) and
//! between them.
//!
//! Coordinates are in texels, x along u and y along v: texel (i, j) covers the square from (i, j) to (i + 1, j + 1), and node
//! (i, j) is its centre. Wrapping makes the plane a torus, a cylinder or a plane whose border goes on for ever.

use crate::{Filter, Image, Texture, Wrap};
use glam::DVec2;
use std::borrow::Cow;

/// Where a clamped texture ends after all, in texels beyond its border: farther out than any coordinate that is cut.
pub(super) const FAR: f64 = (1_u64 << 26) as f64;

/// One direction of the plane.
#[derive(Clone, Copy, Debug)]
pub(super) struct Axis {
    texels: i64,
    wrap: Wrap,
}

impl Axis {
    /// So many texels of a plane that does not repeat itself.
    pub fn of_length(texels: i64) -> Self {
        Self { texels, wrap: Wrap::Clamp }
    }

    /// After how many texels everything repeats, if it does.
    pub fn period(&self) -> Option<f64> {
        match self.wrap {
            Wrap::Repeat => Some(self.texels as f64),
            Wrap::Mirror => Some(2.0 * self.texels as f64),
            Wrap::Clamp => None,
        }
    }

    /// Texels in the image.
    pub fn texels(&self) -> f64 {
        self.texels as f64
    }

    /// The nodes from each of which a cell goes to the next node. Beyond the border of a clamped texture lies a node far
    /// away, and beyond that one where nothing is, so that every contour is closed.
    pub fn cells(&self) -> std::ops::Range<i64> {
        match self.wrap {
            Wrap::Repeat => 0..self.texels,
            Wrap::Mirror => 0..2 * self.texels,
            Wrap::Clamp => -2..self.texels + 1,
        }
    }

    /// The node of [`Self::cells`] that is the same as node `k`.
    pub fn home(&self, k: i64) -> i64 {
        match self.wrap {
            Wrap::Clamp => k,
            Wrap::Repeat | Wrap::Mirror => k.rem_euclid(self.cells().end),
        }
    }

    /// Where node `k` is.
    pub fn node(&self, k: i64) -> f64 {
        match self.wrap {
            Wrap::Clamp if k < 0 => (k + 1) as f64 - FAR,
            Wrap::Clamp if k >= self.texels => k as f64 + FAR,
            _ => k as f64 + 0.5,
        }
    }

    /// Whether nothing is at node `k` any more.
    fn is_beyond(&self, k: i64) -> bool {
        self.wrap == Wrap::Clamp && !(-1..=self.texels).contains(&k)
    }

    /// The texel of the image at node `k`.
    fn texel(&self, k: i64) -> i64 {
        match self.wrap {
            Wrap::Repeat => k.rem_euclid(self.texels),
            Wrap::Mirror => {
                let k = k.rem_euclid(2 * self.texels);
                k.min(2 * self.texels - 1 - k)
            }
            Wrap::Clamp => k.clamp(0, self.texels - 1),
        }
    }
}

/// Alpha over the plane.
#[derive(Clone, Debug)]
pub(super) struct AlphaField<'a> {
    image: Cow<'a, Image>,
    /// Along x and y.
    pub axes: [Axis; 2],
    /// How it goes from node to node.
    pub filter: Filter,
}

impl<'a> AlphaField<'a> {
    /// The alpha of `image` as `texture` samples it in close-up, of the whole or thinned to a half so many times.
    pub fn new(image: &'a Image, texture: &Texture, halvings: u32) -> Self {
        let axis = |texels: u32, wrap| Axis { texels: i64::from(texels), wrap };
        let image = if halvings == 0 { Cow::Borrowed(image) } else { Cow::Owned(thinned(image, halvings)) };
        let axes = [axis(image.width, texture.wrap_u), axis(image.height, texture.wrap_v)];
        Self { image, axes, filter: texture.mag }
    }

    /// Width and height of the image, texels.
    pub fn size(&self) -> DVec2 {
        DVec2::from(self.axes.map(|axis| axis.texels()))
    }

    /// Alpha at a node, 0 to 255; less where nothing is.
    pub fn at_node(&self, [i, j]: [i64; 2]) -> f64 {
        if self.axes[0].is_beyond(i) || self.axes[1].is_beyond(j) { -1.0 } else { self.texel([i, j]) }
    }

    /// Alpha at a point, 0 to 255.
    pub fn at(&self, point: DVec2) -> f64 {
        match self.filter {
            Filter::Nearest => self.texel(point.floor().as_i64vec2().to_array()),
            Filter::Linear => {
                let low = (point - 0.5).floor();
                let [i, j] = low.as_i64vec2().to_array();
                let f = point - 0.5 - low;
                let row = |j| self.texel([i, j]) * (1.0 - f.x) + self.texel([i + 1, j]) * f.x;
                row(j) * (1.0 - f.y) + row(j + 1) * f.y
            }
        }
    }

    fn texel(&self, [i, j]: [i64; 2]) -> f64 {
        let (x, y) = (self.axes[0].texel(i) as usize, self.axes[1].texel(j) as usize);
        self.image.rgba.get((y * self.image.width as usize + x) * 4 + 3).map_or(0.0, |&alpha| f64::from(alpha))
    }
}

/// A smaller image of one pixel out of each block, as if by chance: so much of it is there as of the whole, be it noise or
/// a regular dither, and at every cutoff.
fn thinned(image: &Image, halvings: u32) -> Image {
    let length = |pixels: u32| pixels.checked_shr(halvings).unwrap_or(0).max(1);
    let (width, height) = (length(image.width), length(image.height));
    // Blocks may differ by a pixel where the sides are no powers of two.
    let pick = |k: u32, from: u32, to: u32, chance: u64| {
        let start = |k: u32| u64::from(k) * u64::from(from) / u64::from(to);
        start(k) + chance % (start(k + 1) - start(k))
    };
    let mut rgba = Vec::with_capacity(4 * width as usize * height as usize);
    for y in 0..height {
        for x in 0..width {
            let chance = mixed(u64::from(y) << 32 | u64::from(x));
            let (i, j) =
                (pick(x, image.width, width, chance >> 32), pick(y, image.height, height, chance & 0xffff_ffff));
            let alpha = image.rgba.get((j * u64::from(image.width) + i) as usize * 4 + 3).copied().unwrap_or(0);
            rgba.extend([0, 0, 0, alpha]);
        }
    }
    Image { name: image.name.clone(), width, height, rgba }
}

/// A number that only looks random (the finaliser of SplitMix64).
fn mixed(x: u64) -> u64 {
    let x = x.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let x = (x ^ x >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let x = (x ^ x >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
    x ^ x >> 31
}
