//! Topology on meshes small enough to know the answer.

use crate::shapes::{Soup, cube, inverted, joined, torus};
use glam::DVec3;
use zfail_plan::topology::{Shape, Topology, TopologyError};

fn topology((positions, triangles): &Soup) -> Topology {
    Topology::new(positions, triangles, |_| true).expect("valid mesh")
}

fn only_shape(soup: &Soup) -> Shape {
    let t = topology(soup);
    assert_eq!(t.parts().len(), 1, "one part expected");
    t.parts()[0].shape
}

#[test]
fn closed_embedded_surfaces_are_solids_with_the_side_they_face() {
    assert_eq!(only_shape(&cube()), Shape::Solid { inside: 1 });
    assert_eq!(only_shape(&inverted(cube())), Shape::Solid { inside: -1 });
    assert_eq!(only_shape(&torus(24, 12, 0.4)), Shape::Solid { inside: 1 });
    assert_eq!(only_shape(&inverted(torus(24, 12, 0.4))), Shape::Solid { inside: -1 });
}

#[test]
fn an_unwelded_cube_is_closed_after_the_weld() {
    let (positions, triangles) = cube();
    let loose: Vec<[f32; 3]> = triangles.iter().flatten().map(|&v| positions[v as usize]).collect();
    let indices: Vec<[u32; 3]> = (0..12).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect();
    assert_eq!(only_shape(&(loose, indices)), Shape::Solid { inside: 1 });
}

#[test]
fn signed_zeros_weld() {
    let (mut positions, triangles) = cube();
    positions.iter_mut().flatten().for_each(|x| *x = (*x + 1.0) * 0.5);
    let mut loose: Vec<[f32; 3]> = triangles.iter().flatten().map(|&v| positions[v as usize]).collect();
    for (i, x) in loose.iter_mut().flatten().enumerate() {
        if *x == 0.0 && i % 2 == 0 {
            *x = -0.0;
        }
    }
    let indices: Vec<[u32; 3]> = (0..12).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect();
    assert_eq!(topology(&(loose, indices)).positions().len(), 8);
}

#[test]
fn a_torus_too_thick_for_its_hole_meets_itself() {
    assert_eq!(only_shape(&torus(24, 12, 1.3)), Shape::SelfIntersecting);
}

#[test]
fn a_missing_triangle_opens_a_part_and_leaves_its_neighbour_closed() {
    let mut soup = joined(cube(), cube(), [5.0, 0.0, 0.0]);
    soup.1.remove(3);
    let shapes: Vec<Shape> = topology(&soup).parts().iter().map(|p| p.shape).collect();
    assert_eq!(shapes, [Shape::Open, Shape::Solid { inside: 1 }]);
}

#[test]
fn one_flipped_triangle_unbalances_its_part() {
    let mut soup = cube();
    soup.1[0].swap(1, 2);
    assert_eq!(only_shape(&soup), Shape::Open);
}

#[test]
fn cubes_that_share_an_edge_are_one_balanced_part() {
    let t = topology(&joined(cube(), cube(), [2.0, 2.0, 0.0]));
    assert_eq!(t.parts().len(), 1);
    assert_eq!(t.parts()[0].shape, Shape::Solid { inside: 1 });
    assert_eq!(t.edge_counts(), [0, 34, 1]);
}

#[test]
fn a_fin_is_a_fan_of_three() {
    let mut soup = cube();
    soup.0.push([0.0, 3.0, 3.0]);
    soup.1.push([2, 6, 8]);
    let t = topology(&soup);
    assert_eq!(t.edge_counts(), [2, 17, 1]);
    assert_eq!(t.parts()[0].shape, Shape::Open);
}

#[test]
fn degenerate_triangles_and_duplicates_do_no_harm() {
    let mut soup = cube();
    soup.1.push([0, 0, 3]);
    soup.1.push([1, 1, 1]);
    assert_eq!(only_shape(&soup), Shape::Solid { inside: 1 });
    soup.1.push(soup.1[4]);
    assert_ne!(only_shape(&soup), Shape::Solid { inside: 1 });
}

#[test]
fn a_finely_divided_flat_side_is_still_embedded() {
    let n = 6_u32;
    let mut positions = Vec::new();
    let mut triangles = Vec::new();
    for (axis, flip) in [(0, false), (0, true), (1, false), (1, true), (2, false), (2, true)] {
        let base = positions.len() as u32;
        for i in 0..=n {
            for j in 0..=n {
                let mut p = [0.0; 3];
                p[axis] = if flip { n as f32 } else { 0.0 };
                p[(axis + 1) % 3] = i as f32;
                p[(axis + 2) % 3] = j as f32;
                positions.push(p);
            }
        }
        for i in 0..n {
            for j in 0..n {
                let v = |i: u32, j: u32| base + i * (n + 1) + j;
                let (a, b, c, d) = (v(i, j), v(i + 1, j), v(i + 1, j + 1), v(i, j + 1));
                let quads = if flip { [[a, b, c], [a, c, d]] } else { [[a, c, b], [a, d, c]] };
                triangles.extend(quads);
            }
        }
    }
    assert_eq!(only_shape(&(positions, triangles)), Shape::Solid { inside: 1 });
}

#[test]
fn winding_numbers_tell_inside_from_outside_and_refuse_the_surface() {
    let t = topology(&torus(32, 16, 0.4));
    assert_eq!(t.winding_number(0, DVec3::new(1.0, 0.0, 0.0)), Some(1));
    assert_eq!(t.winding_number(0, DVec3::ZERO), Some(0));
    assert_eq!(t.winding_number(0, DVec3::new(9.0, 0.0, 0.0)), Some(0));
    let on_surface = t.corners(0).into_iter().sum::<DVec3>() / 3.0;
    assert_eq!(t.winding_number(0, on_surface), None);
    let inside_out = topology(&inverted(torus(32, 16, 0.4)));
    assert_eq!(inside_out.winding_number(0, DVec3::new(1.0, 0.0, 0.0)), Some(-1));
}

#[test]
fn bad_input_is_named() {
    let (positions, mut triangles) = cube();
    triangles[5][1] = 8;
    let error = Topology::new(&positions, &triangles, |_| true).expect_err("index 8 of 8");
    assert_eq!(error, TopologyError::IndexOutOfRange { triangle: 5, vertex: 8, vertices: 8 });
    let (mut positions, triangles) = cube();
    positions[2][1] = f32::NAN;
    let error = Topology::new(&positions, &triangles, |_| true).expect_err("NaN");
    assert_eq!(error, TopologyError::NotFinite { vertex: 2 });
}

#[test]
fn an_empty_mesh_is_no_error() {
    assert!(topology(&(Vec::new(), Vec::new())).parts().is_empty());
}

/// A tetrahedron with every corner of every triangle a vertex of its own, and which of them are alike.
fn loose_tetrahedron() -> (Soup, Vec<u32>) {
    let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let alike: Vec<u32> = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]].concat();
    let positions = alike.iter().map(|&v| corners[v as usize]).collect();
    ((positions, (0..4).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect()), alike)
}

#[test]
fn a_mesh_that_bends_keeps_its_incidence() {
    let ((mut positions, triangles), alike) = loose_tetrahedron();
    let mut t = Topology::bending(&positions, &triangles, &alike, |_| true).expect("valid mesh");
    assert_eq!((t.positions().len(), t.edge_counts()), (4, [0, 6, 0]));
    assert_eq!(t.parts()[0].shape, Shape::Bending, "nothing is proved of other poses");
    // Two corners meet: in a rigid mesh they would become one.
    for (p, _) in positions.iter_mut().zip(&alike).filter(|(_, v)| **v == 3) {
        *p = [1.0, 0.0, -0.0];
    }
    assert_eq!(t.move_vertices(&positions), Ok(true));
    assert_eq!(t.move_vertices(&positions), Ok(false), "it is there already");
    assert_eq!((t.positions().len(), t.edge_counts()), (4, [0, 6, 0]));
    assert_eq!(t.bounds().max, [1.0, 1.0, 0.0].into());
    assert_eq!(t.parts()[0].bounds.max, t.bounds().max);
    let rigid = topology(&(positions, triangles));
    assert_eq!(rigid.positions().len(), 3);
}

#[test]
fn vertices_that_only_meet_are_not_welded_in_a_mesh_that_bends() {
    let ((positions, triangles), mut alike) = loose_tetrahedron();
    alike[0] = 9;
    let t = Topology::bending(&positions, &triangles, &alike, |_| true).expect("valid mesh");
    assert_eq!((t.positions().len(), t.parts()[0].shape), (5, Shape::Open));
}

#[test]
fn faulty_moves_are_refused_and_change_nothing() {
    let ((positions, triangles), alike) = loose_tetrahedron();
    assert!(Topology::bending(&positions, &triangles, &alike[1..], |_| true).is_err());
    let mut t = Topology::bending(&positions, &triangles, &alike, |_| true).expect("valid mesh");
    let mut broken = positions.clone();
    broken[5][1] = f32::NAN;
    assert_eq!(t.move_vertices(&broken), Err(TopologyError::NotFinite { vertex: 5 }));
    assert!(matches!(t.move_vertices(&positions[1..]), Err(TopologyError::WrongLength { vertices: 12, found: 11 })));
    assert_eq!(t.move_vertices(&positions), Ok(false));
    let mut rigid = topology(&(positions.clone(), triangles));
    assert_eq!(rigid.move_vertices(&positions), Err(TopologyError::Rigid));
}
