//! Convex polyhedra, cut down plane by plane.
//!
//! In: a box and half spaces. Out: the corners of what is left. Memory is kept between uses, because planning cuts one
//! polyhedron for every caster of every light.

use glam::{DVec3, DVec4};

/// A convex polyhedron by its faces.
#[derive(Clone, Debug, Default)]
pub struct Polyhedron {
    points: Vec<DVec3>,
    /// One past the last point of each face.
    ends: Vec<u32>,
}

/// Memory for cutting.
#[derive(Clone, Debug, Default)]
pub struct Knife {
    spare: Polyhedron,
    cut: Vec<DVec3>,
    order: Vec<(f64, DVec3)>,
}

/// Corners of a box's faces in cycles, numbered by bits x, y, z.
const FACES: [[usize; 4]; 6] = [[0, 2, 6, 4], [1, 5, 7, 3], [0, 4, 5, 1], [2, 3, 7, 6], [0, 1, 3, 2], [4, 6, 7, 5]];

impl Polyhedron {
    /// Becomes a parallelepiped with the corners of [`crate::scene::Bounds::corners`].
    pub fn set_box(&mut self, corners: &[DVec3; 8]) {
        self.points.clear();
        self.ends.clear();
        for face in FACES {
            self.points.extend(face.map(|i| corners[i]));
            self.ends.push(self.points.len() as u32);
        }
    }

    /// Becomes a copy of `other`.
    pub fn set(&mut self, other: &Self) {
        self.points.clone_from(&other.points);
        self.ends.clone_from(&other.ends);
    }

    /// Whether nothing is left.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.points.is_empty()
    }

    /// The corners, each as often as faces meet there.
    #[must_use]
    pub fn points(&self) -> &[DVec3] {
        &self.points
    }

    /// Keeps what lies in the half space `dot(plane.xyz, p) + plane.w >= 0`.
    pub fn cut(&mut self, plane: DVec4, knife: &mut Knife) {
        let height = |p: DVec3| plane.truncate().dot(p) + plane.w;
        if self.points.iter().all(|&p| height(p) >= 0.0) {
            return;
        }
        let Knife { spare, cut, order } = knife;
        spare.points.clear();
        spare.ends.clear();
        cut.clear();
        let mut start = 0;
        for &end in &self.ends {
            let face = &self.points[start..end as usize];
            start = end as usize;
            let first = spare.points.len();
            for (i, &p) in face.iter().enumerate() {
                let q = face[(i + 1) % face.len()];
                let (hp, hq) = (height(p), height(q));
                if hp >= 0.0 {
                    spare.points.push(p);
                }
                if (hp >= 0.0) != (hq >= 0.0) {
                    let crossing = p + (q - p) * (hp / (hp - hq));
                    spare.points.push(crossing);
                    // An edge leaves through the plane in one of its two faces and enters in the other.
                    if hp >= 0.0 {
                        cut.push(crossing);
                    }
                }
            }
            if spare.points.len() > first {
                spare.ends.push(spare.points.len() as u32);
            }
        }
        std::mem::swap(self, spare);
        if cut.len() >= 3 {
            // The new face: its corners around their middle.
            let middle = cut.iter().sum::<DVec3>() / cut.len() as f64;
            let (u, v) = plane.truncate().normalize_or(DVec3::X).any_orthonormal_pair();
            order.clear();
            order.extend(cut.iter().map(|&p| ((p - middle).dot(v).atan2((p - middle).dot(u)), p)));
            order.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
            self.points.extend(order.iter().map(|&(_, p)| p));
            self.ends.push(self.points.len() as u32);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Bounds;

    /// Extremes over the polyhedron are those over the half spaces, found by dense sampling.
    #[test]
    fn cuts_leave_the_intersection() {
        let mut seed = 11_u64;
        let mut random = || {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (seed >> 33) as f64 / f64::from(1_u32 << 31) * 2.0 - 1.0
        };
        let cube = Bounds { min: DVec3::splat(-1.0), max: DVec3::ONE };
        let mut knife = Knife::default();
        for _ in 0..100 {
            let mut left = Polyhedron::default();
            left.set_box(&cube.corners());
            let planes: Vec<DVec4> = (0..5)
                .map(|_| DVec3::new(random(), random(), random()).normalize().extend(0.3 + random().abs()))
                .collect();
            for plane in &planes {
                left.cut(*plane, &mut knife);
            }
            let inside = |p: DVec3| planes.iter().all(|plane| plane.truncate().dot(p) + plane.w >= -1e-9);
            assert!(left.points().iter().all(|&p| inside(p) && p.abs().max_element() <= 1.0 + 1e-9));
            for _ in 0..20 {
                let way = DVec3::new(random(), random(), random()).normalize();
                let greatest = left.points().iter().map(|p| way.dot(*p)).fold(f64::NEG_INFINITY, f64::max);
                for _ in 0..200 {
                    let p = DVec3::new(random(), random(), random());
                    assert!(!inside(p) || way.dot(p) <= greatest + 1e-9, "{p} was cut away");
                }
            }
        }
    }

    #[test]
    fn a_quarter_of_a_cube_has_twelve_edges() {
        let mut left = Polyhedron::default();
        let mut knife = Knife::default();
        left.set_box(&Bounds { min: DVec3::ZERO, max: DVec3::ONE }.corners());
        left.cut(DVec4::new(-1.0, 0.0, 0.0, 0.5), &mut knife);
        left.cut(DVec4::new(0.0, -1.0, 0.0, 0.5), &mut knife);
        assert_eq!((left.points().len(), left.ends.len()), (24, 6));
        left.cut(DVec4::new(0.0, 0.0, 1.0, -2.0), &mut knife);
        assert!(left.is_empty());
    }
}
