//! The same scenes on other drivers: the GL backend, and SwiftShader where Chromium has brought it.
//!
//! What was found out about drivers is in `docs/drivers.md`.

use std::{env, path::Path, process::Command};
use zfail_exact::{bench, kinds::Kind, tally::Tally};
use zfail_render::{Gpu, GpuOptions, Settings};

const SWIFTSHADER: &str = "/usr/lib/chromium/vk_swiftshader_icd.json";

/// Verdicts of two scenes of every kind, and which are wrong.
fn verdicts(gpu: &Gpu) -> (Tally, Vec<String>) {
    println!("{} ({})", gpu.info.name, gpu.info.driver_info);
    let (mut masks, mut failures) = (Tally::default(), Vec::new());
    for kind in Kind::ALL {
        for seed in 1..=2 {
            let images = bench::images(gpu, &kind.recipe(seed, [192, 120]), &Settings::default());
            let comparisons = images.and_then(|i| i.compare()).unwrap_or_else(|e| panic!("{kind:?} seed {seed}: {e}"));
            for comparison in &comparisons {
                masks.add(&comparison.mask);
                if !comparison.mask.wrong.is_empty() {
                    let wrong = comparison.mask.wrong.len();
                    failures.push(format!("{kind:?} seed {seed}, light {}: {wrong}", comparison.light));
                }
            }
        }
    }
    println!("{masks}");
    assert!(masks.checked > 330_000, "{} pixels checked", masks.checked);
    (masks, failures)
}

#[test]
fn gl_gives_the_same_verdicts() {
    let options = GpuOptions { backends: wgpu::Backends::GL, ..GpuOptions::default() };
    match Gpu::new(&options) {
        Ok(gpu) => {
            let (_, failures) = verdicts(&gpu);
            assert!(failures.is_empty(), "wrong verdicts: {failures:#?}");
        }
        Err(error) => println!("skipped: {error}"),
    }
}

#[test]
fn swiftshader_differs_along_edges_at_most() {
    if !Path::new(SWIFTSHADER).exists() {
        println!("skipped: {SWIFTSHADER} is not there (Debian's package chromium has it)");
        return;
    }
    // The loader reads its environment once, so another driver needs another process.
    let output = Command::new(env::current_exe().expect("this test"))
        .args(["--exact", "backends::on_the_driver_of_the_environment", "--ignored", "--nocapture"])
        .env("VK_ICD_FILENAMES", SWIFTSHADER)
        .output()
        .expect("a second process");
    let said = String::from_utf8_lossy(&output.stdout);
    println!("{said}");
    // A test of another name would be no test, and succeed.
    let succeeded = output.status.success() && said.contains("1 passed");
    assert!(succeeded, "{said}{}", String::from_utf8_lossy(&output.stderr));
}

#[test]
#[ignore = "run by swiftshader_differs_along_edges_at_most"]
fn on_the_driver_of_the_environment() {
    let gpu = Gpu::new(&GpuOptions { backends: wgpu::Backends::VULKAN, ..GpuOptions::default() }).expect("an adapter");
    assert!(gpu.info.name.contains("SwiftShader"), "{} is another driver", gpu.info.name);
    let (masks, failures) = verdicts(&gpu);
    // It snaps vertices to 1/16 pixel, as far as the oracle's guard reaches.
    assert!(masks.wrong * 10_000 < masks.checked, "wrong verdicts: {failures:#?}");
}
