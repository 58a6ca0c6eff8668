//! Real models and the built-in scenes: no pixel may be wrong, with a light inside the model's bounds, one outside and
//! a sun, whatever lights the file has of its own. Animated models are checked at rest and at two
//! moments; masked triangles are cut.
//!
//! Models are looked for in `ZFAIL_ASSETS`, or in `shared/assets` beside the checkout, and skipped where absent.
//! `ZFAIL_SIZE=WxH` sets the size of the images, `ZFAIL_MODEL` limits the test to one file, `ZFAIL_FILES` (a list like
//! `PATH`) names other files to test instead, also a moment of their first animation, and `ZFAIL_TECHNIQUE` the technique.
//! Masks are counted by tiles, raw counts are rasterised: both are checked.

use std::{env, path::PathBuf};
use zfail_exact::bench::{self, Images};
use zfail_exact::tally::Tally;
use zfail_files::Limits;
use zfail_plan::glam::DVec3;
use zfail_plan::light::LightKind;
use zfail_render::{Gpu, Settings, Technique, Tiles};
use zfail_scene::{Light, LightShape, Mesh, Scene, cut};

const MODELS: [&str; 24] = [
    "godot-room/godot-room.glb",
    "garage/garage.glb",
    "zdm2/zdm2.glb",
    "ToyCar/ToyCar.glb",
    "FlightHelmet/FlightHelmet.glb",
    "WaterBottle/WaterBottle.glb",
    "LightsPunctualLamp/LightsPunctualLamp.glb",
    "Suzanne/Suzanne.gltf",
    "cad-featuretype/cad-featuretype.glb",
    "retroufo/retroufo.glb",
    "NegativeScaleTest/NegativeScaleTest.glb",
    "CesiumMan/CesiumMan.glb",
    "Fox/Fox.glb",
    "GlassVaseFlowers/GlassVaseFlowers.glb",
    "RiggedFigure/RiggedFigure.glb",
    "kaykit-knight/kaykit-knight.glb",
    "MorphStressTest/MorphStressTest.glb",
    "SimpleInstancing/SimpleInstancing.glb",
    "cat-statue/cat-statue.glb",
    "truck-town/truck-town.glb",
    "helicopter-draco/helicopter-draco.glb",
    "ingenuity/ingenuity.glb",
    "dream-apartment/dream-apartment.glb",
    "cesium-balloon-ktx2/cesium-balloon-ktx2.glb",
];

fn size() -> [u32; 2] {
    let text = env::var("ZFAIL_SIZE").unwrap_or_default();
    text.split_once('x').and_then(|(w, h)| Some([w.parse().ok()?, h.parse().ok()?])).unwrap_or([192, 120])
}

fn assets() -> PathBuf {
    let beside = concat!(env!("CARGO_MANIFEST_DIR"), "/../../../shared/assets");
    env::var_os("ZFAIL_ASSETS").map_or_else(|| beside.into(), PathBuf::from)
}

/// A light inside of the scene's bounds, one outside, and a sun.
fn test_lights(scene: &Scene) -> Vec<Light> {
    let bounds = scene.bounds();
    let at = |x: f64, y: f64, z: f64| bounds.center() + bounds.half() * DVec3::new(x, y, z);
    let point = |position| LightKind::Point { position, range: f64::INFINITY };
    let direction = DVec3::new(-0.4, -0.8, -0.45).normalize();
    [point(at(0.13, 0.21, -0.17)), point(at(1.7, 2.3, 1.9)), LightKind::Directional { direction }]
        .into_iter()
        .map(|kind| Light {
            name: "test".into(),
            kind,
            color: [1.0; 3],
            intensity: 10.0,
            excluded: Vec::new(),
            shape: LightShape::default(),
        })
        .collect()
}

/// Compares every light of a scene from one of its cameras.
fn judge(gpu: &Gpu, name: &str, scene: &Scene, camera: usize, masks: &mut Tally, failures: &mut Vec<String>) {
    let view = scene.cameras[camera].view(size(), &scene.bounds());
    let technique = env::var("ZFAIL_TECHNIQUE").map_or(Technique::Auto, |t| t.parse().expect("a technique's name"));
    let settings = Settings { technique, tiles: Tiles::Always, ..Settings::default() };
    let rendered = bench::render(gpu, scene, &view, &settings).unwrap_or_else(|e| panic!("{name}: {e}"));
    let truths = bench::truths(scene, &view).unwrap_or_else(|e| panic!("{name}: {e}"));
    let images = Images { rendered, truths };
    let comparisons = images.compare().unwrap_or_else(|e| panic!("{name}: {e}"));
    let mut own = Tally::default();
    for comparison in &comparisons {
        own.add(&comparison.mask);
        // Counts of images that are too fine may differ by layers thinner than the guards; verdicts may not.
        let miscounted = !comparison.count.wrong.is_empty() && comparison.count.budget().is_ok();
        if !comparison.mask.wrong.is_empty() || miscounted {
            let (mask, count) = (&comparison.mask.wrong, &comparison.count.wrong);
            failures.push(format!(
                "{name}, light {}: {} wrong verdicts {:?}, {} wrong counts {:?}; {}",
                comparison.light,
                mask.len(),
                &mask[..mask.len().min(3)],
                count.len(),
                &count[..count.len().min(3)],
                images.keep(&format!("{name}-{camera}"), comparison)
            ));
        }
    }
    println!("{name:20} {own}");
    masks.merge(&own);
}

#[test]
fn no_pixel_of_a_real_model_is_wrong() {
    let Some(gpu) = crate::gpu() else { return };
    let only = env::var("ZFAIL_MODEL").unwrap_or_default();
    let (mut masks, mut failures) = (Tally::default(), Vec::new());
    for model in MODELS.into_iter().filter(|m| m.contains(&only)) {
        let path = assets().join(model);
        if !path.exists() {
            println!("skipped: {model} is not there");
            continue;
        }
        let (mut animated, _) = zfail_files::load_animated(&path, &Limits::default()).unwrap_or_else(|e| panic!("{e}"));
        animated.cut_masked(1.0, cut::Limits::default());
        let mut scene = animated.scene.clone();
        zfail_scene::complete(&mut scene);
        let test = test_lights(&scene);
        scene.lights.extend(test);
        let name = model.split('/').next().unwrap_or(model);
        judge(&gpu, name, &scene, 0, &mut masks, &mut failures);
        for (i, animation) in animated.animations.iter().enumerate().take(1) {
            for share in [0.37, 0.71] {
                let seconds = share * animation.duration;
                scene.set_pose(&animated.pose(i, seconds));
                judge(&gpu, &format!("{name} at {seconds:.2} s"), &scene, 0, &mut masks, &mut failures);
            }
        }
    }
    println!("all                  {masks}");
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}

#[test]
fn no_pixel_of_other_files_is_wrong() {
    let Some(files) = env::var_os("ZFAIL_FILES") else { return };
    let Some(gpu) = crate::gpu() else { return };
    let (mut masks, mut failures) = (Tally::default(), Vec::new());
    for path in env::split_paths(&files) {
        let (mut animated, _) = zfail_files::load_animated(&path, &Limits::default()).unwrap_or_else(|e| panic!("{e}"));
        animated.cut_masked(1.0, cut::Limits::default());
        let mut scene = animated.scene.clone();
        zfail_scene::complete(&mut scene);
        let name = path.file_stem().map(|n| n.to_string_lossy().into_owned()).unwrap_or_default();
        judge(&gpu, &name, &scene, 0, &mut masks, &mut failures);
        if !animated.animations.is_empty() {
            scene.set_pose(&animated.pose(0, 0.3));
            judge(&gpu, &format!("{name} at 0.3 s"), &scene, 0, &mut masks, &mut failures);
        }
    }
    println!("all                  {masks}");
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}

#[test]
fn no_pixel_of_a_built_in_scene_is_wrong() {
    let Some(gpu) = crate::gpu() else { return };
    let only = env::var("ZFAIL_MODEL").unwrap_or_default();
    let (mut masks, mut failures) = (Tally::default(), Vec::new());
    for entry in zfail_builtin::SCENES.iter().filter(|e| e.name.contains(&only)) {
        let mut animated = zfail_builtin::animated(entry.name).expect("a name from the list");
        animated.cut_masked(1.0, cut::Limits::default());
        let mut scene = animated.scene.clone();
        for camera in 0..scene.cameras.len() {
            judge(&gpu, entry.name, &scene, camera, &mut masks, &mut failures);
        }
        if scene.meshes.iter().any(Mesh::bends) {
            for seconds in [0.9, 2.7] {
                scene.set_pose(&animated.pose(0, seconds));
                judge(&gpu, &format!("{} at {seconds} s", entry.name), &scene, 0, &mut masks, &mut failures);
            }
        }
    }
    println!("all                  {masks}");
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}
