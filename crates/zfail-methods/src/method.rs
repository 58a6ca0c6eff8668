//! The methods by name, with where they come from and what is to be expected of them.

use std::fmt;
use std::str::FromStr;

/// A way to find what a light reaches, in the order of history and of the modules.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Method {
    /// z-pass, front and back faces in a pass each, counts that saturate.
    HeidmannTwoPass,
    /// z-pass in one pass, counts that wrap.
    HeidmannTwoSided,
    /// z-pass, with the test exchanged where the eye is in a volume.
    InvertedTest,
    /// z-pass, starting from the number of volumes in which the eye is.
    EyeCount,
    /// z-pass, starting from counts without a depth test.
    CarmackPreload,
    /// The same, with counts of those volumes that may meet the near plane.
    CarmackPreloadNear,
    /// z-fail with a far plane and volumes that end somewhere.
    FiniteZFail,
    /// z-pass with volumes capped where the near plane cuts them.
    NearCaps,
    /// z-fail at infinity, back and front faces in a pass each, counts that saturate.
    EverittKilgardTwoPass,
    /// z-fail with the far plane and the ends of volumes at infinity.
    EverittKilgard,
    /// z-pass or z-fail by light.
    Lengyel,
    /// z-pass or z-fail by caster, parts culled.
    Mcguire,
    /// This library.
    Zfail,
    /// A depth map seen from the light.
    ShadowMap,
    /// A ray per pixel, traced by the device.
    RayQuery,
}

impl Method {
    /// Every method, in the order of history.
    pub const ALL: [Self; 15] = [
        Self::HeidmannTwoPass,
        Self::HeidmannTwoSided,
        Self::InvertedTest,
        Self::EyeCount,
        Self::CarmackPreload,
        Self::CarmackPreloadNear,
        Self::FiniteZFail,
        Self::NearCaps,
        Self::EverittKilgardTwoPass,
        Self::EverittKilgard,
        Self::Lengyel,
        Self::Mcguire,
        Self::Zfail,
        Self::ShadowMap,
        Self::RayQuery,
    ];

    /// Its name on the command line.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::HeidmannTwoPass => "heidmann-two-pass",
            Self::HeidmannTwoSided => "heidmann-two-sided",
            Self::InvertedTest => "inverted-test",
            Self::EyeCount => "eye-count",
            Self::CarmackPreload => "carmack-preload",
            Self::CarmackPreloadNear => "carmack-preload-near",
            Self::FiniteZFail => "finite-z-fail",
            Self::NearCaps => "near-caps",
            Self::EverittKilgardTwoPass => "everitt-kilgard-two-pass",
            Self::EverittKilgard => "everitt-kilgard",
            Self::Lengyel => "lengyel",
            Self::Mcguire => "mcguire",
            Self::Zfail => "zfail",
            Self::ShadowMap => "shadow-map",
            Self::RayQuery => "ray-query",
        }
    }

    /// Its name in headings.
    #[must_use]
    pub const fn title(self) -> &'static str {
        match self {
            Self::HeidmannTwoPass => "Heidmann, two passes",
            Self::HeidmannTwoSided => "Heidmann, two-sided stencil",
            Self::InvertedTest => "z-pass, test inverted",
            Self::EyeCount => "z-pass with eye count",
            Self::CarmackPreload => "Carmack's preload",
            Self::CarmackPreloadNear => "Carmack's preload, near the view plane",
            Self::FiniteZFail => "Bilodeau & Carmack, finite z-fail",
            Self::NearCaps => "z-pass with near caps",
            Self::EverittKilgardTwoPass => "Everitt & Kilgard, as printed",
            Self::EverittKilgard => "Everitt & Kilgard",
            Self::Lengyel => "Lengyel",
            Self::Mcguire => "McGuire et al.",
            Self::Zfail => "zfail",
            Self::ShadowMap => "Shadow map",
            Self::RayQuery => "Ray query",
        }
    }

    /// The paper, and the section that tells of it.
    #[must_use]
    pub const fn source(self) -> &'static str {
        match self {
            Self::HeidmannTwoPass => "Heidmann 1991; Everitt & Kilgard 2002, section 2.2.1",
            Self::HeidmannTwoSided => "Heidmann 1991; Everitt & Kilgard 2002, sections 4.1 and 4.3",
            Self::InvertedTest => "Carmack's letter, May 2000, of \"the classic shadow volume works\"",
            Self::EyeCount => "Moller & Haines 1999; McGuire et al. 2003, section 3",
            Self::CarmackPreload => "Carmack's letter, May 2000: \"preload\"",
            Self::CarmackPreloadNear => {
                "Carmack's letter, May 2000: \"surfaces that were likely to intersect the view plane\""
            }
            Self::FiniteZFail => "Bilodeau & Songy 1999; Carmack 2000; Everitt & Kilgard 2002, section 2.2.3",
            Self::NearCaps => "Diefenbach 1996; Kilgard 2001; Everitt & Kilgard 2002, section 2.2.2",
            Self::EverittKilgardTwoPass => "Everitt & Kilgard 2002, section 3.3, step 6",
            Self::EverittKilgard => "Everitt & Kilgard 2002, section 3",
            Self::Lengyel => "Lengyel 2002; McGuire et al. 2003, section 3",
            Self::Mcguire => "McGuire et al. 2003, sections 6 and 7",
            Self::Zfail => "this library's ARCHITECTURE.md",
            Self::ShadowMap => "Williams 1978; Carmack's letter, last paragraphs; McGuire et al. 2003, section 3",
            Self::RayQuery => "Vulkan's VK_KHR_ray_query, 2020",
        }
    }

    /// Whether it promises no wrong pixel on any scene under any view that it accepts.
    #[must_use]
    pub const fn exact(self) -> bool {
        matches!(self, Self::Lengyel | Self::Mcguire | Self::Zfail)
    }

    /// One sentence: why it is right, or where it goes wrong.
    #[must_use]
    pub const fn why(self) -> &'static str {
        match self {
            Self::HeidmannTwoPass => {
                "Counting starts at the near plane as if nothing were in shadow there, so it is wrong wherever the near \
                 rectangle lies in a volume, and counts stop at 0 and at 255."
            }
            Self::HeidmannTwoSided => {
                "Counting starts at the near plane as if nothing were in shadow there, so it is wrong wherever the near \
                 rectangle lies in a volume; counts wrap, so that the order of faces does not matter."
            }
            Self::InvertedTest => {
                "With the eye in shadow, what is not counted is dark; that is right while the eye is in one volume and no \
                 other is in sight, and the near rectangle is not cut by it."
            }
            Self::EyeCount => {
                "One number stands for the whole near rectangle, so it is right with the eye deep inside a volume and \
                 wrong where a volume cuts partway through the rectangle."
            }
            Self::CarmackPreload => {
                "Faces counted without a depth test leave, at each pixel, how many volumes the near plane cuts off, which \
                 is what z-pass has to start from; the far plane still cuts volumes open."
            }
            Self::CarmackPreloadNear => {
                "The preload is empty where volumes keep clear of the near plane, so only those that may meet it are \
                 counted without a depth test; what is right and wrong is the same."
            }
            Self::FiniteZFail => {
                "Counting starts from far away, so the near plane does not matter; but a far plane that cuts volumes, and \
                 volumes that end before they reach a surface, make it wrong."
            }
            Self::NearCaps => {
                "The near plane's cut is closed by polygons computed on the CPU, which never meet the device's clipping to \
                 the bit, so that single pixels along the cut go wrong."
            }
            Self::EverittKilgardTwoPass => {
                "Back faces come first and stop at 255, so that what front faces take off again is too much wherever more \
                 layers overlap; elsewhere it is the same as with counts that wrap."
            }
            Self::EverittKilgard => {
                "Volumes closed at infinity, before a far plane that is there too, cannot be cut open; it is right under \
                 every perspective view where fewer than 256 layers overlap."
            }
            Self::Lengyel => {
                "z-pass where nothing comes between the light and the near rectangle, and z-fail elsewhere: both are \
                 right where they are used."
            }
            Self::Mcguire => {
                "z-pass or z-fail is chosen for every caster by itself, and only parts that cannot be seen are left out, \
                 so that the count is that of z-fail everywhere."
            }
            Self::Zfail => {
                "Integer weights close the volume of any mesh, counts are folded before they can wrap, and nothing is left \
                 out that could change a verdict."
            }
            Self::ShadowMap => {
                "A texel stands for everything that it covers, so that shadows have stairs, a surface shadows itself \
                 without a bias, and with one the shadow leaves its caster."
            }
            Self::RayQuery => {
                "The ray is right, but it has to start a little off the surface, whose position is rounded, so contacts \
                 and edges can differ."
            }
        }
    }
}

impl fmt::Display for Method {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// A name that no method has.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("there is no method {0:?}; known are {known}", known = Method::ALL.map(Method::name).join(", "))]
pub struct UnknownMethod(pub String);

impl FromStr for Method {
    type Err = UnknownMethod;

    fn from_str(name: &str) -> Result<Self, UnknownMethod> {
        Self::ALL.into_iter().find(|method| method.name() == name).ok_or_else(|| UnknownMethod(name.to_owned()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_unique_and_lead_back() {
        for (i, method) in Method::ALL.into_iter().enumerate() {
            assert_eq!(method as usize, i, "the list has the order of the enumeration");
            assert_eq!(method.name().parse(), Ok(method));
        }
        assert_eq!("z-pass".parse::<Method>(), Err(UnknownMethod("z-pass".to_owned())));
    }
}
