use super::*;
use crate::casting::{castings, weights};
use std::collections::BTreeSet;

/// A wavy sheet with holes and a row of slivers, and a sphere above it.
fn mesh() -> Topology {
    const SIDE: u32 = 60;
    let (mut positions, mut triangles) = (Vec::new(), Vec::new());
    for y in 0..=SIDE {
        for x in 0..=SIDE {
            let [u, v] = [x, y].map(|k| f64::from(k) / f64::from(SIDE));
            let x = if x == 7 { u - 0.999_999_9 / f64::from(SIDE) } else { u };
            positions.push([x as f32, (0.1 * (7.0 * u).sin() * (5.0 * v).cos()) as f32, v as f32]);
        }
    }
    let row = SIDE + 1;
    for q in (0..SIDE * SIDE).filter(|q| q % 97 != 0) {
        let a = q / SIDE * row + q % SIDE;
        triangles.extend([[a, a + row, a + 1], [a + 1, a + row, a + row + 1]]);
    }
    let first = positions.len() as u32;
    for i in 0..=40 {
        for j in 0..40 {
            let (theta, phi) =
                (std::f64::consts::PI * f64::from(i) / 40.0, std::f64::consts::TAU * f64::from(j) / 40.0);
            let p = DVec3::new(theta.sin() * phi.cos(), theta.cos(), theta.sin() * phi.sin()) * 0.3;
            positions.push([0.5 + p.x as f32, 0.8 + p.y as f32, 0.5 + p.z as f32]);
        }
    }
    for (i, j) in (0..40).flat_map(|i| (0..40).map(move |j| (i, j))) {
        let at = |i: u32, j: u32| first + i * 40 + j % 40;
        triangles.extend([[at(i, j), at(i, j + 1), at(i + 1, j)], [at(i, j + 1), at(i + 1, j + 1), at(i + 1, j)]]);
    }
    Topology::new(&positions, &triangles, |_| true).expect("a mesh")
}

/// The light, step by step: smoothly, then anywhere, then into the sphere and to infinity.
fn walk() -> Vec<DVec4> {
    let mut numbers = zfail_testing::Random(3);
    let mut random = || numbers.signed();
    let smooth = (0..60).map(|k| DVec3::new(2.0 - 0.05 * f64::from(k), 1.5, 0.02 * f64::from(k)).extend(1.0));
    let mut walk: Vec<DVec4> = smooth.collect();
    walk.extend((0..60).map(|_| (DVec3::new(random(), random(), random()) * 2.0).extend(1.0)));
    walk.extend((0..20).map(|k| DVec3::new(0.5, 0.8, 0.45 + 0.005 * f64::from(k)).extend(1.0)));
    walk.extend((0..20).map(|_| DVec3::new(random(), random(), random()).normalize().extend(0.0)));
    walk.iter().map(|light| light.as_vec4().as_dvec4()).collect()
}

fn edges(mut each: impl FnMut(&mut dyn FnMut([u32; 2], i32))) -> BTreeSet<([u32; 2], i32)> {
    let mut found = BTreeSet::new();
    each(&mut |edge, m| assert!(found.insert((edge, m)), "{edge:?} comes twice"));
    found
}

#[test]
fn what_cones_decide_is_what_triangles_say() {
    let whole = mesh();
    let topology = if whole.sections().is_empty() { &whole } else { &whole.sections()[0].topology };
    let mut decided = 0.0_f64;
    for topology in whole.sections().iter().map(|s| &s.topology).chain([topology]) {
        let Some(tree) = topology.cones() else { continue };
        let (mut states, mut turned, mut cast) = (Vec::new(), Vec::new(), Vec::new());
        let (mut expected, mut sides) = (Vec::new(), Vec::new());
        for light in walk() {
            castings(topology, light.as_vec4(), &mut sides);
            weights(topology, &sides, light.as_vec4(), &mut expected);
            if cast == sides {
                tree.turn(topology, &cast, light, &mut states, &mut turned);
            } else {
                cast.clone_from(&sides);
                turned.clone_from(&expected);
                tree.look(light, &mut states);
            }
            assert_eq!(turned, expected, "under {light}");
            let mut fresh = Vec::new();
            tree.look(light, &mut fresh);
            assert_eq!(states, fresh, "no memory of lights before {light}");
            let all = edges(|emit| topology.boundary(&expected, emit));
            let few = edges(|emit| topology.silhouette(&turned, Some(&states), emit));
            assert_eq!(all, few, "under {light}");
            let mut looked = 0;
            tree.open_edges(&states, &topology.edges, |_| looked += 1);
            decided = decided.max(1.0 - f64::from(looked) / topology.edges.len() as f64);
        }
        // The comparisons can fail.
        turned[topology.by_part[0] as usize] ^= 1;
        assert_ne!(turned, expected);
        let blind = vec![1; states.len()];
        assert_ne!(
            edges(|emit| topology.boundary(&expected, emit)),
            edges(|emit| topology.silhouette(&expected, Some(&blind), emit))
        );
    }
    assert!(decided > 0.7, "at most {decided} of the edges was decided by cones");
}

#[test]
fn small_and_bending_meshes_have_no_tree() {
    let triangle = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    assert!(Topology::new(&triangle, &[[0, 1, 2]], |_| true).expect("a triangle").cones().is_none());
    let bending = Topology::bending(&triangle, &[[0, 1, 2]; 2000], &[0, 1, 2], |_| true).expect("one that bends");
    assert!(bending.cones().is_none());
}
