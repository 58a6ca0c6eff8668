//! Alpha over one triangle as a product, and where it crosses a level on the triangle's edges.
//!
//! In: corners with alpha, and alpha on the plane of a texture. Out: crossings of an edge that depend on its two ends
//! alone, in an order that does not depend on the triangle.

use super::field::AlphaField;
use super::triangle::{Corner, UNIT, Weights, in_order, on_plane, sides};
use glam::DVec2;

/// How far alpha is above a level.
pub(super) struct Product<'a> {
    field: Option<&'a AlphaField<'a>>,
    /// Of a texture that is the same everywhere.
    even: f64,
    level: f64,
    pub corners: [Corner; 3],
    alphas: [f64; 3],
    area: f64,
}

/// A place on the way from an edge's first end to its second, and whether it is inside there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Sample {
    /// The weight of the second end.
    pub far: u32,
    pub inside: bool,
}

impl<'a> Product<'a> {
    /// The product of a `field`, or of what `everywhere` is in the middle, or of 255.
    pub fn new(
        field: Option<&'a AlphaField<'a>>,
        everywhere: Option<&AlphaField<'_>>,
        level: f64,
        corners: [Corner; 3],
        alphas: [f64; 3],
    ) -> Self {
        let [a, b, c] = corners.map(|corner| corner.texel);
        let even = everywhere.map_or(255.0, |field| field.at((a + b + c) / 3.0));
        let area = super::triangle::side(a, b, c);
        Self { field, even, level, corners, alphas, area }
    }

    /// Whether the texture's alpha differs from place to place.
    pub fn is_textured(&self) -> bool {
        self.field.is_some()
    }

    fn texture(&self, point: DVec2) -> f64 {
        self.field.map_or(self.even, |field| field.at(point))
    }

    /// At a corner.
    pub fn at_corner(&self, corner: usize) -> f64 {
        self.texture(self.corners[corner].texel) * self.alphas[corner] - self.level
    }

    /// At a point of the plane, in a triangle with area there.
    pub fn at(&self, point: DVec2) -> f64 {
        let [a, b, c] = sides(&self.corners, point);
        let [u, v, w] = self.alphas;
        self.texture(point) * ((a * u + b * v + c * w) / self.area) - self.level
    }

    /// At the point of the triangle with these weights of its second and third corner.
    pub fn at_weights(&self, [second, third]: [f64; 2]) -> f64 {
        let [u, v, w] = self.alphas;
        let point = on_plane(self.corners.map(|corner| corner.texel), [second, third]);
        self.texture(point) * (u + (v - u) * second + (w - u) * third) - self.level
    }

    /// The ends of the edge between two corners in the order in which it is looked at.
    pub fn ends(&self, edge: [usize; 2]) -> [usize; 2] {
        let [a, b] = edge;
        if in_order(self.corners[a].position, self.corners[b].position) { [a, b] } else { [b, a] }
    }

    /// The point of an edge, from [`Self::ends`], at which the second has a weight of `far`.
    pub fn on_edge(&self, [from, to]: [usize; 2], far: u32) -> DVec2 {
        let [p, q] = [from, to].map(|corner| self.corners[corner].texel);
        match far {
            0 => p,
            UNIT => q,
            _ => p + (q - p) * (f64::from(far) / f64::from(UNIT)),
        }
    }

    /// Whether that point is inside.
    pub fn is_inside(&self, ends: [usize; 2], far: u32) -> bool {
        let [from, to] = ends;
        let value = match far {
            0 => self.at_corner(from),
            UNIT => self.at_corner(to),
            _ => {
                let along = f64::from(far) / f64::from(UNIT);
                let alpha = self.alphas[from] + (self.alphas[to] - self.alphas[from]) * along;
                self.texture(self.on_edge(ends, far)) * alpha - self.level
            }
        };
        value >= 0.0
    }

    /// Where an edge, from [`Self::ends`], meets the line through nodes on which coordinate `axis` is `k` and a half.
    pub fn at_line(&self, [from, to]: [usize; 2], axis: usize, k: f64) -> u32 {
        let [p, q] = [from, to].map(|corner| self.corners[corner].texel[axis]);
        (((k + 0.5 - p) / (q - p)).clamp(0.0, 1.0) * f64::from(UNIT)).round() as u32
    }

    /// All crossings of an edge, from [`Self::ends`], ascending: the last place before each, and whether that is inside.
    ///
    /// Between two lines through nodes the product is a cubic function; it is looked at in four places, and between two
    /// that differ it is taken to cross once.
    pub fn crossings(&self, ends: [usize; 2]) -> Vec<Sample> {
        const PLACES: u32 = 4;
        let mut stops = vec![0, UNIT];
        let [p, q] = ends.map(|corner| self.corners[corner].texel - 0.5);
        for axis in (0..2).filter(|_| self.is_textured()) {
            let (low, high) = (p[axis].min(q[axis]), p[axis].max(q[axis]));
            let lines = low.ceil() as i64..=high.floor() as i64;
            stops.extend(lines.filter(|_| low < high).map(|k| self.at_line(ends, axis, k as f64)));
        }
        stops.sort_unstable();
        stops.dedup();
        let between = |stops: &[u32]| {
            let [from, to] = [stops[0], stops[1]];
            (0..PLACES).map(move |k| from + ((u64::from(to - from) * u64::from(k)) / u64::from(PLACES)) as u32)
        };
        let places = stops.windows(2).flat_map(between).chain([UNIT]);
        let samples: Vec<Sample> = places.map(|far| Sample { far, inside: self.is_inside(ends, far) }).collect();
        let crossing = |pair: &[Sample]| {
            let [mut before, mut after] = [pair[0], pair[1]];
            if before.inside == after.inside {
                return None;
            }
            while after.far - before.far > 1 {
                let far = before.far.midpoint(after.far);
                let inside = self.is_inside(ends, far);
                *(if inside == before.inside { &mut before } else { &mut after }) = Sample { far, inside };
            }
            Some(before)
        };
        samples.windows(2).filter_map(crossing).collect()
    }

    /// The weights of a point of an edge, from [`Self::ends`].
    pub fn weights([from, to]: [usize; 2], far: u32) -> Weights {
        let mut weights = [0; 3];
        weights[to] = far;
        weights[from] = UNIT - far;
        weights
    }
}
