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

use crate::topology::Topology;
use std::ops::Range;

/// One caster's closed volume: ranges into a shared index list.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Volume {
    /// Quads (point light) or triangles (directional light) between silhouette edges and infinity.
    pub sides: Range<u32>,
    /// The casting triangles at infinity; empty for directional lights, whose sides meet in one point.
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

    /// Whether nothing is drawn.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.sides.start == self.light_cap_reversed.end
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

/// Appends the volume of weights `c` to `indices`.
pub fn build(topology: &Topology, c: &[i8], directional: bool, indices: &mut Vec<u32>) -> Volume {
    let mark = |indices: &Vec<u32>| indices.len() as u32;
    let start = mark(indices);
    topology.boundary(c, |[lo, hi], m| {
        // The cap runs along the edge one way, the side has to run the other way.
        let (a, b) = if m > 0 { (lo, hi) } else { (hi, lo) };
        for _ in 0..m.unsigned_abs() {
            if directional {
                indices.extend([near(b), near(a), far(0)]);
            } else {
                indices.extend([near(b), near(a), far(a), near(b), far(a), far(b)]);
            }
        }
    });
    let sides = start..mark(indices);

    if !directional {
        for (&[x, y, z], &weight) in topology.triangles.iter().zip(c) {
            match weight {
                0 => {}
                w if w > 0 => indices.extend([far(x), far(z), far(y)]),
                _ => indices.extend([far(x), far(y), far(z)]),
            }
        }
    }
    let dark_cap = sides.end..mark(indices);

    let mut cap = |wanted: i8| {
        for (&[x, y, z], &weight) in topology.triangles.iter().zip(c) {
            if weight == wanted {
                indices.extend([near(x), near(y), near(z)]);
            }
        }
        mark(indices)
    };
    let light_cap = dark_cap.end..cap(1);
    let light_cap_reversed = light_cap.end..cap(-1);
    Volume { sides, dark_cap, light_cap, light_cap_reversed }
}
