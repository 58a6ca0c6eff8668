//! Where a point lies relative to the cone (or prism) that a triangle spans with an apex.
//!
//! One function serves the eye and the light, points and directions. In: apex, triangle, point, and how far the point
//! may stray. Out: inside, outside, or too close to tell; margins are far wider than the rounding of f64.

use glam::DVec3;

/// Tip of the cones: a position, or infinitely far against a direction.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Apex {
    Point(DVec3),
    /// The way the rays travel.
    Direction(DVec3),
}

impl Apex {
    /// Normals of the planes through the apex and each edge `v[i] -> v[i + 1]`.
    pub fn edge_normals(&self, v: &[DVec3; 3]) -> [DVec3; 3] {
        std::array::from_fn(|i| {
            let (a, b) = (v[i], v[(i + 1) % 3]);
            match *self {
                Self::Point(apex) => (a - apex).cross(b - apex),
                Self::Direction(d) => d.cross(b - a),
            }
        })
    }

    /// Positive if the apex is in front of the plane through `a` with `normal`: the determinant that decides facing.
    pub fn height(&self, a: DVec3, normal: DVec3) -> f64 {
        match *self {
            Self::Point(apex) => normal.dot(apex - a),
            Self::Direction(d) => -normal.dot(d),
        }
    }

    /// Whether the apex lies exactly in the triangle's plane.
    pub fn is_coplanar(&self, v: &[DVec3; 3]) -> bool {
        let coord = |p: DVec3| robust::Coord3D { x: p.x, y: p.y, z: p.z };
        match *self {
            Self::Point(apex) => robust::orient3d(coord(v[0]), coord(v[1]), coord(v[2]), coord(apex)) == 0.0,
            // A direction has no exact position: the planes of axis-aligned faces are the ones that come out as zero.
            Self::Direction(d) => (v[1] - v[0]).cross(v[2] - v[0]).dot(d) == 0.0,
        }
    }
}

/// How far a point may stray: within an ellipse, along a line, and a radius.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Slack {
    /// Half axes (conjugate radii) of the ellipse.
    pub ellipse: [DVec3; 2],
    /// Half of the line.
    pub line: DVec3,
    /// In every direction.
    pub radius: f64,
}

impl Slack {
    pub const NONE: Self = Self { ellipse: [DVec3::ZERO; 2], line: DVec3::ZERO, radius: 0.0 };

    /// Largest change of `normal . point`.
    pub fn along(&self, normal: DVec3) -> f64 {
        let [u, w] = self.ellipse.map(|axis| normal.dot(axis));
        (u * u + w * w).sqrt() + normal.dot(self.line).abs() + normal.length() * self.radius
    }
}

/// Relation of a point to a double cone.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Place {
    Inside,
    Outside,
    /// Inside for some positions within the slack, or too close to tell.
    Near,
}

/// Signed distances, scaled by the normals' lengths, of `point` from the planes of `edge_normals`.
pub(crate) fn sides(v: &[DVec3; 3], normals: &[DVec3; 3], point: DVec3) -> [f64; 3] {
    std::array::from_fn(|i| normals[i].dot(point - v[i]))
}

/// Where `point` and all positions within `slack` lie relative to the double cone with the given `normals`.
pub(crate) fn place(v: &[DVec3; 3], normals: &[DVec3; 3], point: DVec3, slack: &Slack) -> Place {
    let (mut plus, mut minus) = (0, 0);
    for i in 0..3 {
        let to = point - v[i];
        let side = normals[i].dot(to);
        let margin = slack.along(normals[i]) + 1e-13 * normals[i].length() * to.length();
        plus += i32::from(side > margin);
        minus += i32::from(side < -margin);
    }
    match (plus, minus) {
        (3, 0) | (0, 3) => Place::Inside,
        (0, _) | (_, 0) => Place::Near,
        _ => Place::Outside,
    }
}

/// Whether `point` is in the double cone, borders included.
pub(crate) fn contains(v: &[DVec3; 3], normals: &[DVec3; 3], point: DVec3) -> bool {
    let s = sides(v, normals, point);
    s.iter().all(|&s| s >= 0.0) || s.iter().all(|&s| s <= 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    const V: [DVec3; 3] = [DVec3::ZERO, DVec3::X, DVec3::Y];

    #[test]
    fn places_below_a_point_light() {
        let apex = Apex::Point(DVec3::new(0.25, 0.25, 1.0));
        let normals = apex.edge_normals(&V);
        let at = |x, y, radius| place(&V, &normals, DVec3::new(x, y, -1.0), &Slack { radius, ..Slack::NONE });
        assert_eq!(at(0.25, 0.25, 0.1), Place::Inside);
        assert_eq!(at(3.0, 0.25, 0.1), Place::Outside);
        // The shadow at z = -1 is twice as large, its lower border at y = 0.25 - 0.5.
        assert_eq!(at(0.25, -0.24, 0.02), Place::Near);
        assert_eq!(at(0.25, -0.24, 0.005), Place::Inside);
        assert_eq!(at(0.25, -0.26, 0.005), Place::Outside);
        assert!(contains(&V, &normals, DVec3::new(0.25, -0.25, -1.0)));
    }

    #[test]
    fn the_limit_of_a_far_point_is_the_direction() {
        let d = DVec3::new(0.3, -0.2, -1.0).normalize();
        let point = DVec3::new(0.7, 0.1, -2.0);
        let far = Apex::Point(point - d * 1e7);
        let (a, b) = (Apex::Direction(d).edge_normals(&V), far.edge_normals(&V));
        let (a, b) = (sides(&V, &a, point), sides(&V, &b, point).map(|s| s / 1e7));
        assert!(a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-5), "{a:?} {b:?}");
        assert!(Apex::Direction(d).height(V[0], DVec3::Z) > 0.0);
        assert!(far.height(V[0], DVec3::Z) > 0.0);
    }

    #[test]
    fn exact_coplanarity() {
        assert!(Apex::Point(DVec3::new(7.0, 0.1, 0.0)).is_coplanar(&V));
        assert!(!Apex::Point(DVec3::new(7.0, 0.1, 1e-300)).is_coplanar(&V));
        assert!(Apex::Direction(DVec3::X).is_coplanar(&V));
        assert!(!Apex::Direction(DVec3::new(1.0, 0.0, 1e-9)).is_coplanar(&V));
    }

    #[test]
    fn an_ellipse_is_tighter_than_its_circle() {
        let slack = Slack { ellipse: [DVec3::X, DVec3::Y * 0.1], ..Slack::NONE };
        assert!((slack.along(DVec3::Y) - 0.1).abs() < 1e-15);
        assert!((slack.along(DVec3::X) - 1.0).abs() < 1e-15);
    }
}
