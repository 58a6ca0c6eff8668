//! The algorithms by name.

use std::fmt;
use std::str::FromStr;

/// Which published algorithm decides what is drawn. All give the same verdict at every pixel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Technique {
    /// The best there is: z-fail as in Everitt & Kilgard, without casters and pixels that the light cannot reach.
    #[default]
    Auto,
    /// Everitt & Kilgard 2002: every caster's whole volume by z-fail, nothing culled.
    EverittKilgard,
}

impl Technique {
    /// Every technique, in the order of help texts.
    pub const ALL: [Self; 2] = [Self::Auto, Self::EverittKilgard];

    /// Its name on the command line.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Auto => "auto",
            Self::EverittKilgard => "everitt-kilgard",
        }
    }
}

impl fmt::Display for Technique {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// A name that no technique has.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("there is no technique {0:?}; known are {known}", known = Technique::ALL.map(Technique::name).join(", "))]
pub struct UnknownTechnique(pub String);

impl FromStr for Technique {
    type Err = UnknownTechnique;

    fn from_str(name: &str) -> Result<Self, Self::Err> {
        Self::ALL.into_iter().find(|t| t.name() == name).ok_or_else(|| UnknownTechnique(name.to_owned()))
    }
}

/// What the stencil holds when a light's volumes have been drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Counting {
    /// Zero exactly where the light arrives, however many layers are in the way.
    #[default]
    Verdict,
    /// The count of all casters modulo 256, nothing culled and nothing folded.
    Raw,
}
