//! A cathedral-like hall with stepped seating, a sphere and a 3-D grid of cubes around a point light
//! (McGuire et al., Images 1, 5 and 6).

use glam::{DAffine3, DVec2, DVec3};
use std::f64::consts::PI;
use zfail_plan::light::LightKind;
use zfail_scene::{Mesh, Scene};

use super::builder::{SceneBuilder, at};
use super::pattern;
use super::props::{Arch, Pose, arcade, column, figure};
use super::shapes::{Slab, cuboid, ico_sphere, painted};

const LIGHT: DVec3 = DVec3::new(0.75, 4.3, -1.2);

pub(super) fn scene() -> Scene {
    let mut b = SceneBuilder::new("cathedral", [0.03, 0.036, 0.054], [0.05, 0.085, 0.19]);
    nave(&mut b);
    let stone = b.textured(pattern::bricks("seating", [2, 4], 0xc2b49c, 0x7d7464), 2.0, 0.8);
    b.add("seating", seating(), stone, at(0.0, 0.0, -1.5, 0.0));

    let red = b.matte("cube", 0xb8493a, 0.45);
    let cube = b.mesh("cube", painted(cuboid(DVec3::splat(-0.15), DVec3::splat(0.15)), red));
    for i in 0..64 {
        let cell = DVec3::new(f64::from(i % 4), f64::from(i / 4 % 4), f64::from(i / 16)) - 1.5;
        let place = DAffine3::from_translation(DVec3::new(-1.3, 4.1, -1.5) + cell * 0.72);
        b.place(&format!("cube {i}"), cube, place);
    }
    let blue = b.matte("sphere", 0x6f93b8, 0.3);
    b.add("sphere", ico_sphere(0.75, 5, true), blue, at(2.7, 4.0, -2.4, 0.0));
    b.bulb("light", LIGHT, 0.07, 0xffdcab, 80.0);

    let direction = DVec3::new(-0.62, -0.55, -0.28).normalize();
    b.light("moon", LightKind::Directional { direction }, 0x8fb0ff, 0.55);

    let wood = b.matte("wood", 0xc79a6b, 0.5);
    for (name, pose, x, z, turn) in [
        ("walker", Pose::WALK, 1.7, 2.6, 60.0),
        ("dancer", Pose::DANCE, -0.4, 1.2, 30.0),
        ("greeter", Pose::WAVE, -3.0, 3.0, 120.0),
    ] {
        b.add(name, figure(&pose), wood, at(x, 0.0, z, turn));
    }
    b.camera("hall", DVec3::new(2.5, 2.2, 8.4), DVec3::new(-0.1, 3.3, -2.0), 56.0);
    b.camera("behind the grid", DVec3::new(-4.3, 3.6, -2.1), LIGHT + DVec3::Y * 0.05, 62.0);
    b.finish()
}

/// Floor, walls with Gothic windows, two rows of columns under arches, ribs across.
fn nave(b: &mut SceneBuilder) {
    let floor = b.textured(pattern::tiles("floor", 2, [0xa79c8c, 0x6f675e], 0x3c3833), 2.0, 0.4);
    let ashlar = b.textured(pattern::bricks("ashlar", [3, 6], 0xb3a891, 0x776e60), 3.0, 0.85);
    let marble = b.textured(pattern::stone("marble", 0xcfc5b1, 0.18), 2.0, 0.6);
    b.block("floor", [-8.5, -0.4, -12.5], [8.5, 0.0, 13.5], floor);
    b.block("ceiling", [-8.5, 10.0, -12.5], [8.5, 10.4, 13.5], ashlar);

    let window = Arch { span: 1.5, sill: 2.2, spring: 5.2, rise: 1.3, pointed: true };
    let side = b.mesh("side wall", painted(arcade(6, window, 2.35, 10.1, 0.5), ashlar));
    b.place("west wall", side, at(-8.0, -0.05, 0.5, 90.0));
    b.place("east wall", side, at(8.0, -0.05, 0.5, -90.0));
    let rose = Arch { span: 2.2, sill: 3.4, spring: 6.2, rise: 1.91, pointed: true };
    let end = b.mesh("end wall", painted(arcade(3, rose, 2.4, 10.1, 0.5), ashlar));
    b.place("north wall", end, at(0.0, -0.05, -12.0, 0.0));
    b.place("south wall", end, at(0.0, -0.05, 13.0, 180.0));

    let pillar = b.mesh("column", painted(column(0.32, 4.6), marble));
    let rows = b.mesh(
        "nave arcade",
        painted(
            arcade(5, Arch { span: 3.4, sill: 0.0, spring: 0.3, rise: 2.94, pointed: true }, 0.8, 5.41, 0.6),
            ashlar,
        ),
    );
    let rib = b.mesh(
        "rib",
        painted(
            arcade(1, Arch { span: 9.2, sill: 0.0, spring: 0.2, rise: 5.0, pointed: true }, 0.35, 5.41, 0.45),
            ashlar,
        ),
    );
    for side in [-1.0, 1.0] {
        b.place("nave arcade", rows, at(5.0 * side, 4.6, 0.0, 90.0));
        for k in 0..6 {
            b.place("column", pillar, at(5.0 * side, 0.0, 4.2 * f64::from(k) - 10.5, 0.0));
        }
    }
    for k in 0..6 {
        b.place("rib", rib, at(0.0, 4.6, 4.2 * f64::from(k) - 10.5, 0.0));
    }
}

/// Half a ring of steps, open towards +z, one closed body.
fn seating() -> Mesh {
    const STEPS: usize = 7;
    let profile: Vec<DVec2> =
        (0..=2 * STEPS).map(|k| DVec2::new(2.3 + 0.36 * (k / 2) as f64, 0.27 * k.div_ceil(2) as f64)).collect();
    Slab::new(48, 2 * STEPS).mesh(
        |_, _| true,
        |i, j| {
            let angle = DVec2::from_angle(PI * (1.0 - i as f64 / 48.0));
            let p = profile[j];
            let floor = DVec3::new(p.x * angle.x, 0.0, -p.x * angle.y);
            [floor.with_y(p.y), floor]
        },
    )
}
