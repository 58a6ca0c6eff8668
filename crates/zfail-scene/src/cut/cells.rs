//! The contour of a product within a triangle, cell by cell.
//!
//! In: a product of alphas. Out: chords with the inside on their left (x to the right, y up), end to end.
//!
//! What a triangle has of a cell between four nodes is a convex polygon, whose sides belong to edges of the triangle or to
//! lines through nodes. All decisions are made at its corners, which it shares with its neighbours, so chords of neighbours
//! meet.

use super::edge::{Product, Sample};
use super::triangle::{UNIT, Weights, nearest_inside, sides};
use glam::DVec2;
use rustc_hash::FxHashMap;

/// A point of the contour.
#[derive(Clone, Copy, Debug)]
pub(super) struct Point {
    /// On the texture's plane.
    pub at: DVec2,
    pub weights: Weights,
}

/// Whether two points lie on the same edge of the triangle.
pub(super) fn share_an_edge([a, b]: [Weights; 2]) -> bool {
    (0..3).any(|corner| a[corner] == 0 && b[corner] == 0)
}

/// From point to point, by number.
pub(super) type Chord = [usize; 2];

/// A contour.
#[derive(Debug, Default)]
pub(super) struct Tracing {
    pub points: Vec<Point>,
    pub chords: Vec<Chord>,
}

/// The contour of `product` in its triangle, whose area is `area`, with chords at most `flatness` texels from the curve;
/// `None` if it has more than `most` points.
pub(super) fn trace(product: &Product<'_>, area: f64, flatness: f64, most: usize) -> Option<Tracing> {
    let turned = area < 0.0;
    let order = if turned { [0, 2, 1] } else { [0, 1, 2] };
    let edges = [0, 1, 2].map(|k| product.ends([order[k], order[(k + 1) % 3]]));
    let crossings = edges.map(|ends| product.crossings(ends));
    let mut tracer = Tracer {
        product,
        area,
        flatness,
        most,
        edges,
        crossings,
        known: FxHashMap::default(),
        out: Tracing::default(),
    };
    let end = |edge: usize, corner: usize| {
        edges[edge].contains(&corner).then(|| if edges[edge][0] == corner { 0 } else { UNIT })
    };
    let corner = |k: usize| Spot {
        at: product.corners[order[k]].texel,
        inside: product.at_corner(order[k]) >= 0.0,
        next: Side::Edge(k),
        on_edges: [0, 1, 2].map(|edge| end(edge, order[k])),
    };
    let triangle = [0, 1, 2].map(corner);
    if product.is_textured() {
        tracer.rows(&triangle)?;
    } else {
        tracer.cell(&triangle)?;
    }
    Some(tracer.out)
}

/// What a side of a polygon lies on.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Side {
    /// An edge of the triangle, by number.
    Edge(usize),
    /// A line through nodes, by the coordinate that is the same all along it.
    Line(usize),
}

/// A corner of a polygon.
#[derive(Clone, Copy, Debug)]
struct Spot {
    at: DVec2,
    inside: bool,
    /// What leads on to the next corner.
    next: Side,
    /// Its place on each edge of the triangle: the weight of the edge's second end.
    on_edges: [Option<u32>; 3],
}

struct Tracer<'a> {
    product: &'a Product<'a>,
    area: f64,
    flatness: f64,
    most: usize,
    /// Ends of the triangle's edges, counter-clockwise by edge, each in the order in which it is looked at.
    edges: [[usize; 2]; 3],
    crossings: [Vec<Sample>; 3],
    /// Numbers of points by their place.
    known: FxHashMap<(Weights, [u64; 2]), usize>,
    out: Tracing,
}

impl Tracer<'_> {
    /// Goes through all cells that meet the triangle.
    fn rows(&mut self, triangle: &[Spot]) -> Option<()> {
        let range = |spots: &[Spot], axis: usize| {
            let places = || spots.iter().map(|spot| spot.at[axis] - 0.5);
            let (low, high) = (places().fold(f64::MAX, f64::min), places().fold(f64::MIN, f64::max));
            low.floor() as i64..=high.floor() as i64
        };
        for j in range(triangle, 1) {
            let row = self.clipped(&self.clipped(triangle, 1, j, true), 1, j + 1, false);
            if row.is_empty() {
                continue;
            }
            let columns = range(&row, 0);
            let mut left = [j, j + 1].map(|j| self.node([*columns.start(), j]));
            for i in columns {
                let right = [j, j + 1].map(|j| self.node([i + 1, j]));
                let nodes = [left[0], right[0], right[1], left[1]];
                left = right;
                match nodes.map(|(spot, within)| within.then_some(spot)) {
                    [Some(a), Some(b), Some(c), Some(d)] => {
                        if [b, c, d].iter().any(|spot| spot.inside != a.inside) {
                            let next = [Side::Line(1), Side::Line(0), Side::Line(1), Side::Line(0)];
                            let spots = [a, b, c, d];
                            self.cell(&[0, 1, 2, 3].map(|k| Spot { next: next[k], ..spots[k] }))?;
                        }
                    }
                    _ => {
                        let cell = self.clipped(&self.clipped(&row, 0, i, true), 0, i + 1, false);
                        self.cell(&cell)?;
                    }
                }
            }
        }
        Some(())
    }

    /// A node, and whether it lies in the triangle, but on none of its edges.
    fn node(&self, node: [i64; 2]) -> (Spot, bool) {
        let at = DVec2::new(node[0] as f64, node[1] as f64) + 0.5;
        let within = sides(&self.product.corners, at).iter().all(|&side| side * self.area.signum() > 0.0);
        (Spot { at, inside: self.product.at(at) >= 0.0, next: Side::Line(0), on_edges: [None; 3] }, within)
    }

    /// The part of a polygon on one side of the line through nodes on which coordinate `axis` is `k` and a half.
    fn clipped(&self, polygon: &[Spot], axis: usize, k: i64, above: bool) -> Vec<Spot> {
        let line = k as f64 + 0.5;
        let keeps = |spot: &Spot| if above { spot.at[axis] >= line } else { spot.at[axis] <= line };
        let mut clipped: Vec<Spot> = Vec::with_capacity(polygon.len() + 2);
        for (n, spot) in polygon.iter().enumerate() {
            let next = &polygon[(n + 1) % polygon.len()];
            if keeps(spot) {
                clipped.push(*spot);
            }
            if keeps(spot) != keeps(next) {
                let met = self.meeting(spot, next, axis, k);
                let leads = if keeps(spot) { Side::Line(axis) } else { spot.next };
                clipped.push(Spot { next: leads, ..met });
            }
        }
        // Whoever lies on the line is met there once more.
        let mut n = 0;
        while clipped.len() > 1 && n < clipped.len() {
            let next = (n + 1) % clipped.len();
            if clipped[n].at == clipped[next].at {
                for edge in 0..3 {
                    clipped[next].on_edges[edge] = clipped[next].on_edges[edge].or(clipped[n].on_edges[edge]);
                }
                clipped.remove(n);
            } else {
                n += 1;
            }
        }
        clipped
    }

    /// Where the side after `spot` meets a line through nodes.
    fn meeting(&self, spot: &Spot, next: &Spot, axis: usize, k: i64) -> Spot {
        match spot.next {
            Side::Edge(edge) => {
                let far = self.product.at_line(self.edges[edge], axis, k as f64);
                let mut at = self.product.on_edge(self.edges[edge], far);
                at[axis] = k as f64 + 0.5;
                let inside = self.product.is_inside(self.edges[edge], far);
                let on_edges = [0, 1, 2].map(|k| (k == edge).then_some(far));
                Spot { at, inside, next: spot.next, on_edges }
            }
            Side::Line(fixed) => {
                let mut at = next.at;
                at[fixed] = spot.at[fixed];
                at[axis] = k as f64 + 0.5;
                Spot { at, inside: self.product.at(at) >= 0.0, next: spot.next, on_edges: [None; 3] }
            }
        }
    }

    /// The chords in a convex polygon.
    fn cell(&mut self, polygon: &[Spot]) -> Option<()> {
        if polygon.len() < 3 {
            return Some(());
        }
        // Points where the boundary of the polygon crosses the contour, and whether it leaves the inside there.
        let mut met: Vec<(usize, bool)> = Vec::new();
        for (n, spot) in polygon.iter().enumerate() {
            let next = &polygon[(n + 1) % polygon.len()];
            match spot.next {
                Side::Edge(edge) => {
                    if let (Some(from), Some(to)) = (spot.on_edges[edge], next.on_edges[edge]) {
                        self.along_edge(edge, [from, to], &mut met);
                    }
                }
                Side::Line(_) if spot.inside != next.inside => {
                    let at = self.on_line(spot, next);
                    let weights = nearest_inside(sides(&self.product.corners, at), self.area);
                    met.push((self.point(Point { at, weights }), spot.inside));
                }
                Side::Line(_) => {}
            }
        }
        if met.is_empty() {
            return Some(());
        }
        let middle = met.iter().map(|&(point, _)| self.out.points[point].at).sum::<DVec2>() / met.len() as f64;
        let joined = met.len() > 2 && self.product.at(middle) >= 0.0;
        for (n, &(from, leaves)) in met.iter().enumerate().filter(|(_, (_, leaves))| *leaves) {
            let partner = if joined { n + 1 } else { n + met.len() - 1 } % met.len();
            let (to, enters) = (met[partner].0, !met[partner].1);
            if leaves && enters && from != to {
                self.chord(from, to);
            }
        }
        (self.out.points.len() <= self.most).then_some(())
    }

    /// The crossings of an edge of the triangle from one of its places to another.
    fn along_edge(&mut self, edge: usize, [from, to]: [u32; 2], met: &mut Vec<(usize, bool)>) {
        let ends = self.edges[edge];
        let between = |sample: &&Sample| (from.min(to)..from.max(to)).contains(&sample.far);
        let mut found: Vec<Sample> = self.crossings[edge].iter().filter(between).copied().collect();
        if from > to {
            found.reverse();
            found.iter_mut().for_each(|sample| sample.inside = !sample.inside);
        }
        for Sample { far, inside } in found {
            let point = Point { at: self.product.on_edge(ends, far), weights: Product::weights(ends, far) };
            met.push((self.point(point), inside));
        }
    }

    /// Where the contour crosses the line between two corners of a polygon, the same from both sides of the line.
    fn on_line(&self, spot: &Spot, next: &Spot) -> DVec2 {
        /// Of halving the interval: to less than positions are rounded by.
        const STEPS: u32 = 44;
        let ordered = [spot.at.x, spot.at.y] <= [next.at.x, next.at.y];
        let [from, to] = if ordered { [spot, next] } else { [next, spot] };
        let (mut before, mut after) = (0.0, 1.0);
        for _ in 0..STEPS {
            let along = 0.5 * (before + after);
            let inside = self.product.at(from.at + (to.at - from.at) * along) >= 0.0;
            *(if inside == from.inside { &mut before } else { &mut after }) = along;
        }
        from.at + (to.at - from.at) * (0.5 * (before + after))
    }

    /// The number of a point, which may be known.
    fn point(&mut self, point: Point) -> usize {
        let Tracing { points, .. } = &mut self.out;
        *self.known.entry((point.weights, point.at.to_array().map(f64::to_bits))).or_insert_with(|| {
            points.push(point);
            points.len() - 1
        })
    }

    /// Adds a chord, bent where the contour is.
    fn chord(&mut self, from: usize, to: usize) {
        /// Of halving a chord that leads through one cell.
        const HALVINGS: u32 = 4;
        let ends = [from, to].map(|point| self.out.points[point].at);
        let mut bends = Vec::new();
        if self.product.is_textured() {
            // Along an edge, the neighbour has more than a line.
            let along = share_an_edge([from, to].map(|point| self.out.points[point].weights));
            self.bend(ends, HALVINGS, if along { 0.0 } else { self.flatness }, &mut bends);
        }
        let mut last = from;
        for at in bends {
            let weights = nearest_inside(sides(&self.product.corners, at), self.area);
            let next = self.point(Point { at, weights });
            self.out.chords.push([last, next]);
            last = next;
        }
        self.out.chords.push([last, to]);
    }

    /// Points of the contour between two of its points, if it is more than `flatness` off half-way; further ones so that
    /// chords are within the flatness that was asked for.
    fn bend(&self, [from, to]: [DVec2; 2], halvings: u32, flatness: f64, bends: &mut Vec<DVec2>) {
        const STEPS: u32 = 20;
        let chord = to - from;
        let middle = 0.5 * (from + to);
        let within = |at: DVec2| sides(&self.product.corners, at).iter().all(|&side| side * self.area.signum() > 0.0);
        let inside = |at: DVec2| self.product.at(at) >= 0.0;
        if halvings == 0 || chord.length() <= flatness {
            return;
        }
        // The inside is on the left.
        let is_inside = inside(middle);
        let away = 0.5 * if is_inside { -chord.perp() } else { chord.perp() };
        if inside(middle + away) == is_inside {
            return;
        }
        let (mut before, mut after) = (0.0, 1.0);
        for _ in 0..STEPS {
            let along = 0.5 * (before + after);
            *(if inside(middle + away * along) == is_inside { &mut before } else { &mut after }) = along;
        }
        let bend = middle + away * (0.5 * (before + after));
        if bend.distance(middle) > flatness && within(bend) {
            self.bend([from, bend], halvings - 1, self.flatness, bends);
            bends.push(bend);
            self.bend([bend, to], halvings - 1, self.flatness, bends);
        }
    }
}
