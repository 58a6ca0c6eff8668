//! Meshes that the papers exclude: open, non-manifold, inside out, self-intersecting, inconsistently wound, with
//! duplicated and degenerate triangles, mirrored and sheared.

use glam::{DAffine3, DMat3, DVec2, DVec3};
use std::f64::consts::{PI, TAU};
use zfail_scene::{Mesh, Scene};

use super::builder::{SceneBuilder, at};
use super::shapes::{CREASE, Facets, cylinder, ico_sphere, lathe, painted, sheet, stairs, torus_knot};
use super::{pattern, props};

pub(super) fn scene() -> Scene {
    let mut b = SceneBuilder::new("open", [0.035, 0.04, 0.055], [0.02, 0.025, 0.035]);
    let floor = b.textured(pattern::planks("floor", 6, 0x9d8468, 0x3c3026), 1.6, 0.5);
    let wall = b.textured(pattern::stone("wall", 0xa7b0b8, 0.1), 2.0, 0.9);
    let here = DAffine3::IDENTITY;
    b.block("floor", [-8.0, -0.3, -2.6], [8.0, 0.0, 4.5], floor);
    // One sheet without thickness, as walls of game levels are.
    b.add("wall", sheet(1, 1, |i, j| DVec3::new(16.0 * i as f64 - 8.0, 5.0 * j as f64, -2.6)), wall, here);

    let pale = b.matte("plinth", 0xd9d4ca, 0.7);
    let plinth = b.mesh("plinth", painted(cylinder(0.42, 0.5, 40), pale));
    for (k, (name, color, mesh)) in exhibits().into_iter().enumerate() {
        let (row, place) = (k / 5, k % 5);
        let x = 1.25 * (place as f64 - 2.0) + 0.3 * row as f64 - 0.15;
        let z = 1.5 * row as f64 - 1.0;
        b.place(&format!("plinth {k}"), plinth, at(x, 0.0, z, 0.0));
        let paint = b.matte(name, color, 0.45);
        let paint = b.double_sided(paint);
        b.add(name, mesh, paint, at(x, 0.52, z, 0.0));
    }

    // One mesh placed as it is, mirrored and sheared.
    let rust = b.matte("steps", 0xb5613f, 0.5);
    let steps = b.mesh("steps", painted(stairs(5, 0.1, 0.1, 0.3), rust));
    let shear = DMat3::from_cols(DVec3::X, DVec3::new(0.45, 1.0, -0.2), DVec3::Z);
    let variants = [
        ("steps", DMat3::IDENTITY),
        ("mirrored steps", DMat3::from_diagonal(DVec3::new(1.3, 1.0, -1.0))),
        ("sheared steps", shear),
    ];
    for (k, (name, matrix3)) in variants.into_iter().enumerate() {
        let stand = at(1.25 * (k as f64 - 1.0) - 0.2, 0.0, 2.1, 55.0);
        b.place(name, steps, stand * DAffine3::from_mat3(matrix3));
    }

    b.bulb("warm light", DVec3::new(-2.6, 2.9, 2.4), 0.06, 0xffd3a0, 34.0);
    b.bulb("cool light", DVec3::new(2.9, 2.3, 1.9), 0.06, 0x8fb8ff, 17.0);
    b.camera("camera", DVec3::new(1.1, 2.9, 5.6), DVec3::new(0.08, 0.42, 0.25), 38.0);
    b.finish()
}

/// Name, colour and mesh, about 0.7 m in size, standing on y = 0.
fn exhibits() -> Vec<(&'static str, u32, Mesh)> {
    let arc: Vec<DVec2> =
        (0..=10).map(|k| DVec2::from_angle(PI * (f64::from(k) / 20.0 - 0.5)) * 0.33 + DVec2::Y * 0.33).collect();
    let open_bowl = lathe(&[&[DVec2::ZERO], &arc[1..]].concat(), 40, CREASE);
    let knot = torus_knot([3, 4], 0.2, 0.12, 0.085, 200, 16);
    let knot = super::shapes::moved(knot, &DAffine3::from_translation(DVec3::Y * 0.42));
    vec![
        ("open bowl", 0xd0814a, open_bowl),
        ("single sheet", 0xc9483d, flag()),
        ("fins", 0xe0b13f, fins()),
        ("inside-out box", 0x5b86b5, flipped(props::block(DVec3::splat(0.5)), |_| true)),
        ("self-intersecting knot", 0x8e6bb0, knot),
        ("moebius strip", 0x3f9c8f, moebius()),
        ("duplicated and degenerate", 0x9aa33f, damaged()),
        ("inconsistent winding", 0xc46a8a, flipped(ball(), |t| t % 3 == 0)),
        ("curl", 0x4f9d5b, curl()),
        ("pierced ball", 0xd9d0bd, pierced()),
    ]
}

fn ball() -> Mesh {
    super::shapes::moved(ico_sphere(0.3, 2, false), &DAffine3::from_translation(DVec3::Y * 0.3))
}

/// `mesh` with the winding of some triangles turned.
fn flipped(mut mesh: Mesh, which: impl Fn(usize) -> bool) -> Mesh {
    for (t, triangle) in mesh.triangles.iter_mut().enumerate() {
        if which(t) {
            triangle.swap(0, 1);
        }
    }
    mesh
}

/// A flag in the wind.
fn flag() -> Mesh {
    sheet(14, 8, |i, j| {
        let (x, y) = (0.05 * f64::from(i as u32) - 0.35, 0.06 * f64::from(j as u32) + 0.12);
        DVec3::new(x, y, 0.07 * (9.0 * x + 2.0 * y).sin())
    })
}

/// Five sheets on one edge.
fn fins() -> Mesh {
    let mut facets = Facets::default();
    for (out, _) in props::around(5) {
        facets.triangle([DVec3::ZERO, out * 0.34 + DVec3::Y * 0.12, DVec3::Y * 0.66]);
        facets.triangle([DVec3::Y * 0.66, out * 0.34 + DVec3::Y * 0.12, out * 0.26 + DVec3::Y * 0.5]);
    }
    facets.mesh("fins", 0.0)
}

/// A strip with one side and one edge: no consistent winding exists.
fn moebius() -> Mesh {
    const STEPS: usize = 64;
    let point = |i: usize, across: f64| {
        // After one turn the strip comes back upside down, with the same positions bit for bit.
        let across = if i < STEPS { across } else { -across };
        let turn = TAU * (i % STEPS) as f64 / STEPS as f64;
        let out = DVec3::new(turn.cos(), turn.sin(), 0.0);
        DVec3::Y * 0.36 + out * 0.25 + (out * (0.5 * turn).cos() + DVec3::Z * (0.5 * turn).sin()) * across
    };
    sheet(STEPS, 4, |i, j| point(i, 0.05 * (j as f64 - 2.0)))
}

/// A ball with doubled triangles, triangles without area and one triangle missing.
fn damaged() -> Mesh {
    let mut mesh = ball();
    mesh.triangles.remove(7);
    let doubled: Vec<[u32; 3]> = mesh.triangles.iter().copied().step_by(4).collect();
    let collapsed = mesh.triangles.iter().step_by(9).map(|&[a, b, _]| [a, b, b]).collect::<Vec<_>>();
    mesh.triangles.extend(doubled);
    mesh.triangles.extend(collapsed);
    mesh.primitives[0].triangles.end = mesh.triangles.len() as u32;
    mesh
}

/// A rolled-up sheet.
fn curl() -> Mesh {
    sheet(60, 1, |i, j| {
        let turn = f64::from(i as u32) / 60.0 * 2.2 * TAU;
        let radius = 0.06 + 0.02 * turn;
        DVec3::new(radius * turn.cos(), 0.04 + 0.6 * j as f64, radius * turn.sin())
    })
}

/// A faceted ball with every fourth triangle left out.
fn pierced() -> Mesh {
    let mut mesh = ball();
    mesh.triangles = mesh.triangles.into_iter().enumerate().filter(|(t, _)| t % 4 != 3).map(|(_, t)| t).collect();
    mesh.primitives[0].triangles.end = mesh.triangles.len() as u32;
    mesh
}
