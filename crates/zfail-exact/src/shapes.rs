//! Meshes of every sort that may cast: closed, open, non-manifold, and plain soups.
//!
//! In: a shape's few parameters. Out: a mesh around the origin, about one unit in radius.

use crate::random::Random;
use std::f64::consts::{PI, TAU};
use zfail_plan::glam::DVec3;
use zfail_scene::{Mesh, Primitive};

/// What a part looks like.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shape {
    /// A closed cube, fronts outside.
    Cube,
    /// A closed cube with fronts inside.
    Room,
    /// A cube without its top.
    OpenBox,
    /// A closed sphere with so many rings.
    Sphere(u32),
    /// The lower half of a sphere, open.
    Bowl(u32),
    /// A tube without ends.
    Tube(u32),
    /// A closed torus with so many segments around its tube.
    Torus(u32),
    /// Closed bars along the edges of a cube, each a box of its own.
    Cage,
    /// Separate closed cubes in a grid of so many a side.
    Lattice(u32),
    /// A square in the plane y = 0, divided so many times, fronts up.
    Sheet(u32),
    /// The same with waves.
    Waves(u32),
    /// Half planes that share one edge, every second one wound against its neighbours.
    Book(u32),
    /// A cube with a fin on one of its edges: three faces meet there.
    Finned,
    /// Two cubes that share one edge: four faces meet there.
    Twins,
    /// So many triangles between nine vertices at random: edges with any number of triangles and any winding.
    Tangle(u32, u64),
    /// So many separate triangles at random.
    Soup(u32, u64),
    /// So many small separate triangles at random.
    Shards(u32, u64),
    /// A closed sphere on which so many triangles stand: an edge of each lies on one of its faces, within rounding.
    Planted(u32, u64),
    /// So many boxes, spheres, rings and open boxes in one mesh, some of which stand in or touch each other.
    District(u32, u64),
    /// A sphere with every third triangle removed or reversed.
    Wreck(u32),
    /// A square upon itself, so many times, the windings alternating.
    Layers(u32),
    /// So many squares above each other.
    Stack(u32),
}

impl Shape {
    /// The shape's mesh, with one primitive of `material`.
    #[must_use]
    pub fn mesh(self, material: Option<usize>) -> Mesh {
        let mut build = Builder::default();
        match self {
            Self::Cube => build.cuboid(DVec3::ZERO, DVec3::ONE),
            Self::Room => {
                build.cuboid(DVec3::ZERO, DVec3::ONE);
                build.flip(0, |_| true);
            }
            Self::OpenBox => {
                build.cuboid(DVec3::ZERO, DVec3::ONE);
                let Builder { positions, triangles } = &mut build;
                triangles.retain(|t| t.iter().any(|&v| positions[v as usize].y < 0.0));
            }
            Self::Sphere(n) => build.sphere(n, n),
            Self::Bowl(n) => {
                build.sphere(2 * n, 2 * n);
                let Builder { positions, triangles } = &mut build;
                triangles.retain(|t| t.iter().all(|&v| positions[v as usize].y < 1e-6));
            }
            Self::Tube(n) => {
                build.grid(n, 1, [true, false], |u, v| DVec3::new((TAU * u).cos(), 2.0 * v - 1.0, (TAU * u).sin()));
            }
            Self::Torus(n) => build.grid(2 * n, n, [true, true], |u, v| {
                let (outer, inner) = (TAU * u, TAU * v);
                let radius = 0.7 + 0.3 * inner.cos();
                DVec3::new(radius * outer.cos(), 0.3 * inner.sin(), radius * outer.sin())
            }),
            Self::Cage => build.cage(),
            Self::Lattice(n) => build.lattice(n),
            Self::Sheet(n) => build.grid(n, n, [false; 2], |u, v| DVec3::new(2.0 * u - 1.0, 0.0, 2.0 * v - 1.0)),
            Self::Waves(n) => build.grid(n, n, [false; 2], |u, v| {
                DVec3::new(2.0 * u - 1.0, 0.2 * (5.0 * u).sin() * (4.0 * v).cos(), 2.0 * v - 1.0)
            }),
            Self::Book(n) => build.book(n),
            Self::Finned => {
                build.cuboid(DVec3::ZERO, DVec3::splat(0.5));
                let [a, b] = [6, 7];
                let c = build.vertex(DVec3::new(-0.5, 1.2, 0.9));
                let d = build.vertex(DVec3::new(0.5, 1.2, 0.9));
                build.quad([a, b, d, c]);
            }
            Self::Twins => {
                build.cuboid(DVec3::splat(-0.5), DVec3::splat(0.5));
                build.cuboid(DVec3::new(0.5, 0.5, -0.5), DVec3::splat(0.5));
            }
            Self::Tangle(count, seed) => build.tangle(count, seed),
            Self::Soup(count, seed) => build.soup(count, seed, 0.5),
            Self::Shards(count, seed) => build.soup(count, seed, 0.12),
            Self::Planted(count, seed) => build.planted(count, seed),
            Self::District(count, seed) => build.district(count, seed),
            Self::Wreck(n) => {
                build.sphere(n, n);
                let mut i = 0;
                build.triangles.retain(|_| {
                    i += 1;
                    i % 3 != 0
                });
                build.flip(0, |t| t % 4 == 0);
            }
            Self::Layers(n) => {
                for layer in 0..n {
                    let first = build.triangles.len();
                    build.square(0.0, 1.0);
                    build.flip(first, |_| layer % 2 == 1);
                }
            }
            Self::Stack(n) => {
                for layer in 0..n {
                    build.square(f64::from(layer) / f64::from(n.max(1)), 1.0);
                }
            }
        }
        build.finish(material)
    }
}

#[derive(Default)]
struct Builder {
    positions: Vec<DVec3>,
    triangles: Vec<[u32; 3]>,
}

impl Builder {
    fn vertex(&mut self, p: DVec3) -> u32 {
        self.positions.push(p);
        self.positions.len() as u32 - 1
    }

    fn quad(&mut self, [a, b, c, d]: [u32; 4]) {
        self.triangles.extend([[a, b, c], [a, c, d]]);
    }

    fn flip(&mut self, first: usize, which: impl Fn(usize) -> bool) {
        for (_, t) in self.triangles.iter_mut().enumerate().skip(first).filter(|(i, _)| which(*i)) {
            t.swap(1, 2);
        }
    }

    fn cuboid(&mut self, center: DVec3, half: DVec3) {
        let sign = |i: u32, bit: u32| if i >> bit & 1 == 0 { -1.0 } else { 1.0 };
        let corner: [u32; 8] = std::array::from_fn(|i| {
            let i = i as u32;
            self.vertex(center + half * DVec3::new(sign(i, 0), sign(i, 1), sign(i, 2)))
        });
        for quad in [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]] {
            self.quad(quad.map(|i| corner[i]));
        }
    }

    fn square(&mut self, y: f64, half: f64) {
        let corners = [(-1.0, -1.0), (-1.0, 1.0), (1.0, 1.0), (1.0, -1.0)];
        let corners = corners.map(|(x, z)| self.vertex(DVec3::new(half * x, y, half * z)));
        self.quad(corners);
    }

    /// Points of two parameters in 0..1; a direction that wraps reuses its first row, so that the surface closes.
    fn grid(&mut self, columns: u32, rows: u32, wraps: [bool; 2], point: impl Fn(f64, f64) -> DVec3) {
        let [columns, rows] = [columns.max(1), rows.max(1)];
        let [across, down] = [columns + u32::from(!wraps[0]), rows + u32::from(!wraps[1])];
        let first = self.positions.len() as u32;
        for j in 0..down {
            for i in 0..across {
                self.vertex(point(f64::from(i) / f64::from(columns), f64::from(j) / f64::from(rows)));
            }
        }
        let at = |i: u32, j: u32| first + (j % down) * across + i % across;
        for j in 0..rows {
            for i in 0..columns {
                self.quad([at(i, j), at(i, j + 1), at(i + 1, j + 1), at(i + 1, j)]);
            }
        }
    }

    fn sphere(&mut self, rings: u32, columns: u32) {
        let [rings, columns] = [rings.max(2), columns.max(3)];
        let first = self.positions.len() as u32;
        self.vertex(DVec3::Y);
        for i in 1..rings {
            let theta = PI * f64::from(i) / f64::from(rings);
            for j in 0..columns {
                let phi = TAU * f64::from(j) / f64::from(columns);
                self.vertex(DVec3::new(theta.sin() * phi.sin(), theta.cos(), theta.sin() * phi.cos()));
            }
        }
        let last = self.vertex(DVec3::NEG_Y);
        let at = |i: u32, j: u32| first + 1 + (i - 1) * columns + j % columns;
        for j in 0..columns {
            self.triangles.push([first, at(1, j), at(1, j + 1)]);
            self.triangles.push([last, at(rings - 1, j + 1), at(rings - 1, j)]);
            for i in 1..rings - 1 {
                self.quad([at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]);
            }
        }
    }

    fn cage(&mut self) {
        for axis in 0..3 {
            for corner in 0..4 {
                let sides = [corner & 1, corner >> 1].map(|s| if s == 0 { -0.9 } else { 0.9 });
                let mut center = [sides[0], sides[1], 0.0];
                let mut half = [0.1, 0.1, 0.75];
                center.rotate_right(axis);
                half.rotate_right(axis);
                self.cuboid(DVec3::from_array(center), DVec3::from_array(half));
            }
        }
    }

    fn lattice(&mut self, n: u32) {
        let at = |i: u32| (f64::from(i) + 0.5) * 2.0 / f64::from(n) - 1.0;
        for i in 0..n * n * n {
            let center = DVec3::new(at(i % n), at(i / n % n), at(i / n / n));
            self.cuboid(center, DVec3::splat(0.4 / f64::from(n)));
        }
    }

    fn book(&mut self, pages: u32) {
        let spine = [self.vertex(DVec3::NEG_Y), self.vertex(DVec3::Y)];
        for page in 0..pages {
            let angle = TAU * f64::from(page) / f64::from(pages) + 0.2;
            let (z, x) = angle.sin_cos();
            let edge = [self.vertex(DVec3::new(x, 1.0, z)), self.vertex(DVec3::new(x, -1.0, z))];
            let mut page_corners = [spine[0], spine[1], edge[0], edge[1]];
            if page % 2 == 1 {
                page_corners.reverse();
            }
            self.quad(page_corners);
        }
    }

    fn tangle(&mut self, count: u32, seed: u64) {
        let mut random = Random::new(seed);
        self.positions.extend((0..9).map(|_| random.in_cube(1.0)));
        while (self.triangles.len() as u32) < count {
            let t = [0, 1, 2].map(|_| random.below(9));
            if t[0] != t[1] && t[1] != t[2] && t[2] != t[0] {
                self.triangles.push(t);
            }
        }
    }

    /// Each triangle has corners within `half` of its centre along every axis.
    fn soup(&mut self, count: u32, seed: u64, half: f64) {
        let mut random = Random::new(seed);
        for _ in 0..count {
            let center = random.in_cube(0.7);
            let corners = [0, 1, 2].map(|_| {
                let p = center + random.in_cube(half);
                self.vertex(p)
            });
            self.triangles.push(corners);
        }
    }

    fn planted(&mut self, count: u32, seed: u64) {
        let mut random = Random::new(seed);
        self.sphere(8, 8);
        let ground = self.triangles.clone();
        for _ in 0..count {
            let face = random.pick(&ground).map(|v| self.positions[v as usize]);
            let on_face = |random: &mut Random| {
                let (u, v) = (random.between(0.0, 1.0), random.between(0.0, 1.0));
                let (u, v) = if u + v > 1.0 { (1.0 - u, 1.0 - v) } else { (u, v) };
                face[0] + (face[1] - face[0]) * u + (face[2] - face[0]) * v
            };
            let foot = [on_face(&mut random), on_face(&mut random)];
            let top = (foot[0] + foot[1]) * 0.5 + (face[0] + random.in_cube(0.5)) * random.between(0.05, 0.4);
            let corners = [foot[0], foot[1], top].map(|p| self.vertex(p));
            self.triangles.push(corners);
        }
    }

    fn district(&mut self, count: u32, seed: u64) {
        let mut random = Random::new(seed);
        for _ in 0..count {
            let mut part = Self::default();
            match random.below(5) {
                0 => part.sphere(6, 7),
                1 => part.cage(),
                2 => {
                    part.cuboid(DVec3::ZERO, DVec3::ONE);
                    part.triangles.truncate(10);
                }
                _ => part.cuboid(DVec3::ZERO, DVec3::ONE),
            }
            // On a grid, so that some touch at corners.
            let cell = random.in_cube(4.0).round() * 0.25;
            let size = if random.once_in(4) { DVec3::splat(0.125) } else { random.in_cube(0.1).abs() + 0.05 };
            let first = self.positions.len() as u32;
            self.positions.extend(part.positions.iter().map(|&p| cell * DVec3::new(1.0, 0.5, 1.0) + p * size));
            self.triangles.extend(part.triangles.iter().map(|t| t.map(|v| v + first)));
        }
    }

    fn finish(self, material: Option<usize>) -> Mesh {
        let count = self.positions.len();
        Mesh {
            name: String::new(),
            positions: self.positions.iter().map(|p| p.as_vec3().to_array()).collect(),
            normals: vec![[0.0, 1.0, 0.0]; count],
            tangents: vec![[0.0; 4]; count],
            uv0: vec![[0.0; 2]; count],
            uv1: vec![[0.0; 2]; count],
            colors: vec![[1.0; 4]; count],
            primitives: vec![Primitive { triangles: 0..self.triangles.len() as u32, material }],
            triangles: self.triangles,
            alike: Vec::new(),
        }
    }
}
