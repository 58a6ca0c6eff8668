//! How a frame is rendered: the caller's choices, apart from scene and view.

use zfail::{Silhouettes, Steps, Technique, Tiles};

/// Choices for one frame.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// The shadow-volume method.
    pub technique: Technique,
    /// When a technique that counts by tiles does so. Pictures of several samples are always rasterised.
    pub tiles: Tiles,
    /// Where a technique that may use the device for it finds silhouettes.
    pub silhouettes: Silhouettes,
    /// Samples per pixel: 1 or 4. Every sample has a shadow verdict of its own.
    pub samples: u32,
    /// Whether anything casts shadows.
    pub shadows: bool,
    /// The lights that shine, as indices into the scene's; `None` for all.
    pub lights: Option<Vec<usize>>,
    /// How radiance becomes brightness.
    pub exposure: Exposure,
    /// How light ends on smooth surfaces.
    pub terminator: Terminator,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            technique: Technique::Auto,
            tiles: Tiles::WhereCheaper,
            silhouettes: Silhouettes::WhereCheaper,
            samples: 1,
            shadows: true,
            lights: None,
            exposure: Exposure::Auto,
            terminator: Terminator::Soft,
        }
    }
}

impl Settings {
    /// These settings without any choice that goes by measured times: on one device, every run gives the same picture to
    /// the bit. Methods between which times decide may differ in pixels whose centre lies on a silhouette, within rounding.
    #[must_use]
    pub fn repeatable(self) -> Self {
        Self { tiles: Tiles::Never, silhouettes: Silhouettes::Cpu, ..self }
    }

    /// The steps that the technique takes under these settings.
    pub(crate) fn steps(&self) -> Steps {
        let steps = self.technique.steps();
        Steps {
            tiles: if steps.tiles == Tiles::Never { Tiles::Never } else { self.tiles },
            silhouettes: if steps.silhouettes == Silhouettes::Cpu { Silhouettes::Cpu } else { self.silhouettes },
            ..steps
        }
    }
}

/// What becomes of light where a smooth surface turns away from it. Shadows are the same to the bit: they belong to the
/// triangles.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Terminator {
    /// Light fades before the first triangle turns away, so that the border of its own shadow, which follows the edges of
    /// triangles, is not seen. Flat-shaded and well-tessellated meshes look the same as with [`Terminator::Exact`].
    #[default]
    Soft,
    /// Every lit point has all the light that its shading normal gives it.
    Exact,
}

/// How scene radiance is scaled before tone mapping.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Exposure {
    /// What suits the scene's lights, [`zfail_scene::Scene::exposure`], or if that is not known, the picture's own
    /// luminance.
    Auto,
    /// By 2 to this power, in stops: 0 keeps radiance as it is, greater is brighter.
    Ev(f32),
}
