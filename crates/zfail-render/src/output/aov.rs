//! Arbitrary output variables: what a pixel's centre sees, before shading.

use std::fmt;
use std::str::FromStr;

/// One kind of output.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum AovKind {
    /// Per light, 255 where it reaches the visible surface.
    Shadow,
    /// Per light, the raw stencil count modulo 256.
    Stencil,
    /// Distance along the view axis.
    Depth,
    /// World-space position.
    Position,
    /// World-space shading normal.
    Normal,
    /// Linear base colour.
    Albedo,
}

impl AovKind {
    /// Every kind, in the order of the documentation.
    pub const ALL: [Self; 6] = [Self::Shadow, Self::Stencil, Self::Depth, Self::Position, Self::Normal, Self::Albedo];

    /// Its name on the command line.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Shadow => "shadow",
            Self::Stencil => "stencil",
            Self::Depth => "depth",
            Self::Position => "position",
            Self::Normal => "normal",
            Self::Albedo => "albedo",
        }
    }
}

impl fmt::Display for AovKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// The name of no [`AovKind`].
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("there is no output \"{0}\": use shadow, stencil, depth, position, normal or albedo")]
pub struct UnknownAov(String);

impl FromStr for AovKind {
    type Err = UnknownAov;

    fn from_str(name: &str) -> Result<Self, UnknownAov> {
        Self::ALL.into_iter().find(|kind| kind.name() == name).ok_or_else(|| UnknownAov(name.to_owned()))
    }
}

/// The outputs that were asked for, rows from top to bottom, sampled at pixel centres; the others are empty.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Aovs {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Per light of [`crate::Settings::lights`], per pixel: 255 where the stencil says lit, 0 in shadow, where there
    /// is no surface, and outside the light's range or cone. The surface's orientation has no influence.
    pub shadow: Vec<Vec<u8>>,
    /// Per light, per pixel: the count of all casters modulo 256; 0 where there is no surface.
    pub stencil: Vec<Vec<u8>>,
    /// Distance from the eye along the view axis, scene units; 0 where there is no surface.
    pub depth: Vec<f32>,
    /// World space; 0 where there is no surface.
    pub position: Vec<[f32; 3]>,
    /// Unit shading normal, world space, as precise as half floats; 0 where there is no surface.
    pub normal: Vec<[f32; 3]>,
    /// Linear base colour, as precise as 8-bit sRGB; 0 where there is no surface.
    pub albedo: Vec<[f32; 3]>,
}
