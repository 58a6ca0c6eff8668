//! Which casters count in front of the visible surface instead of behind it (McGuire et al. 2003, section 6, line 17).
//!
//! In: pairs with their roles. Out: z-pass where nothing of the caster stands between light and near rectangle, or where the count
//! there is known.

use super::LightPlan;
use super::off_screen::Parts;
use super::pair::{Pair, Role};
use super::pyramid::{self, Pyramid};
use super::stage::Stage;
use crate::scissor::Rectangle;

/// Whether nothing of a caster stands between the light and the near rectangle behind pixels `within`.
pub(super) fn is_clear(stage: &Stage<'_>, c: usize, pair: &Pair, within: Rectangle) -> bool {
    pyramid_of(stage, c, pair, within).excludes(&stage.placed[c].bounds)
}

/// Leaves z-pass to lights all of whose casters are clear (Lengyel 2002).
pub(super) fn all_or_none(pairs: &mut [Pair]) {
    if pairs.iter().any(|pair| matches!(pair.role, Role::Active { z_pass: false, .. })) {
        for pair in pairs.iter_mut() {
            if let Role::Active { z_pass, .. } = &mut pair.role {
                *z_pass = false;
            }
        }
    }
}

/// Turns z-fail into z-pass where the count at the near rectangle is known, and adds those counts up.
pub(super) fn count_from_near_rectangle(stage: &Stage<'_>, light: &mut LightPlan, pairs: &mut [Pair]) {
    let Some(scissor) = light.scissor.filter(|_| stage.steps.near_count) else { return };
    let mut sum = 0;
    for (c, pair) in pairs.iter_mut().enumerate() {
        // Also of those for which it was known before.
        sum += pair.start.layers;
        let Role::Active { within, parts, z_pass: false } = pair.role else { continue };
        if pair.on_device {
            continue;
        }
        let pyramid = pyramid_of(stage, c, pair, scissor);
        let Some(start) = pair.near_count(stage.topology(c), pyramid) else { continue };
        sum += start.layers;
        pair.start = start;
        // What every pixel starts with has to be counted in every pixel.
        let (within, parts) = if start.layers == 0 { (within, parts) } else { (scissor, Parts::ALL) };
        pair.role = Role::Active { within, parts, z_pass: true };
    }
    light.stats.near_count = sum;
}

fn pyramid_of(stage: &Stage<'_>, c: usize, pair: &Pair, within: Rectangle) -> Pyramid {
    let (view, caster) = (stage.view(), &stage.placed[c]);
    let slab = pyramid::near_slab(view, within, pyramid::pad(view, caster.reach));
    Pyramid::new(slab, &caster.object_from_relative(), pair.light)
}
