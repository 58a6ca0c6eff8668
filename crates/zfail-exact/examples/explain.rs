//! Why a random scene fails or is rejected: `explain KIND SEED [WxH]`. `ZFAIL_TECHNIQUE` names the technique.
//!
//! Prints, per light, figures and budget, the surroundings of wrong pixels, and how many of them larger guards leave.

use std::env;
use zfail_exact::{bench, kinds::Kind};
use zfail_oracle::{Guards, Truth, Wrong};
use zfail_render::{Gpu, GpuOptions, Settings};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut arguments = env::args().skip(1);
    let kind = arguments.next().and_then(|name| Kind::ALL.into_iter().find(|k| format!("{k:?}") == name));
    let seed = arguments.next().and_then(|seed| seed.parse().ok());
    let (Some(kind), Some(seed)) = (kind, seed) else {
        return Err(format!("usage: explain KIND SEED [WxH], KIND being one of {:?}", Kind::ALL).into());
    };
    let size = arguments.next().and_then(|s| s.split_once('x').map(|(w, h)| [w.parse().ok(), h.parse().ok()]));
    let size = size.and_then(|[w, h]| Some([w?, h?])).unwrap_or([256, 160]);
    let recipe = kind.recipe(seed, size);
    println!("{recipe:?}");
    let gpu = Gpu::new(&GpuOptions::default())?;
    let scene = recipe.scene();
    let technique = env::var("ZFAIL_TECHNIQUE").unwrap_or_default().parse().unwrap_or_default();
    let images = bench::images(&gpu, &recipe, &Settings { technique, ..Settings::default() })?;
    for comparison in images.compare()? {
        let light = comparison.light;
        for (what, report) in [("mask", &comparison.mask), ("count", &comparison.count)] {
            println!(
                "light {light} {what}: {} wrong, {} checked, left out {:?}, boundary {}, {:?}",
                report.wrong.len(),
                report.checked,
                report.excluded,
                report.boundary,
                report.budget(),
            );
        }
        let wrong = comparison.count.wrong.iter().chain(&comparison.mask.wrong);
        for pixel in wrong.take(12) {
            around(pixel, &images.truths[light], &images.rendered.stencil[light]);
        }
        for (pixels, kappa) in [(8.0, 8.0), (4.0, 8.0), (2.0, 8.0), (16.0, 32.0), (16.0, 128.0), (16.0, 1024.0)] {
            let guards = Guards { epsilon: 1.0 / pixels, kappa };
            let truth = bench::truths_with(&scene, &recipe.view, guards)?.swap_remove(light);
            let mask = truth.compare_mask(&images.rendered.shadow[light])?;
            let count = truth.compare_count(&images.rendered.stencil[light])?;
            println!("1/{pixels} px, kappa {kappa}: mask {} count {} wrong", mask.wrong.len(), count.wrong.len());
        }
    }
    Ok(())
}

/// Prints right = found and the doubts around a wrong pixel.
fn around(wrong: &Wrong, truth: &Truth, counts: &[u8]) {
    println!("{wrong:?}");
    let [width, height] = truth.size;
    for y in wrong.y.saturating_sub(2)..(wrong.y + 3).min(height) {
        let row = wrong.x.saturating_sub(2)..(wrong.x + 3).min(width);
        let cells = row.map(|x| {
            let i = (y * width + x) as usize;
            let pixel = &truth.pixels[i];
            let doubt = pixel.count_doubt.map_or(String::new(), |d| format!("{d:?}"));
            format!("{:>3} = {:<3} {doubt:8}", pixel.count, counts[i])
        });
        println!("    {}", cells.collect::<Vec<_>>().join(" | "));
    }
}
