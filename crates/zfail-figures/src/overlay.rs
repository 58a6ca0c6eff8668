//! The kinds of figures by name.

use std::fmt;
use std::str::FromStr;

/// What a figure shows. Papers: E&K is Everitt & Kilgard 2002, McG is McGuire et al. 2003.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Overlay {
    /// Translucent shadow volumes, coloured by part, as the technique draws them: what is left of them, within their scissors
    /// (McG Image 5, right).
    Volumes,
    /// Translucent shadow volumes, a colour for each light.
    VolumesByLight,
    /// The edges from which sides are extruded: those with a crossing weight other than 0.
    Silhouettes,
    /// Casters coloured by their case under one light (McG section 7, Image 6).
    Cases,
    /// The stencil count of one light at every visible surface.
    Stencil,
    /// Scissor rectangles of lights and draws, and how far lights reach.
    Scissors,
    /// View frustum and occlusion pyramid of one light, from elsewhere (McG section 6, Figure 2).
    Pyramid,
    /// Edges of all triangles.
    Wireframe,
    /// Scene and volumes with everything outside the eye's infinite frustum clipped away, from elsewhere (E&K Figures 2, 3).
    Alternate,
    /// The same in clip space, where volumes end on the far plane at infinity (E&K Figures 2, 3 and 5).
    ClipSpace,
}

impl Overlay {
    /// Every kind, in the order of help texts.
    pub const ALL: [Self; 10] = [
        Self::Volumes,
        Self::VolumesByLight,
        Self::Silhouettes,
        Self::Cases,
        Self::Stencil,
        Self::Scissors,
        Self::Pyramid,
        Self::Wireframe,
        Self::Alternate,
        Self::ClipSpace,
    ];

    /// Its name on the command line.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Volumes => "volumes",
            Self::VolumesByLight => "volumes-by-light",
            Self::Silhouettes => "silhouettes",
            Self::Cases => "cases",
            Self::Stencil => "stencil",
            Self::Scissors => "scissors",
            Self::Pyramid => "pyramid",
            Self::Wireframe => "wireframe",
            Self::Alternate => "alternate",
            Self::ClipSpace => "clip-space",
        }
    }

    /// What it shows, as half a sentence.
    #[must_use]
    pub const fn description(self) -> &'static str {
        match self {
            Self::Volumes => "shadow volumes as the technique draws them, within their scissors, coloured by part",
            Self::VolumesByLight => "the same, a colour for each light",
            Self::Silhouettes => "silhouette edges as the lights see them",
            Self::Cases => {
                "casters coloured by case 1, 2 or 3 (McGuire et al., section 7), under the first light chosen"
            }
            Self::Stencil => "the stencil count of the first light chosen",
            Self::Scissors => "scissor rectangles, and how far lights reach",
            Self::Pyramid => "the occlusion pyramid of the first light chosen, from elsewhere",
            Self::Wireframe => "edges of all triangles",
            Self::Alternate => "scene and volumes inside the eye's infinite frustum, from elsewhere",
            Self::ClipSpace => "the same in clip space, where volumes meet the far plane at infinity",
        }
    }

    /// Whether it is a picture of its own instead of something drawn over the eye's.
    #[must_use]
    pub const fn replaces_picture(self) -> bool {
        matches!(self, Self::Pyramid | Self::Alternate | Self::ClipSpace)
    }
}

impl fmt::Display for Overlay {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// A name that no overlay has.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("there is no overlay {0:?}; known are {known}", known = Overlay::ALL.map(Overlay::name).join(", "))]
pub struct UnknownOverlay(pub String);

impl FromStr for Overlay {
    type Err = UnknownOverlay;

    fn from_str(name: &str) -> Result<Self, Self::Err> {
        Self::ALL.into_iter().find(|o| o.name() == name).ok_or_else(|| UnknownOverlay(name.to_owned()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_lead_back_to_their_overlays() {
        for overlay in Overlay::ALL {
            assert_eq!(overlay.to_string().parse(), Ok(overlay));
        }
        assert!("volume".parse::<Overlay>().unwrap_err().to_string().contains("volumes-by-light"));
    }
}
