//! Convex polyhedra, cut down plane by plane.
//!
//! In: a box and half spaces. Out: the corners of what is left. Memory is kept between uses, because planning cuts one
//! polyhedron for every caster of every light.
//!
//! Faces share their corners by index, so that a corner lies on one side of a plane for all faces that meet there. Planes
//! through edges and along faces, as boxes beside boxes have them, then cut neighbours alike, however heights round. With
//! corners of their own, faces drift apart there, and whole pieces get lost.

use glam::{DVec3, DVec4};

/// A convex polyhedron by its faces.
#[derive(Clone, Debug, Default)]
pub struct Polyhedron {
    points: Vec<DVec3>,
    /// The faces' corners, a cycle each; every edge is traversed once in either direction.
    cycles: Vec<u32>,
    /// One past the last corner of each face.
    ends: Vec<u32>,
}

/// Memory for cutting.
#[derive(Clone, Debug, Default)]
pub struct Knife {
    heights: Vec<f64>,
    /// The new indices of the corners that stay.
    kept: Vec<u32>,
    crossings: Vec<Crossing>,
    spare: Polyhedron,
}

/// Where an edge passes through the plane.
#[derive(Clone, Copy, Debug)]
struct Crossing {
    /// The edge's corners, the one that stays first.
    edge: [u32; 2],
    /// Which corner this becomes.
    corner: u32,
    /// The crossing after it around the new face, until that has been traversed.
    next: Option<usize>,
}

/// Corners of a box's faces in cycles, numbered by bits x, y, z.
const FACES: [[u32; 4]; 6] = [[0, 2, 6, 4], [1, 5, 7, 3], [0, 4, 5, 1], [2, 3, 7, 6], [0, 1, 3, 2], [4, 6, 7, 5]];

impl Polyhedron {
    /// Becomes a parallelepiped with the corners of [`crate::bounds::Bounds::corners`].
    pub fn set_box(&mut self, corners: &[DVec3; 8]) {
        self.clear();
        self.points.extend(corners);
        for face in FACES {
            self.cycles.extend(face);
            self.close_face();
        }
    }

    /// Becomes a copy of `other`.
    pub fn set(&mut self, other: &Self) {
        self.points.clone_from(&other.points);
        self.cycles.clone_from(&other.cycles);
        self.ends.clone_from(&other.ends);
    }

    /// Whether nothing is left.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.points.is_empty()
    }

    /// The corners.
    #[must_use]
    pub fn points(&self) -> &[DVec3] {
        &self.points
    }

    /// Keeps what lies in the half space `dot(plane.xyz, p) + plane.w >= 0`.
    pub fn cut(&mut self, plane: DVec4, knife: &mut Knife) {
        let Knife { heights, kept, crossings, spare } = knife;
        heights.clear();
        heights.extend(self.points.iter().map(|&p| plane.truncate().dot(p) + plane.w));
        if heights.iter().all(|&h| stays(h)) {
            return;
        }
        spare.clear();
        kept.clear();
        crossings.clear();
        for (&p, &h) in self.points.iter().zip(&*heights) {
            kept.push(spare.points.len() as u32);
            if stays(h) {
                spare.points.push(p);
            }
        }
        let mut start = 0;
        for &end in &self.ends {
            let face = &self.cycles[start..end as usize];
            start = end as usize;
            self.cut_face(face, heights, kept, crossings, spare);
        }
        // The new face, in cycles: one, unless rounding left a face not quite flat.
        for i in 0..crossings.len() {
            let mut at = i;
            while let Some(next) = crossings[at].next.take() {
                spare.cycles.push(crossings[at].corner);
                at = next;
            }
            spare.close_face();
        }
        std::mem::swap(self, spare);
    }

    /// Adds what is left of one face to `cut`, and links the crossings on its border for the new face.
    fn cut_face(&self, face: &[u32], heights: &[f64], kept: &[u32], crossings: &mut Vec<Crossing>, cut: &mut Self) {
        let stays = |corner: u32| stays(heights[corner as usize]);
        // From an edge on that comes into the half space, so that whatever leaves it afterwards comes back.
        let along = |i: usize| [face[i % face.len()], face[(i + 1) % face.len()]];
        let Some(first) = (0..face.len()).find(|&i| !stays(along(i)[0]) && stays(along(i)[1])) else {
            if face.iter().all(|&corner| stays(corner)) {
                cut.cycles.extend(face.iter().map(|&corner| kept[corner as usize]));
                cut.close_face();
            }
            return;
        };
        let mut entered = 0;
        let last = first + face.len();
        for i in first..last {
            let [p, q] = along(i);
            match [stays(p), stays(q)] {
                [false, true] => {
                    entered = self.crossing([q, p], heights, crossings, &mut cut.points);
                    cut.cycles.push(crossings[entered].corner);
                }
                [true, false] => {
                    let left = self.crossing([p, q], heights, crossings, &mut cut.points);
                    cut.cycles.extend([kept[p as usize], crossings[left].corner]);
                    cut.close_face();
                    // The new face has this edge the other way round.
                    crossings[entered].next = Some(left);
                }
                [true, true] => cut.cycles.push(kept[p as usize]),
                [false, false] => {}
            }
        }
    }

    /// The crossing on `edge`, whose first corner stays.
    fn crossing(
        &self,
        edge: [u32; 2],
        heights: &[f64],
        crossings: &mut Vec<Crossing>,
        points: &mut Vec<DVec3>,
    ) -> usize {
        if let Some(known) = crossings.iter().position(|crossing| crossing.edge == edge) {
            return known;
        }
        let [p, q] = edge.map(|corner| self.points[corner as usize]);
        let [hp, hq] = edge.map(|corner| heights[corner as usize]);
        crossings.push(Crossing { edge, corner: points.len() as u32, next: None });
        points.push(p + (q - p) * (hp / (hp - hq)));
        crossings.len() - 1
    }

    fn clear(&mut self) {
        self.points.clear();
        self.cycles.clear();
        self.ends.clear();
    }

    /// Ends the face whose corners have been pushed, if any were.
    fn close_face(&mut self) {
        let end = self.cycles.len() as u32;
        if self.ends.last().copied().unwrap_or(0) < end {
            self.ends.push(end);
        }
    }
}

/// Whether a corner this high above the plane is kept; also one of which that is not known.
fn stays(height: f64) -> bool {
    height >= 0.0 || height.is_nan()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bounds::Bounds;
    use glam::DQuat;

    /// Extremes over the polyhedron are those over the half spaces, found by dense sampling.
    #[test]
    fn cuts_leave_the_intersection() {
        let mut numbers = zfail_testing::Random(11);
        let mut random = || numbers.signed();
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
        assert_eq!((left.points().len(), left.cycles.len(), left.ends.len()), (8, 24, 6));
        left.cut(DVec4::new(0.0, 0.0, 1.0, -2.0), &mut knife);
        assert!(left.is_empty());
    }

    /// Boxes beside boxes, turned so that nothing is representable: planes along faces, through edges and through corners.
    #[test]
    fn planes_along_faces_and_through_edges_lose_nothing() {
        let mut knife = Knife::default();
        for round in 0..4000_u32 {
            let mut numbers = zfail_testing::Random(u64::from(round));
            let mut pick = |n: u32| numbers.below(n as usize) as u32;
            let turn = DQuat::from_euler(glam::EulerRot::XYZ, 0.1 * f64::from(pick(60)), 0.7, 0.3 * f64::from(pick(9)));
            let shift = DVec3::new(0.3, -0.7, 1e3 * f64::from(pick(2)));
            let place = |p: DVec3| turn * p + shift;
            let cube = Bounds { min: DVec3::splat(-1.0), max: DVec3::ONE };
            let mut left = Polyhedron::default();
            left.set_box(&cube.corners().map(place));
            let mut planes = Vec::new();
            for _ in 0..6 {
                // Through points of a grid, with slopes on a grid or not.
                let mut grid = |n: u32| f64::from(pick(2 * n + 1)) - f64::from(n);
                let on = DVec3::new(grid(2), grid(2), grid(2)) / 2.0;
                let steps = if round % 2 == 0 { 1 } else { 1000 };
                let normal = DVec3::new(grid(steps), grid(steps), grid(steps)) / f64::from(steps);
                let outward = normal * if normal.dot(on) >= 0.0 { -1.0 } else { 1.0 };
                planes.push(outward.extend(-outward.dot(on)));
                let n = turn * outward * (0.1 + f64::from(pick(100)));
                // Twice, as the borders of a box without thickness come.
                for _ in 0..2 {
                    left.cut(n.extend(-n.dot(place(on))), &mut knife);
                }
            }
            let back: Vec<DVec3> = left.points().iter().map(|&p| turn.inverse() * (p - shift)).collect();
            let inside = |p: DVec3| planes.iter().all(|plane| plane.truncate().dot(p) + plane.w >= 0.0);
            let greatest = |way: DVec3| back.iter().map(|p| way.dot(*p)).fold(f64::NEG_INFINITY, f64::max);
            let ways = [DVec3::X, DVec3::Y, DVec3::Z, DVec3::new(1.0, 2.0, -3.0)].map(|way| [way, -way]);
            let greatest = ways.map(|pair| pair.map(|way| (way, greatest(way))));
            for i in 0..9_i32.pow(3) {
                let p = [i % 9, i / 9 % 9, i / 81].map(|c| f64::from(c) / 4.0 - 1.0);
                // Within, so that the corners of a set without any depth need not be there.
                let p = DVec3::from(p);
                let deep =
                    |e: f64| [DVec3::X, DVec3::Y, DVec3::Z].iter().all(|&a| inside(p + a * e) && inside(p - a * e));
                for (way, most) in greatest.as_flattened() {
                    assert!(!deep(1e-3) || way.dot(p) <= most + 1e-9, "{round}: {p} was cut away, {way}");
                }
            }
        }
    }
}
