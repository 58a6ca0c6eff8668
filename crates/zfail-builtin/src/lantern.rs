//! A magic lantern: one spot light projects a stained-glass window and fades by a curve of its own; a candle's light ends
//! at the faces of a box (custom attenuation and projected light, McGuire et al. section 4).

use glam::DVec3;
use zfail_plan::light::LightKind;
use zfail_scene::{LightShape, Scene};

use super::builder::{SceneBuilder, at};
use super::pattern;
use super::props::{Pose, block, figure, vase};
use super::shapes::{capsule, ico_sphere};

pub(super) fn scene() -> Scene {
    let mut b = SceneBuilder::new("lantern", [0.02, 0.021, 0.026], [0.004, 0.004, 0.006]);
    let floor = b.textured(pattern::planks("floor", 6, 0x9a8468, 0x4a3a2a), 1.4, 0.5);
    let wall = b.textured(pattern::stone("wall", 0xc9c4b8, 0.08), 2.5, 0.95);
    b.block("floor", [-3.0, -0.2, -2.0], [3.0, 0.0, 3.0], floor);
    b.block("wall", [-3.0, -0.2, -2.2], [3.0, 3.6, -2.0], wall);
    b.block("left wall", [-3.2, -0.2, -2.2], [-3.0, 3.6, 3.0], wall);

    let plaster = b.matte("plaster", 0xe4dfd4, 0.7);
    b.add("pedestal", block(DVec3::new(0.5, 0.7, 0.5)), plaster, at(0.95, 0.0, -0.9, 18.0));
    b.add("vase", vase(0.55), plaster, at(0.95, 0.7, -0.9, 0.0));
    b.add("ball", ico_sphere(0.3, 4, true), plaster, at(-0.2, 0.3, 0.55, 0.0));
    b.add("figure", figure(&Pose::WAVE), plaster, at(-0.9, 0.0, -0.5, 30.0));

    let (position, target) = (DVec3::new(1.9, 2.3, 4.2), DVec3::new(-0.35, 1.3, -2.0));
    b.spot("lantern", position, target, 20.0, 0xfff1dc, 9.0);
    let cookie = b.texture(pattern::window("window"));
    let falloff = vec![1.0, 1.0, 1.0, 0.9, 0.75, 0.5, 0.2, 0.0];
    b.shape(12.0, LightShape { falloff, cookie: Some(cookie), ..LightShape::default() });

    let wax = b.matte("wax", 0xe8dcc0, 0.6);
    let flame = DVec3::new(1.9, 0.42, 0.7);
    b.add("candle", capsule(DVec3::ZERO, 0.04, DVec3::Y * 0.3, 0.04, 16), wax, at(flame.x, 0.04, flame.z, 0.0));
    b.light("candle", LightKind::Point { position: flame, range: 3.0 }, 0xffa95a, 2.2);
    let half_extents = Some(DVec3::new(0.8, 2.0, 0.8));
    b.shape(3.0, LightShape { falloff: vec![1.0, 0.45, 0.15, 0.0], half_extents, ..LightShape::default() });
    b.camera("camera", DVec3::new(0.9, 1.9, 5.6), DVec3::new(-0.15, 1.2, -0.8), 40.0);
    b.finish()
}
