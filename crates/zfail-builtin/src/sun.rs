//! A directional light seen with it and against it (E&K Figure 5).

use glam::{DAffine3, DVec2, DVec3};
use zfail_plan::light::LightKind;
use zfail_scene::Scene;

use super::builder::{SceneBuilder, at};
use super::pattern;
use super::props::{Arch, Pose, arcade, block, column, cypress, figure, tree};
use super::shapes::{CREASE, ico_sphere, lathe, merged, moved, painted};

pub(super) fn scene() -> Scene {
    let mut b = SceneBuilder::new("sun", [0.15, 0.19, 0.28], [0.42, 0.58, 0.86]);
    let direction = DVec3::new(-0.52, -0.36, 0.78).normalize();
    b.light("sun", LightKind::Directional { direction }, 0xffd9a8, 3.4);

    let grass = b.textured(pattern::grass("grass", 0x5f7a41, 0x8a8752), 4.0, 0.95);
    b.block("ground", [-150.0, -1.0, -150.0], [150.0, 0.0, 150.0], grass);
    ruin(&mut b);
    garden(&mut b);
    b.camera("with the light", DVec3::new(5.4, 2.4, -11.5), DVec3::new(-0.2, 1.75, 0.6), 48.0);
    b.camera("against the light", DVec3::new(-5.2, 2.3, 11.6), DVec3::new(0.6, 1.8, -1.2), 50.0);
    b.finish()
}

/// A colonnade with an arcade behind it, on a stepped platform.
fn ruin(b: &mut SceneBuilder) {
    let paving = b.textured(pattern::bricks("paving", [3, 6], 0xcfc3ad, 0x8f8573), 3.0, 0.8);
    let marble = b.textured(pattern::stone("marble", 0xe4dccb, 0.12), 2.0, 0.55);
    let platform =
        [0.0, 1.0].map(|k| moved(block(DVec3::new(9.6 - 0.8 * k, 0.2, 7.6 - 0.8 * k)), &at(0.0, 0.2 * k, 0.0, 0.0)));
    b.add("platform", merged("platform", platform), paving, DAffine3::IDENTITY);

    let arch = Arch { span: 1.7, sill: 0.0, spring: 2.3, rise: 0.85, pointed: false };
    b.add("arcade", arcade(3, arch, 0.6, 4.0, 0.5), marble, at(0.0, 0.39, -2.7, 0.0));
    let pillar = b.mesh("column", painted(column(0.26, 3.4), marble));
    for (x, z) in [(-3.6, 2.5), (-1.2, 2.5), (1.2, 2.5), (3.6, 2.5), (3.6, -0.1)] {
        b.place("column", pillar, at(x, 0.395, z, 0.0));
    }
    let stump = b.mesh("broken column", painted(column(0.26, 1.5), marble));
    b.place("broken column", stump, at(-3.6, 0.395, -0.1, 0.0));

    b.add("architrave", block(DVec3::new(5.6, 0.4, 0.72)), marble, at(1.2, 3.79, 2.5, 0.0));

    let basin = [
        (0.0, 0.0),
        (0.5, 0.0),
        (0.42, 0.12),
        (0.2, 0.3),
        (0.2, 0.6),
        (0.8, 0.85),
        (0.8, 0.98),
        (0.7, 0.98),
        (0.2, 0.78),
        (0.0, 0.75),
    ];
    b.add("fountain", lathe(&basin.map(DVec2::from), 40, CREASE), marble, at(0.0, 0.395, 0.2, 0.0));
    let wood = b.matte("wood", 0xc79a6b, 0.5);
    b.add("walker", figure(&Pose::WALK), wood, at(1.9, 0.395, 1.0, -60.0));
    b.add("greeter", figure(&Pose::WAVE), wood, at(-1.7, 0.395, 1.5, 110.0));
}

fn garden(b: &mut SceneBuilder) {
    let bark = b.matte("bark", 0x6d5138, 0.9);
    let dark = b.matte("cypress", 0x3f6339, 0.85);
    let light = b.matte("leaves", 0x6f9440, 0.85);
    let [trunk, crown] = cypress(5.4);
    let conifer = b.mesh("cypress", merged("cypress", [painted(trunk, bark), painted(crown, dark)]));
    let cypresses = [
        (-6.6, -4.2, 1.0),
        (-8.3, -2.4, 0.85),
        (7.6, -1.6, 1.05),
        (8.6, -0.8, 0.8),
        (-13.0, -11.0, 1.4),
        (11.0, -16.0, 1.5),
        (15.0, -9.0, 1.3),
        (-21.0, 6.0, 1.2),
    ];
    for (k, (x, z, size)) in cypresses.into_iter().enumerate() {
        b.place("cypress", conifer, at(x, 0.0, z, 50.0 * k as f64) * DAffine3::from_scale(DVec3::splat(size)));
    }
    let [trunk, crown] = tree(4.2);
    let broad = b.mesh("tree", merged("tree", [painted(trunk, bark), painted(crown, light)]));
    let trees = [
        (6.9, 4.6, 1.0),
        (-10.5, 2.5, 1.25),
        (-4.0, -12.5, 1.5),
        (3.0, -19.0, 1.6),
        (20.0, 2.0, 1.6),
        (-14.0, 15.0, 1.4),
        (9.0, 17.0, 1.5),
    ];
    for (k, (x, z, size)) in trees.into_iter().enumerate() {
        b.place("tree", broad, at(x, 0.0, z, 70.0 * k as f64) * DAffine3::from_scale(DVec3::splat(size)));
    }
    let rock = b.textured(pattern::stone("rock", 0xa39a8b, 0.3), 1.0, 0.9);
    let boulder = b.mesh("rock", painted(ico_sphere(0.5, 1, false), rock));
    for (x, z, size, turn) in
        [(4.9, 5.6, 0.9, 10.0), (5.7, 5.2, 0.5, 50.0), (-6.2, 4.9, 0.7, 80.0), (5.6, -5.6, 0.8, 30.0)]
    {
        let shape = DVec3::new(1.2, 0.8, 1.0) * size;
        b.place("rock", boulder, at(x, 0.2 * size, z, turn) * DAffine3::from_scale(shape));
    }
}
