//! Closer looks at a cell with many edges.
//!
//! In: the edges in a cell and a direction in it. Out: by how much the number of layers can grow on a straight way through the
//! cell. A way in any one direction meets few edges of a chain, however finely that is divided. And where many silhouettes
//! meet in one vertex, no cell that holds it has few of them: about the vertex, edges are spokes, and a straight way turns about it by less than half a circle, to the left or to
//! the right: the most that the steps of the spokes on either way add up to is exact, where their absolute sum is not.

use super::cell::{Cell, NOISE};
use super::outline::Edge;
use glam::DVec3;
use std::cmp::Reverse;
use std::f64::consts::{PI, TAU};
use std::ops::Range;

/// Spokes so short, as seen from the light, that their angle is off by more than this are edges like any other.
const VAGUE: f64 = 1e-3;

/// As many edges at one vertex are no star.
const FEW: usize = 4;

/// Memory for looking at vertices.
#[derive(Debug, Default)]
pub(super) struct Spokes {
    /// Vertex, which of the members, and which of its ends the vertex is.
    ends: Vec<(u32, u32, u8)>,
    /// Ranges of `ends` about one vertex, the largest first.
    stars: Vec<Range<usize>>,
    /// Which members a star has.
    taken: Vec<bool>,
    steps: Vec<Step>,
    order: Vec<(f64, i64)>,
}

/// Across a spoke.
#[derive(Clone, Copy, Debug)]
struct Step {
    /// To the left of the reference.
    angle: f64,
    /// How far it may be off.
    vague: f64,
    /// What a way to the left gains.
    gain: i64,
}

impl Spokes {
    /// By how much the number of layers at most grows from `p` to anywhere in `cell`, which `members` of `edges` may meet.
    pub fn rise(&mut self, cell: &Cell, p: DVec3, edges: &[Edge], members: &[u32]) -> i64 {
        let edge = |k: u32| &edges[members[k as usize] as usize];
        let Self { ends, stars, taken, steps, order } = self;
        find(cell, (0..members.len() as u32).map(|k| (k, edge(k))), ends, stars);
        taken.clear();
        taken.resize(members.len(), false);
        let mut sum = 0;
        for star in stars.iter() {
            steps.clear();
            for &(_, k, end) in &ends[star.clone()] {
                if let Some(step) = Step::of(edge(k), usize::from(end), p).filter(|_| !taken[k as usize]) {
                    taken[k as usize] = true;
                    steps.push(step);
                }
            }
            sum += most(steps, order);
        }
        let others = (0..members.len() as u32).filter(|&k| !taken[k as usize]).map(edge);
        sum + deepest(p, others, order)
    }

    /// The same, from directions alone.
    pub fn rise_seen(&mut self, p: DVec3, edges: &[Edge], members: &[u32]) -> i64 {
        deepest(p, members.iter().map(|&i| &edges[i as usize]), &mut self.order)
    }
}

/// The most layers that edges add on a straight way from `p`: how many of those that raise their number lie that way.
fn deepest<'e>(p: DVec3, edges: impl Iterator<Item = &'e Edge>, order: &mut Vec<(f64, i64)>) -> i64 {
    let p = p.normalize();
    let (east, north) = p.any_orthonormal_pair();
    let mut everywhere = 0;
    order.clear();
    for edge in edges {
        let times = i64::from(edge.rise(p));
        if times == 0 {
            continue;
        }
        let [a, b] = edge.ends.map(|end| {
            let (x, y) = (end.dot(east), end.dot(north));
            (y.atan2(x), NOISE / x.hypot(y))
        });
        let turn = (b.0 - a.0).rem_euclid(TAU);
        // Less than half a circle; where it may be more, it may be anywhere.
        let (from, by) = if turn <= PI { (a.0, turn) } else { (b.0, TAU - turn) };
        let (from, to) = (from - a.1 - b.1, from + by + a.1 + b.1);
        if a.1 + b.1 < VAGUE && to - from < 0.999 * PI {
            let [from, to] = [from, to].map(|angle| angle.rem_euclid(TAU));
            everywhere += if from > to { times } else { 0 };
            order.extend([(from, times), (to, -times)]);
        } else {
            everywhere += times;
        }
    }
    everywhere + highest(order)
}

/// The most that gains add up to in this order of angles; of equal ones in the order that makes it most.
fn highest(order: &mut [(f64, i64)]) -> i64 {
    order.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(b.1.cmp(&a.1)));
    let (mut sum, mut most) = (0, 0);
    for (_, gain) in order.iter() {
        sum += gain;
        most = most.max(sum);
    }
    most
}

/// Groups edges about the vertices from which they leave `cell`, the largest group first.
fn find<'e>(
    cell: &Cell,
    members: impl Iterator<Item = (u32, &'e Edge)>,
    ends: &mut Vec<(u32, u32, u8)>,
    stars: &mut Vec<Range<usize>>,
) {
    let planes = cell.planes();
    // Beyond its far end a spoke would not be in the cell: it leaves that through a plane on the way there.
    let leaves = |vertex: DVec3, far: DVec3| {
        vertex.z > NOISE && planes.iter().any(|plane| plane.dot(vertex) > -NOISE && plane.dot(far) < -4.0 * NOISE)
    };
    ends.clear();
    for (k, edge) in members {
        let [a, b] = edge.ends;
        ends.extend(leaves(a, b).then_some((edge.vertices[0], k, 0)));
        ends.extend(leaves(b, a).then_some((edge.vertices[1], k, 1)));
    }
    ends.sort_unstable();
    stars.clear();
    let mut start = 0;
    for star in ends.chunk_by(|a, b| a.0 == b.0) {
        stars.extend((star.len() > FEW).then_some(start..start + star.len()));
        start += star.len();
    }
    stars.sort_unstable_by_key(|star| Reverse(star.len()));
}

impl Step {
    /// Across the spoke that begins at `edge.ends[end]`, as seen from `p`; `None` if its angle is not known.
    fn of(edge: &Edge, end: usize, p: DVec3) -> Option<Self> {
        let (vertex, far) = (edge.ends[end], edge.ends[1 - end]);
        let left = vertex.cross(p);
        let ahead = left.cross(vertex);
        let vague = NOISE / left.length() + NOISE / vertex.cross(far).length();
        let times = i64::from(edge.times);
        let gain = if end == 0 { times } else { -times };
        (vague < VAGUE).then(|| Self { angle: far.dot(left).atan2(far.dot(ahead)), vague, gain })
    }
}

/// The most that steps add up to on a way from angle 0 by up to half a circle, to either side.
fn most(steps: &[Step], order: &mut Vec<(f64, i64)>) -> i64 {
    let mut most = 0;
    for side in [1, -1] {
        order.clear();
        for step in steps {
            let (angle, gain, vague) = (step.angle * f64::from(side), step.gain * i64::from(side), step.vague);
            // In doubt what raises comes first, and what lowers comes last or not at all.
            if gain > 0 && (angle > -vague || angle < vague - PI) {
                order.push((angle - vague, gain));
            } else if gain < 0 && angle > vague {
                order.push((angle + vague, gain));
            }
        }
        most = most.max(highest(order));
    }
    most
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_way_about_a_vertex_meets_what_is_on_its_side() {
        let greatest = |steps: &[(f64, i64)]| {
            let steps: Vec<Step> = steps.iter().map(|&(angle, gain)| Step { angle, vague: 1e-9, gain }).collect();
            most(&steps, &mut Vec::new())
        };
        // Pleats: up and down in turn, never two at once.
        let pleats: Vec<(f64, i64)> =
            (1..300).map(|i| (f64::from(i) * 0.01, if i % 2 == 0 { 1 } else { -1 })).collect();
        assert_eq!(greatest(&pleats), 0);
        assert_eq!(greatest(&pleats.iter().map(|&(angle, gain)| (angle, -gain)).collect::<Vec<_>>()), 1);
        // To the right, everything is the other way round.
        assert_eq!(greatest(&[(0.1, 2), (0.2, 3), (-0.1, 1), (-0.2, -4)]), 5);
        assert_eq!(greatest(&[(0.1, 2), (0.2, -3), (-0.1, 1), (-0.2, -4)]), 3);
        // Where their order is not known, what raises counts first.
        assert_eq!(greatest(&[(0.1, -1), (0.1 + 1e-10, 1)]), 1);
        assert_eq!(greatest(&[(0.1, -1), (0.1 + 1e-6, 1)]), 0);
        assert_eq!(greatest(&[(-1e-10, 1)]), 1);
    }
}
