//! The algorithms by name, and the steps of which they are made.

use std::fmt;
use std::str::FromStr;

/// Which published algorithm decides what is drawn. All give the same verdict at every pixel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Technique {
    /// The best there is: every step of [`Steps`].
    #[default]
    Auto,
    /// Everitt & Kilgard 2002: every caster's whole volume by z-fail, nothing culled.
    EverittKilgard,
    /// Lengyel 2002, "The Mechanics of Robust Stencil Shadows": z-pass for a light none of whose casters comes between
    /// it and the near rectangle, z-fail otherwise, and a scissor around the light's sphere.
    Lengyel,
    /// McGuire et al. 2003: z-pass or z-fail by caster, parts culled, dark caps as fans, light bounds.
    Mcguire,
}

impl Technique {
    /// Every technique, in the order of help texts.
    pub const ALL: [Self; 4] = [Self::Auto, Self::EverittKilgard, Self::Lengyel, Self::Mcguire];

    /// Its name on the command line.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Auto => "auto",
            Self::EverittKilgard => "everitt-kilgard",
            Self::Lengyel => "lengyel",
            Self::Mcguire => "mcguire",
        }
    }

    /// The steps it takes.
    #[must_use]
    pub const fn steps(self) -> Steps {
        let nothing = Steps {
            reach: false,
            by_section: false,
            off_screen: false,
            z_pass: ZPass::Never,
            near_count: false,
            fan: false,
            receivers: false,
            occluders: 0,
            tiles: Tiles::Never,
            silhouettes: Silhouettes::Cpu,
        };
        let mcguire =
            Steps { reach: true, off_screen: true, z_pass: ZPass::ByCaster, fan: true, receivers: true, ..nothing };
        match self {
            Self::EverittKilgard => nothing,
            Self::Lengyel => Steps { reach: true, z_pass: ZPass::ByLight, ..nothing },
            Self::Mcguire => mcguire,
            Self::Auto => {
                let (tiles, silhouettes) = (Tiles::WhereCheaper, Silhouettes::WhereCheaper);
                Steps { by_section: true, near_count: true, occluders: 8, tiles, silhouettes, ..mcguire }
            }
        }
    }
}

/// The steps beyond counting every volume by z-fail. Each can be taken or left; none changes a verdict.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Steps {
    /// Leave out pixels and casters that the light cannot reach.
    pub reach: bool,
    /// Decide by section of a mesh instead of by mesh: its case, its caps, what is culled, and its pixels (E&K section 3.4).
    pub by_section: bool,
    /// Leave out volumes, and parts of volumes, that do not come into view.
    pub off_screen: bool,
    /// Where to count in front of the visible surface instead of behind it.
    pub z_pass: ZPass,
    /// Let casters that cover the near rectangle whole count in front too, from a number known beforehand.
    pub near_count: bool,
    /// Close volumes at infinity by a fan over the silhouette where that is valid.
    pub fan: bool,
    /// Draw a volume only where the surfaces lie that it can shadow, in depth as on the image (needs
    /// [`super::Input::receivers`]). McGuire et al. 2003, section 6, line 17, sets bounds of depth for that; wgpu has none, so
    /// what of the scene lies within them is asked beforehand.
    pub receivers: bool,
    /// Convex casters, per light, in whose shadow other casters are looked for to leave them out.
    pub occluders: u8,
    /// Where to count sides by tiles in a compute shader instead of rasterising them, if the host lets it.
    pub tiles: Tiles,
    /// Where to find silhouettes.
    pub silhouettes: Silhouettes,
}

/// Where the silhouettes and caps of casters are found.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Silhouettes {
    /// On the CPU, all of them.
    Cpu,
    /// In compute shaders, those of all casters for which that can be done.
    Gpu,
    /// In compute shaders where the cost model of the device says that it saves time: for large casters whose light moves.
    WhereCheaper,
}

/// When the sides of a light's z-pass casters are counted by tiles.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Tiles {
    /// Not at all.
    Never,
    /// Where the cost model of the device says that it saves time.
    WhereCheaper,
    /// Wherever it can be done.
    Always,
}

impl Default for Steps {
    fn default() -> Self {
        Technique::Auto.steps()
    }
}

impl From<Technique> for Steps {
    fn from(technique: Technique) -> Self {
        technique.steps()
    }
}

impl Steps {
    /// Without what changes counts where verdicts stay.
    pub(super) const fn keeping_counts(self) -> Self {
        Self { reach: false, occluders: 0, ..self }
    }
}

/// Where z-pass is preferred to z-fail.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum ZPass {
    /// Nowhere.
    Never,
    /// For lights all of whose casters keep clear of the occlusion pyramid.
    ByLight,
    /// For every caster that keeps clear of the occlusion pyramid.
    ByCaster,
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
    /// The count of all casters modulo 256 on every visible surface, no caster left out and nothing folded.
    Raw,
}
