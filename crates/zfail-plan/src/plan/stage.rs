//! One frame's input as every stage of planning sees it.

use super::placed::Placed;
use super::{Input, ShadowLight, Steps};
use crate::topology::Topology;
use crate::view::View;
use glam::DVec4;

/// What is the same for all lights and casters of a frame.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stage<'a> {
    pub input: &'a Input<'a>,
    /// Those of the input that keep what it counts.
    pub steps: Steps,
    /// The input's casters, or their sections, placed.
    pub placed: &'a [Placed],
}

impl<'a> Stage<'a> {
    pub fn view(&self) -> &'a View {
        self.input.view
    }

    pub fn light(&self, l: usize) -> &'a ShadowLight<'a> {
        &self.input.lights[l]
    }

    /// A light, homogeneous, relative to the eye.
    pub fn relative_light(&self, l: usize) -> DVec4 {
        let light = self.light(l).kind.homogeneous();
        (light.truncate() - self.view().eye() * light.w).extend(light.w)
    }

    pub fn topology(&self, caster: usize) -> &'a Topology {
        let placed = &self.placed[caster];
        placed.source.topology(&self.input.casters[placed.caster as usize])
    }
}
