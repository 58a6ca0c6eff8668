//! Moving geometry between spaces without losing what single precision can hold.
//!
//! In: meshes and f64 transforms. Out: meshes whose coordinates lie near their own origin, and the f64 translation
//! that puts them back, so that a light brought into object space keeps all its digits wherever the mesh stands.

use crate::{Light, Mesh};
use glam::{DAffine3, DMat3, DQuat, DVec3};
use zfail_plan::bounds::Bounds;
use zfail_plan::light::LightKind;

/// What a linear map does to volumes, judged relative to its own scale.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rank {
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
pub fn rank(m: &DMat3) -> Rank {
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

/// `m` itself if it is invertible with room to spare, otherwise a matrix near it that is: a flattened direction gets
/// a millionth of the greatest extent, and what would be a line or a point is so small that nothing can be seen of it.
pub fn invertible(m: &DMat3) -> DMat3 {
    /// Of a mesh that vanishes; and the greatest matrix that counts as nothing.
    const NOTHING: f64 = 1e-9;
    /// Thickness over extent; enough for [`Rank::Full`].
    const THIN: f64 = 1e-6;
    if rank(m) == Rank::Full {
        return *m;
    }
    let mut columns = [m.x_axis, m.y_axis, m.z_axis];
    let extent = columns.iter().map(|c| c.length()).fold(0.0, f64::max);
    if extent < NOTHING {
        return DMat3::IDENTITY * NOTHING;
    }
    // Gram-Schmidt, the longest remainder first; a column that brings nothing new gets the thickness.
    let mut rest = columns;
    let mut axes: Vec<DVec3> = Vec::with_capacity(3);
    let mut left = vec![0, 1, 2];
    while let Some(at) = (0..left.len()).max_by(|&a, &b| rest[left[a]].length().total_cmp(&rest[left[b]].length())) {
        let column = left.swap_remove(at);
        let axis = if rest[column].length() >= THIN * extent {
            rest[column].normalize()
        } else {
            let fresh = match axes[..] {
                [a, b, ..] => a.cross(b),
                [a] => a.any_orthonormal_vector(),
                [] => DVec3::X,
            };
            columns[column] += fresh * (THIN * extent);
            fresh
        };
        rest.iter_mut().for_each(|r| *r -= axis * axis.dot(*r));
        axes.push(axis);
    }
    DMat3::from_cols(columns[0], columns[1], columns[2])
}

fn frobenius(m: &DMat3) -> f64 {
    m.to_cols_array().iter().map(|x| x * x).sum::<f64>().sqrt()
}

/// The matrix that takes area vectors where `m` takes points: the inverse transpose times the determinant, which
/// exists for singular matrices too.
pub fn cofactor(m: &DMat3) -> DMat3 {
    DMat3::from_cols(m.y_axis.cross(m.z_axis), m.z_axis.cross(m.x_axis), m.x_axis.cross(m.y_axis))
}

/// A mesh is far from its origin on an axis if its centre is more than this many of its greatest half extents away.
/// With 3 or more, every coordinate is within a factor of two of the centre, where subtraction is exact (Sterbenz).
const FAR: f64 = 4.0;

/// Moves a far-off mesh to its own origin without changing any difference between coordinates, and returns what was
/// subtracted. Axes on which that would round any vertex stay as they are.
pub fn recenter(mesh: &mut Mesh) -> DVec3 {
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
pub fn localize(points: &[DVec3]) -> (DVec3, Vec<[f32; 3]>) {
    let bounds = Bounds::of(points.iter().copied());
    let origin = if bounds.is_empty() { DVec3::ZERO } else { bounds.center() };
    (origin, points.iter().map(|&p| (p - origin).as_vec3().to_array()).collect())
}

/// `mesh` as a singular `world_from_object` leaves it: in world space, relative to the returned origin.
///
/// All its triangles lie in one plane, so their normals are the plane's, on the side that each vertex normal had.
pub fn flatten(mesh: &Mesh, world_from_object: &DAffine3) -> (Mesh, DVec3) {
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

/// Whether all entries are finite and so small that their products and squares are finite too.
pub fn is_moderate(m: &DAffine3) -> bool {
    m.to_cols_array().iter().all(|x| x.abs() <= 1e30)
}

/// `v` at unit length; `None` if it has no direction. One that is a unit vector but for single precision stays bit for bit.
pub fn unit_vector(v: DVec3) -> Option<DVec3> {
    const ROUNDING: f64 = 1e-6;
    if (v.length_squared() - 1.0).abs() < ROUNDING { Some(v) } else { v.try_normalize() }
}

/// `q` at unit length. One that is a unit quaternion but for rounding stays bit for bit.
pub fn unit_quaternion(q: DQuat) -> Option<DQuat> {
    let length = q.length();
    if (length - 1.0).abs() <= 4.0 * f64::EPSILON {
        return Some(q);
    }
    (length.is_finite() && length > 1e-12).then(|| q / length)
}

/// Rotation and translation of `m`, without scale and shear. It keeps the way the camera looks and, as near as can be,
/// its up; a mirrored camera has left and right exchanged, since a view space is right-handed.
pub fn rigid(m: &DAffine3) -> DAffine3 {
    let back = m.matrix3.z_axis.try_normalize().unwrap_or(DVec3::Z);
    let up = m.matrix3.y_axis.reject_from_normalized(back);
    let up = up.try_normalize().unwrap_or_else(|| back.any_orthonormal_vector());
    DAffine3 { matrix3: DMat3::from_cols(up.cross(back), up, back), translation: m.translation }
}

/// Where a light's node stands; it shines along its -z axis, and +y is up where that matters.
pub fn light_placement(light: &Light) -> DAffine3 {
    let (translation, direction) = match light.kind {
        LightKind::Point { position, .. } => (position, DVec3::NEG_Z),
        LightKind::Spot { position, direction, .. } => (position, direction),
        LightKind::Directional { direction } => (DVec3::ZERO, direction),
    };
    let matrix3 = if !light.shape.is_plain() {
        light.axes()
    } else if direction == DVec3::NEG_Z {
        DMat3::IDENTITY
    } else {
        let (x, y) = direction.any_orthonormal_pair();
        // The pair is right-handed with the direction, the axes must be with its opposite.
        DMat3::from_cols(y, x, -direction)
    };
    DAffine3 { matrix3, translation }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Primitive;

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
    fn singular_matrices_become_invertible_and_others_stay() {
        let turn = DMat3::from_euler(glam::EulerRot::XYZ, 0.3, 1.0, -2.0);
        for scale in [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 3.0, 1.0], [1e-12, 1.0, 1.0], [1e-200; 3], [1e9, 1e9, 0.0]] {
            for m in [turn * DMat3::from_diagonal(scale.into()), DMat3::from_diagonal(scale.into()) * turn] {
                let near = invertible(&m);
                assert_eq!(rank(&near), Rank::Full, "{scale:?}");
                let extent = scale[0].max(scale[1]).max(scale[2]);
                assert!(near.abs_diff_eq(m, 2e-6 * extent + 1e-9), "{scale:?}: {near} is far from {m}");
                assert!(near.inverse().is_finite());
            }
        }
        for m in [turn, DMat3::from_diagonal(DVec3::new(1.0, -1.0, 1e-5)), DMat3::IDENTITY * 1e-30] {
            assert_eq!(invertible(&m), m);
        }
    }

    #[test]
    fn cameras_become_rigid() {
        let turn = DMat3::from_euler(glam::EulerRot::YXZ, 0.7, -0.3, 0.1);
        for scale in [DVec3::ONE, DVec3::new(-1.0, 1.0, 1.0), DVec3::new(2.0, 1e-4, 3.0), DVec3::new(0.0, 1.0, 1.0)] {
            let m = DAffine3 { matrix3: turn * DMat3::from_diagonal(scale), translation: DVec3::ONE };
            let r = rigid(&m);
            assert!((r.matrix3 * r.matrix3.transpose()).abs_diff_eq(DMat3::IDENTITY, 1e-12), "{scale}");
            assert!((r.matrix3.determinant() - 1.0).abs() < 1e-12, "{scale}: right-handed");
            assert!(r.matrix3.z_axis.distance(turn.z_axis) < 1e-12 && r.matrix3.y_axis.distance(turn.y_axis) < 1e-12);
        }
        assert!(rigid(&DAffine3::from_scale(DVec3::ZERO)).is_finite());
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
