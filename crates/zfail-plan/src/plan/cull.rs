//! Casters and pixels that a light cannot concern.

use super::{Counting, Frame, ShadowLight, Technique};
use crate::scene::{Bounds, LightKind};
use crate::scissor::{self, Rectangle};
use glam::DVec3;

/// Whether anything may be left out of this frame.
fn may_cull(frame: &Frame<'_>) -> bool {
    frame.technique != Technique::EverittKilgard && frame.counting == Counting::Verdict
}

/// Pixels whose surfaces the light may reach; `None` if there are none.
pub(super) fn light_scissor(frame: &Frame<'_>, light: &ShadowLight<'_>) -> Option<Rectangle> {
    match reach(&light.kind) {
        Some((center, range)) if may_cull(frame) => {
            let half = DVec3::splat(range);
            scissor::rectangle(frame.view, &Bounds { min: center - half, max: center + half }.corners())
        }
        _ => Some(scissor::full(frame.view)),
    }
}

/// Why caster `c` throws no shadow that matters for `light`, if so.
pub(super) fn reason(
    frame: &Frame<'_>,
    light: &ShadowLight<'_>,
    scissor: Option<Rectangle>,
    c: usize,
) -> Option<&'static str> {
    if light.excluded.contains(&c) {
        return Some("excluded");
    }
    if scissor.is_none() {
        return Some("light off screen");
    }
    let (center, range) = reach(&light.kind).filter(|_| may_cull(frame))?;
    let caster = &frame.casters[c];
    let object = caster.topology.bounds();
    if object.is_empty() {
        return Some("nothing to cast");
    }
    let bounds = object.transformed(&caster.world_from_object);
    (bounds.distance_squared(center) > range * range).then_some("out of range")
}

/// The ball outside of which the light has no effect.
fn reach(kind: &LightKind) -> Option<(DVec3, f64)> {
    match *kind {
        LightKind::Point { position, range } | LightKind::Spot { position, range, .. } => {
            range.is_finite().then_some((position, range))
        }
        LightKind::Directional { .. } => None,
    }
}
