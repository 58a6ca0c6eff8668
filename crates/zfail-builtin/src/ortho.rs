//! An isometric diorama under an orthographic camera, whose view rays are parallel: infinity has no finite depth there.

use glam::{DAffine3, DVec2, DVec3};
use zfail_plan::light::LightKind;
use zfail_scene::{Mesh, Scene};

use super::builder::{SceneBuilder, at};
use super::pattern;
use super::props::{Pose, block, figure, tree};
use super::shapes::{capsule, extruded, ico_sphere, merged, moved, painted};

pub(super) fn scene() -> Scene {
    let mut b = SceneBuilder::new("ortho", [0.1, 0.11, 0.15], [0.18, 0.3, 0.36]);
    let direction = DVec3::new(0.62, -0.9, -0.28).normalize();
    b.light("sun", LightKind::Directional { direction }, 0xffe3bd, 3.0);

    let soil = b.textured(pattern::stone("soil", 0x8a6a4c, 0.3), 2.0, 0.95);
    let grass = b.textured(pattern::grass("grass", 0x76a045, 0xa4ad55), 3.0, 0.95);
    let paving = b.textured(pattern::bricks("paving", [2, 4], 0xcabfa9, 0x8d8371), 1.6, 0.8);
    b.block("soil", [-5.0, -1.2, -5.0], [5.0, -0.25, 5.0], soil);
    b.block("lawn", [-5.1, -0.25, -5.1], [5.1, 0.0, 5.1], grass);
    b.block("path", [0.3, -0.1, -0.2], [1.7, 0.03, 5.0], paving);

    house(&mut b);
    garden(&mut b);
    b.bulb("lantern", DVec3::new(2.35, 1.86, 1.5), 0.09, 0xffb458, 5.0);
    b.orthographic_camera("isometric", DVec3::new(14.0, 12.6, 15.4), DVec3::new(0.0, 0.6, 0.0), 10.2);
    b.finish()
}

fn house(b: &mut SceneBuilder) {
    let plaster = b.textured(pattern::stone("plaster", 0xe9dfca, 0.08), 2.0, 0.85);
    let shingles = b.textured(pattern::bricks("shingles", [6, 8], 0xb5523d, 0x5c2a20), 1.6, 0.75);
    let timber = b.matte("timber", 0x7a5234, 0.7);
    let glass = b.matte("glass", 0x9cc4d6, 0.15);
    let gable = [(-1.7, 0.0), (1.7, 0.0), (1.7, 2.2), (0.0, 3.6), (-1.7, 2.2)].map(DVec2::from);
    b.add("house", extruded(&gable, 4.4), plaster, at(-3.0, 0.0, -1.6, 90.0));
    let tiles = [(-2.05, 1.95), (-1.95, 1.83), (0.0, 3.45), (1.95, 1.83), (2.05, 1.95), (0.0, 3.68)].map(DVec2::from);
    b.add("roof", extruded(&tiles, 4.9), shingles, at(-3.25, 0.05, -1.6, 90.0));
    b.add("chimney", block(DVec3::new(0.55, 1.5, 0.55)), shingles, at(-2.2, 2.6, -2.3, 0.0));
    b.add("door", block(DVec3::new(0.9, 1.6, 0.12)), timber, at(1.0, 0.0, 0.1, 0.0));
    for x in [-0.6, -2.0] {
        b.add("frame", block(DVec3::new(0.9, 0.9, 0.1)), timber, at(x, 0.9, 0.1, 0.0));
        b.add("pane", block(DVec3::new(0.74, 0.74, 0.12)), glass, at(x, 0.98, 0.105, 0.0));
    }
    b.add("side pane", block(DVec3::new(0.12, 0.9, 1.2)), glass, at(1.4, 0.95, -1.6, 0.0));
}

fn garden(b: &mut SceneBuilder) {
    let timber = b.matte("fence", 0xb08a60, 0.8);
    let fence = b.mesh("fence", painted(fence(4.4), timber));
    b.place("fence", fence, at(-2.3, 0.0, 4.75, 0.0));
    b.place("fence", fence, at(4.75, 0.0, -2.4, 90.0));

    let bark = b.matte("bark", 0x6d5138, 0.9);
    let leaves = b.matte("leaves", 0x5f8f3c, 0.85);
    let [trunk, crown] = tree(3.0);
    let broad = b.mesh("tree", merged("tree", [painted(trunk, bark), painted(crown, leaves)]));
    for (x, z, size, turn) in [(-3.2, 2.7, 1.0, 0.0), (3.5, -2.9, 1.15, 120.0), (3.6, 3.6, 0.62, 40.0)] {
        b.place("tree", broad, at(x, 0.0, z, turn) * DAffine3::from_scale(DVec3::splat(size)));
    }
    let iron = b.matte("iron", 0x3d4247, 0.5);
    let post = capsule(DVec3::ZERO, 0.06, DVec3::Y * 1.7, 0.04, 14);
    let arm = capsule(DVec3::Y * 2.15, 0.03, DVec3::new(0.0, 2.15, 0.0) + DVec3::X * 0.35, 0.03, 10);
    let stem = capsule(DVec3::Y * 1.6, 0.04, DVec3::Y * 2.15, 0.03, 10);
    b.add("lamp post", merged("lamp post", [post, stem, arm]), iron, at(2.0, 0.0, 1.5, 0.0));
    let wood = b.matte("wood", 0xd9b184, 0.5);
    b.add("visitor", figure(&Pose::WAVE), wood, at(1.0, 0.03, 2.7, 185.0));
    let stone = b.matte("stone", 0xb4ada1, 0.9);
    for (x, z, size) in [(-0.7, 2.2, 0.32), (-1.25, 2.5, 0.2), (2.9, 0.0, 0.28)] {
        b.add("stone", ico_sphere(size, 1, false), stone, at(x, 0.5 * size, z, 70.0 * x));
    }
}

/// Pickets on two rails along x.
fn fence(length: f64) -> Mesh {
    let picket =
        extruded(&[(-0.07, 0.0), (0.07, 0.0), (0.07, 0.75), (0.0, 0.88), (-0.07, 0.75)].map(DVec2::from), 0.05);
    let count = (length / 0.3) as u32;
    let pickets = (0..=count)
        .map(|k| moved(picket.clone(), &at(length * (f64::from(k) / f64::from(count) - 0.5), 0.0, 0.0, 0.0)));
    let rails = [0.2, 0.55].map(|y| moved(block(DVec3::new(length, 0.08, 0.06)), &at(0.0, y, -0.03, 0.0)));
    merged("fence", pickets.chain(rails))
}
