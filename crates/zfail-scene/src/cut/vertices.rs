//! Vertices that cutting adds to a mesh.
//!
//! In: lattice points of its triangles. Out: a number for each, the same for the same point of an edge, and where it comes
//! from.

use super::triangle::{UNIT, Weights, in_order};
use crate::Mesh;
use glam::Vec3;
use rustc_hash::FxHashMap;

/// Where a vertex comes from: a point of a triangle of the mesh as it was.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Source {
    /// Vertices of the mesh as it was.
    pub corners: [u32; 3],
    /// Their weights, which add up to exactly 1. The last is 0 on an edge.
    pub weights: [f64; 3],
}

impl Source {
    /// The weighted mean of what the corners have, rounded once.
    ///
    /// Computed from the ends of an edge in their stored order, so that vertices on both sides of a seam are bit for bit
    /// the same where the seam's vertices are.
    fn mean<const N: usize>(&self, values: &[[f32; N]]) -> Option<[f32; N]> {
        let [a, b, c] = self.corners.map(|corner| values.get(corner as usize));
        let (a, b, c) = (a?, b?, c?);
        let [u, v, w] = self.weights;
        Some(std::array::from_fn(|k| (f64::from(a[k]) * u + f64::from(b[k]) * v + f64::from(c[k]) * w) as f32))
    }
}

/// What the vertices of `sources` have, given what the vertices of the mesh as it was have: positions, for instance, after
/// skinning. In `f64`, rounded once; the same bits on every machine. Corners that `values` does not reach give zeros.
#[must_use]
pub fn derive<const N: usize>(sources: &[Source], values: &[[f32; N]]) -> Vec<[f32; N]> {
    sources.iter().map(|source| source.mean(values).unwrap_or([0.0; N])).collect()
}

/// Adds the vertices of `sources` to those of the mesh as it was.
pub(crate) fn extend(
    sources: &[Source],
    positions: &mut Vec<[f32; 3]>,
    normals: &mut Vec<[f32; 3]>,
    tangents: &mut Vec<[f32; 4]>,
) {
    extend_attribute(sources, positions, |position| position);
    extend_attribute(sources, normals, |normal| Vec3::from(normal).try_normalize().unwrap_or(Vec3::Y).into());
    extend_attribute(sources, tangents, |[x, y, z, w]| {
        let direction = Vec3::new(x, y, z).normalize_or_zero();
        direction.extend(if direction == Vec3::ZERO { 0.0 } else { 1_f32.copysign(w) }).into()
    });
}

/// Adds one attribute of new vertices to a mesh that has the attribute.
pub(super) fn extend_attribute<const N: usize>(
    sources: &[Source],
    values: &mut Vec<[f32; N]>,
    mend: impl Fn([f32; N]) -> [f32; N],
) {
    if !values.is_empty() {
        let new = derive(sources, values);
        values.extend(new.into_iter().map(mend));
    }
}

/// Which new vertices move as one, given which old ones do: as [`Mesh::alike`].
pub(super) fn extend_alike(sources: &[Source], alike: &mut Vec<u32>) {
    if alike.is_empty() {
        return;
    }
    let mut next = alike.iter().max().map_or(0, |last| last + 1);
    let mut known = FxHashMap::default();
    for source in sources {
        let key = (source.corners.map(|corner| alike[corner as usize]), source.weights.map(f64::to_bits));
        let number = *known.entry(key).or_insert_with(|| {
            next += 1;
            next - 1
        });
        alike.push(number);
    }
}

/// The vertices of one mesh.
pub(super) struct Vertices<'a> {
    mesh: &'a Mesh,
    /// Of the vertices behind those of the mesh.
    pub sources: Vec<Source>,
    /// By the ends of an edge and the second end's weight.
    on_edges: FxHashMap<[u32; 3], u32>,
    /// Points inside of the triangle at hand.
    inside: FxHashMap<Weights, u32>,
}

impl<'a> Vertices<'a> {
    pub fn new(mesh: &'a Mesh) -> Self {
        Self { mesh, sources: Vec::new(), on_edges: FxHashMap::default(), inside: FxHashMap::default() }
    }

    /// The vertices of the `pieces` of triangle `corners`.
    pub fn of_pieces(&mut self, corners: [u32; 3], pieces: &[[Weights; 3]]) -> Vec<[u32; 3]> {
        self.inside.clear();
        pieces.iter().map(|piece| piece.map(|weights| self.vertex(corners, weights))).collect()
    }

    fn vertex(&mut self, corners: [u32; 3], weights: Weights) -> u32 {
        if let Some(corner) = weights.iter().position(|&w| w == UNIT) {
            return corners[corner];
        }
        let share = |w: u32| f64::from(w) / f64::from(UNIT);
        let next = (self.mesh.positions.len() + self.sources.len()) as u32;
        let (vertex, source) = if let Some(opposite) = weights.iter().position(|&w| w == 0) {
            let (mut from, mut to) = ((opposite + 1) % 3, (opposite + 2) % 3);
            let position = |k: usize| self.mesh.positions[corners[k] as usize];
            if !in_order(position(from), position(to)) {
                (from, to) = (to, from);
            }
            let ends = [corners[from], corners[to], corners[to]];
            let vertex = *self.on_edges.entry([corners[from], corners[to], weights[to]]).or_insert(next);
            (vertex, Source { corners: ends, weights: [share(weights[from]), share(weights[to]), 0.0] })
        } else {
            let vertex = *self.inside.entry(weights).or_insert(next);
            (vertex, Source { corners, weights: weights.map(share) })
        };
        if vertex == next {
            self.sources.push(source);
        }
        vertex
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn new_vertices_are_alike_where_their_corners_are() {
        let source = |corners, w| Source { corners, weights: [1.0 - w, w, 0.0] };
        let sources = [source([0, 1, 1], 0.5), source([2, 3, 3], 0.5), source([0, 1, 1], 0.25), source([2, 4, 4], 0.5)];
        let mut alike = vec![7, 8, 7, 8, 9];
        extend_alike(&sources, &mut alike);
        assert_eq!(alike[5..], [10, 10, 11, 12]);
        let mut rigid = Vec::new();
        extend_alike(&sources, &mut rigid);
        assert!(rigid.is_empty());
    }
}
