//! Three coloured spot lights on dancing figures: cones limit both light and shadow (KHR_lights_punctual spots;
//! McGuire et al., Image 7).

use glam::{DAffine3, DMat3, DVec2, DVec3};
use zfail_scene::{Mesh, Scene};

use super::builder::{SceneBuilder, at};
use super::pattern;
use super::props::{Pose, block, figure};
use super::shapes::{Slab, cone, cylinder, lathe, merged, moved, painted};

pub(super) fn scene() -> Scene {
    let mut b = SceneBuilder::new("stage", [0.012, 0.012, 0.018], [0.004, 0.004, 0.006]);
    let boards = b.textured(pattern::planks("boards", 8, 0x9a7450, 0x2b1d12), 1.6, 0.4);
    let velvet = b.matte("velvet", 0x9c2f34, 0.95);
    let screen = b.textured(pattern::stone("screen", 0xbfc3c9, 0.06), 3.0, 0.9);
    b.block("stage", [-4.6, -0.9, -3.0], [4.6, 0.0, 2.2], boards);
    b.block("screen", [-4.6, -0.5, -3.2], [4.6, 5.0, -3.0], screen);
    for side in [-1.0, 1.0] {
        b.add("curtain", curtain(2.0, 4.9), velvet, at(3.8 * side, 0.0, 0.3 - 0.2 * side, -14.0 * side));
    }
    b.add("valance", curtain(9.0, 0.8), velvet, at(0.0, 4.1, 1.15, 0.0));

    let wood = b.matte("wood", 0xddb98c, 0.45);
    let cast = [
        ("left dancer", Pose::WAVE, -1.5, -0.3, 25.0),
        ("middle dancer", Pose::DANCE, 0.1, 0.35, -15.0),
        ("right dancer", Pose::WALK, 1.6, -0.5, -50.0),
    ];
    for (name, pose, x, z, turn) in cast {
        b.add(name, figure(&pose), wood, at(x, 0.0, z, turn));
    }
    let paint = b.matte("paint", 0x6d7680, 0.6);
    b.add(
        "pedestal",
        moved(block(DVec3::new(0.7, 0.45, 0.7)), &at(0.0, 0.0, 0.0, 20.0)),
        paint,
        at(-2.5, 0.0, -1.5, 0.0),
    );
    b.add("cone", cone(0.3, 0.9, 40), paint, at(-2.5, 0.452, -1.5, 0.0));

    let lamp = b.mesh("lamp", painted(lamp(), paint));
    let lights = [
        ("rose spot", DVec3::new(-3.1, 4.4, 2.9), DVec3::new(-0.9, 0.6, -1.0), 0xff5f86, 190.0),
        ("amber spot", DVec3::new(0.2, 4.8, 3.4), DVec3::new(0.1, 0.9, -0.8), 0xffc766, 105.0),
        ("azure spot", DVec3::new(3.2, 4.4, 2.8), DVec3::new(0.9, 0.6, -1.0), 0x4fa2ff, 260.0),
    ];
    for (name, position, target, color, candela) in lights {
        b.spot(name, position, target, 27.0, color, candela);
        let back = (position - target).normalize();
        let right = DVec3::Y.cross(back).normalize();
        let matrix3 = DMat3::from_cols(right, back.cross(right), back);
        b.place(name, lamp, DAffine3 { matrix3, translation: position });
    }
    b.camera("camera", DVec3::new(-1.2, 1.6, 7.4), DVec3::new(-0.05, 1.42, -0.5), 34.0);
    b.finish()
}

/// A hanging cloth along x with folds, from y = 0 up.
fn curtain(width: f64, height: f64) -> Mesh {
    let columns = (width * 24.0) as usize;
    Slab::new(columns, 6).mesh(
        |_, _| true,
        |i, j| {
            let (x, y) = (width * (i as f64 / columns as f64 - 0.5), height * j as f64 / 6.0);
            let z = 0.09 * (15.0 * x).sin() + 0.03 * (37.0 * x + 1.0).sin();
            [0.015, -0.015].map(|half| DVec3::new(x, y, z * (1.0 - 0.08 * j as f64) + half))
        },
    )
}

/// A spot lamp around the light at the origin, open towards -z.
fn lamp() -> Mesh {
    let outline =
        [(0.0, -0.14), (0.1, -0.14), (0.14, 0.0), (0.17, 0.2), (0.15, 0.2), (0.12, 0.0), (0.08, -0.1), (0.0, -0.1)];
    let shade = lathe(&outline.map(DVec2::from), 32, super::shapes::CREASE);
    let shade = moved(shade, &DAffine3::from_rotation_x(-std::f64::consts::FRAC_PI_2));
    let handle = moved(cylinder(0.02, 0.4, 12), &at(0.0, 0.12, 0.05, 0.0));
    merged("lamp", [shade, handle])
}
