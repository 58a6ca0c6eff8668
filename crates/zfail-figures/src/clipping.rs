//! Polygons and segments against planes, in homogeneous coordinates: points at infinity (w = 0) are like all others.

use zfail_plan::glam::{DMat4, DVec4};

/// The points p with `dot(plane, p) >= 0` for all planes.
#[derive(Clone, Debug)]
pub struct Region {
    planes: [DVec4; 5],
}

impl Region {
    /// What lies in the infinite view frustum: beyond the near plane and between the sides. Depth is reversed.
    pub fn frustum(clip_from_origin: &DMat4) -> Self {
        let rows = clip_from_origin.transpose();
        let [x, y, z, w] = [rows.x_axis, rows.y_axis, rows.z_axis, rows.w_axis];
        Self { planes: [w - z, w + x, w - x, w + y, w - y] }
    }

    /// Whether a point lies in the region.
    pub fn contains(&self, p: DVec4) -> bool {
        self.planes.iter().all(|plane| plane.dot(p) >= 0.0)
    }

    /// The part of a triangle in the region: the corners of a convex polygon in the triangle's winding; fewer than three
    /// if there is none.
    pub fn triangle(&self, corners: [DVec4; 3], polygon: &mut Vec<DVec4>) {
        polygon.clear();
        polygon.extend(corners);
        let mut rest = Vec::with_capacity(8);
        for plane in self.planes {
            if polygon.iter().all(|p| plane.dot(*p) >= 0.0) {
                continue;
            }
            rest.clear();
            for (i, &p) in polygon.iter().enumerate() {
                let q = polygon[(i + 1) % polygon.len()];
                let (dp, dq) = (plane.dot(p), plane.dot(q));
                if dp >= 0.0 {
                    rest.push(p);
                }
                if (dp >= 0.0) != (dq >= 0.0) {
                    // From the inside, so that neighbours agree.
                    let (inside, outside, di, d) = if dp >= 0.0 { (p, q, dp, dq) } else { (q, p, dq, dp) };
                    rest.push(inside + (outside - inside) * (di / (di - d)));
                }
            }
            std::mem::swap(polygon, &mut rest);
            if polygon.len() < 3 {
                polygon.clear();
                return;
            }
        }
    }

    /// The part of a segment in the region.
    pub fn segment(&self, [mut a, mut b]: [DVec4; 2]) -> Option<[DVec4; 2]> {
        for plane in self.planes {
            let (da, db) = (plane.dot(a), plane.dot(b));
            if da < 0.0 && db < 0.0 {
                return None;
            }
            if da < 0.0 {
                a = b + (a - b) * (db / (db - da));
            } else if db < 0.0 {
                b = a + (b - a) * (da / (da - db));
            }
        }
        Some([a, b])
    }
}

/// The triangles of a convex polygon.
pub fn fan(polygon: &[DVec4]) -> impl Iterator<Item = [DVec4; 3]> {
    (2..polygon.len()).map(|i| [polygon[0], polygon[i - 1], polygon[i]])
}

#[cfg(test)]
mod tests {
    use super::*;
    use zfail_plan::glam::{DAffine3, DVec3};
    use zfail_plan::view::{Projection, View};

    fn region() -> Region {
        let projection = Projection::Perspective { yfov: std::f64::consts::FRAC_PI_2, near: 1.0, far: None };
        let view = View::new(DAffine3::IDENTITY, projection, [10, 10]);
        Region::frustum(&view.clip_from_relative())
    }

    fn area(polygon: &[DVec4]) -> f64 {
        let at = |p: DVec4| p.truncate() / p.w;
        fan(polygon).map(|[a, b, c]| (at(b) - at(a)).cross(at(c) - at(a)).length() / 2.0).sum()
    }

    #[test]
    fn a_triangle_is_cut_at_the_sides() {
        let mut polygon = Vec::new();
        // At depth 2 the frustum is 4 wide: a triangle around it loses everything but the square.
        let corners = [(-9.0, -9.0), (9.0, -9.0), (0.0, 30.0)].map(|(x, y)| DVec4::new(x, y, -2.0, 1.0));
        region().triangle(corners, &mut polygon);
        assert!((area(&polygon) - 16.0).abs() < 1e-9, "{}", area(&polygon));
        assert!(polygon.iter().all(|p| region().planes.iter().all(|plane| plane.dot(*p) > -1e-9)));
        region().triangle(corners.map(|c| c * DVec4::new(1.0, 1.0, 0.4, 1.0)), &mut polygon);
        assert!(polygon.is_empty(), "in front of the near plane");
    }

    #[test]
    fn points_at_infinity_stay() {
        let mut polygon = Vec::new();
        let far = DVec3::new(0.1, 0.2, -1.0).extend(0.0);
        region().triangle([DVec4::new(0.0, 0.0, -2.0, 1.0), DVec4::new(0.5, 0.0, -2.0, 1.0), far], &mut polygon);
        assert_eq!(polygon.len(), 3);
        assert!(polygon.contains(&far));
        let behind = DVec4::new(0.0, 0.0, 1.0, 0.0);
        let [a, b] = region().segment([behind, DVec4::new(0.0, 0.0, -3.0, 1.0)]).expect("a part");
        assert!((a.z / a.w + 1.0).abs() < 1e-12 && b.z == -3.0, "{a} {b}");
        assert_eq!(region().segment([behind, DVec4::new(0.0, 0.0, 5.0, 1.0)]), None);
    }
}
