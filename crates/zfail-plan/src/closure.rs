//! The proof that volumes are closed: their directed edges cancel, in exact integer arithmetic.
//!
//! In: a volume's index lists, or a topology with weights. Out: how many edges do not cancel, which is 0
//! unless there is a bug. No position is looked at, so no rounding can make an open volume pass or a closed one fail; what
//! is proved holds on every device that places the same vertex in the same place. Closedness is what makes the count of
//! z-fail the same along every ray (McGuire et al. 2003, section 2; E&K 2002, section 2.2.3).

use crate::topology::{NONE, Topology};
use crate::volume::{self, Volume};
use rustc_hash::FxHashMap;
use std::ops::{AddAssign, Range};

/// Edges of the drawn triangles that are not run as often one way as the other. With `converging` sides all extruded
/// vertices are one point.
///
/// # Panics
/// If a range of `volume` lies outside of `indices`.
#[must_use]
pub fn open_edges(indices: &[u32], volume: &Volume, converging: bool) -> usize {
    let point = |i: u32| if converging && i & 1 == 1 { u32::MAX } else { i };
    let mut sums: FxHashMap<[u32; 2], i32> = FxHashMap::default();
    let mut add = |range: Range<u32>, sign: i32| {
        for t in indices[range.start as usize..range.end as usize].chunks_exact(3) {
            for (a, b) in [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])] {
                let (a, b) = (point(a), point(b));
                if a != b {
                    *sums.entry([a.min(b), a.max(b)]).or_default() += if a < b { sign } else { -sign };
                }
            }
        }
    };
    add(volume.outward(), 1);
    add(volume.light_cap_reversed.clone(), -1);
    sums.values().filter(|&&sum| sum != 0).count()
}

/// What was examined, and what was found.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Closure {
    /// Volumes examined: of every caster those with either dark cap, and one of random weights.
    pub volumes: usize,
    /// Their triangles.
    pub triangles: u64,
    /// Their edges that do not cancel.
    pub open_edges: u64,
}

impl AddAssign for Closure {
    fn add_assign(&mut self, other: Self) {
        self.volumes += other.volumes;
        self.triangles += other.triangles;
        self.open_edges += other.open_edges;
    }
}

/// Examines the volume of weights `c`, each from -1 to 1, with extruded triangles as its dark cap and, where there is such, with a fan.
#[must_use]
pub fn of_weights(topology: &Topology, c: &[i8], converging: bool) -> Closure {
    let mut sum = Closure::default();
    let mut examine = |indices: &[u32], volume: &Volume| {
        sum += Closure {
            volumes: 1,
            triangles: volume.triangles().into_iter().map(u64::from).sum(),
            open_edges: open_edges(indices, volume, converging) as u64,
        };
    };
    let mut indices = Vec::new();
    let volume = volume::build(topology, c, c, converging, &mut indices);
    examine(&indices, &volume);
    if !converging {
        // The same volume, its extruded triangles replaced.
        let sides = volume.sides.start as usize..volume.sides.end as usize;
        let light_caps = indices.split_off(volume.light_cap.start as usize);
        indices.truncate(volume.sides.end as usize);
        volume::dark_fan(sides, &mut indices);
        let dark_cap = volume.sides.end..indices.len() as u32;
        let base = dark_cap.end;
        let moved = |r: &Range<u32>| r.start - volume.light_cap.start + base..r.end - volume.light_cap.start + base;
        indices.extend(light_caps);
        let (light_cap, light_cap_reversed) = (moved(&volume.light_cap), moved(&volume.light_cap_reversed));
        examine(&indices, &Volume { sides: volume.sides, dark_cap, light_cap, light_cap_reversed });
    }
    sum
}

/// Examines the volume of random weights, the same ones for the same `seed`.
#[must_use]
pub fn of_random_weights(topology: &Topology, seed: u64, converging: bool) -> Closure {
    let mut weights = Vec::new();
    random_weights(topology, seed, &mut weights);
    of_weights(topology, &weights, converging)
}

/// Weights from -1 to 1 for all triangles that cast at all: no light would choose them, and yet they close.
fn random_weights(topology: &Topology, seed: u64, out: &mut Vec<i8>) {
    out.clear();
    out.extend(topology.part_of.iter().zip(0_u64..).map(|(&part, t)| {
        // SplitMix64.
        let mut z = (seed << 32 ^ t).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        z = (z ^ z >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ z >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
        if part == NONE { 0 } else { ((z ^ z >> 31) % 3) as i8 - 1 }
    }));
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A tetrahedron of which one triangle is missing.
    fn cup() -> Topology {
        let positions = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        Topology::new(&positions, &[[0, 2, 1], [0, 1, 3], [0, 3, 2]], |_| true).unwrap()
    }

    #[test]
    fn both_dark_caps_close_the_volume() {
        for c in [[1, 1, 1], [0, 1, -1], [-1, -1, 1]] {
            let both = of_weights(&cup(), &c, false);
            assert_eq!((both.volumes, both.open_edges), (2, 0));
            let converging = of_weights(&cup(), &c, true);
            assert_eq!((converging.volumes, converging.open_edges), (1, 0));
        }
    }

    #[test]
    fn every_missing_triangle_is_found() {
        let mut indices = Vec::new();
        let volume = volume::build(&cup(), &[1, 1, 1], &[1, 1, 1], false, &mut indices);
        assert_eq!(open_edges(&indices, &volume, false), 0);
        for t in 0..indices.len() / 3 {
            let mut broken = indices.clone();
            // A triangle without extent is as good as none.
            broken[3 * t + 1] = broken[3 * t];
            broken[3 * t + 2] = broken[3 * t];
            assert_eq!(open_edges(&broken, &volume, false), 3, "triangle {t}");
        }
    }

    #[test]
    fn random_weights_differ_and_are_the_same_on_every_run() {
        let (mut a, mut b) = (Vec::new(), Vec::new());
        random_weights(&cup(), 1, &mut a);
        random_weights(&cup(), 1, &mut b);
        assert_eq!(a, b);
        let seen: std::collections::BTreeSet<i8> = (0..40)
            .flat_map(|seed| {
                random_weights(&cup(), seed, &mut b);
                b.clone()
            })
            .collect();
        assert_eq!(seen.into_iter().collect::<Vec<_>>(), [-1, 0, 1]);
    }
}
