use super::*;
use crate::casting;
use glam::Vec4;
use zfail_testing::Random;

/// Square sheets one over the other.
fn sheets(count: u32) -> Topology {
    let (mut positions, mut triangles) = (Vec::new(), Vec::new());
    for i in 0..count {
        let (y, base) = (i as f32 / count as f32, 4 * i);
        positions.extend([[-1.0, y, -1.0], [1.0, y, -1.0], [1.0, y, 1.0], [-1.0, y, 1.0]]);
        triangles.extend([[base, base + 2, base + 1], [base, base + 3, base + 2]]);
    }
    Topology::new(&positions, &triangles, |_| true).unwrap()
}

/// Triangles in a row, each facing along it and none behind another from beside.
fn shingles(count: u32) -> Topology {
    let corner = |i: u32| {
        let x = i as f32 / count as f32;
        [[x, -0.1, -0.1], [x, 0.1, -0.1], [x + 0.001, 0.0, 0.1]]
    };
    let positions: Vec<[f32; 3]> = (0..count).flat_map(corner).collect();
    let triangles: Vec<[u32; 3]> = (0..count).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    Topology::new(&positions, &triangles, |_| true).unwrap()
}

/// A closed ring around y with waves on it, so that rays cross it several times.
fn ring(n: u32, m: u32) -> Topology {
    let angle = |i: u32, n: u32| f64::from(i % n) / f64::from(n) * TAU;
    let at = |i: u32, j: u32| (i % n) * m + j % m;
    let grid = || (0..n).flat_map(|i| (0..m).map(move |j| (i, j)));
    let positions: Vec<[f32; 3]> = grid()
        .map(|(i, j)| {
            let (u, v) = (angle(i, n), angle(j, m));
            let minor = 0.4 + 0.1 * (7.0 * u).sin() * (3.0 * v).cos();
            let r = 1.0 + minor * v.cos();
            DVec3::new(r * u.cos(), minor * v.sin(), r * u.sin()).as_vec3().to_array()
        })
        .collect();
    let quad = |(i, j)| [[at(i, j), at(i, j + 1), at(i + 1, j + 1)], [at(i, j), at(i + 1, j + 1), at(i + 1, j)]];
    let triangles: Vec<[u32; 3]> = grid().flat_map(quad).collect();
    Topology::new(&positions, &triangles, |_| true).unwrap()
}

fn soup(random: &mut Random) -> Topology {
    let positions: Vec<[f32; 3]> = (0..40).map(|_| random.vector(1.0).as_vec3().to_array()).collect();
    let triangles: Vec<[u32; 3]> = (0..80).map(|_| [0; 3].map(|_| random.real(0.0, 40.0) as u32)).collect();
    Topology::new(&positions, &triangles, |_| true).unwrap()
}

/// The most layers that are found along rays from `light` through the mesh.
fn deepest(topology: &Topology, castings: &[Casting], light: ObjectLight, random: &mut Random) -> usize {
    let mut weights = Vec::new();
    casting::weights(topology, castings, light, &mut weights);
    let mut most = 0;
    for _ in 0..60 {
        let t = random.real(0.0, topology.triangles.len() as f64) as usize;
        let [a, b, c] = topology.corners(t);
        let (u, v) = (random.real(0.0, 1.0), random.real(0.0, 1.0));
        let p = a + (b - a) * u + (c - a) * v;
        let way = if light.w == 0.0 { -light.truncate().as_dvec3() } else { p - light.truncate().as_dvec3() };
        let far = if light.w == 0.0 { (p + 1e3 * way).extend(1.0) } else { way.extend(0.0) };
        most = most.max(near_count::layers(topology, &weights, light, far) as usize);
    }
    most
}

fn lights(random: &mut Random, round: usize) -> ObjectLight {
    let at = match round % 3 {
        0 => random.vector(1.0).normalize_or(DVec3::X),
        1 => random.vector(6.0),
        // Within the bounds of the mesh, too.
        _ => random.vector(1.0),
    };
    at.extend(if round.is_multiple_of(3) { 0.0 } else { 1.0 }).as_vec4()
}

#[test]
fn no_ray_from_a_ball_crosses_more_layers_than_its_bound() {
    let mut random = Random(3);
    let (mut judged, mut deep) = (0, 0);
    for round in 0..120 {
        let topology = match round / 3 % 3 {
            0 => sheets(40),
            1 => ring(40, 24),
            _ => soup(&mut random),
        };
        let center = lights(&mut random, round);
        let radius = random.real(0.0, 0.2) * random.real(0.0, 1.0);
        let ball = Ball { center, radius };
        let mut castings = Vec::new();
        casting::castings(&topology, center, &mut castings);
        let Some(bound) = ball.most_layers(&topology, &castings) else { continue };
        judged += 1;
        for _ in 0..8 {
            let step = random.vector(1.0).normalize_or(DVec3::X) * radius * random.real(0.0, 0.999_999);
            let light = center + step.extend(0.0).as_vec4();
            assert!(ball.holds(light) || radius < 1e-6);
            let layers = deepest(&topology, &castings, light, &mut random);
            assert!(layers <= bound, "round {round}: {layers} layers from {light}, but {bound} in {ball:?}");
            deep = deep.max(layers);
        }
    }
    assert!(judged > 80 && deep >= 40, "{judged} judged, {deep} layers");
}

/// The negative control: a bound is one of its ball alone.
#[test]
fn lights_out_of_a_ball_may_have_more_layers() {
    let (topology, mut random) = (shingles(60), Random(9));
    let castings = [Casting::Double; 60];
    let ball = Ball { center: Vec4::new(0.5, 0.0, 8.0, 1.0), radius: 0.01 };
    let bound = ball.most_layers(&topology, &castings).unwrap();
    assert!(bound < 20, "{bound}");
    let along = Vec4::new(9.0, 0.0, 0.0, 1.0);
    assert!(!ball.holds(along) && deepest(&topology, &castings, along, &mut random) > 2 * bound);
}

#[test]
fn bounds_are_near_what_they_bound() {
    let lamp = Vec4::new(0.3, 6.0, 0.2, 1.0);
    let bound = |topology: &Topology, center, radius| {
        let mut castings = Vec::new();
        casting::castings(topology, center, &mut castings);
        Ball { center, radius }.most_layers(topology, &castings).unwrap()
    };
    for light in [lamp, Vec4::new(0.1, 0.9, 0.05, 0.0)] {
        let stack = bound(&sheets(100), light, 0.0);
        assert!((100..=130).contains(&stack), "{stack}");
        let [small, large] = [0.001, 0.1].map(|radius| bound(&ring(120, 60), light, radius));
        assert!(small <= large && (4..60).contains(&small) && large < 300, "{small} {large}");
    }
}

#[test]
fn lights_that_may_touch_a_surface_have_no_bound() {
    let topology = sheets(3);
    let bound =
        |y, radius| Ball { center: Vec4::new(0.0, y, 0.0, 1.0), radius }.most_layers(&topology, &[Casting::Double; 3]);
    assert!(bound(0.5, 0.1).is_some());
    assert_eq!(bound(0.5, 0.2), None);
}
