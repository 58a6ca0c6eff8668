//! What cutting may cost, and how it is made to fit.
//!
//! Nothing in a file bounds how many triangles a mask becomes: a pixel of noise may be an island of its own. So what a cut
//! will take is counted before the work is done, on the contour's cells and on the segments near each triangle, and if
//! that is too much the mesh is tried again with the next [`Step`].

use std::sync::atomic::{AtomicU64, Ordering};

/// What cutting a scene may cost.
#[derive(Clone, Copy, Debug)]
pub struct Limits {
    /// Triangles that the cut primitives of the scene may have together, beyond [`Self::growth`]. A mesh gets at most half
    /// of what those before it have left.
    pub triangles: u64,
    /// Triangles that every masked triangle may become in any case, on the average of its mesh.
    pub growth: u64,
    /// Points of the contours of all textures. A texture gets at most a quarter of what those before it have left, but
    /// always some thousands.
    pub points: u64,
    /// Bytes that the new vertices and triangles may take.
    pub bytes: u64,
}

impl Default for Limits {
    /// Half a million triangles and 64 more for each that is masked, 2 million points, and 2 GiB.
    fn default() -> Self {
        Self { triangles: 1 << 19, growth: 64, points: 1 << 21, bytes: 2 << 30 }
    }
}

impl Limits {
    /// What a mesh with so many masked triangles may take.
    pub(super) fn of_mesh(&self, masked: u64) -> Spent {
        /// The most that any scene may have.
        const MOST: u64 = 4_000_000;
        let triangles = self.growth.saturating_mul(masked).saturating_add(self.triangles / 2);
        Spent { triangles: triangles.min(MOST), bytes: self.bytes }
    }

    /// What a mesh with so many masked triangles has taken is not there any more.
    pub(super) fn take(&mut self, masked: u64, spent: Spent) {
        let beyond = spent.triangles.saturating_sub(self.growth.saturating_mul(masked));
        self.triangles = self.triangles.saturating_sub(beyond);
        self.bytes = self.bytes.saturating_sub(spent.bytes);
    }

    /// How many points the contour of the next texture may have.
    pub(super) fn of_contour(&self) -> usize {
        const ALWAYS: u64 = 1 << 13;
        (self.points / 4).max(ALWAYS.min(self.points)) as usize
    }
}

/// What is spent while a mesh is cut.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Spent {
    pub triangles: u64,
    pub bytes: u64,
}

/// How finely a mesh is cut.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Step {
    /// How often the texture is halved first.
    pub halvings: u32,
    /// In texels of the halved texture.
    pub tolerance: f64,
}

impl Step {
    /// From what was asked for to ever coarser ones.
    ///
    /// A higher tolerance takes points out of contours. Where these are many small ones it does not help, since none is ever
    /// lost to it; there fewer and fewer pixels count, chosen so that as much stays there as was.
    pub fn all(tolerance: f64) -> impl Iterator<Item = Self> {
        const COARSER: f64 = 4.0;
        /// To a single texel for every image.
        const HALVINGS: u32 = 24;
        let whole = [1.0, COARSER].map(|times| Self { halvings: 0, tolerance: tolerance * times });
        let halved = move |halvings: u32| {
            let tolerance = (tolerance * COARSER / f64::from(halvings).exp2()).max(1.0);
            Self { halvings, tolerance }
        };
        whole.into_iter().chain((1..=HALVINGS).map(halved))
    }

    /// How far a contour may be off, in texels of the image as it was, if the longer side of one of the halved image is
    /// `stretch` of those.
    pub fn error(&self, stretch: f64) -> f64 {
        /// What is interpolated at a point depends on pixels that are no farther, in texels of the halved image: one and a
        /// half in both directions. At a contour's point some are above the level and some below.
        const REACH: f64 = 1.5 * std::f64::consts::SQRT_2;
        if self.halvings == 0 { self.tolerance } else { (self.tolerance + REACH) * stretch }
    }
}

/// What is left to spend on a mesh.
pub(super) struct Room {
    pub triangles: AtomicU64,
    /// Buckets of outlines and cells of textures to be looked into.
    pub places: AtomicU64,
}

impl Room {
    pub fn new(limit: Spent) -> Self {
        /// Looking into one takes some 10 ns.
        const PLACES: u64 = 1 << 27;
        Self { triangles: limit.triangles.into(), places: PLACES.into() }
    }

    /// Takes `amount` away, if that much is left.
    pub fn take(of: &AtomicU64, amount: u64) -> Option<()> {
        of.fetch_update(Ordering::Relaxed, Ordering::Relaxed, |left| left.checked_sub(amount)).ok().map(|_| ())
    }
}
