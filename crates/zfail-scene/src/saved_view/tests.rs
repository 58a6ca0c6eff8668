use super::*;
use crate::{Instance, LightShape, Mesh};
use glam::{DAffine3, DQuat, DVec3};
use std::f64::consts::PI;

/// Two instances, a light and a camera.
fn scene() -> Scene {
    let instance = || Instance {
        name: String::new(),
        mesh: 0,
        world_from_object: DAffine3::IDENTITY,
        casts_shadow: true,
        receives_shadow: true,
    };
    let light = Light {
        name: "lamp".into(),
        kind: LightKind::Point { position: DVec3::Y, range: 2.0 },
        color: [1.0; 3],
        intensity: 1.0,
        excluded: Vec::new(),
        shape: LightShape::default(),
    };
    let camera = Camera {
        name: "eye".into(),
        world_from_view: DAffine3::from_translation(DVec3::Z),
        projection: Projection::Perspective { yfov: 1.0, near: 0.1, far: None },
    };
    Scene {
        meshes: vec![Mesh::default()],
        instances: vec![instance(), instance()],
        lights: vec![light],
        cameras: vec![camera],
        ambient: [0.2; 3],
        ..Scene::default()
    }
}

/// With numbers that have no short decimal form.
fn view() -> (Scene, SavedView) {
    let mut scene = scene();
    let thirds = DVec3::new(1.0 / 3.0, -2e-17, 1e6 + 1.0 / 7.0);
    let mut light = scene.lights[0].clone();
    light.kind = LightKind::Point { position: thirds, range: f64::INFINITY };
    light.color = [0.1, 1.0 / 3.0, f32::MIN_POSITIVE];
    light.intensity = 16_777_216.0 / 3.0;
    light.excluded = vec![0];
    light.shape = Default::default();
    let mut spot = light.clone();
    let direction = thirds.normalize();
    spot.kind = LightKind::Spot { position: -thirds, direction, range: PI * 1e3, inner: 0.1, outer: 0.7 };
    spot.shape.falloff = vec![0.1, 0.7, 1e-20];
    let sun =
        Light { kind: LightKind::Directional { direction: -direction }, shape: Default::default(), ..light.clone() };
    scene.lights = vec![light, spot, sun];
    let sky = Sky { zenith: [0.1, 1.0 / 3.0, 7e-20], horizon: [0.2; 3], nadir: [0.0; 3] };
    (scene.sky, scene.ambient) = (Some(sky), [0.1, 0.7, 1e-9]);
    scene.ground = Some(Ground { height: -1.0 / 3.0, center: [1e6 + 0.1, -2e-17], radius: PI });
    scene.instances[0].casts_shadow = false;
    let mut camera = scene.cameras[0].clone();
    camera.world_from_view.matrix3 =
        glam::DMat3::from_quat(DQuat::from_rotation_y(0.1) * DQuat::from_rotation_x(1.0 / 3.0));
    camera.projection = Projection::Perspective { yfov: PI / 3.0, near: 1e-3 / 3.0, far: None };
    let view = SavedView::new(&scene, &camera);
    (scene, view)
}

#[test]
fn a_view_comes_back_bit_for_bit() {
    let (scene_then, saved) = view();
    let read = SavedView::from_json(&saved.to_json()).expect("it was just written");
    let mut loaded = scene();
    let camera = read.apply(&mut loaded).expect("it fits");
    assert_eq!(format!("{camera:?}"), format!("{:?}", saved.camera));
    assert_eq!(format!("{:?}", loaded.lights), format!("{:?}", scene_then.lights));
    assert_eq!(Surroundings::of(&loaded), Surroundings::of(&scene_then));
    assert_ne!(Surroundings::of(&loaded), Surroundings::of(&scene()), "the comparison can fail");
    let casts = |scene: &Scene| scene.instances.iter().map(|i| i.casts_shadow).collect::<Vec<_>>();
    assert_eq!(casts(&loaded), casts(&scene_then));
    assert_ne!(casts(&loaded), casts(&scene()), "the comparison can fail");
}

#[test]
fn every_float_has_a_text_of_its_own() {
    let (_, mut saved) = view();
    let mut random = zfail_testing::Random(1);
    for _ in 0..20_000 {
        let (single, double) = (f32::from_bits(random.next() as u32), f64::from_bits(random.next()));
        if single.is_finite() && double.is_finite() {
            let text = serde_json::to_string(&(single, double)).expect("numbers");
            let read: (f32, f64) = serde_json::from_str(&text).expect("numbers");
            assert_eq!((read.0.to_bits(), read.1.to_bits()), (single.to_bits(), double.to_bits()), "{text}");
        }
    }
    saved.lights[0].intensity = f32::from_bits(0x3EAA_AAAB);
    let read = SavedView::from_json(&saved.to_json()).expect("it was just written");
    assert_eq!(read.lights[0].intensity.to_bits(), 0x3EAA_AAAB);
}

/// Spoils a view.
type Change = fn(&mut SavedView);

#[test]
fn what_makes_no_sense_is_refused_and_changes_nothing() {
    let reason = |change: Change| {
        let (_, mut saved) = view();
        change(&mut saved);
        let mut scene = scene();
        let before = format!("{:?}", scene.lights);
        let error = saved.apply(&mut scene).expect_err("it is refused");
        assert_eq!(format!("{:?}", scene.lights), before);
        error.to_string()
    };
    let cases: [(Change, &str); 12] = [
        (|v| v.surroundings.as_mut().unwrap().sky.as_mut().unwrap().nadir[1] = -1.0, "colour"),
        (|v| v.surroundings.as_mut().unwrap().ground.as_mut().unwrap().radius = f64::INFINITY, "ground"),
        (|v| v.casts.push(true), "instances"),
        (|v| v.camera.world_from_view.matrix3.x_axis *= 2.0, "rotation"),
        (|v| v.camera.world_from_view.matrix3.x_axis *= -1.0, "rotation"),
        (|v| v.camera.world_from_view.translation.y = f64::NAN, "finite"),
        (|v| v.camera.projection = Projection::Perspective { yfov: PI, near: 0.1, far: None }, "projection"),
        (|v| v.camera.projection = Projection::Orthographic { ymag: 1.0, near: 2.0, far: 2.0 }, "projection"),
        (|v| v.lights[0].intensity = -1.0, "light 0"),
        (|v| v.lights[1].excluded.push(99_999), "light 1 excludes instance 99999"),
        (|v| v.lights[2].kind = LightKind::Directional { direction: DVec3::ONE }, "light 2"),
        (|v| v.lights[2].shape.cookie = Some(0), "light 2 has a cookie"),
    ];
    for (change, word) in cases {
        let reason = reason(change);
        assert!(reason.contains(word), "'{word}' is not in '{reason}'");
    }
}

#[test]
fn a_file_without_surroundings_leaves_them_as_they_are() {
    let (_, saved) = view();
    let old = SavedView { surroundings: None, ..saved };
    let text = old.to_json();
    assert!(!text.contains("surroundings"));
    let mut loaded = scene();
    SavedView::from_json(&text).and_then(|view| view.apply(&mut loaded)).expect("it fits");
    assert_eq!(Surroundings::of(&loaded), Surroundings::of(&scene()));
}

#[test]
fn other_files_are_refused() {
    let (_, saved) = view();
    let good = saved.to_json();
    for bad in ["", "{}", "[1]", &good[..good.len() / 2], &good.replace("\"zfail_view\": 1", "\"zfail_view\": 2")] {
        assert!(matches!(SavedView::from_json(bad), Err(SavedViewError::Format(_))), "{bad}");
    }
    assert!(matches!(SavedView::read(Path::new("/no/such/view.json")), Err(SavedViewError::Read(_))));
}
