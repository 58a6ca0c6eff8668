//! Random scenes of every kind: no pixel may be wrong.
//!
//! Techniques and sizes take turns. `ZFAIL_SCENES` sets how many scenes in total (default 100, five of each kind, so that
//! each kind meets every technique), `ZFAIL_SEED` the first seed (default 1), `ZFAIL_KIND` limits them to one kind,
//! `ZFAIL_SIZE=WxH` sets the size of the images, some of which are odd otherwise.

use std::{collections::HashSet, env, fmt::Write as _, str::FromStr};
use zfail_exact::{bench, bench::Comparison, kinds::Kind, recipe::Recipe, shrink::shrink, tally::Tally};
use zfail_render::{Gpu, Settings, Silhouettes, Technique, Tiles};

fn setting<T: FromStr>(name: &str, default: T) -> T {
    env::var(name).ok().and_then(|v| v.parse().ok()).unwrap_or(default)
}

/// Whose turn it is: what kinds get follows one upon the other, so that few scenes of each are many for techniques and
/// sizes, and it is the same when only one kind is asked for.
fn turn(kind: Kind, seed: u64) -> u64 {
    5 * kind as u64 + seed
}

fn size(turn: u64) -> [u32; 2] {
    let text: String = setting("ZFAIL_SIZE", String::new());
    let given = text.split_once('x').and_then(|(w, h)| Some([w.parse().ok()?, h.parse().ok()?]));
    // In turn with the techniques, so that each meets every size.
    given.unwrap_or([[256, 160], [257, 160], [255, 161], [199, 203]][(turn / 4 % 4) as usize])
}

#[test]
fn no_pixel_is_wrong() {
    let Some(gpu) = crate::gpu() else { return };
    let only: String = setting("ZFAIL_KIND", String::new());
    let kinds: Vec<Kind> = Kind::ALL.into_iter().filter(|k| only.is_empty() || format!("{k:?}") == only).collect();
    let scenes: u64 = setting("ZFAIL_SCENES", 100);
    let first: u64 = setting("ZFAIL_SEED", 1);
    let each = scenes.div_ceil(kinds.len() as u64);
    let (mut masks, mut counts) = (Tally::default(), Tally::default());
    let (mut images, mut rejected) = (0, 0);
    let mut turns = HashSet::new();
    let mut failures = String::new();
    for &kind in &kinds {
        let (mut mask, mut count) = (Tally::default(), Tally::default());
        for seed in first..first + each {
            let turn = turn(kind, seed);
            let recipe = kind.recipe(seed, size(turn));
            let technique = Technique::ALL[(turn % Technique::ALL.len() as u64) as usize];
            // The best technique counts by tiles in every second of its scenes, and in the others finds silhouettes on the
            // device.
            let (tiles, silhouettes) =
                if turn % 8 < 4 { (Tiles::Always, Silhouettes::Cpu) } else { (Tiles::Never, Silhouettes::Gpu) };
            let settings = Settings { technique, tiles, silhouettes, ..Settings::default() };
            turns.insert((kind, technique));
            let comparisons = bench::images(&gpu, &recipe, &settings).and_then(|i| i.compare());
            let comparisons = comparisons.unwrap_or_else(|e| panic!("{kind:?} seed {seed}: {e}"));
            for comparison in &comparisons {
                mask.add(&comparison.mask);
                count.add(&comparison.count);
            }
            if comparisons.iter().any(Comparison::failed) {
                describe(&mut failures, &gpu, recipe, &settings);
            }
        }
        println!("{:13} masks  {mask}", format!("{kind:?}"));
        println!("{:13} counts {count}", "");
        // These are made of what is smaller than a pixel in most of their images.
        if !matches!(kind, Kind::Shards | Kind::Planted | Kind::OrthographicCut) {
            images += mask.images.max(count.images);
            rejected += mask.rejected.max(count.rejected);
        }
        masks.merge(&mask);
        counts.merge(&count);
    }
    println!("all           masks  {masks}");
    println!("all           counts {counts}");
    assert!(failures.is_empty(), "{failures}");
    if only.is_empty() {
        let met = Technique::ALL.len().min(each as usize);
        assert_eq!(turns.len(), kinds.len() * met, "each kind meets every technique");
        assert!(rejected * 10 < images, "too many scenes are too fine: {rejected} of {images} images");
        assert!(masks.lit.min(masks.shadowed) * 20 > masks.checked, "too little is lit or shadowed");
        assert!(counts.max_count > 255, "no count wraps");
    }
}

/// Notes the least scene that fails like `recipe`, and how.
fn describe(failures: &mut String, gpu: &Gpu, recipe: Recipe, settings: &Settings) {
    let images = |r: &Recipe| bench::images(gpu, r, settings);
    let failed = |r: &Recipe| images(r).and_then(|i| i.compare()).unwrap_or_default().iter().any(Comparison::failed);
    let least = shrink(recipe, failed);
    let Recipe { kind, seed, view, .. } = &least;
    let _ = writeln!(failures, "\n{kind:?} seed {seed}, {:?}, {}: {least:#?}", view.size, settings.technique);
    let Ok(images) = images(&least) else { return };
    for comparison in images.compare().unwrap_or_default().iter().filter(|c| c.failed()) {
        let few = |wrong: &[zfail_oracle::Wrong]| format!("{} wrong: {:?}", wrong.len(), &wrong[..wrong.len().min(4)]);
        let (mask, count) = (few(&comparison.mask.wrong), few(&comparison.count.wrong));
        let kept = images.keep(&format!("{kind:?}-{seed}"), comparison);
        let _ = writeln!(failures, "light {}: mask {mask}\n  count {count}\n  {kept}", comparison.light);
    }
}
