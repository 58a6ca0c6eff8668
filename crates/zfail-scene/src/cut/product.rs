//! One triangle, cut where the alpha of its texture times that of its corners reaches a level.
//!
//! In: corners with alpha, alpha on the plane of a texture, and a level. Out: triangles over points of a barycentric
//! lattice, as of [`super::triangle`].
//!
//! The alpha of corners is interpolated linearly, so the contour is another one for every triangle, and cannot be traced
//! once for all. It is traced here cell by cell within the triangle (`cells`), and simplified like those of textures, with
//! the points on the triangle's edges held. Those depend on the edge alone (`edge`): both triangles of an edge get the
//! same points.

use super::cells::{Chord, Tracing, share_an_edge, trace};
use super::edge::Product;
use super::field::{AlphaField, Axis};
use super::simplify::kept;
use super::trace::Ring;
use super::triangle::{Corner, Cut, Weights, fill, side};
use glam::DVec2;

/// How many buckets one could look into, about, in the time that it takes to trace what is in a triangle.
pub(super) fn effort([a, b, c]: [DVec2; 3]) -> f64 {
    /// Of a cell.
    const COST: f64 = 6.0;
    let size = a.max(b).max(c) - a.min(b).min(c) + 2.0;
    size.x * size.y * COST
}

/// The part of a triangle where `field`, or 255 without one, times the `alphas` of its corners is at least `level`; its
/// contour is at most `tolerance` texels from the true one. `None` if that takes more than `most` points.
///
/// Where the triangle has no area on the texture, the alpha of its middle counts everywhere.
pub(super) fn cut(
    field: Option<&AlphaField<'_>>,
    level: f64,
    tolerance: f64,
    corners: [Corner; 3],
    alphas: [f64; 3],
    most: usize,
) -> Option<Cut> {
    /// What chords may use up of the tolerance. The rest is left to leaving out points.
    const BENDS: f64 = 0.25;
    let texels = corners.map(|corner| corner.texel);
    let area = side(texels[0], texels[1], texels[2]);
    let product = Product::new(field.filter(|_| area != 0.0), field, level, corners, alphas);
    let Tracing { points, chords } = trace(&product, area, BENDS * tolerance, most)?;
    if points.is_empty() {
        return Some(if product.at_corner(0) >= 0.0 { Cut::Whole } else { Cut::Nothing });
    }
    let lines = lines(&chords, points.len());
    let low = texels[0].min(texels[1]).min(texels[2]).floor();
    let high = texels[0].max(texels[1]).max(texels[2]);
    let ring = |line: &Line| Ring {
        points: line.points.iter().map(|&point| points[point].at - low).collect(),
        closing: DVec2::ZERO,
        open: !line.closed,
        // A line that leaves the triangle through the edge by which it came has to stay off the edge in between.
        least: if line.closed || share_an_edge(line.ends().map(|point| points[point].weights)) { 3 } else { 2 },
    };
    let rings: Vec<Ring> = lines.iter().map(ring).collect();
    let axes = (high - low).to_array().map(|length| Axis::of_length(length.ceil().max(1.0) as i64));
    let mut kept_points = Vec::new();
    let mut kept_chords = Vec::new();
    for (line, kept) in lines.iter().zip(kept(&rings, axes, (1.0 - BENDS) * tolerance)) {
        let weights: Vec<Weights> = kept.iter().map(|&k| points[line.points[k]].weights).collect();
        kept_chords.extend(weights.windows(2).map(|ends| [ends[0], ends[1]]));
        if let (true, &[first, .., last]) = (line.closed, &*weights) {
            kept_chords.push([last, first]);
        }
        kept_points.extend(weights);
    }
    kept_chords.retain(|[from, to]| from != to);
    let contains = |middle| product.at_weights(middle) >= 0.0;
    let pieces = fill(&kept_points, &kept_chords, area >= 0.0, contains);
    Some(pieces.map_or(Cut::Whole, Cut::Pieces))
}

/// Chords end to end.
struct Line {
    /// By number.
    points: Vec<usize>,
    /// Whether the last point is joined to the first.
    closed: bool,
}

impl Line {
    fn ends(&self) -> [usize; 2] {
        [self.points[0], self.points[self.points.len() - 1]]
    }
}

/// All `chords` between so many points as lines, the longest possible.
fn lines(chords: &[Chord], points: usize) -> Vec<Line> {
    let mut on: Vec<Vec<usize>> = vec![Vec::new(); points];
    let mut surplus = vec![0_i32; points];
    for &[from, to] in chords {
        on[from].push(to);
        surplus[from] += 1;
        surplus[to] -= 1;
    }
    let mut lines = Vec::new();
    let starts = (0..points).filter(|&point| surplus[point] > 0).chain(0..points);
    for start in starts {
        while let Some(next) = on[start].pop() {
            let mut line = vec![start, next];
            while let Some(next) = on[line[line.len() - 1]].pop() {
                line.push(next);
            }
            let closed = line.len() > 3 && line.last() == Some(&start);
            line.truncate(line.len() - usize::from(closed));
            lines.push(Line { points: line, closed });
        }
    }
    lines
}
