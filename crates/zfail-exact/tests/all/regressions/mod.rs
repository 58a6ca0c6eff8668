//! Scenes that were once wrong, each with what was the matter.

mod pair;

use zfail_exact::bench;
use zfail_exact::kinds::Kind;
use zfail_render::{Settings, Technique};

/// Kind, seed, size and story.
const SCENES: [(Kind, u64, [u32; 2], &str); 9] = [
    (Kind::Soup, 1, [192, 120], "a culled twin's light cap lay before the visible triangle by rounding"),
    (Kind::Soup, 1003, [256, 160], "the same"),
    (Kind::NonManifold, 1073, [256, 160], "the same, in a sheet with a back"),
    (Kind::NonManifold, 1081, [256, 160], "the same"),
    (
        Kind::EyeInside,
        4,
        [256, 160],
        "counting from within a solid, its culled back faces were taken to hide its light cap",
    ),
    (Kind::EyeInside, 8, [256, 160], "the same"),
    (
        Kind::OrthographicCut,
        14,
        [321, 197],
        "what the near plane cuts ended on the rasteriser's grid, with the clamped depth of all that lies before that plane",
    ),
    (
        Kind::Orthographic,
        910_012,
        [256, 160],
        "two planar volumes had sides along an edge in the midst of a lit slope, whose depths had to be equal",
    ),
    (
        Kind::Orthographic,
        4,
        [257, 160],
        "a box without thickness bounds its shadow by each plane twice, and the second cut lost half of what can be seen",
    ),
];

#[test]
fn what_was_wrong_once_is_right() {
    let Some(gpu) = crate::gpu() else { return };
    for (kind, seed, size, story) in SCENES {
        let images = bench::images(&gpu, &kind.recipe(seed, size), &Settings::default());
        let images = images.unwrap_or_else(|e| panic!("{kind:?} {seed}: {e}"));
        images.judge(&format!("regression {kind:?} {seed}")).unwrap_or_else(|e| panic!("{e}: {story}"));
    }
}

/// A batch ended along the diagonal of a sheet, and its side there stood within rounding of the sheet itself.
#[test]
fn batches_of_a_deep_stack_end_between_sheets() {
    let Some(gpu) = crate::gpu() else { return };
    // The tile pass had it right.
    let settings = Settings { technique: Technique::EverittKilgard, ..Settings::default() };
    let images = bench::images(&gpu, &Kind::Stack.recipe(910_017, [256, 160]), &settings);
    images.expect("images").judge("deep stack").unwrap_or_else(|e| panic!("{e}"));
}
