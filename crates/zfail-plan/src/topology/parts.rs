//! Connected parts and how each may cast.
//!
//! In: the incidence. Out: one [`Part`] per edge-connected set of triangles, with the fact that decides its weights:
//! whether it is the boundary of a simple solid.

use super::{Blocking, NONE, Topology, closed, embedded};
use crate::bounds::Bounds;
use crate::parallel;
use std::ops::Range;

/// Triangles connected through edges.
#[derive(Clone, Debug)]
pub struct Part {
    /// Its triangles, as a range of [`Topology::by_part`].
    pub triangles: Range<u32>,
    /// What kind of surface it is.
    pub shape: Shape,
    /// Object-space bounds.
    pub bounds: Bounds,
    /// From where its triangles hide behind surfaces that are drawn.
    pub cover: Cover,
}

/// From where no view ray crosses a part's triangles before it meets a surface that is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cover {
    /// From nowhere: some triangles may be missing.
    Nowhere,
    /// From outside of the solid that the part bounds.
    Outside,
    /// From everywhere: both sides are drawn.
    Everywhere,
}

/// What a connected part is, as far as casting cares.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shape {
    /// Every edge is traversed equally often in both directions, and no two triangles meet except along shared
    /// vertices and edges: the winding number is 0 outside and `inside` within. One layer of weights is exact.
    Solid {
        /// +1 if the front faces look outward, -1 if inward (an inside-out mesh, or a room).
        inside: i8,
    },
    /// Every edge is balanced, but the surface meets itself, so that the winding number may take any value.
    SelfIntersecting,
    /// Every edge is balanced, but vertices move, so that the surface may come to meet itself.
    Bending,
    /// Some edge is unbalanced: a border, a fin, or neighbours wound against each other.
    Open,
}

/// Fills `part_of` and `parts`.
pub(super) fn find(topology: &mut Topology) {
    let mut roots: Vec<u32> = (0..topology.triangles.len() as u32).collect();
    let mut used = vec![false; topology.triangles.len()];
    for (_, incident) in topology.incidence() {
        let mut first = None;
        for (t, _) in incident.iter() {
            used[t] = true;
            let root = root_of(&mut roots, t as u32);
            match first {
                None => first = Some(root),
                Some(other) if other < root => roots[root as usize] = other,
                Some(other) => {
                    roots[other as usize] = root;
                    first = Some(root);
                }
            }
        }
    }

    let mut members: Vec<Vec<u32>> = Vec::new();
    for t in 0..used.len() {
        if used[t] {
            let root = root_of(&mut roots, t as u32) as usize;
            // A root is its part's lowest triangle, so it is met first.
            if root == t {
                topology.part_of[t] = members.len() as u32;
                members.push(Vec::new());
            }
            topology.part_of[t] = topology.part_of[root];
            members[topology.part_of[t] as usize].push(t as u32);
        }
    }

    let balanced = closed::balanced_parts(topology, members.len());
    let mut end = 0;
    let ranges: Vec<Range<u32>> = members
        .iter()
        .map(|triangles| {
            let start = end;
            end += triangles.len() as u32;
            start..end
        })
        .collect();
    topology.by_part = members.concat();
    let topology_ref = &*topology;
    let parts = parallel::map(ranges.into_iter().zip(balanced).collect(), |(range, balanced): (Range<u32>, bool)| {
        let triangles = &topology_ref.by_part[range.start as usize..range.end as usize];
        let shape = if !balanced {
            Shape::Open
        } else if topology_ref.bends() {
            Shape::Bending
        } else if embedded::is_embedded(topology_ref, triangles) {
            match closed::signed_volume(topology_ref, triangles) {
                v if v > 0.0 => Shape::Solid { inside: 1 },
                v if v < 0.0 => Shape::Solid { inside: -1 },
                _ => Shape::SelfIntersecting,
            }
        } else {
            Shape::SelfIntersecting
        };
        let corners = triangles.iter().flat_map(|&t| topology_ref.corners(t as usize));
        Part { triangles: range, shape, bounds: Bounds::of(corners), cover: Cover::Nowhere }
    });
    topology.parts = parts;
    debug_assert!(topology.part_of.iter().all(|&p| p == NONE || (p as usize) < topology.parts.len()));
}

/// Fills `cover`: a part whose triangles are drawn from both sides hides itself, and so does a solid whose front faces are
/// drawn and look outward, for a ray leaves it through a back face only where it has entered through a front face.
pub(super) fn find_cover(topology: &mut Topology, surface: impl Fn(usize) -> Blocking) {
    let cover = |part: usize| {
        let all = |test: fn(Blocking) -> bool| topology.triangles_of(part).iter().all(|&t| test(surface(t as usize)));
        let outward = topology.parts[part].shape == Shape::Solid { inside: 1 };
        if all(|s| s == Blocking::BothSides) {
            Cover::Everywhere
        } else if outward && all(|s| matches!(s, Blocking::Front | Blocking::BothSides)) {
            Cover::Outside
        } else {
            Cover::Nowhere
        }
    };
    let cover: Vec<Cover> = (0..topology.parts.len()).map(cover).collect();
    for (part, cover) in topology.parts.iter_mut().zip(cover) {
        part.cover = cover;
    }
    // A light cap may be drawn by a twin of another part.
    for group in &topology.twins {
        let parts = group.iter().map(|&t| topology.part_of[t as usize] as usize);
        let first = topology.parts[parts.clone().next().unwrap_or(0)].cover;
        if !parts.clone().all(|part| topology.parts[part].cover == first) {
            parts.for_each(|part| topology.parts[part].cover = Cover::Nowhere);
        }
    }
}

/// Union-find with path halving.
fn root_of(roots: &mut [u32], mut t: u32) -> u32 {
    while roots[t as usize] != t {
        roots[t as usize] = roots[roots[t as usize] as usize];
        t = roots[t as usize];
    }
    t
}
