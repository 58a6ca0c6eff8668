//! One triangle, cut along an outline.
//!
//! In: three corners on the plane of a texture, and the outline. Out: triangles over points of a barycentric lattice.
//!
//! Points are whole barycentric weights that add up to [`UNIT`], so whatever lies on an edge lies there exactly. Where the
//! outline crosses an edge is decided by exact predicates and computed from the edge's ends in an order that does not
//! depend on the triangle: both triangles of an edge get the same points.

use super::outline::Outline;
use glam::DVec2;
use robust::{Coord, orient2d};
use rustc_hash::FxHashSet;
use spade::handles::{FaceHandle, InnerTag};
use spade::{CdtEdge, ConstrainedDelaunayTriangulation, InsertionError, Point2, Triangulation};

/// The sum of a point's weights.
pub(super) const UNIT: u32 = 1 << 26;

/// A point of a triangle: weights of its corners, which add up to [`UNIT`].
pub(super) type Weights = [u32; 3];

/// A corner of a triangle.
#[derive(Clone, Copy, Debug)]
pub(super) struct Corner {
    /// Object space. It decides in which order the ends of an edge are taken.
    pub position: [f32; 3],
    /// On the texture's plane.
    pub texel: DVec2,
}

/// What is left of a triangle.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Cut {
    /// All of it.
    Whole,
    /// Nothing.
    Nothing,
    /// Triangles with the same winding.
    Pieces(Vec<[Weights; 3]>),
}

/// Whether an edge is taken from its end at `a` to that at `b`, rather than the other way.
pub(super) fn in_order(a: [f32; 3], b: [f32; 3]) -> bool {
    // Adding 0 makes -0 equal to 0, as they are where positions are welded.
    let bits = |p: [f32; 3]| p.map(|x| (x + 0.0).to_bits());
    bits(a) <= bits(b)
}

/// The part of a triangle inside of `outline`. One without area on the texture is there or not as its middle is.
pub(super) fn cut(outline: &Outline<'_>, corners: [Corner; 3]) -> Cut {
    let texels = corners.map(|corner| corner.texel);
    let whole = || {
        let [a, b, c] = texels;
        if outline.contains((a + b + c) / 3.0) { Cut::Whole } else { Cut::Nothing }
    };
    let area = side(texels[0], texels[1], texels[2]);
    if area == 0.0 {
        return whole();
    }
    let mut points = Vec::new();
    let mut chords = Vec::new();
    for segment in outline.near(texels) {
        clip(&corners, area, segment, &mut points, &mut chords);
    }
    if chords.is_empty() && points.iter().all(|weights| weights.contains(&UNIT)) {
        return whole();
    }
    // The triangulation refuses only coordinates that are not whole numbers of this size.
    let inside = |region: &[Face<'_>]| outline.contains(on_plane(texels, middle(region)));
    triangulate(&points, &chords).map_or_else(|_| whole(), |mesh| Cut::Pieces(mesh.pieces(inside)))
}

/// The triangles of the region that lies to the left of `chords`, which may only meet at their ends, or to their right;
/// with `points` as corners, too. Where no chord tells, `contains` is asked for the middle of a triangle.
pub(super) fn fill(
    points: &[Weights],
    chords: &[[Weights; 2]],
    left: bool,
    contains: impl Fn([f64; 2]) -> bool,
) -> Option<Vec<[Weights; 3]>> {
    let known: FxHashSet<[Weights; 2]> = chords.iter().copied().collect();
    let inside = |region: &[Face<'_>]| {
        let edges = region.iter().flat_map(|face| face.adjacent_edges()).filter(|edge| edge.is_constraint_edge());
        let side =
            |[from, to]: [Weights; 2]| i64::from(known.contains(&[from, to])) - i64::from(known.contains(&[to, from]));
        let sides: i64 = edges.map(|edge| side(edge.positions().map(weights))).sum();
        if sides == 0 { contains(middle(region)) } else { (sides > 0) == left }
    };
    Some(triangulate(points, chords).ok()?.pieces(inside))
}

/// Twice the area of the triangle `a`, `b`, `c`, with its exact sign: above 0 where it turns left.
pub(super) fn side(a: DVec2, b: DVec2, c: DVec2) -> f64 {
    let coord = |p: DVec2| Coord { x: p.x, y: p.y };
    orient2d(coord(a), coord(b), coord(c))
}

/// Adds the part of a segment inside of the triangle to `chords`, and its ends and all its crossings of edges to `points`.
fn clip(
    corners: &[Corner; 3],
    area: f64,
    [a, b]: [DVec2; 2],
    points: &mut Vec<Weights>,
    chords: &mut Vec<[Weights; 2]>,
) {
    // Along the segment, 0 at `a` and 1 at `b`.
    let mut on_segment: Vec<(f64, Weights)> = Vec::new();
    for edge in 0..3 {
        let next = (edge + 1) % 3;
        let [from, to] = [corners[edge], corners[next]];
        let kept_order = in_order(from.position, to.position);
        let [p, q] = if kept_order { [from.texel, to.texel] } else { [to.texel, from.texel] };
        crossings(p, q, [a, b], |along_edge, along_segment| {
            if (0.0..=1.0).contains(&along_edge) {
                let far = (along_edge * f64::from(UNIT)).round() as u32;
                let mut weights = [0; 3];
                weights[if kept_order { next } else { edge }] = far;
                weights[if kept_order { edge } else { next }] = UNIT - far;
                on_segment.push((along_segment, weights));
            }
        });
    }
    for (end, along) in [(a, 0.0), (b, 1.0)] {
        on_segment.extend(interior(corners, area, end).map(|weights| (along, weights)));
    }
    points.extend(on_segment.iter().map(|&(_, weights)| weights));
    // A triangle is convex, so one stretch of the segment lies in it.
    let first = on_segment.iter().min_by(|a, b| a.0.total_cmp(&b.0));
    let last = on_segment.iter().max_by(|a, b| a.0.total_cmp(&b.0));
    if let (Some(&(_, first)), Some(&(_, last))) = (first, last)
        && first != last
    {
        chords.push([first, last]);
    }
}

/// Calls `found` with every point at which the segment meets the line from `p` to `q`, as fractions of the way from `p`
/// to `q` and along the segment. A segment that lies in the line meets it at its ends.
fn crossings(p: DVec2, q: DVec2, [a, b]: [DVec2; 2], mut found: impl FnMut(f64, f64)) {
    let (side_a, side_b) = (side(p, q, a), side(p, q, b));
    let mut end = |point: DVec2, along| found((point - p).dot(q - p) / (q - p).length_squared(), along);
    if side_a == 0.0 {
        end(a, 0.0);
    }
    if side_b == 0.0 {
        end(b, 1.0);
    }
    if (side_a > 0.0 && side_b < 0.0) || (side_a < 0.0 && side_b > 0.0) {
        let (side_p, side_q) = (side(a, b, p), side(a, b, q));
        if (side_p >= 0.0 && side_q <= 0.0) || (side_p <= 0.0 && side_q >= 0.0) {
            found(side_p / (side_p - side_q), side_a / (side_a - side_b));
        }
    }
}

/// The weights of a point strictly inside of the triangle, none of them 0.
fn interior(corners: &[Corner; 3], area: f64, point: DVec2) -> Option<Weights> {
    let sides = sides(corners, point);
    sides.iter().all(|&side| side * area.signum() > 0.0).then(|| nearest_inside(sides, area))
}

/// On which side of each edge a point lies, by the corner opposite of the edge: twice the area of the two, which has the
/// sign of the triangle's area inside. The sign is exact.
pub(super) fn sides(corners: &[Corner; 3], point: DVec2) -> [f64; 3] {
    std::array::from_fn(|i| side(corners[(i + 1) % 3].texel, corners[(i + 2) % 3].texel, point))
}

/// Weights near the point with these [`sides`], none of them 0.
pub(super) fn nearest_inside(sides: [f64; 3], area: f64) -> Weights {
    let whole = |side: f64, greatest: u32| ((side / area * f64::from(UNIT)).round() as u32).clamp(1, greatest);
    let first = whole(sides[1], UNIT - 2);
    let second = whole(sides[2], UNIT - first - 1);
    [UNIT - first - second, first, second]
}

/// A triangulation of the lattice points of a triangle.
struct Planar(ConstrainedDelaunayTriangulation<Point2<f64>>);

type Face<'a> = FaceHandle<'a, InnerTag, Point2<f64>, (), CdtEdge<()>, ()>;

/// Triangulates the whole triangle with its corners and `points` so that every chord is made of edges.
fn triangulate(points: &[Weights], chords: &[[Weights; 2]]) -> Result<Planar, InsertionError> {
    let mut planar = ConstrainedDelaunayTriangulation::new();
    let place = |[_, x, y]: Weights| Point2::new(f64::from(x), f64::from(y));
    for corner in [[UNIT, 0, 0], [0, UNIT, 0], [0, 0, UNIT]] {
        planar.insert(place(corner))?;
    }
    for &point in points {
        planar.insert(place(point))?;
    }
    for &[from, to] in chords {
        let (from, to) = (planar.insert(place(from))?, planar.insert(place(to))?);
        // Chords do not cross but for the rounding to the lattice.
        planar.add_constraint_and_split(from, to, |crossing| crossing);
    }
    Ok(Planar(planar))
}

impl Planar {
    /// The triangles of the regions that are `inside`; chords lie between regions.
    fn pieces(&self, inside: impl Fn(&[Face<'_>]) -> bool) -> Vec<[Weights; 3]> {
        let mut pieces = Vec::new();
        let mut seen = vec![false; self.0.num_all_faces()];
        for seed in self.0.inner_faces() {
            if std::mem::replace(&mut seen[seed.fix().index()], true) {
                continue;
            }
            let mut region = vec![seed];
            let mut next = 0;
            while let Some(face) = region.get(next).copied() {
                next += 1;
                for edge in face.adjacent_edges().into_iter().filter(|edge| !edge.is_constraint_edge()) {
                    if let Some(neighbour) = edge.rev().face().as_inner()
                        && !std::mem::replace(&mut seen[neighbour.fix().index()], true)
                    {
                        region.push(neighbour);
                    }
                }
            }
            if inside(&region) {
                pieces.extend(region.iter().map(|face| face.vertices().map(|vertex| weights(vertex.position()))));
            }
        }
        pieces.retain(|[a, b, c]| a != b && b != c && c != a);
        pieces
    }
}

/// The second and third weight of the middle of a region's largest triangle, as parts of 1.
fn middle(region: &[Face<'_>]) -> [f64; 2] {
    let largest = region.iter().max_by(|a, b| a.area().total_cmp(&b.area()));
    let middle = largest.map_or(Point2::new(0.0, 0.0), |face| face.center());
    [middle.x, middle.y].map(|w| w / f64::from(UNIT))
}

/// The point of a triangle with these weights of its second and third corner.
pub(super) fn on_plane([a, b, c]: [DVec2; 3], [second, third]: [f64; 2]) -> DVec2 {
    a + (b - a) * second + (c - a) * third
}

/// A place of the triangulation as weights.
fn weights(place: Point2<f64>) -> Weights {
    let second = (place.x.round() as u32).min(UNIT);
    let third = (place.y.round() as u32).min(UNIT - second);
    [UNIT - second - third, second, third]
}
