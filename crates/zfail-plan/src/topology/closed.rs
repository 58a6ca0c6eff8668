//! Closedness: the boundary of a part's triangles is zero, and the winding number that follows.

use super::Topology;
use glam::DVec3;

/// For each part whether every edge is traversed equally often in both directions (`sum of o(t, e)` is 0): the precise
/// condition for single weights, weaker than the 2-manifold of E&K section 3.1.
pub(super) fn balanced_parts(topology: &Topology, parts: usize) -> Vec<bool> {
    let mut balanced = vec![true; parts];
    for (_, incident) in topology.incidence() {
        let sum: i32 = incident.iter().map(|(_, o)| o).sum();
        if sum != 0
            && let Some((t, _)) = incident.iter().next()
        {
            balanced[topology.part_of[t] as usize] = false;
        }
    }
    balanced
}

/// Volume enclosed by a closed set of triangles, positive if front faces look outward.
pub(super) fn signed_volume(topology: &Topology, triangles: &[u32]) -> f64 {
    let Some(&first) = triangles.first() else { return 0.0 };
    let origin = topology.corners(first as usize)[0];
    triangles
        .iter()
        .map(|&t| {
            let [a, b, c] = topology.corners(t as usize).map(|p| p - origin);
            a.dot(b.cross(c))
        })
        .sum::<f64>()
        / 6.0
}

impl Topology {
    /// Winding number of closed part `part` around `point`, or `None` where rounding leaves it undecided because the
    /// point lies on the surface.
    ///
    /// Sum of signed solid angles (van Oosterom & Strackee 1983, "The Solid Angle of a Plane Triangle") over 4 pi.
    #[must_use]
    pub fn winding_number(&self, part: usize, point: DVec3) -> Option<i32> {
        /// A light is an f32 position: closer to the surface than this, its side is a matter of rounding.
        const CONTACT: f64 = 1e-6;
        if self.parts[part].bounds.distance_squared(point) > 0.0 {
            return Some(0);
        }
        let mut half_angle = 0.0;
        for &t in self.triangles_of(part) {
            let [a, b, c] = self.corners(t as usize).map(|p| p - point);
            let (la, lb, lc) = (a.length(), b.length(), c.length());
            let volume = a.dot(b.cross(c));
            let scale = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
            // On the triangle the solid angle jumps between -2 pi and 2 pi; at its rim it is undefined.
            let contact = CONTACT * la * lb * lc;
            if scale <= contact && volume.abs() <= contact {
                return None;
            }
            half_angle += volume.atan2(scale);
        }
        let winding = half_angle / std::f64::consts::TAU;
        let nearest = winding.round();
        ((winding - nearest).abs() < 1e-3).then_some(nearest as i32)
    }
}
