//! Falloff curves, cookies and boxes of lights, against closed forms.

use crate::support::{add, assert_same, at, close, gpu, light, look, matt, picture, plain, reflectance, square, wall};
use zfail_plan::glam::{DAffine3, DMat3, DVec3};
use zfail_plan::light::LightKind;
use zfail_plan::view::{Projection, View};
use zfail_render::{AovKind, Gpu, RenderError, Renderer, Settings, Technique};
use zfail_scene::{AlphaMode, Filter, Image, Light, LightShape, Material, Pose, Scene, Texture, Wrap};

const SIZE: [u32; 2] = [33, 33];
const TOLERANCE: f64 = 4e-3;
const OUTER: f64 = 0.5;

fn head_on() -> View {
    look(DVec3::new(0.0, 0.0, 3.0), DVec3::ZERO, SIZE)
}

/// A point light at `height` above the middle of the wall, its range 4.
fn lamp(height: f64, falloff: &[f32]) -> Light {
    let kind = LightKind::Point { position: DVec3::Z * height, range: 4.0 };
    Light { shape: LightShape { falloff: falloff.to_vec(), ..LightShape::default() }, ..light(kind, 3.0) }
}

/// A spot light 3 m before the wall, shining at it along -z, with cookie 0.
fn projector(axes: DMat3) -> Light {
    let kind = LightKind::Spot {
        position: DVec3::new(0.0, 0.0, 3.0),
        direction: DVec3::NEG_Z,
        range: f64::INFINITY,
        inner: OUTER - 1e-6,
        outer: OUTER,
    };
    Light { shape: LightShape { cookie: Some(0), axes, ..LightShape::default() }, ..light(kind, 9.0) }
}

/// A white wall, with `pixels` in rows from the top as texture 0.
fn cinema(width: u32, pixels: &[[u8; 3]], filter: Filter, mipmaps: bool) -> Scene {
    let rgba = pixels.iter().flat_map(|&[r, g, b]| [r, g, b, 255]).collect();
    let mut scene = wall(matt([1.0; 3]));
    scene.images.push(Image { name: "slide".into(), width, height: pixels.len() as u32 / width, rgba });
    let (wrap_u, wrap_v) = (Wrap::Repeat, Wrap::Repeat);
    scene.textures.push(Texture { image: 0, wrap_u, wrap_v, mag: filter, min: filter, mipmaps });
    scene
}

const RED: [u8; 3] = [255, 0, 0];
const GREEN: [u8; 3] = [0, 255, 0];
const BLUE: [u8; 3] = [0, 0, 255];
const WHITE: [u8; 3] = [255; 3];
/// From the top left corner.
const FOUR: [[u8; 3]; 4] = [RED, GREEN, BLUE, WHITE];

/// Which channels are lit in the four quadrants of a picture, from the top left corner.
fn quadrants(gpu: &Gpu, scene: &Scene, settings: &Settings) -> [[u8; 3]; 4] {
    let found = picture(gpu, scene, &head_on(), settings);
    [(10, 10), (22, 10), (10, 22), (22, 22)].map(|(x, y)| at(&found, x, y).map(|c| if c > 0.1 { 255 } else { 0 }))
}

#[test]
fn a_curve_replaces_the_inverse_square_law_and_the_window() {
    let Some(gpu) = gpu() else { return };
    let normal = reflectance(1.0, 0.0, 1.0, DVec3::Z, DVec3::Z, DVec3::Z);
    for (height, value) in [(0.5, 1.75), (2.0, 1.0), (2.5, 1.75), (3.0, 2.5), (3.99, 3.985), (4.01, 0.0)] {
        // One is unrolled, nine are in a loop.
        for lights in [1, 9] {
            let mut scene = wall(matt([1.0; 3]));
            let one = Light { intensity: 3.0 / lights as f32, ..lamp(height, &[2.0, 1.0, 4.0]) };
            scene.lights = vec![one; lights];
            let found = at(&picture(&gpu, &scene, &look(DVec3::Z * 9.0, DVec3::ZERO, SIZE), &plain()), 16, 16)[0];
            assert!(close(found, 3.0 * value * normal, 8e-3), "at {height}: {found} is not {}", 3.0 * value * normal);
        }
    }
}

#[test]
fn a_constant_curve_is_constant_irradiance() {
    let Some(gpu) = gpu() else { return };
    let view = look(DVec3::Z * 9.0, DVec3::ZERO, SIZE);
    let found = |falloff: &[f32]| {
        [0.5, 3.5].map(|height| {
            let mut scene = wall(matt([1.0; 3]));
            scene.lights.push(lamp(height, falloff));
            at(&picture(&gpu, &scene, &view, &plain()), 16, 16)[0]
        })
    };
    let [near, far] = found(&[1.0, 1.0]);
    assert!(close(near, far.into(), TOLERANCE), "{near} is not {far}");
    let [near, far] = found(&[]);
    assert!(near > 10.0 * far, "without a curve it falls off: {near}, {far}");
}

#[test]
fn one_light_of_a_shape_leaves_the_others_as_they_are() {
    let Some(gpu) = gpu() else { return };
    let render = |lights: &[Light]| {
        let mut scene = wall(matt([1.0; 3]));
        scene.lights = lights.to_vec();
        at(&picture(&gpu, &scene, &look(DVec3::Z * 9.0, DVec3::ZERO, SIZE), &plain()), 16, 16)[0]
    };
    let (physical, curved) = (lamp(2.0, &[]), lamp(3.0, &[1.0, 0.5]));
    let sum = render(std::slice::from_ref(&physical)) + render(std::slice::from_ref(&curved));
    let both = render(&[physical, curved]);
    assert!(close(both, sum.into(), TOLERANCE), "{both} is not {sum}");
}

#[test]
fn a_cookie_stands_upright_and_turns_with_the_light() {
    let Some(gpu) = gpu() else { return };
    let mut scene = cinema(2, &FOUR, Filter::Nearest, false);
    scene.lights.push(projector(DMat3::IDENTITY));
    for samples in [1, 4] {
        assert_eq!(quadrants(&gpu, &scene, &Settings { samples, ..plain() }), FOUR, "{samples} samples");
    }
    // A quarter turn to the left, as the light sees it: its top is on the left, its right at the top.
    scene.lights[0] = projector(DMat3::from_rotation_z(std::f64::consts::FRAC_PI_2));
    assert_eq!(quadrants(&gpu, &scene, &plain()), [GREEN, WHITE, RED, BLUE]);
    // Among many lights.
    scene.lights = vec![projector(DMat3::IDENTITY); 9];
    assert_eq!(quadrants(&gpu, &scene, &plain()), FOUR);
    // Of two colours.
    let mut scene = cinema(2, &[RED, BLUE], Filter::Linear, true);
    scene.lights.push(projector(DMat3::IDENTITY));
    assert_eq!(quadrants(&gpu, &scene, &plain()), [RED, BLUE, RED, BLUE]);
    // Without it all colours are there.
    scene.lights[0].shape = LightShape::default();
    assert_eq!(quadrants(&gpu, &scene, &plain()), [WHITE; 4]);
}

#[test]
fn a_cookie_turns_with_the_pose() {
    let Some(gpu) = gpu() else { return };
    let mut scene = cinema(2, &FOUR, Filter::Nearest, false);
    scene.lights.push(projector(DMat3::IDENTITY));
    let mut renderer = Renderer::new(&gpu, &scene).expect("a renderer");
    let upright = renderer.picture(&head_on(), &plain()).expect("a picture").0;
    let mut pose = Pose::of(&scene);
    pose.light_axes[0] = DMat3::from_rotation_z(1.0);
    renderer.set_pose(&pose).expect("a pose that fits");
    let turned = renderer.picture(&head_on(), &plain()).expect("a picture").0;
    scene.set_pose(&pose);
    assert_same("a turned cookie", &turned, &picture(&gpu, &scene, &head_on(), &plain()));
    assert!(turned != upright);
    pose.light_axes[0].x_axis.x = f64::NAN;
    assert!(matches!(renderer.set_pose(&pose), Err(RenderError::Scene(_))));
}

#[test]
fn blended_surfaces_and_orthographic_views_show_the_cookie_too() {
    let Some(gpu) = gpu() else { return };
    let mut scene = cinema(2, &FOUR, Filter::Nearest, true);
    scene.lights.push(projector(DMat3::IDENTITY));
    let glass = Material { alpha: AlphaMode::Blend, ..matt([1.0; 3]) };
    scene.instances.clear();
    add(&mut scene, square(9.0), glass, DAffine3::IDENTITY);
    assert_eq!(quadrants(&gpu, &scene, &plain()), FOUR);

    let mut view = head_on();
    view.projection = Projection::Orthographic { ymag: 1.6, near: -5.0, far: 10.0 };
    let found = picture(&gpu, &scene, &view, &plain());
    assert!(at(&found, 22, 10)[1] > 0.1 && at(&found, 22, 10)[0] == 0.0);
}

#[test]
fn a_cookie_fills_the_square_around_the_cone_and_its_codes_are_srgb() {
    let Some(gpu) = gpu() else { return };
    // Columns: black, black, black, grey.
    let row = [[0; 3], [0; 3], [0; 3], [188; 3]];
    let mut scene = cinema(4, &[row, row, row, row].concat(), Filter::Nearest, false);
    scene.lights.push(projector(DMat3::IDENTITY));
    let mut view = head_on();
    view.projection = Projection::Orthographic { ymag: 0.5, near: -5.0, far: 10.0 };
    // The last column begins half way to the edge, the cone ends there.
    let radius = 3.0 * OUTER.tan();
    let found = |x: f64| {
        let mut view = view;
        view.world_from_view.translation.x = x;
        at(&picture(&gpu, &scene, &view, &plain()), 16, 16)[0]
    };
    for (x, code) in [(0.48, 0.0), (0.52, 0.502_886_5), (0.98, 0.502_886_5), (1.02, 0.0), (-0.6, 0.0)] {
        let to_light = DVec3::new(-x * radius, 0.0, 3.0);
        let r = reflectance(1.0, 0.0, 1.0, DVec3::Z, DVec3::Z, to_light.normalize());
        let expected = code * r * 9.0 / to_light.length_squared();
        assert!(close(found(x * radius), expected, TOLERANCE), "at {x}: {} is not {expected}", found(x * radius));
    }
}

#[test]
fn a_cookie_seen_from_afar_is_averaged() {
    let Some(gpu) = gpu() else { return };
    let checker: Vec<[u8; 3]> =
        (0..256 * 256).map(|i| if (i / 256 + i) % 2 == 0 { [0; 3] } else { [255; 3] }).collect();
    // The least and the greatest share of the light that passes in the middle of the picture.
    let spread = |mipmaps| {
        let mut scene = cinema(256, &checker, Filter::Nearest, mipmaps);
        scene.lights.push(projector(DMat3::IDENTITY));
        let slide = picture(&gpu, &scene, &head_on(), &plain());
        scene.lights[0].shape = LightShape::default();
        let open = picture(&gpu, &scene, &head_on(), &plain());
        let shares = (12..21).flat_map(|y| (12..21).map(move |x| (x, y)));
        let shares = shares.map(|(x, y)| at(&slide, x, y)[0] / at(&open, x, y)[0]);
        shares.fold((f32::MAX, 0.0_f32), |(least, greatest), s| (least.min(s), greatest.max(s)))
    };
    let (least, greatest) = spread(true);
    assert!(least > 0.49 && greatest < 0.51, "{least} to {greatest}");
    let (least, greatest) = spread(false);
    assert!(least < 0.01 && greatest > 0.99, "single texels: {least} to {greatest}");
}

#[test]
fn a_box_ends_light_and_mask_along_its_own_axes() {
    let Some(gpu) = gpu() else { return };
    let kind = LightKind::Point { position: DVec3::Z, range: f64::INFINITY };
    let axes = DMat3::from_rotation_z(0.6);
    let half_extents = Some(DVec3::new(1.0, 0.4, 1.5));
    let mut scene = wall(matt([1.0; 3]));
    scene.lights.push(Light { shape: LightShape { half_extents, axes, ..LightShape::default() }, ..light(kind, 9.0) });
    let view = head_on();
    let mask = |scene: &Scene| {
        let mut renderer = Renderer::new(&gpu, scene).expect("a renderer");
        renderer.aovs(&view, &plain(), &[AovKind::Shadow]).expect("masks").shadow.remove(0)
    };
    let (found, masked) = (picture(&gpu, &scene, &view, &plain()), mask(&scene));
    let mut inside = 0;
    for (i, &masked) in masked.iter().enumerate() {
        let [x, y] = [i as u32 % SIZE[0], i as u32 / SIZE[0]];
        let [px, py] = [x, y].map(|p| ((f64::from(p) + 0.5) / 33.0 * 2.0 - 1.0) * 3.0 * 0.5_f64.tan());
        let excess = scene.lights[0].box_excess(DVec3::new(px, -py, 0.0));
        if excess.abs() > 1e-4 {
            let expected = excess < 0.0;
            assert_eq!((at(&found, x, y)[0] > 0.0, masked == 255), (expected, expected), "at {x}, {y}");
            inside += u32::from(expected);
        }
    }
    assert!((50..500).contains(&inside), "{inside} pixels inside");
    scene.lights[0].shape.half_extents = Some(DVec3::new(1.0, 0.4, 0.9));
    assert!(mask(&scene).iter().all(|&m| m == 0), "the wall is behind the box");
    scene.lights[0].shape.half_extents = None;
    assert!(mask(&scene).iter().all(|&m| m == 255));
}

#[test]
fn the_box_of_a_light_bounds_its_casters_too() {
    let Some(gpu) = gpu() else { return };
    let scene = zfail_builtin::scene("lantern").expect("a built-in scene");
    let view = scene.cameras[0].view([160, 90], &scene.bounds());
    let drawn = |scene: &Scene, technique| {
        let settings = Settings { technique, lights: Some(vec![1]), ..Settings::default() };
        let mut renderer = Renderer::new(&gpu, scene).expect("a renderer");
        let (_, stats) = renderer.picture(&view, &settings).expect("a picture");
        let mask = renderer.aovs(&view, &settings, &[AovKind::Shadow]).expect("masks").shadow.remove(0);
        let beyond = stats.lights[0].culled.get("out of range").copied().unwrap_or(0);
        (stats.lights[0].casters - beyond, mask)
    };
    let (all, truth) = drawn(&scene, Technique::EverittKilgard);
    let (few, mask) = drawn(&scene, Technique::Mcguire);
    assert_eq!((all, few), (8, 2));
    assert!(mask == truth && mask.contains(&255));
    // The ball around the box holds more.
    let mut ball = scene.clone();
    let half = ball.lights[1].shape.half_extents.take().expect("a box");
    ball.lights[1].kind =
        LightKind::Point { position: ball.lights[1].kind.homogeneous().truncate(), range: half.length() };
    let (more, mask) = drawn(&ball, Technique::Mcguire);
    assert!(more > few && mask != truth, "{more}");
}

#[test]
fn shapes_that_cannot_be_are_refused() {
    let Some(gpu) = gpu() else { return };
    let fails = |damage: fn(&mut Light)| {
        let mut scene = cinema(2, &FOUR, Filter::Linear, true);
        scene.lights.push(projector(DMat3::IDENTITY));
        damage(&mut scene.lights[0]);
        match Renderer::new(&gpu, &scene) {
            Err(RenderError::Scene(message)) => message,
            other => panic!("{other:?}"),
        }
    };
    assert_eq!(fails(|l| l.shape.cookie = Some(1)), "light 0: its cookie refers to a texture that is not there");
    assert_eq!(fails(|l| l.shape.falloff = vec![1.0]), "light 0: its falloff needs at least 2 samples");
    assert!(fails(|l| l.shape.falloff = vec![1.0; 2]).contains("finite range"));
    assert!(fails(|l| l.shape.half_extents = Some(DVec3::ZERO)).contains("box needs"));
    assert!(fails(|l| l.kind = LightKind::Directional { direction: DVec3::X }).contains("needs a spot light"));
}
