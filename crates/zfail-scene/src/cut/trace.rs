//! The contour of alpha at a level, by marching squares that know the true curve.
//!
//! In: alpha at nodes. Out: closed polygons with the inside on their left (x to the right, y up), which touch at most in
//! points.
//!
//! Within the cell between four nodes, bilinear alpha has hyperbolas as level curves. A curve through a cell starts and
//! ends at exact points of the cell's sides; in between it is bent into chords where one chord would be too far off. Where
//! four crossings can be joined in two ways, alpha at the saddle decides, as it does on the true curves. Alpha that is
//! not interpolated has the outlines of texels for contours.

use super::field::AlphaField;
use crate::Filter;
use glam::DVec2;
use rustc_hash::FxHashSet;

/// A closed polygon on a plane that may repeat itself.
#[derive(Clone, Debug)]
pub(super) struct Ring {
    pub points: Vec<DVec2>,
    /// How far one lap leads: zero, or whole periods for a contour that goes around the torus.
    pub closing: DVec2,
    /// Whether it is no ring but a line from its first point to its last, which stay.
    pub open: bool,
    /// How many points it needs.
    pub least: usize,
}

/// All contours are made of points with this many fractional bits, so that moving them by periods is exact.
const FRACTION: f64 = (1_u64 << 24) as f64;

/// Rounds to [`FRACTION`].
fn snapped(point: DVec2) -> DVec2 {
    (point * FRACTION).round() / FRACTION
}

/// The level between the same two byte values that keeps clear of both, so that no contour runs through a node.
pub(super) fn generic(level: f64) -> f64 {
    /// Moves the cutoff by less than 10^-6.
    const CLEAR: f64 = 1.0 / 4096.0;
    let above = level.ceil();
    level.clamp(above - 1.0 + CLEAR, above - CLEAR)
}

/// The contour of `field` at a [`generic`] `level`, with chords at most `flatness` texels from the curve; `None` if it has
/// more than `limit` points.
pub(super) fn trace(field: &AlphaField<'_>, level: f64, flatness: f64, limit: usize) -> Option<Vec<Ring>> {
    let mut crossed = 0;
    cells(field, level, |_, corners| {
        crossed += usize::from(corners.contains(&true) && corners.contains(&false));
        Some(())
    });
    if crossed > limit {
        return None;
    }
    let mut tracer = Tracer { field, level, flatness, left: limit, seen: FxHashSet::default() };
    let mut rings = Vec::new();
    cells(field, level, |cell, corners| {
        for side in 0..4 {
            if corners[side] && !corners[(side + 1) % 4] && !tracer.seen.contains(&(cell, side)) {
                rings.push(tracer.ring(cell, side)?);
            }
        }
        Some(())
    })?;
    Some(rings)
}

/// Calls `visit` with every cell, and with whether its corners are inside, until it returns `None`.
fn cells(field: &AlphaField<'_>, level: f64, mut visit: impl FnMut([i64; 2], [bool; 4]) -> Option<()>) -> Option<()> {
    let [columns, rows] = [field.axes[0].cells(), field.axes[1].cells()];
    let inside = |j| columns.clone().chain([columns.end]).map(move |i| field.at_node([i, j]) >= level);
    let mut upper: Vec<bool> = inside(rows.start).collect();
    let mut lower = Vec::new();
    for j in rows {
        std::mem::swap(&mut lower, &mut upper);
        upper.clear();
        upper.extend(inside(j + 1));
        for (i, k) in columns.clone().zip(0..) {
            visit([i, j], [lower[k], lower[k + 1], upper[k + 1], upper[k]])?;
        }
    }
    Some(())
}

/// Side `s` of a cell goes from its corner `s` to corner `s + 1`, counter-clockwise from node `[i, j]` on. A contour enters
/// a cell through sides that lead out of the inside, and leaves it through sides that lead in.
const CORNERS: [[i64; 2]; 4] = [[0, 0], [1, 0], [1, 1], [0, 1]];

/// The cell behind each side.
const NEIGHBOURS: [[i64; 2]; 4] = [[0, -1], [1, 0], [0, 1], [-1, 0]];

fn sum(a: [i64; 2], b: [i64; 2]) -> [i64; 2] {
    [a[0] + b[0], a[1] + b[1]]
}

struct Tracer<'a> {
    field: &'a AlphaField<'a>,
    level: f64,
    flatness: f64,
    left: usize,
    /// Cells and the sides through which contours have entered them.
    seen: FxHashSet<([i64; 2], usize)>,
}

impl Tracer<'_> {
    /// The contour that enters `first` through `first_side`.
    fn ring(&mut self, first: [i64; 2], first_side: usize) -> Option<Ring> {
        let mut points = Vec::new();
        let (mut cell, mut side) = (first, first_side);
        while self.seen.insert((self.home(cell), side)) {
            let exit = self.exit(cell, side);
            let before = points.len();
            points.push(self.crossing(cell, side));
            self.arc(cell, side, exit, &mut points);
            self.left = self.left.checked_sub(points.len() - before)?;
            cell = sum(cell, NEIGHBOURS[exit]);
            side = (exit + 2) % 4;
        }
        let closing = DVec2::new((cell[0] - first[0]) as f64, (cell[1] - first[1]) as f64);
        let least = if closing == DVec2::ZERO { 3 } else { 1 };
        Some(Ring { points, closing, open: false, least })
    }

    fn home(&self, [i, j]: [i64; 2]) -> [i64; 2] {
        [self.field.axes[0].home(i), self.field.axes[1].home(j)]
    }

    fn node(&self, [i, j]: [i64; 2]) -> DVec2 {
        DVec2::new(self.field.axes[0].node(i), self.field.axes[1].node(j))
    }

    fn values(&self, cell: [i64; 2]) -> [f64; 4] {
        CORNERS.map(|corner| self.field.at_node(sum(cell, corner)))
    }

    /// Where the contour crosses a side, the same for both cells of the side.
    fn crossing(&self, cell: [i64; 2], side: usize) -> DVec2 {
        let ends = [side, (side + 1) % 4].map(|corner| sum(cell, CORNERS[corner]));
        let [a, b] = ends.map(|node| self.field.at_node(node));
        let [(inner, p), (outer, q)] = if a >= b { [(a, ends[0]), (b, ends[1])] } else { [(b, ends[1]), (a, ends[0])] };
        let along = match self.field.filter {
            Filter::Linear => (inner - self.level) / (inner - outer),
            Filter::Nearest => 0.5,
        };
        snapped(self.node(p).lerp(self.node(q), along))
    }

    /// The side through which a contour leaves that enters through `side`.
    fn exit(&self, cell: [i64; 2], side: usize) -> usize {
        let values = self.values(cell);
        let inside = values.map(|value| value >= self.level);
        let is_exit = |side: usize| !inside[side] && inside[(side + 1) % 4];
        let [next, opposite, last] = [1, 2, 3].map(|k| (side + k) % 4);
        if is_exit(opposite) {
            opposite
        } else if is_exit(next) && is_exit(last) {
            let [a, b, c, d] = values;
            let joined = match self.field.filter {
                Filter::Linear => (a * c - b * d) / (a + c - b - d) >= self.level,
                // Outlines of texels that meet in a corner stay apart.
                Filter::Nearest => false,
            };
            if joined { next } else { last }
        } else if is_exit(next) {
            next
        } else {
            last
        }
    }

    /// What lies between entry and exit.
    fn arc(&self, cell: [i64; 2], side: usize, exit: usize, points: &mut Vec<DVec2>) {
        let [low, high] = [self.node(cell), self.node(sum(cell, [1, 1]))];
        if self.field.filter == Filter::Nearest {
            return points.push(snapped(0.5 * (low + high)));
        }
        let [a, b, c, d] = self.values(cell);
        // alpha = level is (x - saddle.x) * (y - saddle.y) = constant in a cell of one texel.
        let twist = a + c - b - d;
        if twist == 0.0 || high - low != DVec2::ONE {
            return;
        }
        let saddle = low + DVec2::new(a - d, a - b) / twist;
        let [from, to] = [side, exit].map(|side| self.crossing(cell, side) - saddle);
        bend(from, to, self.flatness, &mut |point| points.push(snapped(saddle + point)));
    }
}

/// Points of the hyperbola x * y = constant strictly between two of its points, so that chords are at most `flatness` away.
fn bend(from: DVec2, to: DVec2, flatness: f64, push: &mut impl FnMut(DVec2)) {
    // The curve is farthest from its chord where its coordinates are the geometric means of the chord's ends.
    let middle = DVec2::new(mean(from.x, to.x), mean(from.y, to.y));
    let chord = to - from;
    if (middle - from).perp_dot(chord).abs() > flatness * chord.length() {
        bend(from, middle, flatness, push);
        push(middle);
        bend(middle, to, flatness, push);
    }
}

/// The geometric mean of two numbers of the same sign.
fn mean(a: f64, b: f64) -> f64 {
    (a * b).max(0.0).sqrt().copysign(a + b)
}
