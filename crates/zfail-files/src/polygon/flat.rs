//! A polygon on a plane.

use glam::{DVec2, DVec3};
use robust::{Coord, orient2d};

/// The corners as seen along the polygon's vector area (Newell's normal), which points to the eye: moved, sheared and
/// scaled, but never stretched out of shape, so that what lies on a line or turns left does so here. Corners of a polygon
/// that is parallel to two axes are exact.
///
/// `None` if there is nothing to be seen from anywhere, or a corner is not finite.
pub(super) fn project(corners: &[DVec3]) -> Option<Vec<DVec2>> {
    let origin = *corners.first()?;
    let normal = normal(corners, origin)?;
    let away = normal.abs().max_position();
    let (mut right, mut up) = ((away + 1) % 3, (away + 2) % 3);
    if normal[away] < 0.0 {
        (right, up) = (up, right);
    }
    let along = normal / normal[away];
    let seen = |&corner: &DVec3| {
        let p = corner - origin;
        DVec2::new(p[right] - p[away] * along[right], p[up] - p[away] * along[up])
    };
    let mut flat: Vec<DVec2> = corners.iter().map(seen).collect();
    let size = flat.iter().map(|p| p.abs().max_element()).fold(0.0, f64::max);
    // A power of two moves no point against another. What is 2^-100 of the whole is rounded away with the signs of zeros.
    let scale = (-size.log2().floor()).exp2();
    let scaled = |x: f64| if x.abs() * scale < 1e-30 { 0.0 } else { x * scale };
    flat.iter_mut().for_each(|p| *p = DVec2::new(scaled(p.x), scaled(p.y)));
    flat.iter().all(|p| p.is_finite()).then_some(flat)
}

/// Twice the vector area, or that of the largest triangle at `origin` where the areas of all cancel each other out.
fn normal(corners: &[DVec3], origin: DVec3) -> Option<DVec3> {
    /// Of the sum of all areas: a polygon with less is wound one way about as much as the other.
    const CANCELLED: f64 = 1e-9;
    let parts = || corners.windows(2).map(|edge| (edge[0] - origin).cross(edge[1] - origin));
    let (sum, sizes) = parts().fold((DVec3::ZERO, 0.0), |(sum, sizes), part| (sum + part, sizes + part.length()));
    let normal = if sum.length() > CANCELLED * sizes {
        sum
    } else {
        parts().max_by(|a, b| a.length().total_cmp(&b.length()))?
    };
    (normal.is_finite() && normal != DVec3::ZERO).then_some(normal)
}

/// Whether a polygon turns left or not at all at every corner, and goes around once.
pub(super) fn is_convex(flat: &[DVec2]) -> bool {
    let coord = |p: DVec2| Coord { x: p.x, y: p.y };
    let turns_left = |[a, b, c]: [DVec2; 3]| orient2d(coord(a), coord(b), coord(c)) >= 0.0;
    let n = flat.len();
    let corner = |i: usize| [flat[i], flat[(i + 1) % n], flat[(i + 2) % n]];
    if !(0..n).all(|i| turns_left(corner(i))) {
        return false;
    }
    let forwards = |i: usize| {
        let step = flat[(i + 1) % n] - flat[i];
        (step != DVec2::ZERO).then_some(step.x > 0.0 || step.x == 0.0 && step.y > 0.0)
    };
    let directions: Vec<bool> = (0..n).filter_map(forwards).collect();
    let reversals = directions.iter().zip(directions.iter().cycle().skip(1)).filter(|(a, b)| a != b).count();
    reversals <= 2
}
