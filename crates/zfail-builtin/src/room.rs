//! A game-like room with three coloured lights (E&K Figure 4, left).

use glam::{DAffine3, DVec3};
use zfail_scene::Scene;

use super::builder::{SceneBuilder, at};
use super::pattern;
use super::props::{Arch, Pose, arcade, block, column, figure};
use super::shapes::{cuboid, ico_sphere, torus_knot};

pub(super) fn scene() -> Scene {
    let mut b = SceneBuilder::new("room", [0.03, 0.03, 0.038], [0.005, 0.005, 0.008]);
    walls(&mut b);
    contents(&mut b);
    b.bulb("red light", DVec3::new(-2.3, 2.7, 0.4), 0.07, 0xff6a55, 26.0);
    b.bulb("green light", DVec3::new(1.6, 3.0, 2.1), 0.07, 0x74ff86, 24.0);
    b.bulb("blue light", DVec3::new(2.9, 2.5, -1.5), 0.07, 0x6a8dff, 40.0);
    b.camera("camera", DVec3::new(-5.5, 2.25, 2.1), DVec3::new(0.6, 1.0, -0.85), 58.0);
    b.finish()
}

fn walls(b: &mut SceneBuilder) {
    let tiles = b.textured(pattern::tiles("tiles", 4, [0xb9b2a6, 0x8d867c], 0x4a453f), 2.4, 0.35);
    let bricks = b.textured(pattern::bricks("bricks", [4, 8], 0xa89a8c, 0x5f574f), 1.6, 0.85);
    let timber = b.textured(pattern::planks("timber", 4, 0x8a6848, 0x20160e), 1.5, 0.7);
    b.block("floor", [-6.3, -0.3, -4.8], [6.3, 0.0, 4.8], tiles);
    b.block("ceiling", [-6.3, 4.2, -4.8], [6.3, 4.5, 4.8], timber);
    b.block("west wall", [-6.3, -0.1, -4.8], [-6.0, 4.3, 4.8], bricks);
    b.block("south wall", [-6.3, -0.1, 4.5], [6.3, 4.3, 4.8], bricks);
    b.block("east wall", [6.0, -0.1, -4.8], [6.3, 4.3, 4.8], bricks);
    let door = Arch { span: 1.8, sill: 0.0, spring: 1.9, rise: 0.9, pointed: false };
    b.add("north wall", arcade(3, door, 2.16, 4.3, 0.3), bricks, at(0.0, -0.05, -4.65, 0.0));
    b.block("niche", [-6.3, -0.1, -5.6], [6.3, 4.3, -5.3], bricks);
    let beam = b.mesh("beam", super::shapes::painted(block(DVec3::new(0.26, 0.34, 9.2)), timber));
    for x in [-4.5, -1.5, 1.5, 4.5] {
        b.place("beam", beam, at(x, 3.9, 0.0, 0.0));
    }
}

fn contents(b: &mut SceneBuilder) {
    let stone = b.textured(pattern::stone("stone", 0xc9c0b0, 0.25), 1.5, 0.75);
    let pillar = b.mesh("pillar", super::shapes::painted(column(0.26, 4.2), stone));
    for x in [-3.0, 0.0, 3.0] {
        for z in [-3.1, 3.1] {
            b.place("pillar", pillar, at(x, 0.0, z, 0.0));
        }
    }

    let boards = b.textured(pattern::crate_side("crate", 0xb98d5c, 0x241810), 1.0, 0.7);
    let unit = b.mesh("crate", super::shapes::painted(cuboid(DVec3::ZERO, DVec3::ONE), boards));
    let crates = [
        (-4.6, 0.0, -3.9, 6.0, 0.9),
        (-3.5, 0.0, -4.1, -14.0, 0.8),
        (-4.3, 0.9, -3.7, 27.0, 0.62),
        (4.3, 0.0, 1.0, 18.0, 0.95),
        (4.9, 0.0, 2.3, -8.0, 0.7),
    ];
    for (x, y, z, turn, size) in crates {
        b.place("crate", unit, at(x, y, z, turn) * DAffine3::from_scale(DVec3::splat(size)));
    }

    let bronze = b.matte("bronze", 0xd8b06a, 0.3);
    b.add("pedestal", block(DVec3::new(0.9, 0.75, 0.9)), stone, at(1.25, 0.0, -0.9, 12.0));
    b.add(
        "statue",
        torus_knot([2, 3], 0.42, 0.19, 0.1, 200, 20),
        bronze,
        at(1.25, 1.5, -0.9, 12.0) * DAffine3::from_rotation_x(1.35),
    );

    let wood = b.matte("wood", 0xd2a877, 0.5);
    let poses = [
        ("walker", Pose::WALK, -1.7, -1.4, 62.0),
        ("guard", Pose::STAND, 3.6, -0.3, -70.0),
        ("greeter", Pose::WAVE, -0.2, 1.3, -130.0),
    ];
    for (name, pose, x, z, turn) in poses {
        b.add(name, figure(&pose), wood, at(x, 0.0, z, turn));
    }
    let ball = b.matte("ball", 0xd8d4cc, 0.25);
    b.add("ball", ico_sphere(0.32, 4, true), ball, at(-1.9, 0.32, 0.75, 0.0));
}
