//! Fewer points for the same contour.
//!
//! In: closed polygons, and lines whose ends have to stay, that touch at most in points. Out: the same with points left
//! out. Every contour stays within the tolerance of its original, in the Hausdorff distance, and they still touch at most
//! in points: nothing is joined, parted, turned inside out or left out.
//!
//! A point is taken out of the way if the points left out between its neighbours, itself included, are within the
//! tolerance of the segment between these, and if no other point lies in the triangle that the contour sweeps over. The
//! least deviation goes first. That the triangle is empty is decided exactly, on coordinates that [`super::trace`]
//! rounds so that whole periods can be added without error.

use super::field::Axis;
use super::grid::Grid;
use super::trace::Ring;
use glam::DVec2;
use robust::{Coord, orient2d};
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// The `rings` on a plane with these `axes`, simplified to within `tolerance` texels.
pub(super) fn simplify(rings: &[Ring], axes: [Axis; 2], tolerance: f64) -> Vec<Ring> {
    let left = kept(rings, axes, tolerance);
    let simple = |(ring, kept): (&Ring, Vec<usize>)| {
        let points = kept.into_iter().map(|k| ring.points[k]).collect();
        Ring { points, ..*ring }
    };
    rings.iter().zip(left).map(simple).collect()
}

/// Which points of each of the `rings` are left if they are simplified, ascending.
pub(super) fn kept(rings: &[Ring], axes: [Axis; 2], tolerance: f64) -> Vec<Vec<usize>> {
    let mut simplifier = Simplifier::new(rings, axes, tolerance);
    for point in 0..simplifier.links.len() as u32 {
        simplifier.propose(point);
    }
    while let Some(Reverse((_, _, point, proposal))) = simplifier.queue.pop() {
        if simplifier.links[point as usize].proposal == proposal {
            simplifier.leave_out(point);
        }
    }
    let left = |(r, ring): (usize, &Ring)| {
        (0..ring.points.len()).filter(|&k| simplifier.links[simplifier.starts[r] + k].kept).collect()
    };
    rings.iter().enumerate().map(left).collect()
}

/// A point's place in its ring.
#[derive(Clone, Copy)]
struct Link {
    ring: u32,
    /// Points of the original ring back to the last and on to the next point that is kept.
    back: u32,
    on: u32,
    /// Valid in the queue; older proposals are stale.
    proposal: u32,
    kept: bool,
}

struct Simplifier<'a> {
    rings: &'a [Ring],
    /// Number of each ring's first point.
    starts: Vec<usize>,
    /// Points kept per ring.
    kept: Vec<usize>,
    links: Vec<Link>,
    grid: Grid,
    tolerance: f64,
    /// Steps of deviation, span, point, proposal.
    queue: BinaryHeap<Reverse<(u32, u32, u32, u32)>>,
}

impl<'a> Simplifier<'a> {
    fn new(rings: &'a [Ring], axes: [Axis; 2], tolerance: f64) -> Self {
        let points = rings.iter().map(|ring| ring.points.len()).sum();
        let (mut starts, mut links, mut grid) = (Vec::new(), Vec::with_capacity(points), Grid::new(axes, points));
        for (r, ring) in rings.iter().enumerate() {
            starts.push(links.len());
            for &point in &ring.points {
                grid.put(links.len() as u32, [point; 3]);
                links.push(Link { ring: r as u32, back: 1, on: 1, proposal: 0, kept: true });
            }
        }
        let kept = rings.iter().map(|ring| ring.points.len()).collect();
        Self { rings, starts, kept, links, grid, tolerance, queue: BinaryHeap::new() }
    }

    /// Ring and place in the ring of a point.
    fn place(&self, point: u32) -> (usize, i64) {
        let ring = self.links[point as usize].ring as usize;
        (ring, point as i64 - self.starts[ring] as i64)
    }

    /// The position of the `k`-th point of a ring, in any lap.
    fn position(&self, ring: usize, k: i64) -> DVec2 {
        let Ring { points, closing, .. } = &self.rings[ring];
        let length = points.len() as i64;
        points[k.rem_euclid(length) as usize] + *closing * k.div_euclid(length) as f64
    }

    /// The number of the `k`-th point of a ring.
    fn number(&self, ring: usize, k: i64) -> u32 {
        (self.starts[ring] as i64 + k.rem_euclid(self.rings[ring].points.len() as i64)) as u32
    }

    /// The kept neighbours of a point, as places in its ring.
    fn neighbours(&self, point: u32) -> [i64; 2] {
        let (_, k) = self.place(point);
        let Link { back, on, .. } = self.links[point as usize];
        [k - i64::from(back), k + i64::from(on)]
    }

    /// Queues `point` if the contour may do without it as far as the tolerance goes.
    fn propose(&mut self, point: u32) {
        /// Deviations that differ by less than a step count as equal, and short spans go first: that keeps long
        /// straight contours from being gone over from one end to the other again and again.
        const STEPS: f64 = 16.0;
        let (ring, k) = self.place(point);
        let Ring { points, open, .. } = &self.rings[ring];
        if *open && (k == 0 || k + 1 == points.len() as i64) {
            return;
        }
        let [before, after] = self.neighbours(point);
        let ends = [before, after].map(|k| self.position(ring, k));
        let deviation =
            (before + 1..after).map(|k| distance_squared(self.position(ring, k), ends)).fold(0.0, f64::max).sqrt();
        let link = &mut self.links[point as usize];
        link.proposal += 1;
        if deviation <= self.tolerance {
            let steps = (deviation / self.tolerance * STEPS) as u32;
            self.queue.push(Reverse((steps, link.back + link.on, point, link.proposal)));
        }
    }

    fn leave_out(&mut self, point: u32) {
        let (ring, _) = self.place(point);
        if self.kept[ring] <= self.rings[ring].least || self.sweeps_over_a_point(point) {
            return;
        }
        let neighbours = self.neighbours(point);
        let [before, after] = neighbours.map(|k| self.number(ring, k));
        let span = (neighbours[1] - neighbours[0]) as u32;
        self.links[point as usize].kept = false;
        self.links[before as usize].on = span;
        self.links[after as usize].back = span;
        self.kept[ring] -= 1;
        self.propose(before);
        if after != before {
            self.propose(after);
        }
    }

    /// Whether a point other than its three corners lies in the triangle of `point` and its neighbours.
    fn sweeps_over_a_point(&self, point: u32) -> bool {
        let (ring, k) = self.place(point);
        let [before, after] = self.neighbours(point);
        let triangle = [before, k, after].map(|k| self.position(ring, k));
        let mut blocked = false;
        self.grid.near(triangle, |other, shift| {
            if blocked || !self.links[other as usize].kept {
                return;
            }
            let (ring, k) = self.place(other);
            let position = self.position(ring, k) + shift;
            // Who touches an end of the new segment leaves the triangle through that end again.
            let is_corner =
                position == triangle[0] || position == triangle[2] || other == point && position == triangle[1];
            blocked = !is_corner && contains(triangle, position);
        });
        blocked
    }
}

/// Squared distance of `point` from a segment.
fn distance_squared(point: DVec2, [a, b]: [DVec2; 2]) -> f64 {
    let along = (b - a).length_squared();
    let t = if along > 0.0 { ((point - a).dot(b - a) / along).clamp(0.0, 1.0) } else { 0.0 };
    point.distance_squared(a + (b - a) * t)
}

/// Whether `point` is in or on a triangle, which may have no area.
fn contains(triangle: [DVec2; 3], point: DVec2) -> bool {
    let coord = |p: DVec2| Coord { x: p.x, y: p.y };
    let side = |i: usize| orient2d(coord(triangle[i]), coord(triangle[(i + 1) % 3]), coord(point));
    let sides = [side(0), side(1), side(2)];
    if sides == [0.0; 3] {
        let [a, b, c] = triangle;
        return point.cmpge(a.min(b).min(c)).all() && point.cmple(a.max(b).max(c)).all();
    }
    sides.iter().all(|&s| s >= 0.0) || sides.iter().all(|&s| s <= 0.0)
}
