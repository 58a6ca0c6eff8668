//! Ideal lights: points without extent, as the stencil algorithms require (E&K section 3.1).
//!
//! In: where a light is, and how far it reaches. Out: its homogeneous position. What colour it has, nobody here asks.

use glam::{DVec3, DVec4};

/// Where the light is and which part of space it can reach.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LightKind {
    /// Shines in every direction from `position`.
    Point {
        /// World space.
        position: DVec3,
        /// Distance beyond which nothing is lit; infinite if `f64::INFINITY`.
        range: f64,
    },
    /// A point light limited to a cone.
    Spot {
        /// World space.
        position: DVec3,
        /// Unit axis, the way the light travels.
        direction: DVec3,
        /// Distance beyond which nothing is lit.
        range: f64,
        /// Half angle, radians, at which the light begins to fall off.
        inner: f64,
        /// Half angle, radians, beyond which nothing is lit; at most pi/2.
        outer: f64,
    },
    /// Parallel rays.
    Directional {
        /// Unit vector, the way the light travels.
        direction: DVec3,
    },
}

impl LightKind {
    /// The range of a light that is somewhere; `None` for directional ones.
    #[must_use]
    pub fn range(&self) -> Option<f64> {
        match *self {
            Self::Point { range, .. } | Self::Spot { range, .. } => Some(range),
            Self::Directional { .. } => None,
        }
    }

    /// The homogeneous position of McGuire et al. section 4: `(position, 1)`, or `(towards the light, 0)`.
    #[must_use]
    pub fn homogeneous(&self) -> DVec4 {
        match *self {
            Self::Point { position, .. } | Self::Spot { position, .. } => position.extend(1.0),
            Self::Directional { direction } => (-direction).extend(0.0),
        }
    }

    /// Whether `point` lies within the light's range and cone (facing and shadows aside).
    #[must_use]
    pub fn reaches(&self, point: DVec3) -> bool {
        match *self {
            Self::Directional { .. } => true,
            Self::Point { position, range } => position.distance_squared(point) <= range * range,
            Self::Spot { position, direction, range, outer, .. } => {
                let to = point - position;
                let distance = to.length();
                distance <= range && to.dot(direction) >= distance * outer.cos()
            }
        }
    }
}
