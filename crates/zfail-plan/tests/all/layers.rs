//! Bounds on layers beside counting them: random meshes, and many triangles around one vertex.

use crate::shapes;
use crate::shapes::Soup;
use glam::{DAffine3, DMat3, DVec3};
use zfail_plan::casting::{self, Casting};
use zfail_plan::light::LightKind;
use zfail_plan::stack::{Caster, Chart, Outline, Work};
use zfail_plan::topology::Topology;
use zfail_testing::Random;

fn f32s(p: DVec3) -> [f32; 3] {
    p.as_vec3().to_array()
}

/// Triangles that have nothing in common.
fn soup(random: &mut Random, count: u32) -> Soup {
    let positions = (0..3 * count).map(|_| f32s(random.vector(1.0))).collect();
    (positions, (0..count).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect())
}

/// Triangles that have one vertex in common.
fn hedgehog(random: &mut Random, count: u32) -> Soup {
    let positions = (0..=2 * count).map(|i| f32s(if i == 0 { DVec3::ZERO } else { random.vector(1.0) })).collect();
    (positions, (0..count).map(|t| [0, 2 * t + 1, 2 * t + 2]).collect())
}

/// A disc of `segments` triangles around its middle, whose rim goes up and down by `pleat` and around `turns` times.
fn fan(segments: u32, pleat: f64, turns: f64) -> Soup {
    let rim = |i: u32| {
        let (sin, cos) = (std::f64::consts::TAU * turns * f64::from(i) / f64::from(segments)).sin_cos();
        f32s(DVec3::new(cos, if i.is_multiple_of(2) { pleat } else { -pleat }, sin))
    };
    let positions = std::iter::once([0.0; 3]).chain((0..segments).map(rim)).collect();
    (positions, (0..segments).map(|i| [0, 1 + i, 1 + (i + 1) % segments]).collect())
}

/// A mesh of which every triangle casts, under a light.
struct Shape {
    topology: Topology,
    weights: Vec<i8>,
    light: LightKind,
    edges: Vec<[u32; 2]>,
}

impl Shape {
    fn new(soup: &Soup, light: LightKind) -> Self {
        let topology = Topology::new(&soup.0, &soup.1, |_| true).unwrap();
        let from = casting::object_light(&light, &DMat3::IDENTITY, DVec3::ZERO).unwrap();
        let mut weights = Vec::new();
        casting::weights(&topology, &vec![Casting::Double; topology.parts().len()], from, &mut weights);
        let mut edges = Vec::new();
        topology.boundary(&weights, |[lo, hi], times| {
            let edge = if times > 0 { [lo, hi] } else { [hi, lo] };
            edges.extend(std::iter::repeat_n(edge, times.unsigned_abs() as usize));
        });
        Self { topology, weights, light, edges }
    }

    /// What the search says, with these silhouettes, and what it cost.
    fn search(&self, edges: &[[u32; 2]], limit: usize) -> (bool, u64) {
        let mut outline = Outline::new(Chart::new(self.light.homogeneous(), &self.topology.bounds()));
        let light = casting::object_light(&self.light, &DMat3::IDENTITY, DVec3::ZERO).unwrap();
        let world_from_object = &DAffine3::IDENTITY;
        let caster = Caster { topology: &self.topology, weights: &self.weights, world_from_object, light };
        outline.add(&caster, edges.iter().copied(), 0..self.weights.len());
        let mut work = Work::of(1 << 26);
        (outline.is_within(limit, &mut work), work.spent())
    }

    /// The least limit that the search accepts.
    fn bound(&self) -> usize {
        let (mut refused, mut accepted) = (0, self.weights.len());
        while accepted - refused > 1 {
            let middle = usize::midpoint(refused, accepted);
            if self.search(&self.edges, middle).0 { accepted = middle } else { refused = middle }
        }
        accepted
    }

    /// Layers on the ray from the light through a point, or that way.
    fn layers(&self, through: DVec3) -> usize {
        let light = self.light.homogeneous();
        let way = if light.w == 0.0 { -light.truncate() } else { through - light.truncate() };
        let crossed = |t: &usize| {
            let corners = self.topology.corners(*t).map(|p| p - through);
            let [a, b, c] = [0, 1, 2].map(|i| way.dot(corners[i].cross(corners[(i + 1) % 3])));
            let beyond = || {
                let [p, q, r] = corners;
                let normal = (q - p).cross(r - p);
                light.w == 0.0 || normal.dot(p) / normal.dot(way) > -1.0
            };
            self.weights[*t] != 0 && (a > 0.0) == (b > 0.0) && (b > 0.0) == (c > 0.0) && beyond()
        };
        (0..self.weights.len()).filter(crossed).count()
    }

    /// The most layers found by trying, also close to vertices, where most triangles meet.
    fn most(&self, random: &mut Random, tries: u32) -> usize {
        let vertices = self.topology.positions().len() as f64;
        let through = (0..tries).map(|i| {
            let near = self.topology.position(((random.unit()) * (vertices - 1.0)).round() as u32);
            match i % 3 {
                0 => random.vector(1.0),
                1 => near + random.vector(1.0) * 1e-3,
                _ => self.topology.position(0) + random.vector(1.0) * 0.1_f64.powf(3.0 + 3.0 * random.signed()),
            }
        });
        through.map(|p| self.layers(p)).max().unwrap_or(0)
    }
}

fn lights() -> [LightKind; 4] {
    let lamp = |position| LightKind::Point { position, range: f64::INFINITY };
    [
        lamp(DVec3::new(0.2, 5.0, 0.1)),
        lamp(DVec3::new(0.13, 0.21, -0.17)),
        lamp(DVec3::new(-2.0, 0.4, 1.0)),
        LightKind::Directional { direction: DVec3::new(0.3, -1.0, 0.2).normalize() },
    ]
}

#[test]
fn no_ray_crosses_more_layers_than_the_bound() {
    let mut random = Random(7);
    let mut missed = 0;
    for round in 0..40 {
        let soup = match round % 4 {
            0 => soup(&mut random, 60),
            1 => hedgehog(&mut random, 90),
            2 => fan(200, 0.5, 1.0 + f64::from(round / 4)),
            _ => shapes::joined(hedgehog(&mut random, 40), fan(80, 0.1, 3.0), [0.0, 0.3, 0.0]),
        };
        for light in lights() {
            let shape = Shape::new(&soup, light);
            let (bound, most) = (shape.bound(), shape.most(&mut random, 600));
            assert!(bound >= most, "round {round}, {light:?}: {bound} < {most}");
            // What is found by trying is nearly all there is, and the search finds little more.
            assert!(bound <= most + most / 3 + 6, "round {round}, {light:?}: {bound} for {most}");
            // Without some of its silhouettes the bound is too small somewhere.
            let fewer: Vec<[u32; 2]> =
                shape.edges.iter().copied().filter(|edge| (edge[0] ^ edge[1]) % 5 != 0).collect();
            missed += usize::from(shape.search(&fewer, most.saturating_sub(1)).0);
        }
    }
    assert!(missed > 20, "missing silhouettes show in {missed} of 160 bounds");
}

#[test]
fn triangles_around_one_vertex_are_as_many_layers_as_they_are() {
    for light in lights() {
        for (segments, pleat, turns) in
            [(50_000, 0.0, 1.0), (3_000, 0.0, 7.0), (50_000, 0.001, 1.0), (3_000, 0.01, 2.0)]
        {
            let shape = Shape::new(&fan(segments, pleat, turns), light);
            let (within, work) = shape.search(&shape.edges, 120);
            assert!(within, "{light:?}: {segments} segments, {turns} turns");
            assert!(work < 600 * u64::from(segments), "{light:?}: {segments} segments took {work}");
        }
    }
}

#[test]
fn a_search_ends_when_its_work_is_done() {
    let mut random = Random(3);
    let shape = Shape::new(&soup(&mut random, 3000), lights()[0]);
    let most = shape.most(&mut random, 100);
    let mut outline = Outline::new(Chart::Sphere);
    let light = casting::object_light(&shape.light, &DMat3::IDENTITY, DVec3::ZERO).unwrap();
    let world_from_object = &DAffine3::IDENTITY;
    let caster = Caster { topology: &shape.topology, weights: &shape.weights, world_from_object, light };
    outline.add(&caster, shape.edges.iter().copied(), 0..shape.weights.len());
    let mut work = Work::of(100_000);
    assert!(!outline.is_within(most + 1, &mut work), "it would take longer");
    assert!(work.spent() <= 100_000 && work.is_over());
    assert!(!outline.is_within(0, &mut work));
}
