//! Ideal lights: points without extent, as the stencil algorithms require (E&K section 3.1).

use glam::{DVec3, DVec4};

/// A light in world space.
#[derive(Clone, Debug)]
pub struct Light {
    /// The light's or the node's name.
    pub name: String,
    /// Point, spot or directional, with its placement.
    pub kind: LightKind,
    /// Linear RGB, each component usually at most 1.
    pub color: [f32; 3],
    /// Candela for point and spot lights, lux for directional ones (KHR_lights_punctual).
    pub intensity: f32,
    /// Indices of instances that cast no shadow from this light (light extras `shadowExclude`).
    pub excluded: Vec<usize>,
}

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
