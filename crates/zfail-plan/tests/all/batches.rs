//! Inputs that are small and deep: what planning them costs, and that no count of a batch wraps to "lit".

use crate::deep::{self, Tower, below, disc, is_dark, lamp, pages, sun};
use crate::shapes;
use zfail_plan::glam::DVec3;
use zfail_testing::Random;

#[test]
fn small_deep_inputs_cost_little_and_never_wrap() {
    let flat = |segments| disc(segments, |_| 0.0);
    let mut stacked = flat(120);
    for i in 1..300 {
        stacked = shapes::joined(stacked, flat(120), [0.0, i as f32 * 0.01, 0.0]);
    }
    let deep = [
        ("instances of a disc", flat(120), 300, 4),
        ("discs in one mesh", stacked, 1, 6),
        ("a fan", flat(20_000), 1, 1),
        ("a pleated fan", disc(10_000, |angle| 0.2 * (500.0 * angle).sin()), 1, 1),
        ("a heap of fans", disc(500, |angle| 0.1 * (9.0 * angle).sin()), 100, 1),
        ("pages", pages(500), 1, 8),
    ];
    for (name, soup, copies, most) in deep {
        for light in [lamp(), sun()] {
            let tower = Tower::new(&soup, copies, light);
            let plan = tower.plan();
            let (stats, batches) = (plan.lights[0].stats, plan.lights[0].batches.len());
            let triangles = tower.triangles() as u64;
            assert!(batches <= most, "{name}, {light:?}: {batches} batches");
            assert!(stats.searched < 100 * triangles + 1_000_000, "{name}, {light:?}: {} looked at", stats.searched);
            assert!(u64::from(stats.triangles.total()) < 9 * triangles, "{name}, {light:?}: {:?}", stats.triangles);
            let mut deepest = 0;
            for point in below() {
                let counts = tower.counts(&plan, point);
                let layers: usize = counts.iter().sum();
                assert_eq!(is_dark(&counts), layers > 0, "{name}, {light:?}, {point}: {counts:?}");
                deepest = deepest.max(layers);
            }
            assert!(deepest > 0, "{name}, {light:?}: no shadow");
        }
    }
}

/// What a bound that is too small would do: the pages stay in one batch, and where 256 of them lie over one another the
/// count is 0.
#[test]
fn a_bound_that_is_too_small_is_noticed() {
    let tower = Tower::new(&pages(256), 1, lamp());
    let mut plan = tower.plan();
    assert!(plan.lights[0].batches.len() > 1);
    let point = DVec3::new(0.5, -1.0, 0.0);
    let right = tower.counts(&plan, point);
    assert!(right.iter().sum::<usize>() == 256 && is_dark(&right), "{right:?}");
    let all = 0..plan.draws.len() as u32;
    plan.lights[0].batches = vec![all];
    assert!(!is_dark(&tower.counts(&plan, point)), "256 layers wrap to lit");
}

#[test]
fn no_bytes_make_a_search_that_does_not_end() {
    let mut random = Random(11);
    for round in 0..60_u8 {
        // Of each kind as many.
        let mut bytes: Vec<u8> = (0..12 + usize::from(round) * 5).map(|_| random.below(256) as u8).collect();
        bytes[0] = round;
        bytes[1] = bytes[1].min(80);
        deep::check(&bytes);
    }
}
