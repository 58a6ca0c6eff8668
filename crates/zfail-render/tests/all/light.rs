//! Pictures whose radiance is known in closed form.

use crate::support::{add, at, close, gpu, light, look, matt, picture, plain, reflectance, square, sun, wall};
use zfail_plan::glam::{DAffine3, DMat3, DVec3};
use zfail_plan::light::LightKind;
use zfail_plan::view::{Projection, View};
use zfail_render::{Gpu, Renderer, Settings};
use zfail_scene::{AlphaMode, Material, Scene};
use zfail_testing::assert_alike;

const SIZE: [u32; 2] = [33, 33];
/// Half floats hold eleven bits; normals and sums take a few of their last ones.
const TOLERANCE: f64 = 4e-3;

fn head_on() -> View {
    look(DVec3::new(0.0, 0.0, 3.0), DVec3::ZERO, SIZE)
}

#[test]
fn a_wall_in_sunlight_reflects_what_the_model_says() {
    let Some(gpu) = gpu() else { return };
    for (lux, direction) in
        [(3.0, DVec3::NEG_Z), (1e5, DVec3::new(0.4, -0.7, -1.0)), (2e-3, DVec3::new(3.0, 1.0, -1.0))]
    {
        // Values that the targets hold exactly.
        for (metallic, roughness) in [(0.0, 1.0), (0.0, 0.5), (1.0, 0.5)] {
            let mut scene = wall(Material { metallic, roughness, ..matt([1.0; 3]) });
            scene.lights.push(sun(direction, lux));
            let l = -direction.normalize();
            let [m, r] = [metallic, roughness].map(f64::from);
            let expected = f64::from(lux) * reflectance(1.0, m, r, DVec3::Z, DVec3::Z, l);
            let found = at(&picture(&gpu, &scene, &head_on(), &plain()), 16, 16);
            for channel in found {
                assert!(close(channel, expected, TOLERANCE), "{found:?} is not {expected}");
            }
        }
    }
}

#[test]
fn base_colour_scales_diffuse_light() {
    let Some(gpu) = gpu() else { return };
    // The sRGB codes 128 and 188.
    let albedo = [0.215_860_5, 0.502_886_5, 0.0];
    let mut scene = wall(matt(albedo));
    scene.lights.push(sun(DVec3::NEG_Z, 2.0));
    let found = at(&picture(&gpu, &scene, &head_on(), &plain()), 16, 16);
    for (channel, albedo) in found.into_iter().zip(albedo) {
        let expected = 2.0 * reflectance(albedo.into(), 0.0, 1.0, DVec3::Z, DVec3::Z, DVec3::Z);
        // The decoding of sRGB textures is approximate on some devices.
        assert!(close(channel, expected, 1e-2), "{found:?}: {channel} is not {expected}");
    }
}

#[test]
fn the_comparison_can_fail() {
    assert!(!close(1.01, 1.0, TOLERANCE) && close(1.001, 1.0, TOLERANCE));
}

#[test]
fn point_and_spot_lights_fall_off_as_the_extension_says() {
    let Some(gpu) = gpu() else { return };
    let position = DVec3::new(1.0, 0.5, 2.0);
    let distance = position.length();
    let v = DVec3::Z;
    let l = position / distance;
    let plain_reflectance = reflectance(1.0, 0.0, 1.0, DVec3::Z, v, l) * 40.0 / (distance * distance);
    let range = 4.0;
    let window = 1.0 - (distance / range).powi(4);
    let (inner, outer) = (0.1, 0.6);
    // The axis misses the wall's centre by 0.35 radians.
    let axis = DMat3::from_rotation_y(0.35) * -l;
    let cosine = axis.normalize().dot(-l);
    let cone = ((cosine - f64::cos(outer)) / (f64::cos(inner) - f64::cos(outer))).powi(2);
    let spot = |direction| LightKind::Spot { position, direction, range: f64::INFINITY, inner, outer };
    let cases = [
        (LightKind::Point { position, range: f64::INFINITY }, 1.0),
        (LightKind::Point { position, range }, window),
        (LightKind::Point { position, range: distance * 0.999 }, 0.0),
        (spot(axis), cone),
        (spot(DMat3::from_rotation_y(0.62) * -l), 0.0),
        (spot(l), 0.0),
    ];
    for (kind, share) in cases {
        let mut scene = wall(matt([1.0; 3]));
        scene.lights.push(light(kind, 40.0));
        let found = at(&picture(&gpu, &scene, &head_on(), &plain()), 16, 16)[0];
        let expected = plain_reflectance * share;
        assert!(close(found, expected, TOLERANCE), "{kind:?}: {found} is not {expected}");
    }
}

#[test]
fn ambient_and_emitted_light_add_up() {
    let Some(gpu) = gpu() else { return };
    let mut scene = wall(Material { emissive: [0.5, 0.0, 2.0], ..matt([1.0, 0.0, 1.0]) });
    scene.ambient = [0.25, 3.0, 0.125];
    let found = at(&picture(&gpu, &scene, &head_on(), &plain()), 16, 16);
    assert_eq!(found, [0.75, 0.0, 2.125]);
}

#[test]
fn unlit_colour_is_shown_as_it_is() {
    let Some(gpu) = gpu() else { return };
    let mut scene = wall(Material { unlit: true, ..matt([0.215_860_5, 1.0, 0.0]) });
    scene.lights.push(sun(DVec3::NEG_Z, 1e4));
    scene.ambient = [100.0; 3];
    for settings in [plain(), Default::default()] {
        for samples in [1, 4] {
            let found = picture(&gpu, &scene, &head_on(), &Settings { samples, ..settings.clone() });
            assert_eq!(found.rgba8[..4], [128, 255, 0, 255]);
        }
    }
}

/// A row of 8-bit codes across a wall that a point light grades smoothly.
fn gradient(gpu: &Gpu, lights: u16) -> Vec<u8> {
    let mut scene = wall(matt([1.0; 3]));
    let lamp = LightKind::Point { position: DVec3::new(-2.0, 0.0, 1.5), range: f64::INFINITY };
    scene.lights = vec![light(lamp, 6.0 / f32::from(lights)); lights.into()];
    let view = look(DVec3::new(0.0, 0.0, 3.0), DVec3::ZERO, [256, 192]);
    picture(gpu, &scene, &view, &plain()).rgba8.chunks_exact(4).skip(96 * 256).take(256).map(|p| p[0]).collect()
}

/// The greatest difference, in codes.
fn difference(a: &[u8], b: &[u8]) -> u8 {
    a.iter().zip(b).map(|(a, b)| a.abs_diff(*b)).max().unwrap_or(u8::MAX)
}

#[test]
fn fifty_lights_equal_one_without_banding() {
    let Some(gpu) = gpu() else { return };
    let [one, fifty] = [1, 50].map(|lights| gradient(&gpu, lights));
    assert!(one.iter().max() > Some(&150) && one.iter().min() < Some(&80), "no gradient: {one:?}");
    // Half-float sums may lose half a unit in the last place each, if the device cuts instead of rounding: 1 % in all.
    assert!(difference(&one, &fifty) <= 2, "{one:?}\n{fifty:?}");
    // To the right of the brightest point.
    assert!(fifty[20..].is_sorted_by(|a, b| a >= b), "banding: {fifty:?}");

    // An 8-bit sum of the same lights would fail both.
    let eight_bit: Vec<u8> = one.iter().map(|&c| (u32::from(c) / 50 * 50) as u8).collect();
    assert!(difference(&one, &eight_bit) > 2);
    assert!(difference(&one, &gradient(&gpu, 49).iter().map(|c| c - 3).collect::<Vec<_>>()) > 2);
}

#[test]
fn back_faces_are_hidden_unless_double_sided_however_instances_are_mirrored() {
    let Some(gpu) = gpu() else { return };
    let turned = DAffine3::from_rotation_y(std::f64::consts::PI);
    let mirrored = DAffine3::from_scale(DVec3::new(-1.0, 1.0, 1.0));
    for (placement, double_sided, visible) in [
        (DAffine3::IDENTITY, false, true),
        (turned, false, false),
        (turned, true, true),
        (mirrored, false, true),
        (mirrored * turned, false, false),
        (mirrored * turned, true, true),
        (DAffine3::from_scale(DVec3::new(1.0, 1.0, -1.0)), false, false),
    ] {
        for alpha in [AlphaMode::Opaque, AlphaMode::Mask(0.5), AlphaMode::Blend] {
            let mut scene = Scene { background: [0.0, 0.0, 1.0], ..Scene::default() };
            add(&mut scene, square(9.0), Material { double_sided, alpha, ..matt([1.0; 3]) }, placement);
            scene.lights.push(sun(DVec3::NEG_Z, 3.0));
            let found = at(&picture(&gpu, &scene, &head_on(), &plain()), 16, 16);
            let expected = if visible { 3.0 * reflectance(1.0, 0.0, 1.0, DVec3::Z, DVec3::Z, DVec3::Z) } else { 0.0 };
            assert!(close(found[0], expected, TOLERANCE), "{placement:?} {double_sided} {alpha:?}: {found:?}");
        }
    }
}

#[test]
fn blended_surfaces_cover_what_is_behind_them_from_back_to_front() {
    let Some(gpu) = gpu() else { return };
    let mut scene = wall(Material { unlit: false, emissive: [1.0, 0.0, 0.0], ..matt([0.0; 3]) });
    let glass = |emissive, alpha| Material {
        alpha: AlphaMode::Blend,
        base_color: [0.0, 0.0, 0.0, alpha],
        emissive,
        ..matt([0.0; 3])
    };
    // The nearer one comes first in the scene.
    add(&mut scene, square(9.0), glass([0.0, 0.0, 1.0], 0.5), DAffine3::from_translation(DVec3::Z * 2.0));
    add(&mut scene, square(9.0), glass([0.0, 1.0, 0.0], 0.25), DAffine3::from_translation(DVec3::Z));
    // Behind the wall: hidden.
    add(&mut scene, square(9.0), glass([9.0; 3], 0.5), DAffine3::from_translation(-DVec3::Z));
    for samples in [1, 4] {
        let settings = Settings { samples, ..plain() };
        let found = at(&picture(&gpu, &scene, &head_on(), &settings), 16, 16);
        assert_eq!(found, [0.75 * 0.5, 0.25 * 0.5, 0.5], "at {samples} samples");
    }
}

#[test]
fn alpha_masks_cut_holes() {
    let Some(gpu) = gpu() else { return };
    for (cutoff, expected) in [(0.4, [1.0, 0.0, 0.0]), (0.6, [0.0, 0.0, 1.0])] {
        let mut scene = Scene { background: [0.0, 0.0, 1.0], ..Scene::default() };
        let leaf = Material {
            alpha: AlphaMode::Mask(cutoff),
            base_color: [0.0, 0.0, 0.0, 0.5],
            emissive: [1.0, 0.0, 0.0],
            ..matt([0.0; 3])
        };
        add(&mut scene, square(9.0), leaf, DAffine3::IDENTITY);
        assert_eq!(at(&picture(&gpu, &scene, &head_on(), &plain()), 16, 16), expected);
    }
}

#[test]
fn an_orthographic_camera_sees_the_same_light() {
    let Some(gpu) = gpu() else { return };
    let mut scene = wall(matt([1.0; 3]));
    let position = DVec3::new(1.0, 0.5, 2.0);
    scene.lights.push(light(LightKind::Point { position, range: f64::INFINITY }, 40.0));
    let mut view = head_on();
    view.projection = Projection::Orthographic { ymag: 2.0, near: -5.0, far: 10.0 };
    let found = picture(&gpu, &scene, &view, &plain());
    for (x, y) in [(16, 16), (3, 28), (30, 9)] {
        let [px, py] = [x, y].map(|p| (f64::from(p) + 0.5) / 33.0 * 4.0 - 2.0);
        let to_light = position - DVec3::new(px, -py, 0.0);
        let l = to_light.normalize();
        let expected = 40.0 / to_light.length_squared() * reflectance(1.0, 0.0, 1.0, DVec3::Z, DVec3::Z, l);
        let radiance = at(&found, x, y)[0];
        assert!(close(radiance, expected, TOLERANCE), "at {x}, {y}: {radiance} is not {expected}");
    }
}

#[test]
fn a_million_metres_away_nothing_changes() {
    let Some(gpu) = gpu() else { return };
    let render = |offset: DVec3| {
        let mut scene = Scene::default();
        add(&mut scene, square(50.0), matt([0.8; 3]), DAffine3::from_translation(offset));
        let post = DAffine3::from_translation(offset + DVec3::new(0.3, 0.1, 0.7));
        add(&mut scene, square(0.4), Material { double_sided: true, ..matt([0.8; 3]) }, post);
        let kind = LightKind::Point { position: offset + DVec3::new(1.0, 0.5, 2.0), range: 9.0 };
        scene.lights.push(light(kind, 40.0));
        let mut view = look(DVec3::new(-1.0, 1.0, 3.0), DVec3::ZERO, [64, 64]);
        view.world_from_view.translation += offset;
        Renderer::new(&gpu, &scene).expect("a renderer").picture(&view, &plain()).expect("a picture").0
    };
    // Offsets that f64 adds without rounding.
    let near = render(DVec3::ZERO);
    let far = render(DVec3::new(1_048_576.0, -1_048_576.0, 2_097_152.0));
    let differ = near.rgba8.chunks_exact(4).zip(far.rgba8.chunks_exact(4)).filter(|(a, b)| a != b).count();
    assert!(differ <= 4, "{differ} pixels differ");
    let elsewhere = render(DVec3::new(0.05, 0.0, 0.0));
    assert_alike("relative placement", near.size, &elsewhere.rgba8, &near.rgba8, 0);
}
