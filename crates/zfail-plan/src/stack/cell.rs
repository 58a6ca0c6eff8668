//! Rectangles of directions.

use glam::DVec3;

/// Far above the rounding of determinants of unit vectors in f64, far below anything that f32 positions can express.
pub(super) const NOISE: f64 = 4e-15;

/// Turns cube face `face` towards +z; never mirrors.
pub(super) fn turn(h: DVec3, face: usize) -> DVec3 {
    match face {
        0 => h,
        1 => DVec3::new(-h.x, h.y, -h.z),
        2 => DVec3::new(h.y, h.z, h.x),
        3 => DVec3::new(-h.y, h.z, -h.x),
        4 => DVec3::new(h.z, h.x, h.y),
        _ => DVec3::new(-h.z, h.x, -h.y),
    }
}

/// A rectangle of the plane z = 1, standing for the pyramid of directions through it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cell {
    x: [f64; 2],
    y: [f64; 2],
}

impl Cell {
    /// A whole face of the cube.
    pub const FACE: Self = Self { x: [-1.0, 1.0], y: [-1.0, 1.0] };

    /// A direction alone.
    pub const fn at(p: DVec3) -> Self {
        Self { x: [p.x, p.x], y: [p.y, p.y] }
    }

    /// Its quarters.
    pub fn quarters(&self) -> [Self; 4] {
        let (mx, my) = ((self.x[0] + self.x[1]) * 0.5, (self.y[0] + self.y[1]) * 0.5);
        let ([left, right], [below, above]) = ([[self.x[0], mx], [mx, self.x[1]]], [[self.y[0], my], [my, self.y[1]]]);
        [(left, below), (right, below), (left, above), (right, above)].map(|(x, y)| Self { x, y })
    }

    /// A direction in it that no vertex of an ordinary mesh shares.
    pub fn reference(&self) -> DVec3 {
        let within = |[from, to]: [f64; 2], part: f64| from + (to - from) * part;
        DVec3::new(within(self.x, 0.414_213_562_373), within(self.y, 0.618_033_988_749), 1.0)
    }

    /// The planes that bound it, positive within.
    pub fn planes(&self) -> [DVec3; 5] {
        [
            DVec3::new(1.0, 0.0, -self.x[0]),
            DVec3::new(-1.0, 0.0, self.x[1]),
            DVec3::new(0.0, 1.0, -self.y[0]),
            DVec3::new(0.0, -1.0, self.y[1]),
            DVec3::Z,
        ]
    }

    /// Whether all `directions` lie beside the cell, on one side.
    pub fn is_beside(&self, directions: &[DVec3]) -> bool {
        let size = directions.iter().map(|h| h.abs().max_element()).fold(0.0, f64::max);
        self.planes().iter().any(|plane| directions.iter().all(|h| plane.dot(*h) < -NOISE * size))
    }

    /// Whether it lies on one side of the plane of all directions across `normal`.
    pub fn is_apart(&self, normal: DVec3) -> bool {
        let height = |x: f64, y: f64| normal.x * x + normal.y * y + normal.z;
        let heights = [(0, 0), (1, 0), (0, 1), (1, 1)].map(|(i, j)| height(self.x[i], self.y[j]));
        heights.iter().all(|h| *h > NOISE) || heights.iter().all(|h| *h < -NOISE)
    }
}
