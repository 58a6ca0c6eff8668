//! The volume is closed for any mesh, any light and any integer weights, and counts what it should.

use crate::shapes;
use glam::{DVec3, DVec4, Vec4};
use proptest::prelude::*;
use zfail_plan::casting::{self, Casting};
use zfail_plan::closure::{of_weights, open_edges};
use zfail_plan::topology::Topology;
use zfail_plan::volume::{self, Volume};

/// Signed crossings of the drawn volume by the ray from `from` along `along`: an independent count in f64.
fn crossings(topology: &Topology, indices: &[u32], volume: &Volume, light: Vec4, from: DVec3, along: DVec3) -> i32 {
    let light = light.as_dvec4();
    let place = |i: u32| {
        let v = topology.position(i >> 1);
        if i & 1 == 0 { v.extend(1.0) } else { (v * light.w - light.truncate()).extend(0.0) }
    };
    // In homogeneous coordinates, relative to the ray's start: inside the triangle iff `along` is a positive
    // combination of the three (x, y, z) parts with a positive total w.
    let hit = |t: &[u32]| {
        let h: Vec<DVec4> = t.iter().map(|&i| place(i)).collect();
        let d: Vec<DVec3> = h.iter().map(|p| p.truncate() - from * p.w).collect();
        let det = d[0].dot(d[1].cross(d[2]));
        let a = [d[1].cross(d[2]), d[2].cross(d[0]), d[0].cross(d[1])].map(|n| n.dot(along) / det);
        if a.iter().any(|&x| x <= 0.0 || !x.is_finite()) {
            return 0;
        }
        // Leaving through the outside counts +1.
        if det > 0.0 { -1 } else { 1 }
    };
    let slice = |r: &std::ops::Range<u32>| &indices[r.start as usize..r.end as usize];
    -slice(&volume.outward()).chunks(3).map(&hit).sum::<i32>()
        + slice(&volume.light_cap_reversed).chunks(3).map(&hit).sum::<i32>()
}

fn layers(topology: &Topology, c: &[i8], light: Vec4, to: DVec3) -> i32 {
    let light = light.as_dvec4();
    let mut count = 0;
    for (t, &weight) in c.iter().enumerate().filter(|&(_, &c)| c != 0) {
        let [p, q, r] = topology.corners(t).map(|v| v - to);
        let along = light.truncate() - to * light.w;
        let det = p.dot(q.cross(r));
        let a = [q.cross(r), r.cross(p), p.cross(q)].map(|n| n.dot(along) / det);
        // Within the triangle, and between the point and the light: the weights of the corners sum to 1/distance.
        let sum: f64 = a.iter().sum();
        if a.iter().all(|&x| x > 0.0) && (light.w == 0.0 || sum > 1.0) {
            count += i32::from(weight) * i32::from(casting::facing(topology.corners(t), light));
        }
    }
    count
}

prop_compose! {
    fn soup()(
        points in prop::collection::vec(prop::array::uniform3(-8_i8..8), 3..12),
        raw in prop::collection::vec(prop::array::uniform3(0_usize..64), 1..40),
    ) -> shapes::Soup {
        let n = points.len();
        let positions = points.into_iter().map(|p| p.map(f32::from)).collect();
        let triangles = raw.into_iter().map(|t| t.map(|v| (v % n) as u32)).collect();
        (positions, triangles)
    }
}

prop_compose! {
    fn light()(p in prop::array::uniform3(-10_i8..10), directional: bool) -> Vec4 {
        let [x, y, z] = p.map(f32::from);
        // A direction of zero is no light.
        if directional { Vec4::new(x, y + 0.5, z, 0.0) } else { Vec4::new(x, y, z, 1.0) }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, rng_seed: proptest::test_runner::RngSeed::Fixed(7), ..Default::default() })]

    #[test]
    fn any_soup_is_closed_under_every_casting((positions, triangles) in soup(), light in light()) {
        let topology = Topology::new(&positions, &triangles, |_| true).unwrap();
        for rule in [Casting::Front, Casting::Back, Casting::Double] {
            let mut c = Vec::new();
            casting::weights(&topology, &vec![rule; topology.parts().len()], light, &mut c);
            let mut indices = Vec::new();
            let volume = volume::build(&topology, &c, &c, light.w == 0.0, &mut indices);
            prop_assert_eq!(open_edges(&indices, &volume, light.w == 0.0), 0);
            prop_assert_eq!(of_weights(&topology, &c, light.w == 0.0).open_edges, 0);
        }
    }

    #[test]
    fn any_soup_is_closed_under_random_weights((positions, triangles) in soup(), weights in prop::collection::vec(-1_i8..2, 40)) {
        let topology = Topology::new(&positions, &triangles, |_| true).unwrap();
        let degenerate = |t: &[u32; 3]| t[0] == t[1] || t[1] == t[2] || t[2] == t[0];
        let c: Vec<i8> = topology.triangles().iter().zip(weights).map(|(t, c)| if degenerate(t) { 0 } else { c }).collect();
        let mut indices = Vec::new();
        let volume = volume::build(&topology, &c, &c, false, &mut indices);
        prop_assert_eq!(open_edges(&indices, &volume, false), 0);
        prop_assert_eq!(of_weights(&topology, &c, false).open_edges, 0);
        // Negative control: without one drawn triangle it is open.
        if volume.sides.end > volume.sides.start {
            let broken = Volume { sides: volume.sides.start + 3..volume.sides.end, ..volume };
            prop_assert_ne!(open_edges(&indices, &broken, false), 0);
        }
    }

    #[test]
    fn the_count_is_the_number_of_triangles_in_the_way(
        (positions, triangles) in soup(),
        light in light(),
        at in prop::array::uniform3(-9.0_f64..9.0),
        along in prop::array::uniform3(-1.0_f64..1.0),
    ) {
        let topology = Topology::new(&positions, &triangles, |_| true).unwrap();
        let (at, along) = (DVec3::from(at), DVec3::from(along));
        prop_assume!(along.length() > 0.1);
        for rule in [Casting::Front, Casting::Back, Casting::Double] {
            let mut c = Vec::new();
            casting::weights(&topology, &vec![rule; topology.parts().len()], light, &mut c);
            let mut indices = Vec::new();
            let volume = volume::build(&topology, &c, &c, light.w == 0.0, &mut indices);
            let expected = layers(&topology, &c, light, at);
            prop_assert_eq!(crossings(&topology, &indices, &volume, light, at, along), expected);
            prop_assert!(expected >= 0);
        }
    }
}

#[test]
fn twins_cast_in_the_order_of_the_visible_one() {
    // A sheet with a back: the same triangle twice, wound against itself and starting elsewhere, and once more.
    let positions = [[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [0.0, 2.0, 0.0]];
    let topology = Topology::new(&positions, &[[0, 1, 2], [0, 2, 1], [1, 2, 0]], |_| true).unwrap();
    assert_eq!(topology.twins(), [[0, 1, 2]]);
    let light = Vec4::new(0.5, 0.5, 3.0, 1.0);
    let mut c = Vec::new();
    casting::weights(&topology, &[Casting::Double], light, &mut c);
    assert_eq!(c, [1, -1, 1]);
    for (eye_z, expected) in [(4.0, [3, 0, 0]), (-4.0, [0, -3, 0])] {
        let (mut visible, mut cap) = (Vec::new(), Vec::new());
        volume::visible_twins(&topology, DVec4::new(0.3, 0.4, eye_z, 1.0), &mut visible);
        volume::cap_weights(&topology, &c, &visible, &mut cap);
        assert_eq!(cap, expected);
        let mut indices = Vec::new();
        let volume = volume::build(&topology, &c, &cap, false, &mut indices);
        assert_eq!(open_edges(&indices, &volume, false), 0);
        assert_eq!(volume.triangles(), [18, 3, 3]);
    }
}

#[test]
fn single_and_double_weights_agree_on_what_is_dark() {
    for (soup, inside) in
        [(shapes::torus(16, 8, 0.4), false), (shapes::torus(16, 8, 0.4), true), (shapes::cube(), true)]
    {
        for soup in [soup.clone(), shapes::inverted(soup)] {
            let topology = Topology::new(&soup.0, &soup.1, |_| true).unwrap();
            let light = if inside { Vec4::new(0.95, 0.05, 0.02, 1.0) } else { Vec4::new(0.1, 0.2, 0.05, 1.0) };
            let mut rules = Vec::new();
            casting::castings(&topology, light, &mut rules);
            assert_ne!(rules[0], Casting::Double);
            let (mut single, mut double) = (Vec::new(), Vec::new());
            casting::weights(&topology, &rules, light, &mut single);
            casting::weights(&topology, &[Casting::Double], light, &mut double);
            let mut dark = 0;
            for i in 0..4000_u32 {
                let hash =
                    |k: u32| f64::from(i.wrapping_mul(k).wrapping_mul(2_654_435_761) >> 8 & 0xffff) / 32768.0 - 1.0;
                let p = DVec3::new(hash(1), hash(7), hash(131)) * 2.0;
                let (s, d) = (layers(&topology, &single, light, p), layers(&topology, &double, light, p));
                assert_eq!(s > 0, d > 0, "{p}: single {s}, double {d}");
                dark += usize::from(d > 0);
            }
            assert!(dark > 100, "the test sees shadow");
        }
    }
}
