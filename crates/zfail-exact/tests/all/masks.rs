//! Masked surfaces: once cut along their masks they are like all others, and no pixel may be wrong.
//!
//! The scenes are those of open meshes with a mask of noise on every caster, the built-in scene of leaves and wire, and the
//! one model at hand that has masks, which is skipped where absent.

use std::{env, path::PathBuf};
use zfail_exact::{bench, kinds::Kind};
use zfail_oracle::Report;
use zfail_plan::light::LightKind;
use zfail_plan::view::View;
use zfail_render::{Gpu, Settings, Tiles};
use zfail_scene::cut::{self, cut_masked};
use zfail_scene::{
    AlphaMode, Filter, Image, Light, LightShape, MaskCasting, Material, Scene, Texture, TextureRef, Wrap,
};

/// Pixels of all lights that are not right in mask or count, and those left out because of a mask in front of the eye,
/// when `drawn` is rendered and the oracle asked about `scene`.
fn judge(gpu: &Gpu, drawn: &Scene, scene: &Scene, view: &View) -> [usize; 2] {
    let settings = Settings { tiles: Tiles::Always, ..Settings::default() };
    let rendered = bench::render(gpu, drawn, view, &settings).expect("images");
    let images = bench::Images { rendered, truths: bench::truths(scene, view).expect("truth") };
    let alpha = |report: &Report| report.excluded[report.excluded.len() - 1];
    let mut sum = [0; 2];
    for comparison in images.compare().expect("comparable images") {
        let miscounted = if comparison.count.budget().is_ok() { comparison.count.wrong.len() } else { 0 };
        sum[0] += comparison.mask.wrong.len() + miscounted;
        sum[1] += alpha(&comparison.mask);
    }
    sum
}

fn cut_to_within(scene: &Scene, texels: f64) -> Scene {
    let mut scene = scene.clone();
    assert!(!cut_masked(&mut scene, texels, cut::Limits::default()).is_empty(), "nothing is masked");
    scene
}

/// A scene of open meshes whose casters are masked by noise.
fn noisy(seed: u64) -> (Scene, View) {
    let recipe = Kind::Open.recipe(seed, [192, 120]);
    let mut scene = recipe.scene();
    const SIDE: u32 = 12;
    let hash = |k: u32| (k ^ seed as u32).wrapping_mul(0x9e37_79b9).wrapping_mul(k | 1).to_be_bytes()[0];
    let rgba = (0..SIDE * SIDE).flat_map(|k| [200, 200, 200, hash(k + 1)]).collect();
    scene.images.push(Image { name: "noise".into(), width: SIDE, height: SIDE, rgba });
    let mag = if seed.is_multiple_of(3) { Filter::Nearest } else { Filter::Linear };
    let wraps = [Wrap::Repeat, Wrap::Mirror, Wrap::Clamp];
    scene.textures.push(Texture {
        image: 0,
        wrap_u: wraps[seed as usize % 3],
        wrap_v: wraps[seed as usize / 2 % 3],
        mag,
        min: mag,
        mipmaps: true,
    });
    for k in 0..2 {
        let material = scene.materials[k].clone();
        let base_color_texture = Some(TextureRef::new(0));
        scene.materials.push(Material { base_color_texture, alpha: AlphaMode::Mask(0.5), ..material });
    }
    for mesh in scene.meshes.iter_mut().skip(1) {
        mesh.uv0 = mesh.positions.iter().map(|p| [0.7 * p[0] + 0.2 * p[1], 0.6 * p[2] + 0.3 * p[1]]).collect();
        for primitive in &mut mesh.primitives {
            primitive.material = primitive.material.map(|material| material + 3);
        }
    }
    (scene, recipe.view)
}

#[test]
fn no_pixel_of_cut_meshes_is_wrong() {
    let Some(gpu) = crate::gpu() else { return };
    let mut caught = 0;
    for seed in 1..=12 {
        let (scene, view) = noisy(seed);
        let cut = cut_to_within(&scene, [0.25, 1.0][seed as usize % 2]);
        assert_eq!(judge(&gpu, &cut, &cut, &view), [0, 0], "seed {seed}");
        let coarse = cut_to_within(&scene, 4.0);
        caught += usize::from(judge(&gpu, &coarse, &cut, &view)[0] > 0);
    }
    assert!(caught >= 10, "another cut is caught in {caught} of 12 scenes");
}

#[test]
fn no_pixel_of_foliage_is_wrong() {
    let Some(gpu) = crate::gpu() else { return };
    let scene = zfail_builtin::scene("foliage").expect("a built-in scene");
    let cut = cut_to_within(&scene, 1.0);
    for camera in &scene.cameras {
        let view = camera.view([256, 160], &scene.bounds());
        assert_eq!(judge(&gpu, &cut, &cut, &view), [0, 0], "{}", camera.name);
        assert!(judge(&gpu, &scene, &cut, &view)[0] > 0, "{}: shadows of whole cards are caught", camera.name);
    }
    let view = scene.cameras[0].view([256, 160], &scene.bounds());
    let off = Scene { mask_casting: MaskCasting::Off, ..scene.clone() };
    let [wrong, masked] = judge(&gpu, &off, &off, &view);
    assert!(wrong == 0 && masked > 0, "{wrong} wrong, {masked} left out");
    assert!(judge(&gpu, &scene, &off, &view)[0] > 0, "shadows where there should be none are caught");
}

#[test]
fn no_pixel_of_flowers_is_wrong() {
    let beside = concat!(env!("CARGO_MANIFEST_DIR"), "/../../../shared/assets");
    let assets = env::var_os("ZFAIL_ASSETS").map_or_else(|| beside.into(), PathBuf::from);
    let path = assets.join("GlassVaseFlowers/GlassVaseFlowers.glb");
    if !path.exists() {
        println!("skipped: {} is not there", path.display());
        return;
    }
    let Some(gpu) = crate::gpu() else { return };
    let mut scene = zfail_files::load(&path).unwrap_or_else(|e| panic!("{e}"));
    zfail_scene::complete(&mut scene);
    let bounds = scene.bounds();
    let position = bounds.center() + bounds.half() * zfail_plan::glam::DVec3::new(0.13, 0.41, -0.17);
    scene.lights.push(Light {
        name: "inside".into(),
        kind: LightKind::Point { position, range: f64::INFINITY },
        color: [1.0; 3],
        intensity: 1.0,
        excluded: Vec::new(),
        shape: LightShape::default(),
    });
    let cut = cut_to_within(&scene, 1.0);
    let view = scene.cameras[0].view([256, 192], &bounds);
    assert_eq!(judge(&gpu, &cut, &cut, &view), [0, 0]);
}
