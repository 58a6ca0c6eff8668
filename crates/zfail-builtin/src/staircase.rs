//! A light on top of a staircase, whose steps cast nested volumes: as McGuire et al., Image 3, but with 11 layers at most, far
//! from what 8 bits hold.

use glam::{DAffine3, DVec3};
use zfail_plan::light::LightKind;
use zfail_scene::Scene;

use super::builder::{SceneBuilder, at};
use super::pattern;
use super::props::{Arch, Pose, arcade, block, figure};
use super::shapes::{cuboid, ico_sphere, lathe, merged, moved, painted, stairs};

const STEPS: usize = 56;
const RISE: f64 = 0.16;
const RUN: f64 = 0.3;
const WIDTH: f64 = 4.0;

pub(super) fn scene() -> Scene {
    let mut b = SceneBuilder::new("staircase", [0.024, 0.032, 0.055], [0.03, 0.045, 0.09]);
    let (top, far) = (RISE * STEPS as f64, -RUN * STEPS as f64);
    let here = DAffine3::IDENTITY;

    let tread = b.textured(pattern::stone("tread", 0xd0c6b4, 0.2), 1.5, 0.6);
    let ashlar = b.textured(pattern::bricks("ashlar", [3, 6], 0xa4937c, 0x5f5548), 2.4, 0.85);
    let paving = b.textured(pattern::tiles("paving", 4, [0x9f978b, 0x87806f], 0x4b463e), 3.0, 0.6);
    b.add("stairs", stairs(STEPS, RISE, RUN, WIDTH), tread, here);
    b.block("court", [-14.0, -0.4, -26.0], [14.0, -0.001, 12.0], paving);
    b.block("landing", [-4.2, -0.4, far - 4.0], [4.2, top, far + 0.001], tread);
    let gate = Arch { span: 1.8, sill: 0.0, spring: 2.2, rise: 0.9, pointed: false };
    b.add("gate", arcade(3, gate, 0.6, 4.2, 0.5), ashlar, at(0.0, top - 0.01, far - 2.6, 0.0));

    let wall = b.mesh("wall", painted(balustrade_wall(), ashlar));
    let baluster = b.mesh("baluster", painted(baluster(), tread));
    for side in [-1.0, 1.0] {
        let x = side * (0.5 * WIDTH + 0.2);
        b.place("wall", wall, at(x, 0.0, 0.0, 0.0));
        for k in 0..STEPS / 2 {
            let step = 2.0 * k as f64 + 1.0;
            b.place("baluster", baluster, at(x, RISE * step + 0.35, -RUN * step, 0.0));
        }
        let rail = cuboid(DVec3::new(-0.1, 0.0, -0.5), DVec3::new(0.1, 0.1, 0.5));
        let length = top.hypot(far);
        let lean = DAffine3::from_rotation_x(RISE.atan2(RUN)) * DAffine3::from_scale(DVec3::new(1.0, 1.0, length));
        let middle = DVec3::new(x, 0.5 * top + 1.03, 0.5 * far);
        b.add("rail", rail, tread, DAffine3::from_translation(middle) * lean);
        b.add("post", block(DVec3::new(0.5, 1.5, 0.5)), ashlar, at(x, 0.0, 0.26, 0.0));
        b.add("finial", ico_sphere(0.24, 4, true), tread, at(x, 1.72, 0.26, 0.0));
    }

    let wood = b.matte("wood", 0xd2a877, 0.5);
    for (name, pose, step, x, turn) in
        [("walker", Pose::WALK, 11.0, -0.9, 180.0), ("greeter", Pose::WAVE, 24.0, 0.8, 20.0)]
    {
        b.add(name, figure(&pose), wood, at(x, RISE * (step + 1.0), -RUN * (step + 0.5), turn));
    }
    let ball = b.matte("ball", 0xb8493a, 0.4);
    b.add("ball", ico_sphere(0.3, 4, true), ball, at(0.9, 0.3, 1.5, 0.0));
    b.bulb("light", DVec3::new(0.0, top + 1.7, far + 0.3), 0.14, 0xffcf8f, 260.0);
    b.light("moon", LightKind::Directional { direction: DVec3::new(-0.5, -0.6, -0.3).normalize() }, 0x8fb0ff, 0.5);
    b.camera("from the top", DVec3::new(1.5, top + 1.3, far + 4.6), DVec3::new(-0.7, 1.2, -1.5), 56.0);
    b.camera("from the side", DVec3::new(10.6, 9.0, 0.2), DVec3::new(-0.6, 5.6, -10.2), 52.0);
    b.finish()
}

/// The sloping wall that carries the balusters.
fn balustrade_wall() -> zfail_scene::Mesh {
    use glam::{DMat3, DVec2};
    let (top, far) = (RISE * STEPS as f64, RUN * STEPS as f64);
    let outline = [(0.0, -0.2), (far, -0.2), (far, top + 0.36), (0.0, 0.36)].map(DVec2::from);
    let lying = super::shapes::extruded(&outline, 0.4);
    let world_from_profile =
        DAffine3 { matrix3: DMat3::from_cols(DVec3::NEG_Z, DVec3::Y, DVec3::X), translation: DVec3::X * -0.2 };
    moved(lying, &world_from_profile)
}

fn baluster() -> zfail_scene::Mesh {
    use super::shapes::{CREASE, curve};
    use glam::DVec2;
    let mut profile = vec![DVec2::ZERO];
    profile.extend(curve(&[(0.07, 0.0), (0.05, 0.08), (0.085, 0.24), (0.04, 0.5), (0.06, 0.75)], 3));
    profile.push(DVec2::new(0.0, 0.75));
    merged("baluster", [lathe(&profile, 12, CREASE)])
}
