//! Where vertices are: which can be drawn, and the origin about which single precision holds them.

use zfail_scene::animate::MAX_COORDINATE;

/// Whether a vertex can be drawn: it is finite, and a scene can hold it wherever the others are.
pub(crate) fn is_usable(point: &[f64; 3]) -> bool {
    point.iter().all(|x| x.abs() <= 0.5 * MAX_COORDINATE)
}

/// The origin of `points`, all usable. Surveyed models lie 10^6 m from where they are measured from, in decimals that single
/// precision would round to half a metre: on the axes on which they are further away than they are large, it is the middle.
/// Where single precision holds them anyway it is zero, and whoever places the mesh may move it without rounding.
pub(crate) fn origin(points: impl Iterator<Item = [f64; 3]> + Clone) -> [f64; 3] {
    let ([mut least, mut most], mut exact) = ([[f64::MAX; 3], [f64::MIN; 3]], [true; 3]);
    for point in points {
        for axis in 0..3 {
            let x = point[axis];
            least[axis] = least[axis].min(x);
            most[axis] = most[axis].max(x);
            exact[axis] &= f64::from(x as f32) == x;
        }
    }
    let size = (0..3).map(|axis| most[axis] - least[axis]).fold(0.0, f64::max);
    [0, 1, 2].map(|axis| {
        let middle = least[axis].midpoint(most[axis]);
        if exact[axis] || middle.abs() <= size { 0.0 } else { middle }
    })
}

/// `point` from `origin`, in single precision.
pub(crate) fn relative(point: &[f64; 3], origin: &[f64; 3]) -> [f32; 3] {
    [0, 1, 2].map(|axis| (point[axis] - origin[axis]) as f32)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_is_far_and_would_be_rounded_moves() {
        let origin = |points: &[[f64; 3]]| origin(points.iter().copied());
        assert_eq!(origin(&[[0.1, 100.1, 5e6], [1.1, 100.3, 5e6]]), [0.0, f64::midpoint(100.1, 100.3), 0.0]);
        assert_eq!(origin(&[[442_307.37, 0.0, -0.1], [442_315.37, 1.0, 0.1]]), [442_311.37, 0.0, 0.0]);
        assert_eq!(origin(&[]), [0.0; 3]);
        assert_eq!(relative(&[442_307.37, 0.5, 0.0], &[442_311.37, 0.0, 0.0]), [-4.0, 0.5, 0.0]);
    }

    #[test]
    fn beyond_all_measure() {
        assert!(is_usable(&[1e14, 0.0, -1e14]));
        for bad in [f64::NAN, f64::INFINITY, -1e15] {
            assert!(!is_usable(&[0.0, bad, 0.0]));
        }
    }
}
