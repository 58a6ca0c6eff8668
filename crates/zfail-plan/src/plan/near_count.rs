//! The near count: z-pass for casters that cover the near rectangle whole.
//!
//! In: a caster's weights, its silhouette and the occlusion pyramid. Out: in how many of its layers the near rectangle
//! stands, if that is one number for all of it. Counting in front of the visible surface from that number on gives the
//! count of z-fail without any cap. It is one number where no silhouette edge enters the pyramid, for only there the
//! number of layers between the light and a point of the rectangle changes, and no casting triangle enters the near slab.

use super::pyramid::Pyramid;
use crate::bounds::Bounds;
use crate::casting::ObjectLight;
use crate::parallel;
use crate::topology::{Cover, Topology};
use glam::{DVec3, DVec4};

/// Items that one task looks at; fewer are not worth a task.
const TASK: usize = 8192;

/// What is known of a caster at the near rectangle.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct NearCount {
    /// Layers over all of it.
    pub layers: u32,
    /// Whether it may be within a solid, from where front faces hide nothing.
    pub within_solid: bool,
}

/// The layers of the volume of `weights` over the whole near rectangle, or `None` where they may differ.
/// `sides` are the volume's, `stride` indices each.
pub(super) fn near_count(
    topology: &Topology,
    weights: &[i8],
    sides: &[u32],
    stride: usize,
    pyramid: &Pyramid,
) -> Option<NearCount> {
    let clear =
        |side: &[u32]| pyramid.excludes_segment(topology.position(side[0] >> 1), topology.position(side[1] >> 1));
    if !parallel::all_pieces(sides, TASK * stride, |_, sides| sides.chunks_exact(stride).all(clear)) {
        return None;
    }
    let casting = |t: usize, c: i8| c != 0 && pyramid.slab_meets(topology.corners(t));
    if any(weights, casting) {
        return None;
    }
    let middle = pyramid.slab.iter().sum::<DVec3>() / 8.0;
    let layers = layers(topology, weights, pyramid.light, middle.extend(1.0));
    Some(NearCount { layers, within_solid: within_solid(topology, pyramid, middle) })
}

/// Whether some of the near slab may be inside of a part that hides itself only from outside.
fn within_solid(topology: &Topology, pyramid: &Pyramid, middle: DVec3) -> bool {
    let slab = Bounds::of(pyramid.slab);
    (0..topology.parts.len()).any(|p| {
        let part = &topology.parts[p];
        let apart = part.bounds.min.cmpgt(slab.max).any() || part.bounds.max.cmplt(slab.min).any();
        let surface_apart =
            || topology.triangles_of(p).iter().all(|&t| !pyramid.slab_meets(topology.corners(t as usize)));
        part.cover == Cover::Outside && !apart && !(surface_apart() && topology.winding_number(p, middle) == Some(0))
    })
}

fn any(weights: &[i8], test: impl Fn(usize, i8) -> bool + Sync) -> bool {
    !parallel::all_pieces(weights, TASK, |first, piece| piece.iter().enumerate().all(|(k, &c)| !test(first + k, c)))
}

/// How many layers of the weights lie on the segment from the light to homogeneous point `to` (object space).
///
/// Edges are compared with the line in one canonical direction, so that neighbouring triangles never both claim or both
/// deny a line that passes between them.
pub(super) fn layers(topology: &Topology, weights: &[i8], light: ObjectLight, to: DVec4) -> u32 {
    let light = light.as_dvec4();
    // One of them is not at infinity; the line runs through it.
    let through = if light.w != 0.0 { light.truncate() } else { to.truncate() };
    let along = to.truncate() * light.w - light.truncate() * to.w;
    let side = |a: u32, b: u32| {
        let (lo, hi) = (a.min(b), a.max(b));
        let s = along.dot((topology.position(lo) - through).cross(topology.position(hi) - through));
        (s >= 0.0) == (a < b)
    };
    let crossed = |t: usize, c: i8| {
        if c == 0 {
            return 0;
        }
        let [a, b, c2] = topology.triangles[t];
        let first = side(a, b);
        if side(b, c2) != first || side(c2, a) != first {
            return 0;
        }
        let [p, q, r] = topology.corners(t);
        let normal = (q - p).cross(r - p);
        let height = |h: DVec4| normal.dot(h.truncate() - p * h.w);
        if (height(light) > 0.0) == (height(to) > 0.0) { 0 } else { u32::from(c.unsigned_abs()) }
    };
    parallel::sum_pieces(weights, TASK, |first, piece| {
        piece.iter().enumerate().map(|(k, &c)| crossed(first + k, c)).sum()
    })
}
