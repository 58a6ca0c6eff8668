//! What holds for every frame: sizes, sample counts, backgrounds, exposure, shadows and outputs.

use crate::support::{add, assert_same, at, gpu, light, look, matt, picture, plain, square, sun, wall};
use zfail_plan::glam::{DAffine3, DVec3};
use zfail_plan::light::LightKind;
use zfail_plan::view::{Projection, View};
use zfail_render::{AovKind, Gpu, GpuOptions, RenderError, Renderer, Settings, Technique};
use zfail_scene::{Material, Pose, Scene};

const SIZE: [u32; 2] = [64, 48];

/// A square of half width 0.5 hovering before a wall, lit from the front and a little from the left.
fn hovering() -> (Scene, View) {
    let mut scene = wall(matt([0.8; 3]));
    let single_sided = matt([0.8, 0.2, 0.2]);
    add(&mut scene, square(0.5), single_sided, DAffine3::from_translation(DVec3::Z));
    scene.lights.push(sun(DVec3::new(1.0, 0.0, -1.0), 3.0));
    (scene, look(DVec3::new(0.0, 0.0, 4.0), DVec3::ZERO, SIZE))
}

/// The middle of the wall point `x`, `y`, 0 or of any other point, in pixels.
fn pixel(view: &View, point: DVec3) -> usize {
    let clip = view.clip_from_view() * view.world_from_view.inverse().transform_point3(point).extend(1.0);
    let [w, h] = view.size.map(f64::from);
    let x = ((clip.x / clip.w + 1.0) * 0.5 * w) as usize;
    let y = ((1.0 - clip.y / clip.w) * 0.5 * h) as usize;
    y * view.size[0] as usize + x
}

#[test]
fn an_empty_scene_is_its_background() {
    let Some(gpu) = gpu() else { return };
    let mut scene = Scene::default();
    let view = look(DVec3::Z, DVec3::ZERO, SIZE);
    for samples in [1, 4] {
        let black = picture(&gpu, &scene, &view, &Settings { samples, ..Settings::default() });
        assert!(black.rgba8.chunks_exact(4).all(|p| p == [0, 0, 0, 255]));
        assert_eq!(black.rgba8.len(), 64 * 48 * 4);
    }
    scene.background = [0.25, 0.5, 8.0];
    for samples in [1, 4] {
        let blue = picture(&gpu, &scene, &view, &Settings { samples, ..plain() });
        assert!(blue.hdr.iter().all(|&p| p == [0.25, 0.5, 8.0]));
    }
}

#[test]
fn impossible_requests_are_refused() {
    let Some(gpu) = gpu() else { return };
    let (scene, view) = hovering();
    let mut renderer = Renderer::new(&gpu, &scene).expect("a renderer");
    let mut fails = |size, settings: &Settings| {
        renderer.picture(&View { size, ..view }, settings).map(|_| ()).expect_err("should be refused")
    };
    assert!(matches!(fails([0, 5], &plain()), RenderError::EmptySize { .. }));
    assert!(matches!(fails([100_000, 5], &plain()), RenderError::TooLarge { .. }));
    assert!(matches!(fails([5, 100_000], &plain()), RenderError::TooLarge { .. }));
    assert!(matches!(fails(SIZE, &Settings { samples: 3, ..plain() }), RenderError::Samples(3)));
    let unknown = Settings { lights: Some(vec![0, 7]), ..plain() };
    assert!(matches!(fails(SIZE, &unknown), RenderError::UnknownLight { index: 7, count: 1 }));
    // And afterwards it still works.
    assert!(renderer.picture(&view, &plain()).is_ok());
}

#[test]
fn inconsistent_scenes_are_refused() {
    let Some(gpu) = gpu() else { return };
    let (scene, _) = hovering();
    let broken: [fn(&mut Scene); 5] = [
        |s| s.meshes[0].triangles[0][1] = 99,
        |s| s.instances[1].mesh = 2,
        |s| s.meshes[1].primitives[0].material = Some(2),
        |s| s.meshes[1].primitives[0].triangles = 0..3,
        |s| s.lights[0].excluded.push(2),
    ];
    for (i, breaks) in broken.into_iter().enumerate() {
        let mut scene = scene.clone();
        breaks(&mut scene);
        assert!(matches!(Renderer::new(&gpu, &scene), Err(RenderError::Scene(_))), "mutation {i}");
    }
}

#[test]
fn samples_change_edges_only() {
    let Some(gpu) = gpu() else { return };
    let (scene, view) = hovering();
    let one = picture(&gpu, &scene, &view, &plain());
    let four = picture(&gpu, &scene, &view, &Settings { samples: 4, ..plain() });
    let width = view.size[0] as usize;
    let mut edges = 0;
    let mut interior = 0;
    for y in 1..view.size[1] as usize - 1 {
        for x in 1..width - 1 {
            let pixel = |dx: usize, dy: usize| &one.rgba8[((y + dy - 1) * width + x + dx - 1) * 4..][..4];
            let flat = (0..3)
                .all(|dy| (0..3).all(|dx| pixel(dx, dy).iter().zip(pixel(1, 1)).all(|(a, b)| a.abs_diff(*b) < 4)));
            let same = pixel(1, 1) == &four.rgba8[(y * width + x) * 4..][..4];
            if flat {
                assert!(same, "interior pixel {x}, {y} differs");
                interior += 1;
            } else if !same {
                edges += 1;
            }
        }
    }
    assert!(interior > 1000 && edges > 20, "{interior} interior pixels, {edges} smoothed");
}

#[test]
fn automatic_exposure_follows_the_light_and_leaves_black_alone() {
    let Some(gpu) = gpu() else { return };
    let grey = |lux| {
        let mut scene = wall(matt([0.5; 3]));
        scene.lights.push(sun(DVec3::NEG_Z, lux));
        picture(&gpu, &scene, &look(DVec3::Z, DVec3::ZERO, SIZE), &Settings::default()).rgba8[0]
    };
    let [dim, bright] = [1e-3, 1e6].map(grey);
    assert!(dim.abs_diff(bright) <= 2 && (100..220).contains(&dim), "{dim} and {bright}");
    assert_eq!(grey(0.0), 0);

    let (scene, view) = hovering();
    let first = picture(&gpu, &scene, &view, &Settings::default());
    assert_same("the same once more", &picture(&gpu, &scene, &view, &Settings::default()), &first);
}

#[test]
fn shadows_fall_where_they_should() {
    let Some(gpu) = gpu() else { return };
    let (mut scene, view) = hovering();
    let mut lamp = light(LightKind::Point { position: DVec3::new(0.0, 0.0, 3.0), range: 3.05 }, 10.0);
    lamp.excluded = vec![1];
    scene.lights.push(lamp);
    // Light travels as far to the right as it goes down: the square's shadow lies at x = 0.5 to 1.5.
    let shadow = pixel(&view, DVec3::new(1.0, 0.0, 0.0));
    let lit = pixel(&view, DVec3::new(-1.0, 0.0, 0.0));
    let front = pixel(&view, DVec3::Z);
    let kinds = [AovKind::Shadow, AovKind::Stencil];
    for technique in [Technique::Auto, Technique::EverittKilgard] {
        let mut renderer = Renderer::new(&gpu, &scene).expect("a renderer");
        let settings = Settings { technique, ..plain() };
        let out = renderer.aovs(&view, &settings, &kinds).expect("outputs");
        assert_eq!([shadow, lit, front].map(|p| out.shadow[0][p]), [0, 255, 255], "{technique}");
        assert_eq!([shadow, lit, front].map(|p| out.stencil[0][p]), [1, 0, 0], "{technique}");
        // Not cast by the excluded square, and beyond its range at x = 1 but not straight ahead.
        assert_eq!([shadow, front].map(|p| out.shadow[1][p]), [0, 255], "{technique}");
        assert_eq!(out.shadow[1][pixel(&view, DVec3::new(0.5, 0.0, 0.0))], 255, "{technique}");

        for samples in [1, 4] {
            let only_sun = Settings { lights: Some(vec![0]), samples, ..settings.clone() };
            let (dark, stats) = renderer.picture(&view, &only_sun).expect("a picture");
            assert_eq!(dark.hdr[shadow], [0.0; 3]);
            assert!(dark.hdr[lit][0] > 0.1);
            assert_eq!(stats.lights.len(), 1);
            assert!(stats.lights[0].triangles.sides > 0);
            let (open, _) = renderer.picture(&view, &Settings { shadows: false, ..only_sun }).expect("a picture");
            assert_eq!(open.hdr[shadow], open.hdr[lit]);
        }
    }
    let off = Renderer::new(&gpu, &scene)
        .and_then(|mut r| r.aovs(&view, &Settings { shadows: false, ..plain() }, &kinds))
        .expect("outputs");
    assert_eq!([off.shadow[0][shadow], off.stencil[0][shadow]], [255, 0]);
}

#[test]
fn outputs_describe_the_surface() {
    let Some(gpu) = gpu() else { return };
    for (orthographic, offset) in [(false, DVec3::ZERO), (true, DVec3::ZERO), (false, DVec3::new(1e6, 2e6, -1e6))] {
        let mut scene = Scene { background: [1.0; 3], ..Scene::default() };
        let place = DAffine3::from_translation(offset + DVec3::new(0.25, 0.0, 0.5));
        add(&mut scene, square(0.5), Material { unlit: true, ..matt([1.0, 0.215_860_5, 0.0]) }, place);
        let mut view = look(DVec3::new(0.0, 0.0, 2.0), DVec3::ZERO, SIZE);
        view.world_from_view.translation += offset;
        if orthographic {
            view.projection = Projection::Orthographic { ymag: 1.0, near: 0.0, far: 10.0 };
        }
        let out =
            Renderer::new(&gpu, &scene).and_then(|mut r| r.aovs(&view, &plain(), &AovKind::ALL)).expect("outputs");
        let inside = pixel(&view, offset + DVec3::new(0.25, 0.25, 0.5));
        assert!((out.depth[inside] - 1.5).abs() < 1e-6, "{}", out.depth[inside]);
        assert!((out.normal[inside][2] - 1.0).abs() < 1e-6);
        assert!((out.albedo[inside][1] - 0.215_860_5).abs() < 1e-6 && out.albedo[inside][0] == 1.0);
        // f32 at two million metres has steps of an eighth; a pixel here is a few hundredths.
        let tolerance = if offset == DVec3::ZERO { 0.03 } else { 0.16 };
        let found = out.position[inside].map(f64::from);
        let expected = (offset + DVec3::new(0.25, 0.25, 0.5)).to_array();
        for axis in 0..3 {
            assert!((found[axis] - expected[axis]).abs() < tolerance, "{found:?} is not {expected:?}");
        }
        assert_eq!((out.depth[0], out.position[0], out.normal[0], out.albedo[0]), (0.0, [0.0; 3], [0.0; 3], [0.0; 3]));
        assert!(out.shadow.is_empty() && out.stencil.is_empty(), "there is no light");
    }
}

#[test]
fn figures_have_the_agreed_shape() {
    let Some(gpu) = gpu() else { return };
    let (scene, view) = hovering();
    let (_, stats) = Renderer::new(&gpu, &scene).and_then(|mut r| r.picture(&view, &plain())).expect("a picture");
    let json = serde_json::to_value(&stats).expect("JSON");
    for key in ["adapter", "backend", "depth_format"] {
        assert!(json[key].is_string(), "{key}: {json}");
    }
    assert!(json["planning_ms"].is_number());
    let light = &json["lights"][0];
    assert_eq!(light["kind"], "directional");
    assert_eq!(light["scissor"].as_array().map(Vec::len), Some(4));
    assert_eq!(light["cases"].as_array().map(Vec::len), Some(3));
    for key in ["casters", "vertices"] {
        assert!(light[key].is_u64(), "{key}: {light}");
    }
    for key in ["sides", "dark_cap", "light_cap"] {
        assert!(light["triangles"][key].is_u64(), "{key}: {light}");
    }
    for key in ["culled", "fragments", "shadow_ms", "light_ms"] {
        assert!(light.get(key).is_some(), "{key}: {light}");
    }
}

#[test]
fn background_pixels_are_not_lit() {
    let Some(gpu) = gpu() else { return };
    let mut scene = Scene::default();
    add(&mut scene, square(0.1), matt([1.0; 3]), DAffine3::IDENTITY);
    scene.lights.push(sun(DVec3::NEG_Z, 1000.0));
    let found = picture(&gpu, &scene, &look(DVec3::Z, DVec3::ZERO, SIZE), &plain());
    assert_eq!(at(&found, 0, 0), [0.0; 3]);
    assert!(at(&found, 32, 24)[0] > 1.0);
}

#[test]
fn the_gl_backend_agrees() {
    let options = GpuOptions { backends: wgpu::Backends::GL, ..GpuOptions::default() };
    let (Some(gpu), Ok(gl)) = (gpu(), Gpu::new(&options)) else {
        eprintln!("skipped: no GL adapter");
        return;
    };
    let (scene, view) = hovering();
    let view = View { size: [256, 192], ..view };
    let kinds = [AovKind::Shadow, AovKind::Stencil];
    let [one, other] = [&gpu, &gl].map(|gpu| {
        let mut renderer = Renderer::new(gpu, &scene).expect("a renderer");
        renderer.aovs(&view, &plain(), &kinds).expect("outputs")
    });
    let differ = |a: &[u8], b: &[u8]| a.iter().zip(b).filter(|(a, b)| a != b).count();
    // Edges may fall to the other side of a pixel's centre.
    assert!(differ(&one.shadow[0], &other.shadow[0]) < 40 && differ(&one.stencil[0], &other.stencil[0]) < 40);
    assert!(one.shadow[0].iter().filter(|&&s| s == 0).count() > 100, "no shadow to compare");
}

#[test]
fn a_pose_moves_what_a_new_renderer_would_show() {
    let Some(gpu) = gpu() else { return };
    let (scene, view) = hovering();
    let mut moved = scene.clone();
    // Mirrored, so that the draw's state changes as well.
    moved.instances[1].world_from_object = DAffine3::from_scale_rotation_translation(
        DVec3::new(-1.0, 1.0, 1.0),
        Default::default(),
        DVec3::new(0.4, 0.2, 1.5),
    );
    moved.lights[0].kind = LightKind::Point { position: DVec3::new(0.0, 1.0, 3.0), range: f64::INFINITY };
    let pose = |s: &Scene| Pose {
        instances: s.instances.iter().map(|i| i.world_from_object).collect(),
        lights: s.lights.iter().map(|l| l.kind).collect(),
        ..Pose::default()
    };
    let mut renderer = Renderer::new(&gpu, &scene).expect("a renderer");
    let before = renderer.picture(&view, &plain()).expect("a picture").0;
    renderer.set_pose(&pose(&moved)).expect("a pose that fits");
    let after = renderer.picture(&view, &plain()).expect("a picture").0;
    assert_same("a pose set", &after, &picture(&gpu, &moved, &view, &plain()));
    assert!(after != before);

    let mut short = pose(&scene);
    short.instances.pop();
    let mut wild = pose(&scene);
    wild.instances[0].translation.x = f64::NAN;
    for bad in [short, wild] {
        assert!(matches!(renderer.set_pose(&bad), Err(RenderError::Scene(_))));
    }
    assert_same("a refused pose", &renderer.picture(&view, &plain()).expect("a picture").0, &after);
    renderer.set_pose(&pose(&scene)).expect("a pose that fits");
    assert_same("a pose set back", &renderer.picture(&view, &plain()).expect("a picture").0, &before);
}
