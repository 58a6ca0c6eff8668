//! Silhouettes of the device give the stencil of those of the CPU, bit for bit, on built-in scenes and real models.
//!
//! Models are looked for in `ZFAIL_ASSETS`, or in `shared/assets` beside the checkout, and skipped where absent.
//! `ZFAIL_FILES` (a list like `PATH`) names other files to test instead.

use std::{env, path::PathBuf};
use zfail_plan::glam::DVec3;
use zfail_plan::light::LightKind;
use zfail_plan::view::View;
use zfail_render::{AovKind, Gpu, Renderer, Settings, Silhouettes, Tiles};
use zfail_scene::{Light, LightShape, Scene};

/// Solids, soups, sheets and parts of all sizes.
const MODELS: [&str; 4] = [
    "Suzanne/Suzanne.gltf",
    "kaykit-knight/kaykit-knight.glb",
    "cad-featuretype/cad-featuretype.glb",
    "cat-statue/cat-statue.glb",
];

fn models() -> Vec<PathBuf> {
    let beside = concat!(env!("CARGO_MANIFEST_DIR"), "/../../../shared/assets");
    let assets = env::var_os("ZFAIL_ASSETS").map_or_else(|| beside.into(), PathBuf::from);
    match env::var_os("ZFAIL_FILES") {
        Some(files) => env::split_paths(&files).collect(),
        None => MODELS.iter().map(|model| assets.join(model)).filter(|path| path.exists()).collect(),
    }
}

/// Counts of every light, and how many triangles the CPU has submitted.
fn draw(gpu: &Gpu, scene: &Scene, view: &View, silhouettes: Silhouettes) -> (Vec<Vec<u8>>, f64) {
    let settings = Settings { silhouettes, tiles: Tiles::Never, ..Settings::default() };
    let mut renderer = Renderer::new(gpu, scene).expect("a renderer");
    let aovs = renderer.aovs(view, &settings, &[AovKind::Shadow, AovKind::Stencil]).expect("images");
    let figures = renderer.render(view, &settings).expect("a picture");
    let triangles = figures.lights.iter().map(|light| f64::from(light.triangles.sides)).sum();
    let images = aovs.stencil.into_iter().chain(aovs.shadow).collect();
    (images, triangles)
}

/// A light inside of the scene's bounds and one outside.
fn lamps(scene: &Scene) -> impl Iterator<Item = Light> {
    let bounds = scene.bounds();
    let lamp = move |at: DVec3| Light {
        name: "test".into(),
        kind: LightKind::Point { position: bounds.center() + bounds.half() * at, range: f64::INFINITY },
        color: [1.0; 3],
        intensity: 10.0,
        excluded: Vec::new(),
        shape: LightShape::default(),
    };
    [DVec3::new(0.13, 0.21, -0.17), DVec3::new(1.7, 2.3, 1.9)].into_iter().map(lamp)
}

#[test]
fn the_device_and_the_cpu_agree() {
    let Some(gpu) = crate::gpu() else { return };
    let built_in = zfail_builtin::SCENES
        .iter()
        .map(|entry| (entry.name.to_owned(), zfail_builtin::scene(entry.name).expect("a name from the list")));
    let models = models().into_iter().map(|path| {
        let mut scene = zfail_files::load(&path).unwrap_or_else(|e| panic!("{e}"));
        zfail_scene::complete(&mut scene);
        let lamps: Vec<Light> = lamps(&scene).collect();
        scene.lights.extend(lamps);
        (path.display().to_string(), scene)
    });
    let (mut extracted, mut scenes, mut moved) = (0, 0, 0);
    for (name, scene) in built_in.chain(models) {
        let view = |camera: usize| scene.cameras[camera].view([160, 100], &scene.bounds());
        let (expected, of_cpu) = draw(&gpu, &scene, &view(0), Silhouettes::Cpu);
        let (found, of_gpu) = draw(&gpu, &scene, &view(0), Silhouettes::Gpu);
        let differing = |images: &[Vec<u8>]| -> usize {
            let pixels = |(a, b): (&Vec<u8>, &Vec<u8>)| a.iter().zip(b).filter(|(a, b)| a != b).count();
            expected.iter().zip(images).map(pixels).sum()
        };
        println!("{name}: {of_gpu} of {of_cpu} triangles on the CPU");
        assert_eq!(found.len(), expected.len(), "{name}");
        for (light, (found, expected)) in found.iter().zip(&expected).enumerate() {
            zfail_testing::assert_alike(&format!("{name} light {light} silhouettes"), view(0).size, found, expected, 0);
        }
        extracted += usize::from(of_gpu < of_cpu);
        scenes += 1;
        // The negative control: lights moved by a thousandth.
        if scenes % 8 == 0 {
            let mut other = scene.clone();
            for light in &mut other.lights {
                match &mut light.kind {
                    LightKind::Point { position, .. } | LightKind::Spot { position, .. } => *position *= 1.001,
                    LightKind::Directional { direction } => *direction = (*direction + 0.001).normalize(),
                }
            }
            moved += usize::from(differing(&draw(&gpu, &other, &view(0), Silhouettes::Gpu).0) > 0);
        }
    }
    assert!(extracted * 2 > scenes && moved > 0, "{extracted} of {scenes} scenes on the device, {moved} moved");
}
