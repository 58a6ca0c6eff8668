//! Polyhedra: boxes and subdivided icosahedra.

use super::{CREASE, Facets, Mesh};
use glam::DVec3;
use rustc_hash::FxHashMap;

/// An axis-aligned box between two corners, flat-shaded.
#[must_use]
pub fn cuboid(min: DVec3, max: DVec3) -> Mesh {
    let corner = |i: usize| {
        let pick = |bit: usize, lo: f64, hi: f64| if i >> bit & 1 == 0 { lo } else { hi };
        DVec3::new(pick(0, min.x, max.x), pick(1, min.y, max.y), pick(2, min.z, max.z))
    };
    let mut facets = Facets::default();
    for face in [[1, 3, 7, 5], [0, 4, 6, 2], [2, 6, 7, 3], [0, 1, 5, 4], [4, 5, 7, 6], [0, 2, 3, 1]] {
        facets.quad(face.map(corner));
    }
    facets.mesh("box", CREASE)
}

/// [`cuboid`] with every face divided into `cells` by `cells` squares (at least one).
#[must_use]
pub fn divided_cuboid(min: DVec3, max: DVec3, cells: usize) -> Mesh {
    let cells = cells.max(1);
    // One formula for every face, so that faces meet bit for bit.
    let at = |axis: usize, i: usize| min[axis] + (max[axis] - min[axis]) * (i as f64 / cells as f64);
    let mut facets = Facets::default();
    for axis in 0..3 {
        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
        for (i, j) in (0..cells).flat_map(|i| (0..cells).map(move |j| (i, j))) {
            let corner = |side: usize, i: usize, j: usize| {
                let mut p = DVec3::ZERO;
                (p[axis], p[u], p[v]) = (at(axis, side * cells), at(u, i), at(v, j));
                p
            };
            let square =
                |side: usize| [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)].map(|(i, j)| corner(side, i, j));
            let [a, b, c, d] = square(0);
            facets.quad(square(1));
            facets.quad([a, d, c, b]);
        }
    }
    facets.mesh("box", CREASE)
}

/// An icosahedron, each triangle cut into four `subdivisions` times, on the sphere of `radius` around the origin;
/// smooth if `smooth`, faceted otherwise.
#[must_use]
pub fn ico_sphere(radius: f64, subdivisions: u32, smooth: bool) -> Mesh {
    let (mut points, mut triangles) = icosahedron();
    for _ in 0..subdivisions {
        let mut middles: FxHashMap<(usize, usize), usize> = FxHashMap::default();
        let mut middle = |a: usize, b: usize| {
            *middles.entry((a.min(b), a.max(b))).or_insert_with(|| {
                points.push((points[a] + points[b]).normalize());
                points.len() - 1
            })
        };
        triangles = triangles
            .iter()
            .flat_map(|&[a, b, c]| {
                let [ab, bc, ca] = [middle(a, b), middle(b, c), middle(c, a)];
                [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
            })
            .collect();
    }
    let mut facets = Facets::default();
    for t in triangles {
        facets.triangle(t.map(|v| points[v] * radius));
    }
    facets.mesh("ico sphere", if smooth { std::f64::consts::PI } else { 0.0 })
}

/// Unit vertices and triangles of an icosahedron: three golden rectangles across each other.
fn icosahedron() -> (Vec<DVec3>, Vec<[usize; 3]>) {
    let golden = (1.0 + 5.0_f64.sqrt()) / 2.0;
    let mut points = Vec::with_capacity(12);
    for (a, b) in [(-1.0, golden), (1.0, golden), (-1.0, -golden), (1.0, -golden)] {
        points.push(DVec3::new(a, b, 0.0));
        points.push(DVec3::new(0.0, a, b));
        points.push(DVec3::new(b, 0.0, a));
    }
    // Edges have length 2; the faces are the triples of points at that distance from each other.
    let near = |a: usize, b: usize| points[a].distance_squared(points[b]) < 4.5;
    let mut triangles = Vec::with_capacity(20);
    for a in 0..12 {
        for b in a + 1..12 {
            for c in b + 1..12 {
                if near(a, b) && near(b, c) && near(c, a) {
                    let outward = points[a].dot(points[b].cross(points[c])) > 0.0;
                    triangles.push(if outward { [a, b, c] } else { [a, c, b] });
                }
            }
        }
    }
    (points.iter().map(|p| p.normalize()).collect(), triangles)
}
