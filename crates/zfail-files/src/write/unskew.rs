//! Splits a skewing transform into two that do not skew, by a singular value decomposition.

use glam::{DAffine3, DMat3};

/// Cosine of the angle between two axes below which they count as perpendicular.
const PERPENDICULAR: f64 = 1e-9;

/// `None` if the axes of `transform` are perpendicular; otherwise two transforms of which each has perpendicular axes
/// and whose product is `transform`.
pub(super) fn split(transform: &DAffine3) -> Option<[DAffine3; 2]> {
    if !is_skewed(&transform.matrix3) {
        return None;
    }
    // One-sided Jacobi: turning pairs of columns until all are perpendicular leaves (turned columns) * (turns)^T.
    let mut turned = transform.matrix3.to_cols_array_2d().map(glam::DVec3::from);
    let mut turns = DMat3::IDENTITY.to_cols_array_2d().map(glam::DVec3::from);
    for _ in 0..16 {
        for (i, j) in [(0, 1), (0, 2), (1, 2)] {
            let angle =
                0.5 * (2.0 * turned[i].dot(turned[j])).atan2(turned[i].length_squared() - turned[j].length_squared());
            let (sin, cos) = angle.sin_cos();
            for columns in [&mut turned, &mut turns] {
                let (p, q) = (columns[i], columns[j]);
                columns[i] = p * cos + q * sin;
                columns[j] = q * cos - p * sin;
            }
        }
    }
    let matrix = |[x, y, z]: [glam::DVec3; 3]| DMat3::from_cols(x, y, z);
    let outer = DAffine3 { matrix3: matrix(turned), translation: transform.translation };
    Some([outer, DAffine3::from_mat3(matrix(turns).transpose())])
}

fn is_skewed(m: &DMat3) -> bool {
    [(m.x_axis, m.y_axis), (m.y_axis, m.z_axis), (m.z_axis, m.x_axis)]
        .iter()
        .any(|(a, b)| a.dot(*b).abs() > PERPENDICULAR * a.length() * b.length())
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    #[test]
    fn skewing_transforms_split_into_perpendicular_ones() {
        let shear = DMat3::from_cols(DVec3::X, DVec3::new(0.8, 1.0, -0.2), DVec3::new(0.1, -3.0, 0.5));
        let mirror = DMat3::from_diagonal(DVec3::new(-1.0, 2.0, 1e-3));
        for matrix3 in [shear, shear * mirror, mirror * shear, DMat3::from_rotation_x(0.3) * mirror * shear] {
            let whole = DAffine3 { matrix3, translation: DVec3::new(1e6, 2.0, 3.0) };
            let [outer, inner] = split(&whole).expect("skewed");
            assert!(!is_skewed(&outer.matrix3) && !is_skewed(&inner.matrix3), "{whole}");
            assert!((outer * inner).abs_diff_eq(whole, 1e-12), "{whole}");
        }
    }

    #[test]
    fn rotated_scaled_and_mirrored_transforms_stay_whole() {
        let turn = DMat3::from_rotation_y(0.7) * DMat3::from_rotation_z(2.1);
        assert!(split(&DAffine3::from_mat3(turn * DMat3::from_diagonal(DVec3::new(-1e-4, 7.0, 1e5)))).is_none());
        assert!(split(&DAffine3::from_mat3(DMat3::from_diagonal(DVec3::new(1.0, 7.0, 1.0)) * turn)).is_some());
    }
}
