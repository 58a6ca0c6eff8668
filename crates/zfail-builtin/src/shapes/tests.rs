//! Each generator of a solid is closed and faces outward; the checks themselves fail on broken meshes.

use super::checks::{collapsed_triangles, repeated_edges, unmatched_edges, volume};
use super::*;
use glam::{DAffine3, DVec2, DVec3};

fn bowl() -> Mesh {
    let mut profile = curve(&[(0.0, 0.0), (0.5, 0.1), (0.8, 0.6)], 6);
    profile.extend(curve(&[(0.75, 0.6), (0.45, 0.15), (0.0, 0.05)], 6));
    lathe(&profile, 31, CREASE)
}

fn pierced_globe() -> Mesh {
    let around = circle(24);
    Slab { wraps: true, ..Slab::new(24, 9) }.mesh(
        |i, j| i % 3 == 0 || j % 4 == 0,
        |i, j| {
            let latitude = DVec2::from_angle(0.2 * j as f64 - 0.9);
            let out = DVec3::new(around[i].x * latitude.x, latitude.y, -around[i].y * latitude.x);
            [out, out * 0.95]
        },
    )
}

fn solids() -> Vec<Mesh> {
    let hall =
        [(0.0, 0.0), (1.0, 0.0), (1.0, 2.0), (2.0, 2.0), (2.0, 0.0), (3.0, 0.0), (3.0, 3.0), (1.5, 3.0), (0.0, 3.0)];
    let mirror = DAffine3::from_scale(DVec3::new(-1.0, 2.0, 0.5));
    vec![
        cuboid(DVec3::new(-1.0, 0.0, -2.0), DVec3::new(1.0, 3.0, 0.1)),
        divided_cuboid(DVec3::new(-1.0, 0.0, -2.0), DVec3::new(1.0, 3.0, 0.1), 7),
        ico_sphere(0.7, 0, false),
        ico_sphere(0.7, 3, true),
        uv_sphere(2.0, 17, 9),
        torus(1.0, 0.3, 29, 13),
        torus_knot([2, 3], 1.0, 0.4, 0.15, 101, 11),
        cylinder(0.5, 2.0, 23),
        cone(0.5, 2.0, 23),
        capsule(DVec3::new(0.1, 0.2, 0.3), 0.2, DVec3::new(1.0, -1.0, 0.4), 0.1, 16),
        capsule(DVec3::ZERO, 0.2, DVec3::NEG_Y, 0.3, 16),
        bowl(),
        ring(&[(1.0, 0.0), (1.2, 0.0), (1.1, 0.4)].map(DVec2::from), 19, CREASE),
        extruded(&hall.map(DVec2::from), 0.4),
        stairs(25, 0.17, 0.3, 2.0),
        pierced_globe(),
        Slab::new(4, 4).mesh(
            |i, j| !(1..3).contains(&i) || !(1..3).contains(&j),
            |i, j| {
                let front = DVec3::new(i as f64, j as f64, 0.2);
                [front, front - DVec3::Z * 0.2]
            },
        ),
        moved(bowl(), &mirror),
    ]
}

#[test]
fn solids_are_closed_manifolds_and_face_outward() {
    for mesh in solids() {
        assert_eq!(unmatched_edges(&mesh), 0, "{} is open", mesh.name);
        assert_eq!(repeated_edges(&mesh), 0, "{} is not a manifold", mesh.name);
        assert_eq!(collapsed_triangles(&mesh), 0, "{}", mesh.name);
        assert!(volume(&mesh) > 0.0, "{} is inside out", mesh.name);
    }
}

#[test]
fn normals_point_to_the_front_of_their_triangles() {
    for mesh in solids() {
        for t in &mesh.triangles {
            let [a, b, c] = t.map(|v| mesh.position(v));
            let face = (b - a).cross(c - a);
            for &v in t {
                let normal = glam::Vec3::from_array(mesh.normals[v as usize]).as_dvec3();
                assert!((normal.length() - 1.0).abs() < 1e-6, "{}", mesh.name);
                assert!(normal.dot(face) > 0.0, "{}: {normal} against {face}", mesh.name);
            }
        }
    }
}

#[test]
fn volumes_approach_the_known_ones() {
    let pi = std::f64::consts::PI;
    let close = |mesh: Mesh, expected: f64| {
        let got = volume(&mesh);
        assert!((got / expected - 1.0).abs() < 0.01, "{}: {got} instead of {expected}", mesh.name);
    };
    close(cuboid(DVec3::ZERO, DVec3::new(1.0, 2.0, 3.0)), 6.0);
    close(divided_cuboid(DVec3::ZERO, DVec3::new(1.0, 2.0, 3.0), 5), 6.0);
    close(uv_sphere(2.0, 96, 48), pi * 32.0 / 3.0);
    close(ico_sphere(2.0, 4, true), pi * 32.0 / 3.0);
    close(torus(2.0, 0.5, 96, 48), pi * pi);
    close(capsule(DVec3::ZERO, 0.5, DVec3::X, 0.5, 96), pi * (0.25 + 4.0 / 3.0 * 0.125));
    close(stairs(3, 1.0, 1.0, 2.0), 12.0);
}

#[test]
fn smooth_bodies_share_vertices_and_boxes_do_not() {
    assert_eq!(cuboid(DVec3::ZERO, DVec3::ONE).positions.len(), 24);
    assert_eq!(ico_sphere(1.0, 0, false).positions.len(), 60);
    assert_eq!(torus_knot([2, 3], 1.0, 0.4, 0.1, 50, 8).normals.len(), 51 * 9);
}

#[test]
fn checks_catch_holes_repetitions_and_inversion() {
    let mut holed = bowl();
    holed.triangles.pop();
    assert_eq!(unmatched_edges(&holed), 3);
    let twice = merged("twice", [bowl(), bowl()]);
    assert!(repeated_edges(&twice) > 0);
    let mut pinched = bowl();
    pinched.triangles[3][0] = pinched.triangles[3][1];
    assert_eq!(collapsed_triangles(&pinched), 1);
    let mut inverted = bowl();
    for t in &mut inverted.triangles {
        t.swap(0, 1);
    }
    assert!(volume(&inverted) < 0.0);
}
