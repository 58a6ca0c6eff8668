//! The comparison must notice errors: what is rendered here is not what the oracle is asked about.

use zfail_exact::{bench, kinds::Kind};
use zfail_plan::light::LightKind;
use zfail_render::{Gpu, Settings};
use zfail_scene::Scene;

/// Renders ten scenes with `change` and returns in how many the masks, and the counts, are found to be wrong.
fn caught(gpu: &Gpu, change: impl Fn(&mut Scene, &mut Settings)) -> [usize; 2] {
    let mut caught = [0; 2];
    for (seed, kind) in
        [Kind::Closed, Kind::Open, Kind::Soup, Kind::Sheared, Kind::Sun].into_iter().cycle().take(10).enumerate()
    {
        let recipe = kind.recipe(100 + seed as u64, [192, 120]);
        let scene = recipe.scene();
        let (mut changed, mut settings) = (scene.clone(), Settings::default());
        change(&mut changed, &mut settings);
        let rendered = bench::render(gpu, &changed, &recipe.view, &settings).expect("images");
        let images = bench::Images { rendered, truths: bench::truths(&scene, &recipe.view).expect("truth") };
        let comparisons = images.compare().expect("comparable images");
        caught[0] += usize::from(comparisons.iter().any(|c| !c.mask.wrong.is_empty()));
        caught[1] += usize::from(comparisons.iter().any(|c| !c.count.wrong.is_empty()));
    }
    caught
}

#[test]
fn unchanged_scenes_are_right() {
    let Some(gpu) = crate::gpu() else { return };
    assert_eq!(caught(&gpu, |_, _| {}), [0, 0]);
}

#[test]
fn missing_shadows_are_caught() {
    let Some(gpu) = crate::gpu() else { return };
    assert_eq!(caught(&gpu, |_, settings| settings.shadows = false), [10, 10]);
}

#[test]
fn a_missing_caster_is_caught() {
    let Some(gpu) = crate::gpu() else { return };
    let [masks, counts] = caught(&gpu, |scene, _| scene.instances[1].casts_shadow = false);
    assert!(masks >= 8 && counts >= 8, "{masks} masks, {counts} counts");
}

#[test]
fn a_missing_triangle_is_caught() {
    let Some(gpu) = crate::gpu() else { return };
    let [masks, counts] = caught(&gpu, |scene, _| scene.meshes[1].triangles[0] = [0; 3]);
    assert!(masks >= 4 && counts >= 5, "{masks} masks, {counts} counts");
}

#[test]
fn a_moved_light_is_caught() {
    let Some(gpu) = crate::gpu() else { return };
    let [masks, counts] = caught(&gpu, |scene, _| {
        for light in &mut scene.lights {
            match &mut light.kind {
                LightKind::Point { position, .. } | LightKind::Spot { position, .. } => *position *= 1.01,
                LightKind::Directional { direction } => direction.x += 0.01,
            }
        }
    });
    assert!(masks >= 8 && counts >= 8, "{masks} masks, {counts} counts");
}
