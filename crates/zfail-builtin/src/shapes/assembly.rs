//! Putting meshes together: move, paint, merge.

use super::Mesh;
use glam::{DAffine3, DVec3, Vec3};
use zfail_scene::Primitive;

/// `mesh` after `transform`, which must be invertible; a mirroring one turns the winding so that outside stays outside.
#[must_use]
pub fn moved(mut mesh: Mesh, transform: &DAffine3) -> Mesh {
    let vector = |v: [f32; 3]| Vec3::from_array(v).as_dvec3();
    let array = |v: DVec3| (v.as_vec3() + Vec3::ZERO).to_array();
    let normal_matrix = transform.matrix3.inverse().transpose();
    for p in &mut mesh.positions {
        *p = array(transform.transform_point3(vector(*p)));
    }
    for n in &mut mesh.normals {
        *n = array((normal_matrix * vector(*n)).normalize());
    }
    if transform.matrix3.determinant() < 0.0 {
        for [_, b, c] in &mut mesh.triangles {
            std::mem::swap(b, c);
        }
    }
    mesh
}

/// `mesh` with `material` everywhere.
#[must_use]
pub fn painted(mut mesh: Mesh, material: usize) -> Mesh {
    for primitive in &mut mesh.primitives {
        primitive.material = Some(material);
    }
    mesh
}

/// `mesh` with the linear colour `rgb` in every vertex.
#[must_use]
pub fn tinted(mut mesh: Mesh, [r, g, b]: [f32; 3]) -> Mesh {
    mesh.colors.fill([r, g, b, 1.0]);
    mesh
}

/// One mesh from many; parts that follow each other with the same material become one primitive.
#[must_use]
pub fn merged(name: &str, parts: impl IntoIterator<Item = Mesh>) -> Mesh {
    let mut whole = Mesh { name: name.to_owned(), ..Mesh::default() };
    for part in parts {
        let first_vertex = whole.positions.len() as u32;
        let first_triangle = whole.triangles.len() as u32;
        whole.positions.extend(part.positions);
        whole.normals.extend(part.normals);
        whole.tangents.extend(part.tangents);
        whole.uv0.extend(part.uv0);
        whole.uv1.extend(part.uv1);
        whole.colors.extend(part.colors);
        whole.triangles.extend(part.triangles.iter().map(|t| t.map(|v| v + first_vertex)));
        for Primitive { triangles, material } in part.primitives {
            let triangles = triangles.start + first_triangle..triangles.end + first_triangle;
            match whole.primitives.last_mut() {
                Some(last) if last.material == material => last.triangles.end = triangles.end,
                _ => whole.primitives.push(Primitive { triangles, material }),
            }
        }
    }
    whole
}
