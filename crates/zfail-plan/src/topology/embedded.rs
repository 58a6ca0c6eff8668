//! Whether a closed surface is embedded: no two of its triangles meet except in the vertices and edges they share.
//!
//! Then, by Jordan-Brouwer, a connected closed part separates space into an inside and an outside, and single weights
//! are exact. The answer is conservative: any contact that is not through shared vertices counts as meeting, and so does what
//! takes too long to find out, as where tens of thousands of triangles meet in one vertex. All
//! predicates are exact (Shewchuk 1997, "Adaptive Precision Floating-Point Arithmetic and Fast Robust Geometric
//! Predicates", by the crate `robust`).

use super::Topology;
use crate::parallel;
use robust::{Coord, Coord3D, orient2d, orient3d};
use std::sync::atomic::{AtomicI64, Ordering};

type Point = [f64; 3];

/// Triangles below this many in a node are compared pair by pair.
const LEAF: usize = 8;
/// Pairs compared per triangle at most. Ordinary meshes need about a hundred; n triangles around one vertex need n / 2.
const PAIRS: usize = 512;

/// Whether `triangles` (of one part) meet only in shared vertices and edges.
pub(super) fn is_embedded(topology: &Topology, triangles: &[u32]) -> bool {
    let mut items: Vec<Item> = triangles.iter().map(|&t| Item::new(topology, t as usize)).collect();
    let tree = Node::build(&mut items);
    tree.is_free_of_contact(&Pairs { items: &items, left: AtomicI64::new((PAIRS * triangles.len()) as i64) })
}

/// The triangles, and how many pairs of them may still be compared.
struct Pairs<'a> {
    items: &'a [Item],
    left: AtomicI64,
}

impl Pairs<'_> {
    /// Whether so many may be compared.
    fn take(&self, pairs: usize) -> bool {
        self.left.fetch_sub(pairs as i64, Ordering::Relaxed) >= pairs as i64
    }
}

struct Item {
    vertices: [u32; 3],
    corners: [Point; 3],
    min: [f32; 3],
    max: [f32; 3],
}

impl Item {
    fn new(topology: &Topology, t: usize) -> Self {
        let vertices = topology.triangles[t];
        let p = vertices.map(|v| topology.positions[v as usize]);
        let axis = |i: usize, pick: fn(f32, f32) -> f32| pick(pick(p[0][i], p[1][i]), p[2][i]);
        Self {
            vertices,
            corners: p.map(|q| q.map(f64::from)),
            min: std::array::from_fn(|i| axis(i, f32::min)),
            max: std::array::from_fn(|i| axis(i, f32::max)),
        }
    }
}

struct Node {
    min: [f32; 3],
    max: [f32; 3],
    start: usize,
    end: usize,
    children: Option<Box<[Node; 2]>>,
}

impl Node {
    fn build(items: &mut [Item]) -> Self {
        Self::range(items, 0)
    }

    fn range(items: &mut [Item], start: usize) -> Self {
        let mut min = [f32::INFINITY; 3];
        let mut max = [f32::NEG_INFINITY; 3];
        for item in items.iter() {
            for i in 0..3 {
                min[i] = min[i].min(item.min[i]);
                max[i] = max[i].max(item.max[i]);
            }
        }
        let end = start + items.len();
        let children = (items.len() > LEAF).then(|| {
            let extent: [f32; 3] = std::array::from_fn(|i| max[i] - min[i]);
            let axis = (0..3).max_by(|&a, &b| extent[a].total_cmp(&extent[b])).unwrap_or(0);
            let middle = items.len() / 2;
            items.select_nth_unstable_by(middle, |a, b| {
                (a.min[axis] + a.max[axis]).total_cmp(&(b.min[axis] + b.max[axis]))
            });
            let (left, right) = items.split_at_mut(middle);
            let (left, right) = parallel::join(|| Self::range(left, start), || Self::range(right, start + middle));
            Box::new([left, right])
        });
        Self { min, max, start, end, children }
    }

    fn is_free_of_contact(&self, pairs: &Pairs<'_>) -> bool {
        let items = pairs.items;
        match &self.children {
            Some(children) => {
                let [left, right] = &**children;
                let (l, r) = parallel::join(|| left.is_free_of_contact(pairs), || right.is_free_of_contact(pairs));
                l && r && left.is_apart_from(right, pairs)
            }
            None => (self.start..self.end).all(|i| (i + 1..self.end).all(|j| !meet(&items[i], &items[j]))),
        }
    }

    fn is_apart_from(&self, other: &Self, pairs: &Pairs<'_>) -> bool {
        let items = pairs.items;
        if !overlap(self.min, self.max, other.min, other.max) {
            return true;
        }
        match (&self.children, &other.children) {
            (None, None) => {
                pairs.take((self.end - self.start) * (other.end - other.start))
                    && (self.start..self.end).all(|i| (other.start..other.end).all(|j| !meet(&items[i], &items[j])))
            }
            (Some(c), None) => c.iter().all(|child| child.is_apart_from(other, pairs)),
            (None, Some(c)) => c.iter().all(|child| self.is_apart_from(child, pairs)),
            (Some(a), Some(b)) => a.iter().all(|x| b.iter().all(|y| x.is_apart_from(y, pairs))),
        }
    }
}

fn overlap(min_a: [f32; 3], max_a: [f32; 3], min_b: [f32; 3], max_b: [f32; 3]) -> bool {
    (0..3).all(|i| min_a[i] <= max_b[i] && min_b[i] <= max_a[i])
}

/// Whether a segment lies beside the box of a triangle.
fn is_beside(segment: &[Point; 2], of: &Item) -> bool {
    let [p, q] = segment;
    (0..3).any(|i| p[i].max(q[i]) < f64::from(of.min[i]) || p[i].min(q[i]) > f64::from(of.max[i]))
}

/// Whether two triangles meet anywhere but in their shared vertices or their one shared edge.
fn meet(a: &Item, b: &Item) -> bool {
    if !overlap(a.min, a.max, b.min, b.max) {
        return false;
    }
    let shared = |x: &Item, y: &Item| std::array::from_fn::<bool, 3, _>(|i| y.vertices.contains(&x.vertices[i]));
    let (shared_a, shared_b) = (shared(a, b), shared(b, a));
    match shared_a.iter().filter(|&&s| s).count() {
        0 => {
            let below = edges(&a.corners).iter().any(|e| crosses(e, &b.corners));
            below || edges(&b.corners).iter().any(|e| crosses(e, &a.corners))
        }
        1 => {
            let (va, vb) = (position_of(&shared_a, true), position_of(&shared_b, true));
            let far = |p: &[Point; 3], v: usize| [p[(v + 1) % 3], p[(v + 2) % 3]];
            let (ea, eb) = (far(&a.corners, va), far(&b.corners, vb));
            // Where they meet beyond the vertex, the far edge of one of them meets the other.
            if is_beside(&ea, b) && is_beside(&eb, a) {
                return false;
            }
            if ea.iter().all(|p| side(&b.corners, p) == 0.0) {
                return sectors_meet(a.corners[va], ea, eb);
            }
            crosses(&ea, &b.corners) || crosses(&eb, &a.corners)
        }
        2 => {
            let (wa, wb) = (a.corners[position_of(&shared_a, false)], b.corners[position_of(&shared_b, false)]);
            if side(&b.corners, &wa) != 0.0 {
                return false;
            }
            // Coplanar: folded onto each other if both apexes lie on one side of the shared edge.
            let i = position_of(&shared_a, false);
            let (p, q) = (a.corners[(i + 1) % 3], a.corners[(i + 2) % 3]);
            let drop = dropped_axis(&a.corners);
            turn(drop, p, q, wa) * turn(drop, p, q, wb) >= 0.0
        }
        _ => true,
    }
}

fn position_of(flags: &[bool; 3], value: bool) -> usize {
    flags.iter().position(|&f| f == value).unwrap_or(0)
}

fn edges(t: &[Point; 3]) -> [[Point; 2]; 3] {
    [[t[0], t[1]], [t[1], t[2]], [t[2], t[0]]]
}

/// Exact side of `p` with respect to the plane of `t`.
fn side(t: &[Point; 3], p: &Point) -> f64 {
    let c = |p: &Point| Coord3D { x: p[0], y: p[1], z: p[2] };
    orient3d(c(&t[0]), c(&t[1]), c(&t[2]), c(p))
}

/// Whether the closed segment meets the closed triangle; coplanar pairs whose projections overlap count as meeting.
fn crosses(segment: &[Point; 2], t: &[Point; 3]) -> bool {
    let (s0, s1) = (side(t, &segment[0]), side(t, &segment[1]));
    if s0 * s1 > 0.0 {
        return false;
    }
    if s0 == 0.0 && s1 == 0.0 {
        return coplanar_meet(segment, t);
    }
    let [p, q] = *segment;
    let turns = edges(t).map(|[a, b]| side(&[p, q, a], &b));
    turns.iter().all(|&v| v >= 0.0) || turns.iter().all(|&v| v <= 0.0)
}

fn coplanar_meet(segment: &[Point; 2], t: &[Point; 3]) -> bool {
    let drop = dropped_axis(t);
    let outside = |a: Point, b: Point, inner: Point| {
        let reference = turn(drop, a, b, inner).signum();
        segment.iter().all(|&p| turn(drop, a, b, p) * reference < 0.0)
    };
    if outside(t[0], t[1], t[2]) || outside(t[1], t[2], t[0]) || outside(t[2], t[0], t[1]) {
        return false;
    }
    let turns = t.map(|p| turn(drop, segment[0], segment[1], p));
    !(turns.iter().all(|&v| v > 0.0) || turns.iter().all(|&v| v < 0.0))
}

/// Whether two coplanar triangles with the common corner `v` and far edges `a`, `b` overlap beyond `v`.
fn sectors_meet(v: Point, a: [Point; 2], b: [Point; 2]) -> bool {
    let drop = dropped_axis(&[v, a[0], a[1]]);
    let within = |p: Point, s: [Point; 2]| {
        let orientation = turn(drop, v, s[0], s[1]).signum();
        turn(drop, v, s[0], p) * orientation >= 0.0 && turn(drop, v, p, s[1]) * orientation >= 0.0
    };
    within(a[0], b) || within(a[1], b) || within(b[0], a) || within(b[1], a)
}

/// The axis along which the triangle's projection is largest, so that it is safe to drop.
fn dropped_axis(t: &[Point; 3]) -> usize {
    let d = |i: usize, j: usize| t[j][i] - t[0][i];
    let normal: [f64; 3] = std::array::from_fn(|i| {
        let (u, w) = ((i + 1) % 3, (i + 2) % 3);
        (d(u, 1) * d(w, 2) - d(w, 1) * d(u, 2)).abs()
    });
    (0..3).max_by(|&i, &j| normal[i].total_cmp(&normal[j])).unwrap_or(2)
}

/// Exact turn of `a -> b -> c` after dropping one axis.
fn turn(drop: usize, a: Point, b: Point, c: Point) -> f64 {
    let flat = |p: Point| Coord { x: p[(drop + 1) % 3], y: p[(drop + 2) % 3] };
    orient2d(flat(a), flat(b), flat(c))
}
