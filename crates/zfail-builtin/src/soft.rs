//! Twelve clustered lights that together cast soft shadows (E&K Figure 4, right; McGuire et al. section 8).

use glam::DVec3;
use zfail_plan::light::LightKind;
use zfail_scene::Scene;

use super::builder::{SceneBuilder, at};
use super::pattern;
use super::props::{block, bowl, vase};
use super::shapes::{capsule, ico_sphere, merged, moved, torus};

/// Lights in the cluster; each has this fraction of the lamp's intensity.
const LIGHTS: u32 = 12;

pub(super) fn scene() -> Scene {
    let mut b = SceneBuilder::new("soft", [0.05, 0.055, 0.07], [0.02, 0.02, 0.03]);
    let floor = b.textured(pattern::planks("floor", 5, 0xb08a62, 0x5a4330), 1.0, 0.5);
    let wall = b.textured(pattern::stone("wall", 0xb9c3c4, 0.1), 2.0, 0.9);
    b.block("floor", [-3.5, -0.2, -2.2], [3.5, 0.0, 3.5], floor);
    b.block("wall", [-3.5, -0.2, -2.4], [3.5, 3.2, -2.2], wall);
    b.block("left wall", [-3.7, -0.2, -2.3], [-3.5, 3.2, 3.5], wall);
    furniture(&mut b);
    still_life(&mut b);
    lamp(&mut b, DVec3::new(1.75, 2.5, 1.15), 0.3, 0xffe2bd, 46.0);
    b.camera("camera", DVec3::new(0.75, 1.7, 2.1), DVec3::new(-0.32, 0.78, -0.45), 42.0);
    b.finish()
}

/// Lights on a sunflower disc that faces the room.
fn lamp(b: &mut SceneBuilder, center: DVec3, radius: f64, color: u32, candela: f32) {
    let axis = (DVec3::new(0.0, 0.8, 0.0) - center).normalize();
    let (x, y) = axis.any_orthonormal_pair();
    for k in 0..LIGHTS {
        let r = radius * ((f64::from(k) + 0.5) / f64::from(LIGHTS)).sqrt();
        let (sin, cos) = (2.399_963 * f64::from(k)).sin_cos();
        let kind = LightKind::Point { position: center + (x * cos + y * sin) * r, range: f64::INFINITY };
        b.light(&format!("light {k}"), kind, color, candela / LIGHTS as f32);
    }
}

fn furniture(b: &mut SceneBuilder) {
    let wood = b.textured(pattern::planks("table", 3, 0x9a6a42, 0x5a3a22), 0.6, 0.38);
    let leg = |x: f64, z: f64| moved(block(DVec3::new(0.08, 0.72, 0.08)), &at(x, 0.0, z, 0.0));
    let top = moved(block(DVec3::new(1.7, 0.05, 0.95)), &at(0.0, 0.715, 0.0, 0.0));
    let apron = moved(block(DVec3::new(1.5, 0.1, 0.75)), &at(0.0, 0.6, 0.0, 0.0));
    let legs = [leg(-0.72, -0.36), leg(0.72, -0.36), leg(-0.72, 0.36), leg(0.72, 0.36)];
    b.add("table", merged("table", legs.into_iter().chain([top, apron])), wood, at(-0.1, 0.0, -0.5, 0.0));

    let paint = b.matte("painted wood", 0x5b8a8a, 0.5);
    let chair = b.mesh("chair", super::shapes::painted(chair(), paint));
    b.place("chair", chair, at(-1.75, 0.0, -0.35, 78.0));
    b.place("chair", chair, at(0.35, 0.0, -1.45, 4.0));
}

fn chair() -> zfail_scene::Mesh {
    let rod = |a: [f64; 3], b: [f64; 3], r: f64| capsule(DVec3::from(a), r, DVec3::from(b), r, 12);
    let mut parts = vec![moved(block(DVec3::new(0.44, 0.04, 0.42)), &at(0.0, 0.43, 0.0, 0.0))];
    for side in [-1.0, 1.0] {
        parts.push(rod([0.17 * side, 0.45, 0.16], [0.2 * side, 0.02, 0.2], 0.02));
        parts.push(rod([0.17 * side, 0.45, -0.16], [0.2 * side, 0.02, -0.22], 0.02));
        parts.push(rod([0.19 * side, 0.45, -0.18], [0.2 * side, 0.96, -0.26], 0.02));
    }
    for k in 0..4 {
        let x = 0.12 * (f64::from(k) - 1.5) / 1.5;
        parts.push(rod([x, 0.45, -0.18], [x, 0.93, -0.255], 0.011));
    }
    parts.push(moved(block(DVec3::new(0.46, 0.1, 0.03)), &at(0.0, 0.9, -0.255, 0.0)));
    merged("chair", parts)
}

fn still_life(b: &mut SceneBuilder) {
    const TABLE: f64 = 0.765;
    let glaze = b.matte("white glaze", 0xe9e6df, 0.25);
    let cobalt = b.matte("cobalt glaze", 0x31528f, 0.22);
    let brass = b.matte("brass", 0xb98a45, 0.25);
    b.add("vase", vase(0.46), cobalt, at(-0.62, TABLE, -0.6, 0.0));
    b.add("bowl", bowl(0.2), glaze, at(0.02, TABLE, -0.42, 0.0));
    b.add("ring", torus(0.11, 0.032, 56, 18), brass, at(0.5, TABLE + 0.032, -0.38, 0.0));
    let stems = b.matte("stems", 0x55733f, 0.6);
    let stalk = |x: f64, y: f64, z: f64| capsule(DVec3::new(0.0, 0.1, 0.0), 0.006, DVec3::new(x, y, z), 0.004, 10);
    let tips = [(0.13, 0.78, 0.05), (-0.14, 0.72, 0.07), (-0.02, 0.86, -0.1), (0.05, 0.7, 0.14)];
    b.add("stems", merged("stems", tips.map(|(x, y, z)| stalk(x, y, z))), stems, at(-0.62, TABLE, -0.6, 0.0));
    let petals = b.matte("petals", 0xe0a83c, 0.6);
    let flower = b.mesh("flower", super::shapes::painted(ico_sphere(0.055, 1, false), petals));
    for (x, y, z) in tips {
        b.place("flower", flower, at(x - 0.62, TABLE + y, z - 0.6, 90.0 * x));
    }

    let fruit = [
        ("orange", 0xd9772b, -0.05, 0.115, -0.46),
        ("apple", 0xa8322d, 0.08, 0.112, -0.36),
        ("lime", 0x86a33a, 0.06, 0.12, -0.5),
    ];
    let small = [("plum", 0x5d3557, 0.33, 0.036, -0.22), ("apricot", 0xdf9a4c, 0.24, 0.036, -0.3)];
    for (size, group) in [(0.06, &fruit[..]), (0.036, &small[..])] {
        for &(name, color, x, y, z) in group {
            let skin = b.matte(name, color, 0.45);
            b.add(name, ico_sphere(size, 4, true), skin, at(x, TABLE + y, z, 0.0));
        }
    }
}
