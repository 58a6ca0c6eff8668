//! The eye in the middle of nested volumes: pierced, open shells around the light and around the camera
//! (the "noclip" flight of Carmack's letter; E&K section 3).

use glam::{DAffine3, DVec2, DVec3};
use std::f64::consts::TAU;
use zfail_plan::scene::{Mesh, Scene};

use super::builder::{SceneBuilder, at};
use super::shapes::{CREASE, Slab, cuboid, ico_sphere, ring};
use super::{pattern, props};

const CENTER: DVec3 = DVec3::new(0.0, 2.2, 0.0);

pub(super) fn scene() -> Scene {
    let mut b = SceneBuilder::new("nested", [0.03, 0.036, 0.055], [0.01, 0.015, 0.03]);
    let here = DAffine3::IDENTITY;
    let plaster = b.textured(pattern::stone("plaster", 0x8fa0b5, 0.15), 2.0, 0.9);
    let tiles = b.textured(pattern::tiles("tiles", 4, [0xa9a296, 0x5b5f66], 0x3a3a3c), 3.0, 0.4);
    b.add("floor", cuboid(DVec3::new(-5.0, -0.3, -5.0), DVec3::new(5.0, 0.0, 5.0)), tiles, here);
    for (out, turn) in props::around(4) {
        let wall = cuboid(DVec3::new(-5.2, -0.2, 4.8), DVec3::new(5.2, 5.2, 5.0));
        b.add(&format!("wall {out}"), wall, plaster, at(0.0, 0.0, 0.0, turn));
    }

    let copper = b.matte("copper", 0xd98a5c, 0.4);
    let teal = b.matte("teal", 0x3f9c98, 0.45);
    let ivory = b.matte("ivory", 0xe3d8c2, 0.55);
    let shells = [
        ("inner shell", copper, 0.34, 10, 1.1, -12.0, 20.0),
        ("middle shell", teal, 1.25, 14, -0.8, 14.0, 0.0),
        ("outer shell", ivory, 2.05, 18, 0.6, -8.0, 50.0),
    ];
    for (name, material, radius, ribs, twist, lean, turn) in shells {
        let place = DAffine3::from_translation(CENTER)
            * DAffine3::from_rotation_z(f64::to_radians(lean))
            * DAffine3::from_rotation_y(f64::to_radians(turn));
        b.add(name, shell(radius, ribs, twist), material, place);
    }
    let brass = b.matte("brass", 0xd8b65a, 0.35);
    for (radius, tilt, turn) in [(0.5, 70.0, 0.0), (0.62, 30.0, 80.0), (0.74, 100.0, 40.0)] {
        let place = DAffine3::from_translation(CENTER)
            * DAffine3::from_rotation_y(f64::to_radians(turn))
            * DAffine3::from_rotation_x(f64::to_radians(tilt));
        let band = [(radius, -0.025), (radius + 0.02, -0.025), (radius + 0.02, 0.025), (radius, 0.025)];
        b.add("gimbal", ring(&band.map(DVec2::from), 72, CREASE), brass, place);
    }
    let ball = b.matte("ball", 0xb8493a, 0.35);
    for (k, (out, _)) in props::around(5).enumerate() {
        let place = CENTER + out * 0.98 + DVec3::Y * (0.25 * (k as f64 - 2.0));
        b.add("ball", ico_sphere(0.08, 3, true), ball, DAffine3::from_translation(place));
    }
    b.bulb("light", CENTER + DVec3::new(0.03, 0.02, -0.04), 0.05, 0xffdcae, 11.0);
    b.camera("camera", CENTER + DVec3::new(-0.42, 0.36, 0.92), CENTER + DVec3::new(0.22, -0.08, -0.6), 78.0);
    b.finish()
}

/// A lattice of `ribs` twisted ribs and three hoops, open at the top.
fn shell(radius: f64, ribs: usize, twist: f64) -> Mesh {
    const ROWS: usize = 24;
    let columns = 6 * ribs;
    Slab { wraps: true, ..Slab::new(columns, ROWS) }.mesh(
        |i, j| i % 6 < 2 || matches!(j, 0..2 | 8..10 | 15..17 | 22..),
        |i, j| {
            let height = j as f64 / ROWS as f64;
            let around = DVec2::from_angle(TAU * i as f64 / columns as f64 + twist * height);
            let latitude = DVec2::from_angle(-1.3 + 2.2 * height);
            let out = DVec3::new(around.x * latitude.x, latitude.y, -around.y * latitude.x);
            [out * radius, out * (radius * 0.97)]
        },
    )
}
