//! The eye in the middle of nested volumes: pierced, open shells around the light and around the camera
//! (the flight without clipping of Carmack's letter; E&K section 2.2.2).

use glam::{DAffine3, DVec2, DVec3};
use std::f64::consts::TAU;
use zfail_scene::{Mesh, Scene};

use super::builder::SceneBuilder;
use super::shapes::{CREASE, Slab, ico_sphere, ring};
use super::{pattern, props};

const CENTER: DVec3 = DVec3::new(0.0, 2.4, 0.0);

pub(super) fn scene() -> Scene {
    let mut b = SceneBuilder::new("nested", [0.014, 0.018, 0.03], [0.01, 0.015, 0.03]);
    hall(&mut b);
    let shells = [
        ("inner shell", 0xe08a54, Shell { radius: 0.42, ribs: 7, bars: 2, twist: 0.9 }, [0.35, -0.1, -0.5], -14.0),
        ("middle shell", 0xcfd6d2, Shell { radius: 1.5, ribs: 11, bars: 5, twist: -0.6 }, [0.0, 0.0, 0.0], 12.0),
        ("outer shell", 0x4f9a97, Shell { radius: 2.2, ribs: 14, bars: 4, twist: 0.5 }, [0.0, 0.0, 0.0], -8.0),
    ];
    for (name, color, shell, offset, lean) in shells {
        let glaze = b.matte(name, color, 0.45);
        let place =
            DAffine3::from_translation(CENTER + DVec3::from(offset)) * DAffine3::from_rotation_z(f64::to_radians(lean));
        b.add(name, shell.mesh(), glaze, place);
    }
    let light = CENTER + DVec3::new(0.35, -0.06, -0.5);
    let brass = b.matte("brass", 0xd8b65a, 0.35);
    for (radius, tilt, turn) in [(0.56, 75.0, 10.0), (0.7, 25.0, 80.0)] {
        let place = DAffine3::from_translation(light)
            * DAffine3::from_rotation_y(f64::to_radians(turn))
            * DAffine3::from_rotation_x(f64::to_radians(tilt));
        let band = [(radius, -0.02), (radius + 0.015, -0.02), (radius + 0.015, 0.02), (radius, 0.02)];
        b.add("gimbal", ring(&band.map(DVec2::from), 72, CREASE), brass, place);
    }
    let planet = b.matte("planet", 0xc0503f, 0.35);
    for (k, (out, _)) in props::around(5).enumerate() {
        let place = light + out * 0.95 + DVec3::Y * (0.2 * (k as f64 - 2.0));
        b.add("planet", ico_sphere(0.075, 3, true), planet, DAffine3::from_translation(place));
    }
    b.bulb("inner light", light, 0.05, 0xffd19a, 8.0);
    b.point("light by the eye", CENTER + DVec3::new(-0.9, 0.55, 0.85), 0x86b8ff, 2.2);
    b.bulb("outer light", DVec3::new(-3.9, 4.0, 2.6), 0.09, 0x7fa8ff, 60.0);
    b.camera("camera", CENTER + DVec3::new(-0.62, 0.32, 1.05), CENTER + DVec3::new(0.3, -0.12, -0.8), 68.0);
    b.finish()
}

fn hall(b: &mut SceneBuilder) {
    let plaster = b.textured(pattern::stone("plaster", 0xa9b2bd, 0.1), 2.0, 0.9);
    let tiles = b.textured(pattern::tiles("tiles", 4, [0xb9b2a6, 0x6f737a], 0x4a4a4c), 3.0, 0.4);
    b.block("floor", [-5.0, -0.3, -5.0], [5.0, 0.0, 5.0], tiles);
    b.block("north wall", [-5.2, -0.2, -5.2], [5.2, 5.6, -5.0], plaster);
    b.block("south wall", [-5.2, -0.2, 5.0], [5.2, 5.6, 5.2], plaster);
    b.block("west wall", [-5.2, -0.2, -5.1], [-5.0, 5.6, 5.1], plaster);
    b.block("east wall", [5.0, -0.2, -5.1], [5.2, 5.6, 5.1], plaster);
    b.block("ceiling", [-5.2, 5.5, -5.2], [5.2, 5.7, 5.2], plaster);
}

/// A lattice of twisted ribs and hoops, open at the top.
struct Shell {
    radius: f64,
    ribs: usize,
    /// Eighths of the circumference that the ribs fill.
    bars: usize,
    twist: f64,
}

impl Shell {
    fn mesh(&self) -> Mesh {
        const ROWS: usize = 26;
        let columns = 8 * self.ribs;
        Slab { wraps: true, ..Slab::new(columns, ROWS) }.mesh(
            |i, j| i % 8 < self.bars || matches!(j, 0..3 | 9..12 | 17..20 | 23..),
            |i, j| {
                let height = j as f64 / ROWS as f64;
                let around = DVec2::from_angle(TAU * i as f64 / columns as f64 + self.twist * height);
                let latitude = DVec2::from_angle(-1.3 + 2.25 * height);
                let out = DVec3::new(around.x * latitude.x, latitude.y, -around.y * latitude.x);
                [out * self.radius, out * (self.radius - 0.025)]
            },
        )
    }
}
