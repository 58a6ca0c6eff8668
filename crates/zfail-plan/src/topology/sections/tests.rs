use super::*;
use crate::topology::Blocking;
use std::collections::BTreeSet;

/// Boxes of 12 triangles in a row along x, two fins on one edge of each, and behind each a card that does not cast.
fn row(boxes: usize) -> Topology {
    let (mut positions, mut triangles) = (Vec::new(), Vec::new());
    let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    // Every other one first, so that neighbours are not neighbours in the list.
    for b in (0..boxes).step_by(2).chain((1..boxes).step_by(2)) {
        let first = positions.len() as u32;
        let corner = |i: u32| [i & 1, i >> 1 & 1, i >> 2 & 1].map(|bit| bit as f32);
        positions.extend((0..8).map(corner).map(|[x, y, z]| [x + 2.0 * b as f32, y, z]));
        positions.extend([[2.0 * b as f32, 3.0, 0.0], [2.0 * b as f32, 4.0, 1.0]]);
        triangles.extend(quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).map(|t| t.map(|v| v + first)));
        triangles.extend([[2, 3, 8], [3, 2, 9], [3, 8, 2], [8, 9, 0]].map(|t| t.map(|v| v + first)));
    }
    Topology::new(&positions, &triangles, |t| if t % 16 == 15 { Blocking::Nothing } else { Blocking::BothSides })
        .expect("a row of boxes")
}

#[test]
fn sections_are_the_mesh_in_pieces() {
    let whole = row(100);
    let sections = whole.sections();
    assert!((8..=24).contains(&sections.len()), "{} sections", sections.len());
    let (mut triangles, mut sides, mut parts, mut twins) = (0, 0, 0, 0);
    for section in sections {
        let topology = &section.topology;
        let bounds = topology.bounds();
        assert!(bounds.half().x < 17.0, "neighbours are together: {bounds:?}");
        assert!(topology.sections().is_empty() && topology.convex().is_none());
        for v in 0..topology.positions().len() as u32 {
            assert_eq!(topology.position(v), whole.position(v + section.first_vertex));
        }
        for (t, &part) in topology.part_of().iter().enumerate() {
            assert!(topology.triangles_of(part as usize).contains(&(t as u32)));
        }
        triangles += topology.triangles().len();
        sides += topology.edge_counts().iter().sum::<usize>();
        parts += topology.parts().len();
        twins += topology.twins().len();
    }
    assert_eq!(triangles, 1500);
    assert_eq!(sides, whole.edge_counts().iter().sum::<usize>());
    assert_eq!((parts, twins), (whole.parts().len(), whole.twins().len()));
    assert_eq!(twins, 100);
}

#[test]
fn the_boundary_of_sections_is_that_of_the_whole() {
    let whole = row(60);
    // Some weight or other for every place in the world.
    let weight = |topology: &Topology, t: usize| {
        let [a, b, c] = topology.corners(t);
        let sum = (a + b * 3.0 + c * 5.0).dot(DVec3::new(7.0, 11.0, 13.0));
        (sum as i64).rem_euclid(3) as i8 - 1
    };
    let casting = |topology: &Topology, t: usize| topology.part_of()[t] != NONE;
    let weights = |topology: &Topology| -> Vec<i8> {
        let all = 0..topology.triangles().len();
        all.map(|t| if casting(topology, t) { weight(topology, t) } else { 0 }).collect()
    };
    let mut expected = BTreeSet::new();
    whole.boundary(&weights(&whole), |edge, m| assert!(expected.insert((edge, m))));
    let mut found = BTreeSet::new();
    for Section { topology, first_vertex } in whole.sections() {
        topology.boundary(&weights(topology), |edge, m| assert!(found.insert((edge.map(|v| v + first_vertex), m))));
    }
    assert!(expected.len() > 500);
    assert_eq!(found, expected);
    found.pop_first();
    assert_ne!(found, expected, "the comparison can fail");
}

#[test]
fn small_meshes_and_whole_ones_have_no_sections() {
    assert!(row(8).sections().is_empty(), "120 triangles");
    let points: Vec<[f32; 3]> = (0..400_u16).map(|i| [f32::from(i / 2), f32::from(i % 2), 0.0]).collect();
    let strip: Vec<[u32; 3]> =
        (0..398).map(|i| if i % 2 == 0 { [i, i + 1, i + 2] } else { [i + 1, i, i + 2] }).collect();
    assert!(Topology::new(&points, &strip, |_| true).expect("a strip").sections().is_empty());
}
