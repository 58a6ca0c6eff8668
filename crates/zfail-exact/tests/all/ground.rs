//! The ground that only catches shadows: it shows those that rays find on a disc in its place, and nothing else changes.
//!
//! The scenes are the random ones, with a ground through them. A picture under one light and no other is the background
//! where the light arrives on the ground, and black where it does not. The oracle sees a real disc that casts nothing.

use std::{env, str::FromStr};
use zfail_exact::{bench, kinds::Kind, recipe::Surface};
use zfail_oracle::Pixel;
use zfail_plan::view::View;
use zfail_render::{AovKind, Aovs, Exposure, Gpu, Renderer, Settings, Silhouettes, Technique, Tiles};
use zfail_scene::{Ground, Instance, Scene};

fn setting<T: FromStr>(name: &str, default: T) -> T {
    env::var(name).ok().and_then(|v| v.parse().ok()).unwrap_or(default)
}

/// A random scene before a white background, with a ground at a share of its height that seems endless.
fn scene(kind: Kind, seed: u64) -> (Scene, View) {
    let mut recipe = kind.recipe(seed, [192, 120]);
    // What is blended would lie over the ground.
    recipe.parts.retain(|part| part.surface != Surface::Blended);
    let mut scene = recipe.scene();
    let bounds = scene.bounds();
    let (size, middle) = (bounds.max - bounds.min, bounds.center());
    let height = bounds.min.y + size.y * [0.02, 0.11, 0.23][(kind as usize + seed as usize) % 3];
    scene.ground = Some(Ground { height, center: [middle.x, middle.z], radius: 40.0 * size.length() });
    scene.background = [1.0; 3];
    (scene, recipe.view)
}

/// The scene with a disc in place of its ground.
fn with_disc(scene: &Scene) -> Scene {
    let mut real = scene.clone();
    let ground = real.ground.take().expect("a ground");
    real.meshes.push(Ground::disc());
    real.instances.push(Instance {
        name: "disc".into(),
        mesh: real.meshes.len() - 1,
        world_from_object: ground.world_from_disc(),
        casts_shadow: false,
        receives_shadow: true,
    });
    real
}

fn measured(gpu: &Gpu, scene: &Scene, view: &View, settings: &Settings, kinds: &[AovKind]) -> Aovs {
    Renderer::new(gpu, scene).and_then(|mut renderer| renderer.aovs(view, settings, kinds)).expect("outputs")
}

#[derive(Debug, Default)]
struct Sum {
    lit: usize,
    dark: usize,
    wrong: usize,
}

impl Sum {
    /// Compares what a pixel of the ground shows with what it should.
    fn add(&mut self, shown: f32, right: &Pixel, from_above: bool) {
        if right.mask_doubt.is_some() || !right.surface {
            return;
        }
        let dark = right.reached && !right.lit && from_above;
        self.wrong += usize::from(shown != if dark { 0.0 } else { 1.0 });
        self.dark += usize::from(dark);
        self.lit += usize::from(!dark);
    }
}

#[test]
fn the_ground_shows_the_shadows_that_rays_find() {
    let Some(gpu) = crate::gpu() else { return };
    let (mut sum, mut control) = (Sum::default(), Sum::default());
    let first: u64 = setting("ZFAIL_SEED", 1);
    let scenes: u64 = setting("ZFAIL_SCENES", 38);
    for kind in Kind::ALL {
        for seed in first..first + scenes.div_ceil(Kind::ALL.len() as u64) {
            let (scene, view) = scene(kind, seed);
            let ground = scene.ground.expect("a ground");
            if view.eye().y <= ground.height {
                continue;
            }
            let real = with_disc(&scene);
            // Two scenes of each kind, and techniques in turn through all kinds.
            let turn = 2 * kind as u64 + seed;
            let settings = Settings {
                technique: Technique::ALL[(turn % Technique::ALL.len() as u64) as usize],
                tiles: if turn % 8 < 4 { Tiles::Always } else { Tiles::Never },
                silhouettes: if turn % 8 < 4 { Silhouettes::Cpu } else { Silhouettes::Gpu },
                exposure: Exposure::Ev(0.0),
                ..Settings::default()
            };
            let depth = |scene: &Scene| measured(&gpu, scene, &view, &settings, &[AovKind::Depth]).depth;
            let (without, with) = (depth(&scene), depth(&real));
            let truths = bench::truths(&real, &view).expect("truth");
            let mut renderer = Renderer::new(&gpu, &scene).expect("a renderer");
            for (l, truth) in truths.iter().enumerate() {
                let light = &scene.lights[l];
                let homogeneous = light.kind.homogeneous();
                let from_above = homogeneous.y > ground.height * homogeneous.w;
                let settings = Settings { lights: Some(vec![l]), ..settings.clone() };
                let shown = renderer.picture(&view, &settings).expect("a picture").0.hdr;
                let before = sum.wrong;
                // Towards its rim, a ground shows less of its shadows.
                let is_ground = |i: usize| without[i] != with[i] && f64::from(with[i]) < 0.2 * ground.radius;
                for (i, pixel) in truth.pixels.iter().enumerate().filter(|&(i, _)| is_ground(i)) {
                    sum.add(shown[i][0], pixel, from_above);
                    control.add(shown[i.saturating_sub(3)][0], pixel, from_above);
                }
                let kept = || {
                    let shown: Vec<u8> = shown.iter().map(|p| (255.0 * p[0]) as u8).collect();
                    zfail_testing::keep(&format!("ground {kind:?} {seed} light {l}"), view.size, &[("shown", &shown)])
                };
                let technique = settings.technique;
                assert_eq!(sum.wrong, before, "{kind:?} seed {seed} light {l} {technique:?}; {}", kept());
            }
        }
    }
    println!("{sum:?}, three pixels beside: {control:?}");
    assert!(sum.dark > 20_000 && sum.lit > 200_000, "{sum:?}");
    assert!(control.wrong > 1000, "{control:?}: the comparison can fail");
}

#[test]
fn no_output_knows_of_the_ground() {
    let Some(gpu) = crate::gpu() else { return };
    let mut told = 0;
    for (kind, seed) in [(Kind::Closed, 3), (Kind::Spot, 2), (Kind::Orthographic, 5), (Kind::EyeInside, 1)] {
        let (scene, view) = scene(kind, seed);
        let bare = Scene { ground: None, ..scene.clone() };
        for technique in Technique::ALL {
            let settings = Settings { technique, ..Settings::default() }.repeatable();
            let [with, without] = [&scene, &bare].map(|scene| measured(&gpu, scene, &view, &settings, &AovKind::ALL));
            assert!(with == without, "{kind:?} {technique:?}");
        }
        let [disc, none] = [&with_disc(&scene), &bare]
            .map(|scene| measured(&gpu, scene, &view, &Settings::default().repeatable(), &AovKind::ALL));
        told += usize::from(disc != none);
    }
    assert!(told > 0, "the comparison can fail");
}
