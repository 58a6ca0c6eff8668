//! 1000 and 256 stacked sheets between light and floor: counts beyond the 8 bits of the stencil buffer
//! (E&K section 4.1; McGuire et al. section 4 on the 256th stair).

use glam::{DVec2, DVec3};
use zfail_scene::{Mesh, Scene};

use super::builder::{SceneBuilder, at, linear};
use super::pattern;
use super::props::{Pose, figure};
use super::shapes::{Facets, cylinder, ico_sphere, merged, tinted};

pub(super) fn scene() -> Scene {
    let mut b = SceneBuilder::new("stacked", [0.03, 0.032, 0.042], [0.012, 0.014, 0.02]);
    let floor = b.textured(pattern::tiles("floor", 2, [0xc2bcb2, 0xaea79c], 0x6f6a62), 2.4, 0.45);
    let wall = b.textured(pattern::stone("wall", 0x8d949c, 0.1), 2.5, 0.9);
    b.block("floor", [-6.0, -0.3, -3.2], [6.0, 0.0, 6.0], floor);
    b.block("wall", [-6.0, -0.3, -3.5], [6.0, 6.0, -3.2], wall);

    let paper = b.matte("paper", 0xffffff, 0.7);
    let paper = b.double_sided(paper);
    b.add("1000 sheets", stack(1000, 0.0027, [0xf2c14e, 0xc8402f]), paper, at(-1.25, 0.55, 0.0, 0.0));
    b.add("256 sheets", stack(256, 0.0063, [0x8fd6c4, 0x2c5f9e]), paper, at(1.35, 0.55, 0.0, 30.0));

    let dark = b.matte("cushion", 0x4a4d55, 0.6);
    for x in [-1.25, 1.35] {
        b.add("disc", cylinder(0.85, 0.04, 64), dark, at(x, 0.0, 0.0, 0.0));
    }
    let wood = b.matte("wood", 0xd2a877, 0.5);
    b.add("visitor", figure(&Pose::STAND), wood, at(3.0, 0.0, -0.6, -60.0));
    let ball = b.matte("ball", 0xb8493a, 0.35);
    b.add("ball", ico_sphere(0.22, 4, true), ball, at(0.1, 0.22, 0.9, 0.0));

    let spots = [("spot over 1000", -1.25, 0xffe0b8, 75.0), ("spot over 256", 1.35, 0xcfe4ff, 75.0)];
    for (name, x, color, candela) in spots {
        b.spot(name, DVec3::new(x, 6.2, 0.0), DVec3::new(x, 0.0, 0.0), 24.0, color, candela);
    }
    b.point("window", DVec3::new(-1.2, 3.4, 7.0), 0xaec4ff, 26.0);
    b.camera("camera", DVec3::new(1.3, 4.5, 6.3), DVec3::new(0.1, 1.3, 0.0), 42.0);
    b.finish()
}

/// `count` square sheets, `gap` metres apart, each turned a little against the one below, from one colour to another.
/// A disc of 0.4 m radius is covered by all of them.
fn stack(count: u32, gap: f64, colors: [u32; 2]) -> Mesh {
    let [from, to] = colors.map(linear);
    let sheets = (0..count).map(|k| {
        let share = f64::from(k) / f64::from(count);
        let side = 0.42 + 0.14 * (std::f64::consts::PI * share).sin().powi(2);
        let corner = |n: u32| {
            let p = DVec2::from_angle(2.4 * share + std::f64::consts::FRAC_PI_2 * f64::from(n)) * side * 2.0_f64.sqrt();
            DVec3::new(p.x, gap * f64::from(k), -p.y)
        };
        let mut facets = Facets::default();
        facets.quad([0, 1, 2, 3].map(corner));
        let color = std::array::from_fn(|c| from[c] + (to[c] - from[c]) * share as f32);
        tinted(facets.mesh("sheet", 0.0), color)
    });
    merged("stack", sheets)
}
