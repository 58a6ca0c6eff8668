//! Triangles on their way to a mesh.
//!
//! In: triangles with positions and perhaps texture coordinates. Out: a [`Mesh`] with normals, smooth up to a crease
//! angle, and vertices shared where position, normal and texture coordinates agree in every bit.

use super::Mesh;
use glam::{DVec2, DVec3};
use rustc_hash::FxHashMap;
use zfail_scene::Primitive;

/// Collects triangles; [`Facets::mesh`] turns them into a mesh.
#[derive(Clone, Debug, Default)]
pub struct Facets {
    triangles: Vec<[Corner; 3]>,
}

#[derive(Clone, Copy, Debug)]
struct Corner {
    position: [f32; 3],
    uv: Option<[f32; 2]>,
}

impl Corner {
    fn new(position: DVec3, uv: Option<DVec2>) -> Self {
        // Adding zero turns -0.0 into 0.0, so that bit equality is value equality.
        let position = (position.as_vec3() + glam::Vec3::ZERO).to_array();
        Self { position, uv: uv.map(|uv| uv.as_vec2().to_array()) }
    }
}

impl Facets {
    /// Adds a triangle, counter-clockwise seen from the front; texture coordinates will be projected along the axis
    /// nearest to its normal.
    pub fn triangle(&mut self, [a, b, c]: [DVec3; 3]) {
        self.triangles.push([a, b, c].map(|p| Corner::new(p, None)));
    }

    /// Adds a planar convex quadrilateral, counter-clockwise seen from the front.
    pub fn quad(&mut self, [a, b, c, d]: [DVec3; 4]) {
        self.add_quad([a, b, c, d].map(|p| Corner::new(p, None)));
    }

    /// [`Facets::quad`] with texture coordinates.
    pub fn textured_quad(&mut self, corners: [(DVec3, DVec2); 4]) {
        self.add_quad(corners.map(|(p, uv)| Corner::new(p, Some(uv))));
    }

    /// Splits along the shorter diagonal and drops a half that has collapsed to an edge, as at a pole.
    fn add_quad(&mut self, [a, b, c, d]: [Corner; 4]) {
        let length = |p: Corner, q: Corner| vec3(p.position).distance_squared(vec3(q.position));
        let halves = if length(b, d) < length(a, c) { [[a, b, d], [b, c, d]] } else { [[a, b, c], [a, c, d]] };
        let collapsed =
            |[p, q, r]: [Corner; 3]| p.position == q.position || q.position == r.position || r.position == p.position;
        self.triangles.extend(halves.into_iter().filter(|&half| !collapsed(half)));
    }

    /// The mesh, with faces that meet at less than `crease` radians shaded as one smooth surface.
    #[must_use]
    pub fn mesh(&self, name: &str, crease: f64) -> Mesh {
        let weights: Vec<[DVec3; 3]> = self.triangles.iter().map(weighted_normals).collect();
        let mut around: FxHashMap<[u32; 3], Vec<(usize, usize)>> = FxHashMap::default();
        for (t, corners) in self.triangles.iter().enumerate() {
            for (k, corner) in corners.iter().enumerate() {
                around.entry(corner.position.map(f32::to_bits)).or_default().push((t, k));
            }
        }

        let mut mesh = Mesh { name: name.to_owned(), ..Mesh::default() };
        let mut vertices: FxHashMap<[u32; 8], u32> = FxHashMap::default();
        for corners in &self.triangles {
            let face = face_normal(&corners.map(|c| vec3(c.position))).normalize_or(DVec3::Y);
            let triangle = corners.map(|corner| {
                let smooth: DVec3 = around[&corner.position.map(f32::to_bits)]
                    .iter()
                    .map(|&(t, k)| weights[t][k])
                    .filter(|w| w.normalize_or_zero().dot(face) > crease.cos())
                    .sum();
                let normal = (smooth.normalize_or(face).as_vec3() + glam::Vec3::ZERO).to_array();
                let uv = corner.uv.unwrap_or_else(|| projected_uv(corner.position, face));
                let [x, y, z] = corner.position.map(f32::to_bits);
                let [i, j, k] = normal.map(f32::to_bits);
                let [u, v] = uv.map(f32::to_bits);
                *vertices.entry([x, y, z, i, j, k, u, v]).or_insert_with(|| {
                    mesh.positions.push(corner.position);
                    mesh.normals.push(normal);
                    mesh.uv0.push(uv);
                    (mesh.positions.len() - 1) as u32
                })
            });
            mesh.triangles.push(triangle);
        }

        let count = mesh.positions.len();
        mesh.tangents = vec![[0.0; 4]; count];
        mesh.uv1 = vec![[0.0; 2]; count];
        mesh.colors = vec![[1.0; 4]; count];
        mesh.primitives = vec![Primitive { triangles: 0..mesh.triangles.len() as u32, material: None }];
        mesh
    }
}

fn vec3(p: [f32; 3]) -> DVec3 {
    glam::Vec3::from_array(p).as_dvec3()
}

fn face_normal([a, b, c]: &[DVec3; 3]) -> DVec3 {
    (b - a).cross(c - a)
}

/// The face normal at each corner, weighted by the angle there: independent of how a polygon was cut into triangles.
fn weighted_normals(corners: &[Corner; 3]) -> [DVec3; 3] {
    let p = corners.map(|c| vec3(c.position));
    let normal = face_normal(&p).normalize_or_zero();
    std::array::from_fn(|k| {
        let to = |i: usize| (p[(k + i) % 3] - p[k]).normalize_or_zero();
        normal * to(1).dot(to(2)).clamp(-1.0, 1.0).acos()
    })
}

/// Metres along the two axes across the one nearest to `normal`; v grows downwards, as image rows do.
fn projected_uv([x, y, z]: [f32; 3], normal: DVec3) -> [f32; 2] {
    let size = normal.abs();
    if size.y >= size.x && size.y >= size.z {
        [x, z]
    } else if size.x >= size.z {
        [if normal.x > 0.0 { -z } else { z }, -y]
    } else {
        [if normal.z > 0.0 { x } else { -x }, -y]
    }
}
