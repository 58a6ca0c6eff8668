//! A ground that shows shadows: what it looks like, and what it leaves alone.

use crate::support::{add, assert_same, at, gpu, light, look, matt, picture, plain, square, sun};
use zfail_plan::glam::{DAffine3, DVec3};
use zfail_plan::light::LightKind;
use zfail_plan::view::{Projection, View};
use zfail_render::{Picture, RenderError, Renderer, Settings, Technique};
use zfail_scene::{AlphaMode, Ground, Material, Scene, Sky, Specular};

const SIZE: [u32; 2] = [96, 64];
const SKY: Sky = Sky { zenith: [0.3, 0.5, 0.9], horizon: [1.0, 0.9, 0.8], nadir: [0.3, 0.25, 0.2] };

/// A square of half width 0.5 that lies a metre over the ground, under the sun at noon.
fn table() -> Scene {
    let mut scene = Scene { background: [0.5, 0.25, 1.0], ..Scene::default() };
    let flat = DAffine3::from_translation(DVec3::Y) * DAffine3::from_rotation_x(-std::f64::consts::FRAC_PI_2);
    add(&mut scene, square(0.5), Material { double_sided: true, ..matt([0.8; 3]) }, flat);
    scene.lights.push(sun(DVec3::NEG_Y, 3.0));
    scene.ground = Some(Ground { height: 0.0, center: [0.0; 2], radius: 100.0 });
    scene
}

fn from_above() -> View {
    look(DVec3::new(0.0, 2.5, 4.0), DVec3::ZERO, SIZE)
}

/// What is shown of a world-space point.
fn pixel(picture: &Picture, view: &View, point: DVec3) -> [f32; 3] {
    let clip = view.clip_from_view() * view.world_from_view.inverse().transform_point3(point).extend(1.0);
    let [w, h] = view.size.map(f64::from);
    at(picture, ((clip.x / clip.w + 1.0) * 0.5 * w) as u32, ((1.0 - clip.y / clip.w) * 0.5 * h) as u32)
}

fn alike(a: [f32; 3], b: [f32; 3]) -> bool {
    a.iter().zip(b).all(|(a, b)| (a - b).abs() < 2e-3)
}

#[test]
fn shadows_have_the_share_of_light_that_is_left() {
    let Some(gpu) = gpu() else { return };
    let view = from_above();
    for (ambient, sky) in [([0.0; 3], None), ([1.0, 0.5, 0.0], None), ([0.1; 3], Some(SKY))] {
        let scene = Scene { ambient, sky, ..table() };
        for samples in [1, 4] {
            let shown = picture(&gpu, &scene, &view, &Settings { samples, ..plain() });
            let bare = picture(&gpu, &Scene { ground: None, ..scene.clone() }, &view, &Settings { samples, ..plain() });
            let direct = 3.0 / std::f32::consts::PI;
            let middle = pixel(&shown, &view, DVec3::ZERO);
            let behind = pixel(&bare, &view, DVec3::ZERO);
            let expected = std::array::from_fn(|c| {
                // Two thirds of the irradiance from above are the zenith's.
                let rest = ambient[c] + sky.map_or(0.0, |sky| (2.0 * sky.zenith[c] + sky.horizon[c]) / 3.0);
                behind[c] * rest / (rest + direct)
            });
            assert!(alike(middle, expected), "{middle:?} is not {expected:?}");
            for (beside, dark) in [(DVec3::X * 0.4, true), (DVec3::X * 0.62, false), (DVec3::Z * 0.66, false)] {
                let is_dark = !alike(pixel(&shown, &view, beside), pixel(&bare, &view, beside));
                assert_eq!(is_dark, dark, "{beside}, {samples} samples");
            }
            // All else is as it was.
            let changed = shown.hdr.iter().zip(&bare.hdr).filter(|(a, b)| !alike(**a, **b)).count();
            assert!((40..500).contains(&changed), "{changed} pixels differ");
        }
    }
}

#[test]
fn the_ground_is_not_there_from_below_without_shadows_or_past_its_rim() {
    let Some(gpu) = gpu() else { return };
    let scene = Scene { ambient: [0.3; 3], ..table() };
    let bare = Scene { ground: None, ..scene.clone() };
    let below = look(DVec3::new(0.0, -2.5, 4.0), DVec3::ZERO, SIZE);
    let mut parallel = below;
    parallel.projection = Projection::Orthographic { ymag: 2.0, near: -9.0, far: 99.0 };
    for view in [below, parallel] {
        assert_same("from below", &picture(&gpu, &scene, &view, &plain()), &picture(&gpu, &bare, &view, &plain()));
    }
    let above = from_above();
    let unshadowed = Settings { shadows: false, ..plain() };
    let [with, without] = [&scene, &bare].map(|scene| picture(&gpu, scene, &above, &unshadowed));
    assert_same("unshadowed ground", &with, &without);
    assert_ne!(picture(&gpu, &scene, &above, &plain()), picture(&gpu, &bare, &above, &plain()), "else it is");

    // Its shadow fades where the sun is low, and ends at the rim.
    let low = Scene { lights: vec![sun(DVec3::new(4.0, -1.0, 0.0), 3.0)], ..bare.clone() };
    let shade = |scene: &Scene, x: f64| {
        let view = look(DVec3::new(x, 3.0, 3.0), DVec3::new(x, 0.0, 0.0), SIZE);
        pixel(&picture(&gpu, scene, &view, &plain()), &view, DVec3::new(x, 0.0, 0.0))[0]
    };
    let dark = |radius| {
        let ground = Some(Ground { height: 0.0, center: [0.0; 2], radius });
        shade(&Scene { ground, ..low.clone() }, 4.0)
    };
    let radii = [100.0, 8.0, 6.0, 5.0, 4.0, 2.0].map(dark);
    assert!(radii[0] == dark(11.0) && radii[0] < 0.3, "{radii:?}");
    assert!(radii.is_sorted() && radii[1] > radii[0] && radii[3] < 0.5, "{radii:?}");
    assert_eq!(radii[4..], [0.5; 2]);
}

#[test]
fn shadows_fall_on_it_far_from_everything_else_by_every_technique() {
    let Some(gpu) = gpu() else { return };
    // Its shadow is out of the scene's bounds, so that a plan that does not know of the ground draws none.
    let mut scene = table();
    scene.lights[0] = sun(DVec3::new(1.0, -0.5, 0.0), 3.0);
    let lamps = [
        scene.lights[0].clone(),
        light(LightKind::Point { position: DVec3::new(-2.0, 2.0, 0.0), range: 50.0 }, 40.0),
        light(
            LightKind::Spot {
                position: DVec3::new(-2.0, 2.0, 0.0),
                direction: DVec3::new(2.0, -1.0, 0.0).normalize(),
                range: f64::INFINITY,
                inner: 0.4,
                outer: 0.6,
            },
            40.0,
        ),
    ];
    let view = look(DVec3::new(2.0, 3.0, 3.0), DVec3::new(2.0, 0.0, 0.0), SIZE);
    for lamp in lamps {
        scene.lights[0] = lamp;
        for technique in Technique::ALL {
            for orthographic in [false, true] {
                let mut view = view;
                if orthographic {
                    view.projection = Projection::Orthographic { ymag: 2.0, near: 0.1, far: 9.0 };
                }
                let shown = picture(&gpu, &scene, &view, &Settings { technique, ..plain() });
                let middle = pixel(&shown, &view, DVec3::X * 2.0);
                assert_eq!(middle, [0.0; 3], "{:?} {technique:?} {orthographic}", scene.lights[0].kind);
                assert_eq!(at(&shown, 2, 60), scene.background);
            }
        }
    }
}

#[test]
fn any_number_of_lights_darkens_it_by_their_shares() {
    let Some(gpu) = gpu() else { return };
    let view = from_above();
    for count in [2_u32, 5, 33, 70] {
        let mut scene = Scene { ambient: [0.25; 3], ..table() };
        // Every second light comes from so low that the shadow is elsewhere.
        scene.lights = (0..count)
            .map(|i| sun(if i % 2 == 0 { DVec3::NEG_Y } else { DVec3::new(1.0, -0.25, 0.1) }, 3.0 / count as f32))
            .collect();
        let shown = picture(&gpu, &scene, &view, &plain());
        let (high, low) = (f64::from(count.div_ceil(2)), f64::from(count / 2));
        let each = 3.0 / f64::from(count) / std::f64::consts::PI;
        let slant = 0.25 / DVec3::new(1.0, -0.25, 0.1).length();
        let rest = 0.25 + low * each * slant;
        let share = rest / (rest + high * each);
        let middle = pixel(&shown, &view, DVec3::ZERO);
        let expected = scene.background.map(|c| (f64::from(c) * share) as f32);
        assert!(alike(middle, expected), "{count} lights: {middle:?} is not {expected:?}");
    }
}

#[test]
fn blended_surfaces_lie_over_it() {
    let Some(gpu) = gpu() else { return };
    let mut scene = table();
    let specular = Specular { strength: 0.0, ..Specular::default() };
    let film = Material { alpha: AlphaMode::Blend, base_color: [0.0, 0.0, 0.0, 0.5], specular, ..matt([0.0; 3]) };
    let flat = DAffine3::from_translation(DVec3::Y * 0.5) * DAffine3::from_rotation_x(-std::f64::consts::FRAC_PI_2);
    let view = look(DVec3::new(0.0, 9.0, 0.1), DVec3::ZERO, SIZE);
    add(&mut scene, square(3.0), film, flat);
    scene.ambient = [3.0 / std::f32::consts::PI; 3];
    scene.instances[0].world_from_object.translation.x = 1.0;
    scene.lights[0] = sun(DVec3::new(-1.0, -1.0, 0.0), 3.0 * std::f32::consts::SQRT_2);
    for samples in [1, 4] {
        let shown = picture(&gpu, &scene, &view, &Settings { samples, ..plain() });
        let share = |x: f64| pixel(&shown, &view, DVec3::new(x, 0.0, 0.0))[2];
        assert!((share(0.0) - 0.25).abs() < 4e-3, "half of half: {}", share(0.0));
        assert!((share(-2.0) - 0.5).abs() < 0.02, "half of all: {}", share(-2.0));
    }
}

#[test]
fn surroundings_change_in_place_and_a_ground_without_extent_is_refused() {
    let Some(gpu) = gpu() else { return };
    let (scene, view) = (table(), from_above());
    let bare = Scene { ground: None, ..scene.clone() };
    let mut renderer = Renderer::new(&gpu, &bare).expect("a renderer");
    let other = Scene { sky: Some(SKY), ambient: [0.2; 3], ..scene.clone() };
    for next in [&scene, &other, &bare] {
        renderer.set_surroundings(next).expect("surroundings");
        let edited = renderer.picture(&view, &plain()).expect("a picture").0;
        assert_same("edited surroundings", &edited, &picture(&gpu, next, &view, &plain()));
    }
    for radius in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let broken = Scene { ground: Some(Ground { height: 0.0, center: [0.0; 2], radius }), ..bare.clone() };
        assert!(matches!(Renderer::new(&gpu, &broken), Err(RenderError::Scene(_))), "{radius}");
        assert!(renderer.set_surroundings(&broken).is_err());
    }
}
