//! Coincident triangles: the same three welded points, whatever their order.
//!
//! A rasteriser may give two orders of the same points depths that differ in the last bit. Where one of the triangles is
//! visible and its twin is culled, the twin's light cap would then lie before or behind the surface by chance, so light
//! caps of twins are drawn in the order of the one that is visible.

use super::{NONE, Topology};
use crate::parallel;

/// All groups of two or more.
pub(super) fn find(topology: &Topology) -> Vec<Vec<u32>> {
    let mut keyed: Vec<([u32; 3], u32)> = (0..topology.triangles.len())
        .filter(|&t| topology.part_of[t] != NONE)
        .map(|t| {
            let mut key = topology.triangles[t];
            key.sort_unstable();
            (key, t as u32)
        })
        .collect();
    parallel::sort_unstable(&mut keyed);
    let groups = keyed.chunk_by(|a, b| a.0 == b.0).filter(|group| group.len() > 1);
    groups.map(|group| group.iter().map(|&(_, t)| t).collect()).collect()
}

/// Whether two triangles over the same points turn the same way.
#[must_use]
pub fn same_winding(a: [u32; 3], b: [u32; 3]) -> bool {
    let start = b.iter().position(|&v| v == a[0]).unwrap_or(0);
    b[(start + 1) % 3] == a[1]
}
