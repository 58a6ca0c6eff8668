//! A light that shines out horizontally through a jail-cell door: the worst case for fill rate (Carmack's letter).

use glam::{DAffine3, DVec3};
use zfail_scene::{Mesh, Scene};

use super::builder::{SceneBuilder, at};
use super::pattern;
use super::props::{Arch, Pose, arcade, block, figure};
use super::shapes::{capsule, cylinder, merged, moved, painted};

pub(super) fn scene() -> Scene {
    let mut b = SceneBuilder::new("jail", [0.01, 0.014, 0.024], [0.004, 0.005, 0.008]);
    let here = DAffine3::IDENTITY;
    let bricks = b.textured(pattern::bricks("bricks", [3, 6], 0x9b8f80, 0x4e463d), 1.5, 0.85);
    let paving = b.textured(pattern::bricks("paving", [2, 4], 0x8f8a80, 0x45413b), 1.6, 0.5);
    let iron = b.matte("iron", 0x54575c, 0.4);

    // The corridor runs along x on the camera's side of the bars, the cells lie behind them.
    b.block("floor", [-7.0, -0.3, -3.6], [7.0, 0.0, 5.2], paving);
    b.block("ceiling", [-7.0, 2.9, -3.6], [7.0, 3.2, 5.2], bricks);
    b.block("back wall", [-7.0, -0.1, -3.6], [7.0, 3.0, -3.3], bricks);
    b.block("corridor wall", [-7.0, -0.1, 4.8], [7.0, 3.0, 5.1], bricks);
    for x in [-6.6, 6.6] {
        b.add("end wall", moved(block(DVec3::new(0.3, 3.1, 8.8)), &at(x, -0.1, 0.8, 0.0)), bricks, here);
    }
    for x in [-2.1, 2.1] {
        b.add("partition", moved(block(DVec3::new(0.3, 3.1, 3.4)), &at(x, -0.1, -1.8, 0.0)), bricks, here);
    }
    let opening = Arch { span: 2.4, sill: 0.0, spring: 1.75, rise: 1.2, pointed: false };
    b.add("front", arcade(3, opening, 1.8, 3.0, 0.36), bricks, at(0.0, -0.05, 0.0, 0.0));
    let grille = b.mesh("grille", painted(grille(&opening), iron));
    for x in [-4.2, 0.0, 4.2] {
        b.place("grille", grille, at(x, 0.0, 0.0, 0.0));
    }

    let timber = b.textured(pattern::planks("timber", 3, 0x8d6a47, 0x2a1d12), 0.6, 0.7);
    b.add("bunk", bunk(), timber, at(-1.2, 0.0, -2.1, 0.0));
    b.add("stool", stool(), timber, at(0.95, 0.0, -1.35, 20.0));
    let wood = b.matte("wood", 0xd2a877, 0.5);
    b.add("prisoner", figure(&Pose::WAVE), wood, at(0.35, 0.0, -0.75, 12.0));
    b.add("warder", figure(&Pose::WALK), wood, at(1.9, 0.0, 1.35, -80.0));
    let bucket = b.matte("bucket", 0x7b8a91, 0.4);
    b.add("bucket", super::props::vase(0.4), bucket, at(-1.5, 0.0, 0.75, 0.0));

    b.bulb("light", DVec3::new(-0.25, 1.5, -2.3), 0.07, 0xffcb85, 42.0);
    b.point("skylight", DVec3::new(-5.2, 2.6, 3.4), 0x7f9fe0, 12.0);
    b.camera("camera", DVec3::new(-1.55, 1.7, 4.1), DVec3::new(0.3, 1.02, 0.3), 52.0);
    b.finish()
}

/// Bars under an arch, with two rails across.
fn grille(opening: &Arch) -> Mesh {
    const BARS: u32 = 11;
    let bars = (0..BARS).map(|k| {
        let t = 2.0 * (f64::from(k) + 0.5) / f64::from(BARS) - 1.0;
        moved(cylinder(0.026, opening.edge(t), 12), &at(0.5 * t * opening.span, -0.02, 0.0, 0.0))
    });
    let rail = |y: f64| moved(block(DVec3::new(opening.span + 0.1, 0.07, 0.03)), &at(0.0, y, 0.0, 0.0));
    merged("grille", bars.chain([0.25, 1.05, 1.85].map(rail)))
}

fn bunk() -> Mesh {
    let plank = |y: f64| moved(block(DVec3::new(0.8, 0.06, 1.9)), &at(0.0, y, 0.0, 0.0));
    let post = |x: f64, z: f64| moved(block(DVec3::new(0.07, 1.5, 0.07)), &at(x, 0.0, z, 0.0));
    merged("bunk", [plank(0.42), plank(1.25), post(-0.35, -0.9), post(0.35, -0.9), post(-0.35, 0.9), post(0.35, 0.9)])
}

fn stool() -> Mesh {
    let legs = super::props::around(3)
        .map(|(out, _)| capsule(out * 0.2 + DVec3::Y * 0.02, 0.02, out * 0.1 + DVec3::Y * 0.42, 0.02, 10));
    merged("stool", legs.chain([moved(cylinder(0.2, 0.04, 28), &at(0.0, 0.42, 0.0, 0.0))]))
}
