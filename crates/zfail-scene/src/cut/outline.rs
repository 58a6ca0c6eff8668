//! Where a texture is there: its simplified contour, ready to be asked.
//!
//! In: alpha and a cutoff. Out: the contour's segments near a triangle, and on which side of it a point lies.

use super::field::AlphaField;
use super::grid::Grid;
use super::simplify::simplify;
use super::trace::{generic, trace};
use glam::DVec2;

/// The region of the plane where alpha reaches a level, to within a tolerance.
#[derive(Debug)]
pub(super) struct Outline<'a> {
    field: AlphaField<'a>,
    level: f64,
    /// With the region on their left.
    segments: Vec<[DVec2; 2]>,
    grid: Grid,
    traced: usize,
}

impl<'a> Outline<'a> {
    /// The region where `field` is at least `level` (0 to 255), its contour at most `tolerance` texels from the true one;
    /// `None` if the true one would take more than `limit` points.
    pub fn new(field: AlphaField<'a>, level: f64, tolerance: f64, limit: usize) -> Option<Self> {
        /// What chords may use up of the tolerance. The rest is left to leaving out points.
        const BENDS: f64 = 0.25;
        let level = generic(level);
        let rings = trace(&field, level, BENDS * tolerance, limit.min(u32::MAX as usize))?;
        let traced = rings.iter().map(|ring| ring.points.len()).sum();
        let rings = simplify(&rings, field.axes, (1.0 - BENDS) * tolerance);
        let mut segments = Vec::new();
        for ring in &rings {
            segments.extend(ring.points.windows(2).map(|ends| [ends[0], ends[1]]));
            segments.push([ring.points[ring.points.len() - 1], ring.points[0] + ring.closing]);
        }
        let mut grid = Grid::new(field.axes, segments.len());
        for (number, &[a, b]) in segments.iter().enumerate() {
            grid.put(number as u32, [a, b, b]);
        }
        Some(Self { field, level, segments, grid, traced })
    }

    /// The segments in one period of the plane.
    #[cfg(test)]
    pub fn segments(&self) -> &[[DVec2; 2]] {
        &self.segments
    }

    /// How many points the contour had before it was simplified.
    pub fn traced(&self) -> usize {
        self.traced
    }

    /// Width and height of the image, texels.
    pub fn size(&self) -> DVec2 {
        self.field.size()
    }

    /// Work that it takes to find the segments near a triangle, in buckets.
    pub fn effort(&self, triangle: [DVec2; 3]) -> f64 {
        self.grid.effort(triangle)
    }

    /// All segments that may meet a triangle, each once.
    pub fn near(&self, triangle: [DVec2; 3]) -> Vec<[DVec2; 2]> {
        let mut found = Vec::new();
        // Shifts are whole numbers of texels.
        self.grid.near(triangle, |segment, shift| found.push((segment, shift.x as i64, shift.y as i64)));
        found.sort_unstable();
        found.dedup();
        let moved = |(segment, x, y): (u32, i64, i64)| {
            self.segments[segment as usize].map(|end| end + DVec2::new(x as f64, y as f64))
        };
        found.into_iter().map(moved).collect()
    }

    /// Whether `point` is in the region. It should not lie on the contour.
    pub fn contains(&self, point: DVec2) -> bool {
        // The first segment in the direction of +x tells: its left is the region. Where several meet on the way, it is the
        // one that is first just above.
        let mut nearest = (f64::INFINITY, f64::INFINITY, false);
        self.grid.walk(point, |bucket_end, things| {
            for (segment, shift) in things {
                let [a, b] = self.segments[segment as usize].map(|end| end + shift);
                if (a.y <= point.y) == (b.y <= point.y) {
                    continue;
                }
                let x = a.x + (b.x - a.x) * (point.y - a.y) / (b.y - a.y);
                let lean = (b.x - a.x) / (b.y - a.y);
                if x >= point.x && (x, lean) < (nearest.0, nearest.1) {
                    nearest = (x, lean, b.y > a.y);
                }
            }
            nearest.0 <= bucket_end
        });
        if nearest.0 < f64::INFINITY { nearest.2 } else { self.field.at(point) >= self.level }
    }
}
