//! The region that a polygon bounds, as triangles.
//!
//! In: corners on a plane. Out: triangles between them.
//!
//! Every face of a constrained Delaunay triangulation is taken as many times as the polygon winds around it, so the
//! polygon is the boundary of what is taken, whatever its shape: each edge once, bridges to holes and back not at all.
//! That needs every edge of the polygon to be one of the triangulation. One that is not, because another crosses it or a
//! corner lies on it, makes a detour along edges that are there, and what lies between it and the detour becomes triangles
//! of its own.

use glam::{DVec2, DVec3};
use rustc_hash::{FxBuildHasher, FxHashMap, FxHashSet};
use spade::handles::{FixedDirectedEdgeHandle, FixedVertexHandle};
use spade::{
    ConstrainedDelaunayTriangulation, HasPosition, HierarchyHintGenerator, Intersection, LineIntersectionIterator,
    Point2, Triangulation,
};
use std::hash::BuildHasher;

/// Triangles whose boundary is a polygon.
pub(super) struct Region {
    /// Corners of the polygon by number.
    pub triangles: Vec<[usize; 3]>,
    /// Whether edges cross each other.
    pub crosses: bool,
}

/// Triangles may be so many times as many as corners, where the polygon winds around them more than once.
const LAYERS: usize = 4;

/// Edges of the triangulation that may be looked at per corner, beyond [`FREE_WORK`]. A leaning comb takes 20.
const WORK: usize = 64;
const FREE_WORK: usize = 1 << 16;

/// The same for an edge that crosses another: every sixteenth may.
const CROSSING: usize = 1024;

/// The region of the polygon `flat`, whose corners are in fact at `places`. `None` if it crosses itself in many places, or
/// corners hide each other.
pub(super) fn cover(flat: &[DVec2], places: &[DVec3]) -> Option<Region> {
    let sites = Sites::new(flat, places)?;
    let mut work = WORK * flat.len() + FREE_WORK;
    let plane = Plane::new(&sites, &mut work)?;
    let mut triangles = Vec::with_capacity(flat.len());
    // Of each directed edge, how often the polygon runs along it.
    let mut runs = vec![0_isize; plane.mesh.num_directed_edges()];
    let mut starts = Vec::new();
    let mut crosses = false;
    for corner in 0..flat.len() {
        let next = (corner + 1) % flat.len();
        let ends = [corner, next].map(|corner| sites.of_corner[corner]);
        if ends[0] == ends[1] {
            continue;
        }
        let way = plane.way(ends, &mut work, &mut crosses)?;
        for (k, step) in way.windows(2).enumerate() {
            let edge = *plane.edges.get(&[step[0], step[1]])?;
            if k == 0 && runs[edge.index()] == 0 {
                starts.push((corner, edge));
            }
            runs[edge.index()] += 1;
            if k > 0 {
                let far = if k + 2 == way.len() { next } else { sites.corners[step[1]] };
                triangles.push([corner, far, sites.corners[step[0]]]);
            }
        }
    }
    let shared = plane.shared_corners(&sites, &runs, starts);
    let windings = plane.windings(&runs);
    for face in plane.mesh.inner_faces() {
        let number = face.index();
        let turns = windings[number];
        let corner = |site| *shared.get(&(number, site)).unwrap_or(&sites.corners[site]);
        let [a, b, c] = face.vertices().map(|vertex| corner(vertex.data().site));
        let triangle = if turns > 0 { [a, b, c] } else { [a, c, b] };
        triangles.extend(std::iter::repeat_n(triangle, turns.unsigned_abs()));
        if triangles.len() > LAYERS * flat.len() {
            return None;
        }
    }
    Some(Region { triangles, crosses })
}

/// The points where corners are.
struct Sites {
    points: Vec<Point2<f64>>,
    /// The first corner of each.
    corners: Vec<usize>,
    of_corner: Vec<usize>,
}

impl Sites {
    /// `None` if corners at the same point of the plane are not in fact at the same place.
    fn new(flat: &[DVec2], places: &[DVec3]) -> Option<Self> {
        let mut known = FxHashMap::default();
        let mut sites = Self { points: Vec::new(), corners: Vec::new(), of_corner: Vec::new() };
        for (corner, (point, place)) in flat.iter().zip(places).enumerate() {
            let site = *known.entry(point.to_array().map(f64::to_bits)).or_insert(sites.points.len());
            if site == sites.points.len() {
                sites.points.push(Point2::new(point.x, point.y));
                sites.corners.push(corner);
            }
            if places[sites.corners[site]] != *place {
                return None;
            }
            sites.of_corner.push(site);
        }
        Some(sites)
    }

    /// What the polygon runs along, each edge once.
    fn edges(&self) -> Vec<[usize; 2]> {
        let next = self.of_corner.iter().cycle().skip(1);
        let mut known = FxHashSet::default();
        let edges = self.of_corner.iter().zip(next).map(|(&a, &b)| [a, b]);
        edges.filter(|&[a, b]| a != b && known.insert([a.min(b), a.max(b)])).collect()
    }
}

/// A triangulation of the plane.
struct Plane {
    mesh: Mesh,
    /// Of each site.
    vertices: Vec<FixedVertexHandle>,
    /// Directed edges by the sites at their ends.
    edges: FxHashMap<[usize; 2], FixedDirectedEdgeHandle>,
}

type Mesh = ConstrainedDelaunayTriangulation<Vertex, (), (), (), HierarchyHintGenerator<f64>>;

struct Vertex {
    point: Point2<f64>,
    site: usize,
}

impl HasPosition for Vertex {
    type Scalar = f64;

    fn position(&self) -> Point2<f64> {
        self.point
    }
}

impl Plane {
    fn new(sites: &Sites, work: &mut usize) -> Option<Self> {
        let mut mesh = Mesh::default();
        let mut vertices = vec![FixedVertexHandle::from_index(0); sites.points.len()];
        for site in insertion_order(&sites.points) {
            vertices[site] = mesh.insert(Vertex { point: sites.points[site], site }).ok()?;
        }
        for [from, to] in sites.edges().into_iter().map(|ends| ends.map(|site| vertices[site])) {
            let mut is_free = true;
            // Adding looks at all of this too, but cannot be stopped.
            for met in LineIntersectionIterator::new_from_handles(&mesh, from, to) {
                *work = work.checked_sub(1)?;
                if matches!(met, Intersection::EdgeIntersection(edge) if edge.is_constraint_edge()) {
                    *work = work.checked_sub(CROSSING)?;
                    is_free = false;
                    break;
                }
            }
            if is_free {
                mesh.try_add_constraint(from, to);
            }
        }
        let edges = mesh.directed_edges().map(|edge| (edge.vertices().map(|v| v.data().site), edge.fix())).collect();
        Some(Self { mesh, vertices, edges })
    }

    /// The sites along edges of the triangulation from one site to another, as near to the straight way as there are; the
    /// number of edges that are looked at is taken off `work`, and `crosses` set if it has to leave the straight way.
    fn way(&self, [from, to]: [usize; 2], work: &mut usize, crosses: &mut bool) -> Option<Vec<usize>> {
        if self.edges.contains_key(&[from, to]) {
            return Some(vec![from, to]);
        }
        let [start, end] = [from, to].map(|site| self.vertices[site]);
        *work = work.checked_sub(self.mesh.vertex(start).out_edges().count())?;
        let mut way: Vec<usize> = Vec::new();
        for met in LineIntersectionIterator::new_from_handles(&self.mesh, start, end) {
            *work = work.checked_sub(1)?;
            let site = match met {
                Intersection::VertexIntersection(vertex) => vertex.data().site,
                Intersection::EdgeOverlap(edge) => edge.to().data().site,
                // Its left end, as seen on the way.
                Intersection::EdgeIntersection(edge) => {
                    *crosses = true;
                    edge.from().data().site
                }
            };
            if way.last() != Some(&site) {
                way.push(site);
            }
        }
        Some(way)
    }

    /// Which corner is meant where several are at one site, by face and site: the one whose edge in `starts` comes next
    /// to the right, since nothing of the polygon lies between the two.
    fn shared_corners(
        &self,
        sites: &Sites,
        runs: &[isize],
        starts: Vec<(usize, FixedDirectedEdgeHandle)>,
    ) -> FxHashMap<(usize, usize), usize> {
        let mut shared = FxHashMap::default();
        if sites.points.len() == sites.of_corner.len() {
            return shared;
        }
        for (corner, edge) in starts {
            let mut edge = self.mesh.directed_edge(edge);
            while !edge.is_outer_edge() {
                shared.insert((edge.face().index(), edge.from().data().site), corner);
                edge = edge.ccw();
                if runs[edge.fix().index()] > 0 || runs[edge.rev().fix().index()] > 0 {
                    break;
                }
            }
        }
        shared
    }

    /// How often a polygon with these `runs` winds around each face, counter-clockwise above 0.
    fn windings(&self, runs: &[isize]) -> Vec<isize> {
        let mut windings = vec![None; self.mesh.num_all_faces()];
        windings[self.mesh.outer_face().index()] = Some(0);
        let mut next: Vec<_> = self.mesh.directed_edges().filter(|edge| edge.is_outer_edge()).collect();
        while let Some(edge) = next.pop() {
            let beyond = edge.rev();
            let face = beyond.face().index();
            if windings[face].is_none() {
                let here: isize = windings[edge.face().index()].unwrap_or(0);
                windings[face] = Some(here + runs[beyond.fix().index()] - runs[edge.fix().index()]);
                next.extend([beyond.next(), beyond.prev()]);
            }
        }
        windings.into_iter().map(|turns| turns.unwrap_or(0)).collect()
    }
}

/// All points by number, as if shuffled, so that none takes long to find its place; but first three that lie on no line if
/// there are such, since the places on a line are gone through one by one.
fn insertion_order(points: &[Point2<f64>]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..points.len()).collect();
    order.sort_unstable_by_key(|&k| FxBuildHasher.hash_one(k));
    let at = |k: usize| DVec2::new(points[k].x, points[k].y);
    let mut lead = |place: usize, far: &dyn Fn(DVec2) -> f64| {
        let farthest = (place..order.len()).max_by(|&a, &b| far(at(order[a])).total_cmp(&far(at(order[b]))));
        let farthest = farthest.unwrap_or(place);
        order.swap(place, farthest);
        at(order[place])
    };
    if points.len() > 3 {
        let left = lead(0, &|p| -p.x);
        let right = lead(1, &|p| p.distance_squared(left));
        lead(2, &|p| (right - left).perp_dot(p - left).abs());
    }
    order
}
