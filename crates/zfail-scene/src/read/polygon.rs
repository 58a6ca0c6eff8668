//! Polygons to triangles.
//!
//! In: corners in order. Out: two triangles fewer than there are corners, each corner used. No corner is ever dropped,
//! not even one on a straight edge: the neighbour has it too, and a body must stay closed.

use glam::DVec3;

/// Convex polygons become fans; of others, ears are cut, as long as there are few corners and enough time.
pub(super) struct Triangulator {
    /// Containment tests that are left. A file cannot be allowed to choose how long this takes.
    tests: u64,
}

/// Concave polygons of more corners become fans too: cutting takes their cube.
const MAX_CORNERS: usize = 128;

impl Default for Triangulator {
    fn default() -> Self {
        Self { tests: 1 << 28 }
    }
}

impl Triangulator {
    /// Adds the triangles of the polygon `corners` to `triangles`, wound alike.
    pub fn cut(&mut self, corners: &[u32], position: impl Fn(u32) -> [f32; 3], triangles: &mut Vec<[u32; 3]>) {
        let at = |v: u32| DVec3::from(position(v).map(f64::from));
        let mut ring = corners.to_vec();
        let concave = corners.len() > 3 && corners.len() <= MAX_CORNERS && !is_convex(corners, &at);
        while concave && ring.len() > 3 && self.tests > 0 {
            let ear = self.ear(&ring, &at).unwrap_or(1);
            triangles.push(around(&ring, ear));
            ring.remove(ear);
        }
        if let [hub, rim @ ..] = &*ring {
            triangles.extend(rim.windows(2).map(|edge| [*hub, edge[0], edge[1]]));
        }
    }

    /// A corner that turns as the whole polygon does, with no other corner in its triangle.
    fn ear(&mut self, ring: &[u32], at: &impl Fn(u32) -> DVec3) -> Option<usize> {
        let normal = normal(ring, at);
        (0..ring.len()).find(|&i| {
            let corners @ [a, b, c] = around(ring, i).map(at);
            let inside = |p: DVec3| {
                let edges = [(a, b), (b, c), (c, a)];
                !corners.contains(&p)
                    && edges.iter().all(|(from, to)| (*to - *from).cross(p - *from).dot(normal) >= 0.0)
            };
            let turns = (b - a).cross(c - b).dot(normal) > 0.0;
            self.tests = self.tests.saturating_sub(1 + if turns { ring.len() as u64 } else { 0 });
            turns && !ring.iter().any(|&v| inside(at(v)))
        })
    }
}

/// Corner `i` of `ring` between its neighbours.
fn around(ring: &[u32], i: usize) -> [u32; 3] {
    let n = ring.len();
    [ring[(i + n - 1) % n], ring[i], ring[(i + 1) % n]]
}

/// Twice the vector area.
fn normal(ring: &[u32], at: &impl Fn(u32) -> DVec3) -> DVec3 {
    let origin = at(ring[0]);
    ring.windows(2).map(|edge| (at(edge[0]) - origin).cross(at(edge[1]) - origin)).sum()
}

fn is_convex(ring: &[u32], at: &impl Fn(u32) -> DVec3) -> bool {
    let normal = normal(ring, at);
    (0..ring.len()).all(|i| {
        let [a, b, c] = around(ring, i).map(at);
        (b - a).cross(c - b).dot(normal) >= 0.0
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cut(points: &[[f32; 2]]) -> Vec<[u32; 3]> {
        let mut triangles = Vec::new();
        let corners: Vec<u32> = (0..points.len() as u32).collect();
        let position = |v: u32| [points[v as usize][0], points[v as usize][1], 0.0];
        Triangulator::default().cut(&corners, position, &mut triangles);
        triangles
    }

    fn area(points: &[[f32; 2]], t: &[u32; 3]) -> f32 {
        let [a, b, c] = t.map(|v| points[v as usize]);
        ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])) / 2.0
    }

    #[test]
    fn convex_ones_become_fans() {
        let square = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
        assert_eq!(cut(&square), [[0, 1, 2], [0, 2, 3]]);
        assert_eq!(cut(&square[..3]), [[0, 1, 2]]);
        assert!(cut(&square[..2]).is_empty() && cut(&[]).is_empty());
    }

    /// Without overlaps, the areas add up to the polygon's and none is negative; a fan fails this.
    #[test]
    fn concave_ones_do_not_overlap() {
        let arrow = [[0.0, 0.0], [2.0, 1.0], [0.0, 2.0], [1.0, 1.0]];
        let l = [[2.0, 1.0], [1.0, 1.0], [1.0, 2.0], [1.0, 3.0], [0.0, 3.0], [0.0, 0.0], [2.0, 0.0]];
        for (points, expected) in [(&arrow[..], 1.0), (&l, 4.0)] {
            let triangles = cut(points);
            assert_eq!(triangles.len(), points.len() - 2);
            let areas: Vec<f32> = triangles.iter().map(|t| area(points, t)).collect();
            assert!(areas.iter().all(|&a| a >= 0.0), "{areas:?}");
            assert_eq!(areas.iter().sum::<f32>(), expected);
            assert!((0..points.len() as u32).all(|v| triangles.iter().flatten().any(|&c| c == v)), "no corner is lost");
        }
        let mirrored = l.map(|[x, y]| [-x, y]);
        assert!(cut(&mirrored).iter().all(|t| area(&mirrored, t) <= 0.0), "wound as the polygon is");
        assert_eq!(cut(&[[0.0; 2]; 5]).len(), 3, "a polygon without area");
    }

    #[test]
    fn time_is_bounded() {
        let mut triangulator = Triangulator { tests: 10 };
        let spike = |i: u32| {
            let (angle, radius) = (i as f32 * std::f32::consts::TAU / 100.0, 1.0 + (i % 2) as f32);
            [angle.cos() * radius, angle.sin() * radius, 0.0]
        };
        let star: Vec<[f32; 3]> = (0..100).map(spike).collect();
        let mut triangles = Vec::new();
        let corners: Vec<u32> = (0..100).collect();
        triangulator.cut(&corners, |v| star[v as usize], &mut triangles);
        assert_eq!((triangles.len(), triangulator.tests), (98, 0));
    }
}
