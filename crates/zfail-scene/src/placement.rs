//! Moving geometry between spaces without losing what single precision can hold.
//!
//! In: meshes and f64 transforms. Out: meshes whose coordinates lie near their own origin, and the f64 translation
//! that puts them back, so that a light brought into object space keeps all its digits wherever the mesh stands.

use glam::{DAffine3, DMat3, DVec3};
use zfail_plan::scene::{Bounds, Mesh};

/// What a linear map does to volumes, judged relative to its own scale.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Rank {
    /// Invertible with room to spare.
    Full,
    /// Flattens everything into a plane, or so nearly that its inverse means nothing.
    Plane,
    /// Leaves a line or a point, which no triangle survives.
    Line,
}

/// Smallest ratio of singular values that counts as invertible.
const LEAST_RATIO: f64 = 1e-7;

/// Smaller maps leave nothing to see, and their determinants underflow.
const LEAST_SCALE: f64 = 1e-60;

/// The rank of `m`.
///
/// With singular values a >= b >= c, the norms of `m`, its cofactors and its determinant are a, ab and abc within
/// a factor of two, so their quotients tell the ratios without a decomposition.
pub(crate) fn rank(m: &DMat3) -> Rank {
    let scale = m.to_cols_array().iter().fold(0.0_f64, |s, x| s.max(x.abs()));
    if scale < LEAST_SCALE {
        return Rank::Line;
    }
    let m = *m * (1.0 / scale);
    let norm = frobenius(&m);
    let cofactors = frobenius(&cofactor(&m));
    if cofactors < LEAST_RATIO * norm * norm {
        Rank::Line
    } else if m.determinant().abs() < LEAST_RATIO * norm * cofactors {
        Rank::Plane
    } else {
        Rank::Full
    }
}

fn frobenius(m: &DMat3) -> f64 {
    m.to_cols_array().iter().map(|x| x * x).sum::<f64>().sqrt()
}

/// The matrix that takes area vectors where `m` takes points: the inverse transpose times the determinant, which
/// exists for singular matrices too.
pub(crate) fn cofactor(m: &DMat3) -> DMat3 {
    DMat3::from_cols(m.y_axis.cross(m.z_axis), m.z_axis.cross(m.x_axis), m.x_axis.cross(m.y_axis))
}

/// A mesh is far from its origin on an axis if its centre is more than this many of its greatest half extents away.
/// With 3 or more, every coordinate is within a factor of two of the centre, where subtraction is exact (Sterbenz).
const FAR: f64 = 4.0;

/// Moves a far-off mesh to its own origin without changing any difference between coordinates, and returns what was
/// subtracted. Axes on which that would round any vertex stay as they are.
pub(crate) fn recenter(mesh: &mut Mesh) -> DVec3 {
    let bounds = mesh.bounds();
    let mut origin = DVec3::ZERO;
    if bounds.is_empty() {
        return origin;
    }
    let (center, size) = (bounds.center(), bounds.half().max_element());
    for axis in 0..3 {
        let c = center[axis] as f32;
        let far = center[axis].abs() > FAR * size;
        if far && mesh.positions.iter().all(|p| is_exact_difference(p[axis], c)) {
            mesh.positions.iter_mut().for_each(|p| p[axis] -= c);
            origin[axis] = c.into();
        }
    }
    origin
}

/// Whether `a - b` needs no rounding: the error term of the error-free transformation of a difference is zero.
fn is_exact_difference(a: f32, b: f32) -> bool {
    let d = a - b;
    let b_virtual = a - d;
    let a_virtual = d + b_virtual;
    d.is_finite() && (a - a_virtual) + (b_virtual - b) == 0.0
}

/// Rounds world-space `points` to single precision about an origin near them; returns the origin and the points.
pub(crate) fn localize(points: &[DVec3]) -> (DVec3, Vec<[f32; 3]>) {
    let bounds = Bounds::of(points.iter().copied());
    let origin = if bounds.is_empty() { DVec3::ZERO } else { bounds.center() };
    (origin, points.iter().map(|&p| (p - origin).as_vec3().to_array()).collect())
}

/// `mesh` as a singular `world_from_object` leaves it: in world space, relative to the returned origin.
///
/// All its triangles lie in one plane, so their normals are the plane's, on the side that each vertex normal had.
pub(crate) fn flatten(mesh: &Mesh, world_from_object: &DAffine3) -> (Mesh, DVec3) {
    let points: Vec<DVec3> =
        mesh.positions.iter().map(|p| world_from_object.transform_point3(DVec3::from(p.map(f64::from)))).collect();
    let (origin, positions) = localize(&points);
    let area_map = cofactor(&world_from_object.matrix3);
    // Of a rank-one matrix every non-zero column has the same direction; the longest one is the most precise.
    let columns = [area_map.x_axis, area_map.y_axis, area_map.z_axis];
    let plane_normal =
        columns.into_iter().max_by(|a, b| a.length_squared().total_cmp(&b.length_squared())).unwrap_or(DVec3::Y);
    let plane_normal = plane_normal.try_normalize().unwrap_or(DVec3::Y);
    let normals = mesh.normals.iter().map(|n| {
        let side = plane_normal.dot(area_map * DVec3::from(n.map(f64::from)));
        (if side < 0.0 { -plane_normal } else { plane_normal }).as_vec3().to_array()
    });
    let tangents = mesh.tangents.iter().map(|&[x, y, z, w]| {
        let t = world_from_object.transform_vector3(DVec3::new(x.into(), y.into(), z.into()));
        t.try_normalize().map_or([0.0; 4], |t| t.as_vec3().extend(w).to_array())
    });
    let flat = Mesh { normals: normals.collect(), tangents: tangents.collect(), positions, ..mesh.clone() };
    (flat, origin)
}

#[cfg(test)]
mod tests {
    use super::*;
    use zfail_plan::scene::Primitive;

    fn mesh_at(offset: [f32; 3]) -> Mesh {
        let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.1], [0.0, 1.0, 0.3]];
        Mesh {
            positions: corners.map(|c: [f32; 3]| std::array::from_fn(|i| c[i] + offset[i])).to_vec(),
            normals: vec![[0.0, 0.0, 1.0]; 3],
            tangents: vec![[1.0, 0.0, 0.0, 1.0]; 3],
            triangles: vec![[0, 1, 2]],
            primitives: vec![Primitive { triangles: 0..1, material: None }],
            ..Mesh::default()
        }
    }

    fn world(mesh: &Mesh, origin: DVec3) -> Vec<DVec3> {
        (0..mesh.positions.len()).map(|v| mesh.position(v as u32) + origin).collect()
    }

    #[test]
    fn recentering_changes_no_position_by_a_single_bit() {
        for offset in [[1e6, -1e6, 3e5], [1e6, 0.0, 0.0], [1e-3; 3], [4.0, 5.0, 6.0]] {
            let mut mesh = mesh_at(offset);
            let before = world(&mesh, DVec3::ZERO);
            let origin = recenter(&mut mesh);
            assert_eq!(world(&mesh, origin), before, "{offset:?}");
            for axis in 0..3 {
                let far = offset[axis].abs() > 3.0;
                assert_eq!(origin[axis] != 0.0, far, "{offset:?} axis {axis}");
            }
        }
    }

    #[test]
    fn an_unused_outlier_keeps_its_axis() {
        let mut mesh = mesh_at([1e6, 1e6, 1e6]);
        mesh.positions.push([0.1, 1e6, 1e6]);
        let before = world(&mesh, DVec3::ZERO);
        let origin = recenter(&mut mesh);
        assert_eq!(origin.x, 0.0, "0.1 - 1e6 rounds");
        assert_ne!(origin.y, 0.0);
        assert_eq!(world(&mesh, origin), before);
    }

    #[test]
    fn inexact_differences_are_recognised() {
        assert!(is_exact_difference(1.0e6, 1.0e6 + 0.0625));
        assert!(!is_exact_difference(0.1, 1.0e6));
        assert!(!is_exact_difference(f32::MAX, -f32::MAX));
    }

    #[test]
    fn ranks() {
        let turn = DMat3::from_euler(glam::EulerRot::XYZ, 0.3, 1.0, -2.0);
        let scaled = |x, y, z| turn * DMat3::from_diagonal(DVec3::new(x, y, z)) * turn.transpose();
        for scale in [1e-30, 1e-4, 1.0, 1e30] {
            assert_eq!(rank(&(scaled(1.0, 2.0, 3.0) * scale)), Rank::Full);
            assert_eq!(rank(&(scaled(1.0, -1.0, 1e-5) * scale)), Rank::Full);
            assert_eq!(rank(&(scaled(1.0, 1.0, 0.0) * scale)), Rank::Plane);
            assert_eq!(rank(&(scaled(1.0, 1.0, 1e-9) * scale)), Rank::Plane);
            assert_eq!(rank(&(scaled(0.0, 1.0, 1e-9) * scale)), Rank::Line);
        }
        assert_eq!(rank(&DMat3::ZERO), Rank::Line);
        assert_eq!(rank(&(DMat3::IDENTITY * 1e-100)), Rank::Line);
    }

    #[test]
    fn a_flattened_mesh_lies_in_its_plane() {
        let squash = DAffine3::from_scale(DVec3::new(2.0, 0.0, 1.0));
        let place = DAffine3::from_translation(DVec3::new(1e6, 5.0, 0.0)) * squash;
        let mut mesh = mesh_at([0.0; 3]);
        mesh.normals = vec![[0.0, -1.0, 0.0], [0.0, 1.0, 0.0], [1.0, 0.0, 0.0]];
        let (flat, origin) = flatten(&mesh, &place);
        for (p, q) in world(&flat, origin).iter().zip(world(&mesh, DVec3::ZERO)) {
            assert!(p.distance(place.transform_point3(q)) < 1e-6);
            assert_eq!(p.y, 5.0);
        }
        assert_eq!(flat.normals[..2], [[0.0, -1.0, 0.0], [0.0, 1.0, 0.0]]);
        assert!(flat.normals[2][1].abs() == 1.0, "a normal in the plane becomes the plane's");
    }
}
