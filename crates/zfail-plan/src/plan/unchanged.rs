//! Nothing moved, nothing done: whether a frame is the one before.
//!
//! In: frames. Out: whether everything that the last plan depends on is still the same, by comparison element by element. That
//! costs a few nanoseconds per caster; deciding again that nothing has to be decided costs a thousand times as much.

use super::{Counting, Input, ShadowLight, Steps};
use crate::bounds::{Bounds, OrientedBox};
use crate::light::LightKind;
use crate::view::View;
use glam::DAffine3;

/// What the last frame was planned for.
#[derive(Debug, Default)]
pub(super) struct Unchanged {
    /// Nothing if the plan belongs to no frame.
    fixed: Option<(View, Steps, Counting)>,
    casters: Vec<(u64, DAffine3)>,
    lights: Vec<(LightKind, Option<OrientedBox>, usize)>,
    /// Of all lights, one after the other.
    excluded: Vec<usize>,
    receivers: Vec<Bounds>,
    extractable: Vec<bool>,
}

impl Unchanged {
    /// Whether a frame is the one that was kept, but for its lights.
    pub fn is_but_for_lights(&self, input: &Input<'_>, extractable: &[bool]) -> bool {
        self.fixed == Some((*input.view, input.steps, input.counting))
            && self.extractable == extractable
            && self.lights.len() == input.lights.len()
            && self.excluded.iter().copied().eq(excluded(input))
            && self.casters.iter().copied().eq(casters(input))
            && self.receivers == input.receivers
    }

    /// Whether light `l` is the one that was kept.
    pub fn has_light(&self, input: &Input<'_>, l: usize) -> bool {
        self.lights.get(l) == Some(&light(&input.lights[l]))
    }

    /// Keeps a frame.
    pub fn keep(&mut self, input: &Input<'_>, extractable: &[bool]) {
        refill(&mut self.casters, casters(input));
        refill(&mut self.lights, lights(input));
        refill(&mut self.excluded, excluded(input));
        self.receivers.clear();
        self.receivers.extend_from_slice(input.receivers);
        self.extractable.clear();
        self.extractable.extend_from_slice(extractable);
        self.fixed = Some((*input.view, input.steps, input.counting));
    }

    /// Forgets the frame.
    pub fn forget(&mut self) {
        self.fixed = None;
    }
}

fn refill<T>(list: &mut Vec<T>, items: impl Iterator<Item = T>) {
    list.clear();
    list.extend(items);
}

fn casters(input: &Input<'_>) -> impl Iterator<Item = (u64, DAffine3)> {
    input.casters.iter().map(|caster| (caster.mesh, caster.world_from_object))
}

fn lights(input: &Input<'_>) -> impl Iterator<Item = (LightKind, Option<OrientedBox>, usize)> {
    input.lights.iter().map(light)
}

fn light(light: &ShadowLight<'_>) -> (LightKind, Option<OrientedBox>, usize) {
    (light.kind, light.bounds, light.excluded.len())
}

fn excluded(input: &Input<'_>) -> impl Iterator<Item = usize> {
    input.lights.iter().flat_map(|light| light.excluded.iter().copied())
}
