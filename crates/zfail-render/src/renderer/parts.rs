//! How a frame is divided, and how its times are numbered.

use crate::passes::verdict_pass;
use std::ops::Range;

/// How a picture is finished.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Finish {
    /// By the forward pass itself.
    Forward,
    /// From radiance.
    Darkroom,
}

/// Part of a frame. One is enough unless shadows fall on blended surfaces, or there are more lights than a texel of
/// verdicts has bits.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Part {
    /// Of the frame's lights.
    pub lights: Range<usize>,
    /// Draws solid surfaces.
    pub solid: bool,
    /// Draws blended surfaces.
    pub blended: bool,
    /// Adds lights to surfaces that an earlier part has drawn.
    pub further: bool,
}

/// The parts of a frame in order.
pub fn parts(lights: usize, shadows: bool, blends: bool) -> Vec<Part> {
    if !shadows || lights == 0 {
        return vec![Part { lights: 0..lights, solid: true, blended: blends, further: false }];
    }
    let surfaces = [true, false].into_iter().filter(|&solid| solid || blends);
    let groups = |solid| {
        (0..lights).step_by(verdict_pass::LIGHTS).map(move |start| {
            let lights = start..lights.min(start + verdict_pass::LIGHTS);
            Part { lights, solid, blended: !solid, further: start > 0 }
        })
    };
    surfaces.flat_map(groups).collect()
}

/// Numbers what is timed: verdicts, forward, develop, then each light's volumes.
#[derive(Clone, Copy, Debug)]
pub struct Spans {
    pub shadows: bool,
    pub darkroom: bool,
    /// Lights that are timed.
    pub lights: usize,
}

impl Spans {
    pub fn forward(self) -> usize {
        usize::from(self.shadows)
    }

    pub fn develop(self) -> usize {
        self.forward() + 1
    }

    pub fn light(self, light: usize) -> Option<usize> {
        (self.shadows && light < self.lights).then_some(self.develop() + usize::from(self.darkroom) + light)
    }

    pub fn count(self) -> usize {
        self.develop() + usize::from(self.darkroom) + if self.shadows { self.lights } else { 0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn many_lights_are_divided() {
        let whole = |lights: usize, blended| Part { lights: 0..lights, solid: true, blended, further: false };
        assert_eq!(parts(50, false, true), [whole(50, true)]);
        assert_eq!(parts(32, true, false), [whole(32, false)]);
        assert_eq!(parts(32, true, true), [whole(32, false), Part { solid: false, ..whole(32, true) }]);
        let divided = parts(50, true, true);
        assert_eq!(divided.iter().map(|p| p.lights.clone()).collect::<Vec<_>>(), [0..32, 32..50, 0..32, 32..50]);
        assert_eq!(
            divided.iter().map(|p| [p.solid, p.blended, p.further]).collect::<Vec<_>>(),
            [[true, false, false], [true, false, true], [false, true, false], [false, true, true]]
        );
    }
}
