//! What each triangle adds to the stencil count when a light ray crosses it.
//!
//! In: the weights that the volumes under test were built with. Out: a table that [`crate::Oracle::judge`] reads. It
//! influences counts only; the lit verdict always comes from plain two-sided casting.

use zfail_plan::casting::Casting;
use zfail_scene::Scene;

/// A triangle's casting policy (`c_t` as a function of the facing sign).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Cast {
    /// Adds nothing.
    None,
    /// Adds 1 where its front faces the light.
    Front,
    /// Adds 1 where its back faces the light.
    Back,
    /// Adds 1 from both sides.
    #[default]
    Double,
}

impl From<Option<Casting>> for Cast {
    fn from(casting: Option<Casting>) -> Self {
        match casting {
            None => Self::None,
            Some(Casting::Front) => Self::Front,
            Some(Casting::Back) => Self::Back,
            Some(Casting::Double) => Self::Double,
        }
    }
}

impl Cast {
    /// What one crossing adds, given whether the front faces the light.
    #[must_use]
    pub const fn weight(self, faces_light: bool) -> i32 {
        match self {
            Self::None => 0,
            Self::Front => faces_light as i32,
            Self::Back => !faces_light as i32,
            Self::Double => 1,
        }
    }
}

/// One [`Cast`] per triangle of every instance, for one light. Triangles that cast no shadow at all (blended
/// materials, excluded instances) add nothing, whatever the table says.
#[derive(Clone, Debug)]
pub struct CastTable {
    casts: Vec<Vec<Cast>>,
}

impl CastTable {
    /// Every triangle casts from both sides.
    #[must_use]
    pub fn double(scene: &Scene) -> Self {
        Self::from_fn(scene, |_, _| Cast::Double)
    }

    /// Asks `cast(instance, triangle of its mesh)` for every triangle; sides are those of the surface in world space,
    /// so that a mirrored solid still has its fronts outside.
    pub fn from_fn(scene: &Scene, mut cast: impl FnMut(usize, usize) -> Cast) -> Self {
        let count = |mesh: usize| scene.meshes.get(mesh).map_or(0, |m| m.triangles.len());
        let casts = scene.instances.iter().enumerate();
        Self { casts: casts.map(|(i, instance)| (0..count(instance.mesh)).map(|t| cast(i, t)).collect()).collect() }
    }

    /// The policy of one triangle; [`Cast::None`] for one the table does not know.
    #[must_use]
    pub fn get(&self, instance: usize, triangle: usize) -> Cast {
        self.casts.get(instance).and_then(|i| i.get(triangle)).copied().unwrap_or(Cast::None)
    }
}
