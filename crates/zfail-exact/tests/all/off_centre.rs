//! Frusta that are off centre: parts of a picture, and jittered ones. They are right by the oracle, whose rays know of them, and
//! parts make up the whole.

use zfail_exact::bench;
use zfail_exact::kinds::Kind;
use zfail_plan::view::View;
use zfail_render::{Settings, Technique, Tiles};

const SIZE: [u32; 2] = [200, 144];
/// Overlapping, of different shapes, and beyond the picture's border.
const PARTS: [[u32; 4]; 3] = [[0, 0, 90, 144], [80, 20, 120, 50], [133, 100, 100, 77]];
const KINDS: [Kind; 6] = [Kind::Mixed, Kind::Orthographic, Kind::NearCut, Kind::EyeInside, Kind::Spot, Kind::Open];

#[test]
fn off_centre_views_are_right() {
    let Some(gpu) = crate::gpu() else { return };
    let (mut checked, mut shadowed) = (0, 0);
    for (i, kind) in KINDS.into_iter().enumerate() {
        let whole = kind.recipe(77, SIZE);
        let moved = |part| if i % 2 == 0 { whole.view.part(part) } else { whole.view.part(part).jittered([0.3, -0.2]) };
        for (p, view) in PARTS.map(moved).into_iter().enumerate() {
            let technique = Technique::ALL[(i + p) % Technique::ALL.len()];
            let settings = Settings { technique, tiles: Tiles::Always, ..Settings::default() };
            let recipe = zfail_exact::recipe::Recipe { view, ..whole.clone() };
            let images = bench::images(&gpu, &recipe, &settings).unwrap_or_else(|e| panic!("{kind:?}: {e}"));
            let comparisons = images.judge(&format!("off centre {kind:?} {p}"));
            for comparison in comparisons.unwrap_or_else(|e| panic!("{e}; {technique}, {:?}", view.window)) {
                checked += comparison.mask.checked;
                shadowed += comparison.mask.shadowed;
            }
        }
    }
    assert!(checked > 100_000 && shadowed * 20 > checked, "{shadowed} of {checked} pixels in shadow");
}

/// The masks of the parts and of the whole, but for pixels on borders: vertices of parts are rounded elsewhere.
#[test]
fn parts_make_up_the_whole() {
    let Some(gpu) = crate::gpu() else { return };
    for kind in [Kind::Mixed, Kind::Orthographic] {
        let recipe = kind.recipe(77, SIZE);
        let scene = recipe.scene();
        let masks = |view: &View| bench::render(&gpu, &scene, view, &Settings::default()).expect("images").shadow;
        let whole = masks(&recipe.view);
        let [x, y, width, height] = PARTS[1];
        let differ = |part: &[Vec<u8>], shift: u32| {
            let of_whole = |i: u32| (y + i / width) * SIZE[0] + (x + shift + i % width).min(SIZE[0] - 1);
            let differ = |l: usize| {
                (0..width * height).filter(|&i| part[l][i as usize] != whole[l][of_whole(i) as usize]).count()
            };
            (0..whole.len()).map(differ).sum::<usize>()
        };
        let part = masks(&recipe.view.part(PARTS[1]));
        let (same, shifted) = (differ(&part, 0), differ(&part, 4));
        assert!(same <= 12 && shifted > 20 + 4 * same, "{kind:?}: {same} pixels differ, {shifted} where it is shifted");
    }
}
