//! The same scenes on the GL backend: no judged pixel may be wrong there either.
//!
//! Vulkan drivers other than the default one are tested by pointing the loader at them, for instance
//! `VK_DRIVER_FILES=/usr/lib/chromium/vk_swiftshader_icd.json cargo test -p zfail-exact`; see `docs/drivers.md`.

use zfail_exact::{bench, kinds::Kind, tally::Tally};
use zfail_render::{Gpu, GpuOptions, Settings};

#[test]
fn gl_gives_the_same_verdicts() {
    let options = GpuOptions { backends: wgpu::Backends::GL, ..GpuOptions::default() };
    let gpu = match Gpu::new(&options) {
        Ok(gpu) => gpu,
        Err(error) => {
            println!("skipped: {error}");
            return;
        }
    };
    println!("{} ({})", gpu.info.name, gpu.info.driver_info);
    let (mut masks, mut counts) = (Tally::default(), Tally::default());
    let mut failures = Vec::new();
    for kind in Kind::ALL {
        for seed in 1..=3 {
            let recipe = kind.recipe(seed, [192, 120]);
            let images = bench::images(&gpu, &recipe, &Settings::default());
            let comparisons = images.and_then(|i| i.compare()).unwrap_or_else(|e| panic!("{kind:?} seed {seed}: {e}"));
            for comparison in &comparisons {
                masks.add(&comparison.mask);
                counts.add(&comparison.count);
                if comparison.failed() {
                    let wrong = (comparison.mask.wrong.len(), comparison.count.wrong.len());
                    failures.push(format!("{kind:?} seed {seed}, light {}: {wrong:?}", comparison.light));
                }
            }
        }
    }
    println!("masks  {masks}\ncounts {counts}");
    assert!(masks.checked > 500_000, "{} pixels checked", masks.checked);
    assert!(failures.is_empty(), "wrong verdicts and counts: {failures:#?}");
}
