//! A light inside an open, pierced container close to the eye (E&K Figures 2 and 3).

use glam::{DVec2, DVec3};
use std::f64::consts::TAU;
use zfail_plan::scene::{Mesh, Scene};

use super::builder::{SceneBuilder, at};
use super::shapes::{Slab, cuboid, ico_sphere, merged, torus, torus_knot};
use super::{pattern, props};

pub(super) fn scene() -> Scene {
    let mut b = SceneBuilder::new("container", [0.022, 0.028, 0.045], [0.01, 0.012, 0.02]);

    let floor = b.textured(pattern::planks("planks", 6, 0xa9805a, 0x2b1c12), 1.2, 0.45);
    let plaster = b.textured(pattern::stone("plaster", 0xcfc4b4, 0.16), 2.0, 0.9);
    b.add("floor", cuboid(DVec3::new(-3.0, -0.2, -2.2), DVec3::new(2.4, 0.0, 4.0)), floor, at(0.0, 0.0, 0.0, 0.0));
    b.add(
        "back wall",
        cuboid(DVec3::new(-3.0, -0.2, -2.4), DVec3::new(2.6, 3.0, -2.2)),
        plaster,
        at(0.0, 0.0, 0.0, 0.0),
    );
    b.add("side wall", cuboid(DVec3::new(2.4, -0.2, -2.3), DVec3::new(2.6, 3.0, 4.0)), plaster, at(0.0, 0.0, 0.0, 0.0));

    let green = b.matte("green glaze", 0x3f9f57, 0.35);
    b.add("container", container(), green, at(0.0, 0.0, 0.0, 0.0));
    b.bulb("light", DVec3::new(0.03, 0.44, -0.02), 0.035, 0xffd9a0, 9.0);

    let red = b.matte("red", 0xb5443a, 0.4);
    let blue = b.matte("blue", 0x4a6fa5, 0.4);
    let ivory = b.matte("ivory", 0xe6dcc8, 0.5);
    b.add("ball", ico_sphere(0.22, 4, true), red, at(1.05, 0.22, -0.75, 0.0));
    b.add("vase", props::vase(0.85), blue, at(-1.15, 0.0, -1.1, 0.0));
    b.add("knot", torus_knot([2, 3], 0.2, 0.085, 0.045, 160, 16), ivory, at(1.6, 0.28, -1.55, 20.0));

    b.camera("camera", DVec3::new(-0.62, 0.98, 1.22), DVec3::new(0.32, 0.5, -0.55), 55.0);
    b.finish()
}

/// A spherical pot whose wall is a twisted lattice, on a ring.
fn container() -> Mesh {
    const COLUMNS: usize = 96;
    const ROWS: usize = 26;
    let pot = Slab { wraps: true, ..Slab::new(COLUMNS, ROWS) }.mesh(
        |i, j| i % 8 < 3 || !(3..ROWS - 2).contains(&j) || (j - 3) % 7 >= 5,
        |i, j| {
            let height = j as f64 / ROWS as f64;
            let twist = 0.9 * height;
            let around = DVec2::from_angle(TAU * i as f64 / COLUMNS as f64 + twist);
            let latitude = DVec2::from_angle(-1.35 + 2.15 * height);
            let out = DVec3::new(around.x * latitude.x, latitude.y, -around.y * latitude.x);
            [0.4, 0.375].map(|radius| out * radius + DVec3::Y * 0.44)
        },
    );
    let foot = super::shapes::moved(torus(0.16, 0.035, 48, 14), &at(0.0, 0.035, 0.0, 0.0));
    merged("container", [pot, foot])
}
