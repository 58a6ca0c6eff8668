//! Surfaces that are seen through: their order, their shadows and what they let pass.

use crate::support::{add, at, close, gpu, look, matt, picture, plain, reflectance, square, sun, wall};
use zfail_plan::glam::{DAffine3, DVec3};
use zfail_plan::view::View;
use zfail_render::{AovKind, Renderer, Settings};
use zfail_scene::{AlphaMode, Material, Mesh, Scene, Specular, Transmission};

const SIZE: [u32; 2] = [33, 33];

fn head_on() -> View {
    look(DVec3::new(0.0, 0.0, 3.0), DVec3::ZERO, SIZE)
}

fn film(color: [f32; 3], alpha: f32) -> Material {
    let [r, g, b] = color;
    Material { alpha: AlphaMode::Blend, base_color: [r, g, b, alpha], ..matt([0.0; 3]) }
}

/// Two sheets of glowing film in one mesh, the nearer one first.
fn stack() -> Mesh {
    let mut mesh = square(9.0);
    let [far, near] = [1.0, 2.0].map(|z| square(9.0).positions.iter().map(|&[x, y, _]| [x, y, z]).collect::<Vec<_>>());
    mesh.positions = [near, far].concat();
    mesh.colors = [[[0.0, 0.0, 1.0, 0.5]; 4], [[0.0, 1.0, 0.0, 0.25]; 4]].concat();
    for attribute in [&mut mesh.uv0, &mut mesh.uv1] {
        attribute.extend_from_within(..);
    }
    mesh.normals.extend_from_within(..);
    mesh.tangents.extend_from_within(..);
    mesh.triangles.extend([[4, 5, 6], [4, 6, 7]]);
    mesh.primitives[0].triangles = 0..4;
    mesh
}

#[test]
fn triangles_of_one_mesh_are_blended_from_back_to_front() {
    let Some(gpu) = gpu() else { return };
    for double_sided in [false, true] {
        // Seen from both sides.
        for (side, expected) in [(1.0, [0.75 * 0.5, 0.25 * 0.5, 0.5]), (-1.0, [0.75 * 0.5, 0.25, 0.5 * 0.75])] {
            if side < 0.0 && !double_sided {
                continue;
            }
            let mut scene = Scene { background: [1.0, 0.0, 0.0], ..Scene::default() };
            add(&mut scene, stack(), Material { double_sided, ..film([1.0; 3], 1.0) }, DAffine3::IDENTITY);
            scene.ambient = [1.0; 3];
            let view = look(DVec3::new(0.0, 0.001, 5.0 * side), DVec3::ZERO, SIZE);
            for samples in [1, 4] {
                let found = at(&picture(&gpu, &scene, &view, &Settings { samples, ..plain() }), 16, 16);
                let difference = found.iter().zip(expected).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
                assert!(difference < 1e-3, "{side}, {samples} samples: {found:?} is not {expected:?}");
            }
        }
    }
}

/// A pane at z = 1, before a black wall and behind a black square at z = 2.
fn pane() -> Scene {
    let mut scene = wall(Material { unlit: true, ..matt([0.0; 3]) });
    add(&mut scene, square(9.0), film([1.0; 3], 0.5), DAffine3::from_translation(DVec3::Z));
    add(&mut scene, square(0.3), matt([0.0; 3]), DAffine3::from_translation(DVec3::new(-0.1, 0.0, 2.0)));
    // From the right, so that the shadow is beside the square.
    scene.lights.push(sun(DVec3::new(-1.0, 0.0, -1.0), 3.0));
    scene
}

#[test]
fn shadows_fall_on_blended_surfaces() {
    let Some(gpu) = gpu() else { return };
    let scene = pane();
    let expected = 0.5 * 3.0 * reflectance(1.0, 0.0, 1.0, DVec3::Z, DVec3::Z, DVec3::new(1.0, 0.0, 1.0).normalize());
    let view = look(DVec3::new(0.0, 0.0, 5.0), DVec3::new(0.0, 0.0, 0.0), SIZE);
    // 4 m from the eye a pixel is 0.132 m; the shadow is centred at x = -1.1.
    let column = |x: f64| (16.5 + x / (8.0 * 0.5_f64.tan() / 33.0)) as u32;
    for samples in [1, 4] {
        let settings = Settings { samples, ..plain() };
        let shown = picture(&gpu, &scene, &view, &settings);
        assert_eq!(at(&shown, column(-1.1), 16), [0.0; 3], "in shadow at {samples} samples");
        let lit = at(&shown, column(1.0), 16)[0];
        assert!((f64::from(lit) - expected).abs() < 0.1 * expected, "{lit} is not {expected}");
        let open = picture(&gpu, &scene, &view, &Settings { shadows: false, ..settings });
        assert!(at(&open, column(-1.1), 16)[0] > 0.5 * lit, "the comparison can fail");
    }
}

#[test]
fn light_of_many_lights_is_blended_as_that_of_few() {
    let Some(gpu) = gpu() else { return };
    // Nothing casts, so that shadows change nothing: seen from the front, a film that shines by itself, glass, and film.
    let layers = [
        Material { unlit: true, ..film([0.3, 0.1, 0.2], 0.5) },
        Material {
            transmission: Some(Transmission { share: 0.7, texture: None, tint: [0.9, 1.0, 0.8] }),
            ..matt([0.8; 3])
        },
        film([0.9, 0.5, 0.7], 0.4),
    ];
    for count in [33, 70] {
        let mut scene = wall(matt([0.5, 0.4, 0.3]));
        for (height, material) in (1..).zip(layers.iter().rev()) {
            let place = DAffine3::from_translation(DVec3::Z * f64::from(height) * 0.3);
            add(&mut scene, square(9.0), material.clone(), place);
        }
        scene.instances.iter_mut().for_each(|instance| instance.casts_shadow = false);
        scene.ambient = [0.2; 3];
        let lamp = |i: usize| sun(DVec3::new((i % 9) as f64 - 4.0, (i / 9) as f64 - 4.0, -5.0), 0.05 + 0.01 * i as f32);
        scene.lights = (0..count).map(lamp).collect();
        for samples in [1, 4] {
            let shown = |scene: &Scene, shadows| {
                at(&picture(&gpu, scene, &head_on(), &Settings { samples, shadows, ..plain() }), 16, 16)
            };
            let (many, few) = (shown(&scene, true), shown(&scene, false));
            let alike = |a: [f32; 3]| a.iter().zip(few).all(|(&a, b)| close(a, b.into(), 2e-3));
            assert!(alike(many), "{count} lights, {samples} samples: {many:?} is not {few:?}");
            let mut fewer = scene.clone();
            fewer.lights.pop();
            assert!(!alike(shown(&fewer, true)), "the comparison can fail");
        }
    }
}

#[test]
fn blended_surfaces_cast_where_the_scene_says_so() {
    let Some(gpu) = gpu() else { return };
    let shadow = |blended_casts, transmission| {
        let mut scene = wall(matt([1.0; 3]));
        let film = Material { transmission, ..film([1.0; 3], 0.5) };
        add(&mut scene, square(0.5), film, DAffine3::from_translation(DVec3::Z));
        scene.instances[1].casts_shadow = true;
        scene.lights.push(sun(DVec3::new(1.0, 0.0, -1.0), 3.0));
        scene.blended_casts = blended_casts;
        let mut renderer = Renderer::new(&gpu, &scene).expect("a renderer");
        let masks = renderer.aovs(&look(DVec3::new(0.0, 0.0, 4.0), DVec3::ZERO, SIZE), &plain(), &[AovKind::Shadow]);
        masks.expect("outputs").shadow[0].iter().filter(|&&lit| lit == 0).count()
    };
    let clear = Some(Transmission { share: 1.0, texture: None, tint: [1.0; 3] });
    for transmission in [None, clear] {
        assert_eq!(shadow(false, transmission), 0);
        assert!((20..120).contains(&shadow(true, transmission)), "{}", shadow(true, transmission));
    }
}

#[test]
fn glass_filters_by_its_colour_and_reflects_by_its_refraction() {
    let Some(gpu) = gpu() else { return };
    let mut scene = Scene { background: [1.0, 2.0, 4.0], ..Scene::default() };
    let glass = Material {
        base_color: [1.0, 0.5, 0.25, 0.1],
        specular: Specular { ior: 3.0, ..Specular::default() },
        transmission: Some(Transmission { share: 0.75, texture: None, tint: [0.5, 1.0, 1.0] }),
        ..matt([0.0; 3])
    };
    add(&mut scene, square(9.0), glass, DAffine3::IDENTITY);
    let filtered = |scene: &Scene| at(&picture(&gpu, scene, &head_on(), &plain()), 16, 16);
    // A quarter is mirrored; three quarters of the rest pass.
    let share = 0.75 * 0.75;
    let expected = [1.0 * 0.5, 2.0 * 0.5, 4.0 * 0.25].map(|c| share * c);
    let found = filtered(&scene);
    assert!(found.iter().zip(expected).all(|(&a, b)| close(a, b, 4e-3)), "{found:?} is not {expected:?}");
    scene.ambient = [1.0; 3];
    let more = filtered(&scene);
    for (channel, color) in [1.0, 0.5, 0.25].into_iter().enumerate() {
        let added = f64::from(more[channel] - found[channel]);
        assert!((added - (0.25 * color + 0.25)).abs() < 0.01, "channel {channel}: {added}");
    }
    scene.materials[0].transmission = None;
    assert!(filtered(&scene)[2] < 0.3, "without it the square is opaque");
}
