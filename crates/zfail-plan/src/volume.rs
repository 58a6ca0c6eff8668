//! The shadow volume as index lists: sides, light cap and dark cap.
//!
//! In: topology and weights. Out: indices `2 * vertex + extruded` over the welded positions; the vertex shader turns an
//! extruded index into the point at infinity `(v * Lw - L, 0)` (McGuire et al. 2003, section 6, EXTRUDE, with the
//! doubled vertex array replaced by a bit).
//!
//! The volume of a chain `F = sum of c_t * t` is `sum of m_e * quad(e) + F - extruded(F)`, closed for any integer
//! weights because the boundary of a boundary is zero. Its outside is counter-clockwise.
//!
//! Light-cap triangles keep the exact vertex order in which they are rendered, so that a rasteriser gives them the
//! very depths of the depth pass; those that cast from their back form a list of their own, drawn with the stencil
//! operations exchanged instead of their winding.

use crate::casting;
use crate::topology::{NodeFacing, Topology, same_winding};
use glam::DVec4;
use std::ops::Range;

/// One caster's closed volume: ranges into a shared index list.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Volume {
    /// Quads, or triangles where they converge, between silhouette edges and infinity.
    pub sides: Range<u32>,
    /// The casting triangles at infinity; empty where sides converge.
    pub dark_cap: Range<u32>,
    /// Casting triangles whose front faces the light, as stored.
    pub light_cap: Range<u32>,
    /// Casting triangles whose back faces the light, as stored: wound against the volume.
    pub light_cap_reversed: Range<u32>,
}

impl Volume {
    /// Sides, dark cap and unreversed light cap: one contiguous range, one draw.
    #[must_use]
    pub fn outward(&self) -> Range<u32> {
        self.sides.start..self.light_cap.end
    }

    /// The same ranges `base` indices further on.
    #[must_use]
    pub fn shifted(&self, base: u32) -> Self {
        let shift = |r: &Range<u32>| r.start + base..r.end + base;
        Self {
            sides: shift(&self.sides),
            dark_cap: shift(&self.dark_cap),
            light_cap: shift(&self.light_cap),
            light_cap_reversed: shift(&self.light_cap_reversed),
        }
    }

    /// Triangles in sides, dark cap and light cap.
    #[must_use]
    pub fn triangles(&self) -> [u32; 3] {
        let count = |r: &Range<u32>| (r.end - r.start) / 3;
        [count(&self.sides), count(&self.dark_cap), count(&self.light_cap) + count(&self.light_cap_reversed)]
    }
}

/// The index of a vertex where it is stored.
#[must_use]
pub const fn near(vertex: u32) -> u32 {
    vertex << 1
}

/// The index of a vertex extruded to infinity.
#[must_use]
pub const fn far(vertex: u32) -> u32 {
    vertex << 1 | 1
}

/// Appends the whole volume of weights `c` to `indices`, its dark cap made of extruded triangles. The light cap is drawn by
/// `cap` instead, the same chain with the weights of coincident triangles gathered on one of them ([`cap_weights`]). With
/// `converging` sides all extruded vertices are one point, as the parallel rays of a directional light meet at infinity.
pub fn build(topology: &Topology, c: &[i8], cap: &[i8], converging: bool, indices: &mut Vec<u32>) -> Volume {
    let mark = |indices: &Vec<u32>| indices.len() as u32;
    let start = mark(indices);
    sides(topology, c, converging, indices);
    let sides = start..mark(indices);
    if !converging {
        dark_cap(topology, c, indices);
    }
    let dark_cap = sides.end..mark(indices);
    light_cap(topology, cap, 1, |_| true, indices);
    let light_cap_range = dark_cap.end..mark(indices);
    light_cap(topology, cap, -1, |_| true, indices);
    let light_cap_reversed = light_cap_range.end..mark(indices);
    Volume { sides, dark_cap, light_cap: light_cap_range, light_cap_reversed }
}

/// Indices of one side: a quad, or where sides converge a triangle. The first two are the edge's vertices.
#[must_use]
pub const fn side_len(converging: bool) -> usize {
    if converging { 3 } else { 6 }
}

/// Appends a side for every silhouette edge of weights `c`, as many as its multiplicity.
pub fn sides(topology: &Topology, c: &[i8], converging: bool, indices: &mut Vec<u32>) {
    topology.boundary(c, |edge, m| side(edge, m, converging, indices));
}

/// The same where it is known how the nodes of the topology's tree face the light.
pub(crate) fn sides_where_facing_turns(
    topology: &Topology,
    c: &[i8],
    states: Option<&[NodeFacing]>,
    converging: bool,
    indices: &mut Vec<u32>,
) {
    topology.silhouette(c, states, |edge, m| side(edge, m, converging, indices));
}

/// Appends the sides of one edge of multiplicity `m` ([`Topology::boundary`]).
pub(crate) fn side([lo, hi]: [u32; 2], m: i32, converging: bool, indices: &mut Vec<u32>) {
    // The cap runs along the edge one way, the side has to run the other way.
    let (a, b) = if m > 0 { (lo, hi) } else { (hi, lo) };
    for _ in 0..m.unsigned_abs() {
        if converging {
            indices.extend([near(b), near(a), far(0)]);
        } else {
            indices.extend([near(b), near(a), far(a), near(b), far(a), far(b)]);
        }
    }
}

/// Appends the casting triangles extruded to infinity: the dark cap that closes any volume.
pub fn dark_cap(topology: &Topology, c: &[i8], indices: &mut Vec<u32>) {
    for (&[x, y, z], &weight) in topology.triangles.iter().zip(c) {
        match weight {
            0 => {}
            w if w > 0 => indices.extend([far(x), far(z), far(y)]),
            _ => indices.extend([far(x), far(y), far(z)]),
        }
    }
}

/// Appends a dark cap of one triangle per side, from the first silhouette vertex to every edge of the quads
/// `indices[sides]` (McGuire et al. 2003, section 6).
///
/// Closed by the same edges as [`dark_cap`], it can differ from that by whole spheres at infinity. It does not where all
/// directions from the light to the caster lie in one open hemisphere: where the light is strictly outside of the
/// caster's convex hull.
pub fn dark_fan(sides: Range<usize>, indices: &mut Vec<u32>) {
    let Some(&first) = indices.get(sides.start).filter(|_| !sides.is_empty()) else { return };
    let apex = first >> 1;
    for side in sides.step_by(side_len(false)) {
        let (b, a) = (indices[side] >> 1, indices[side + 1] >> 1);
        if a != apex && b != apex {
            indices.extend([far(apex), far(b), far(a)]);
        }
    }
}

/// Appends the chosen casting triangles in place, those whose weight has the sign of `sign`, as often as they count.
pub fn light_cap(topology: &Topology, cap: &[i8], sign: i8, chosen: impl Fn(usize) -> bool, indices: &mut Vec<u32>) {
    for (t, (&[x, y, z], &weight)) in topology.triangles.iter().zip(cap).enumerate() {
        let times = (weight * sign).max(0);
        if times > 0 && chosen(t) {
            for _ in 0..times {
                indices.extend([near(x), near(y), near(z)]);
            }
        }
    }
}

/// Which of each group of twins is visible to the homogeneous `eye` (object space), if either is: the one whose front
/// faces it. Where both are drawn the depth buffer holds the nearer, so that either will do.
pub fn visible_twins(topology: &Topology, eye: DVec4, out: &mut Vec<u32>) {
    out.clear();
    out.extend(topology.twins.iter().map(|group| {
        let faces = |&&t: &&u32| casting::facing(topology.corners(t as usize), eye) > 0;
        group.iter().find(faces).copied().unwrap_or(group[0])
    }));
}

/// Weights `c` with those of twins gathered on the `visible` one of each group.
pub fn cap_weights(topology: &Topology, c: &[i8], visible: &[u32], out: &mut Vec<i8>) {
    out.clear();
    out.extend_from_slice(c);
    for (group, &visible) in topology.twins.iter().zip(visible) {
        for &t in group.iter().filter(|&&t| t != visible) {
            let same = same_winding(topology.triangles[t as usize], topology.triangles[visible as usize]);
            let moved = if same { c[t as usize] } else { -c[t as usize] };
            // A hundred duplicates and more keep their own caps.
            if let Some(sum) = out[visible as usize].checked_add(moved).filter(|sum| sum.unsigned_abs() <= 100) {
                out[visible as usize] = sum;
                out[t as usize] = 0;
            }
        }
    }
}
