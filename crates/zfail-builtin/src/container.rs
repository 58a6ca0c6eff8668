//! A light inside an open, pierced container close to the eye (E&K Figures 2 and 3).

use glam::{DVec2, DVec3};
use std::f64::consts::TAU;
use zfail_scene::{Mesh, Scene};

use super::builder::{SceneBuilder, at};
use super::shapes::{Slab, ico_sphere, merged, moved, torus, torus_knot};
use super::{pattern, props};

pub(super) fn scene() -> Scene {
    let mut b = SceneBuilder::new("container", [0.012, 0.016, 0.028], [0.01, 0.012, 0.02]);
    let floor = b.textured(pattern::planks("planks", 6, 0xa9805a, 0x4b3524), 1.2, 0.45);
    let plaster = b.textured(pattern::stone("plaster", 0xcfc4b4, 0.12), 2.0, 0.9);
    b.block("floor", [-3.0, -0.2, -2.0], [2.0, 0.0, 4.0], floor);
    b.block("back wall", [-3.0, -0.2, -2.2], [2.2, 3.0, -2.0], plaster);
    b.block("side wall", [2.0, -0.2, -2.1], [2.2, 3.0, 4.0], plaster);

    let green = b.matte("green glaze", 0x4fae63, 0.3);
    b.add("container", container(), green, at(0.0, 0.0, 0.0, 0.0));
    b.bulb("light", DVec3::new(0.03, 0.45, -0.02), 0.035, 0xffc98a, 8.0);
    b.point("window", DVec3::new(-2.6, 2.6, 2.4), 0x8fb0ff, 7.0);

    let red = b.matte("red", 0xb5443a, 0.4);
    let blue = b.matte("blue", 0x5f8cc9, 0.4);
    let ivory = b.matte("ivory", 0xe6dcc8, 0.5);
    b.add("ball", ico_sphere(0.2, 4, true), red, at(0.95, 0.2, -0.2, 0.0));
    b.add("vase", props::vase(0.8), blue, at(-0.75, 0.0, -1.15, 0.0));
    b.add("knot", torus_knot([2, 3], 0.2, 0.085, 0.045, 160, 16), ivory, at(1.25, 0.28, -1.25, 20.0));
    b.camera("camera", DVec3::new(-0.5, 0.86, 1.1), DVec3::new(0.24, 0.47, -0.4), 58.0);
    b.finish()
}

/// A spherical pot whose wall is a twisted lattice, on a ring.
fn container() -> Mesh {
    const COLUMNS: usize = 112;
    const ROWS: usize = 32;
    let pot = Slab { wraps: true, ..Slab::new(COLUMNS, ROWS) }.mesh(
        |i, j| i % 7 < 3 || !(4..ROWS - 3).contains(&j) || (j - 4) % 5 < 1,
        |i, j| {
            let height = j as f64 / ROWS as f64;
            let around = DVec2::from_angle(TAU * i as f64 / COLUMNS as f64 + 1.1 * height);
            let latitude = DVec2::from_angle(-1.35 + 2.15 * height);
            let out = DVec3::new(around.x * latitude.x, latitude.y, -around.y * latitude.x);
            [0.4, 0.38].map(|radius| out * radius + DVec3::Y * 0.44)
        },
    );
    let foot = moved(torus(0.16, 0.035, 48, 14), &at(0.0, 0.035, 0.0, 0.0));
    merged("container", [pot, foot])
}
