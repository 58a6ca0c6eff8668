//! Surfaces given by a function of a grid: open sheets, and slabs with thickness and holes.

use super::{CREASE, Facets, Mesh};
use glam::DVec3;

/// An open sheet of `columns` x `rows` quadrilaterals through the points `at(i, j)`, smooth; its front is where
/// `at` turns counter-clockwise.
#[must_use]
pub fn sheet(columns: usize, rows: usize, at: impl Fn(usize, usize) -> DVec3) -> Mesh {
    let mut facets = Facets::default();
    for j in 0..rows {
        for i in 0..columns {
            facets.quad([at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]);
        }
    }
    facets.mesh("sheet", std::f64::consts::FRAC_PI_2)
}

/// A closed slab over a grid of cells, some of which may be holes: a pierced lantern, a wall with windows, an arcade.
#[derive(Clone, Copy, Debug)]
pub struct Slab {
    /// Cells along i.
    pub columns: usize,
    /// Cells along j.
    pub rows: usize,
    /// Whether the last column joins the first.
    pub wraps: bool,
    /// Edges sharper than this, in radians, are creases.
    pub crease: f64,
}

impl Slab {
    /// A slab that does not wrap, with the usual crease angle.
    #[must_use]
    pub const fn new(columns: usize, rows: usize) -> Self {
        Self { columns, rows, wraps: false, crease: CREASE }
    }

    /// The mesh: `solid(i, j)` says which cells exist, `at(i, j)` gives the front and the back point of a grid corner.
    /// Seen from the front, j grows counter-clockwise from i. Solid cells must not touch at a corner only.
    #[must_use]
    pub fn mesh(&self, solid: impl Fn(usize, usize) -> bool, at: impl Fn(usize, usize) -> [DVec3; 2]) -> Mesh {
        let at = |i: usize, j: usize| at(if self.wraps { i % self.columns } else { i }, j);
        let filled = |i: isize, j: isize| {
            let i = if self.wraps { i.rem_euclid(self.columns as isize) } else { i };
            (0..self.columns as isize).contains(&i)
                && (0..self.rows as isize).contains(&j)
                && solid(i as usize, j as usize)
        };
        let mut facets = Facets::default();
        for j in 0..self.rows {
            for i in 0..self.columns {
                if !solid(i, j) {
                    continue;
                }
                let corners = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
                let [a, b, c, d] = corners.map(|[front, _]| front);
                facets.quad([a, b, c, d]);
                let [a, b, c, d] = corners.map(|[_, back]| back);
                facets.quad([d, c, b, a]);
                for (side, (di, dj)) in [(0, -1), (1, 0), (0, 1), (-1, 0)].into_iter().enumerate() {
                    if !filled(i as isize + di, j as isize + dj) {
                        let [from, to] = [corners[side], corners[(side + 1) % 4]];
                        facets.quad([to[0], from[0], from[1], to[1]]);
                    }
                }
            }
        }
        facets.mesh("slab", self.crease)
    }
}
