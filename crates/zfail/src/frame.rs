//! What one frame's shadows depend on.

use crate::error::Error;
use crate::mesh::MeshId;
use glam::{DAffine3, DVec3, Mat4};
use zfail_plan::bounds::Bounds;
use zfail_plan::plan::{Counting, ShadowLight, Steps, Technique};
use zfail_plan::view::View;

/// A mesh placed in the world that blocks light.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Caster {
    /// Which mesh.
    pub mesh: MeshId,
    /// Object to world; invertible, may mirror, shear and scale.
    pub world_from_object: DAffine3,
    /// The host's own matrix for this object, if its depth pass does not take [`View::clip_from_object`].
    ///
    /// Volumes start at the rendered triangles, so the depths of both have to agree to the last bit. That asks of the host
    /// - one matrix per object, this one, applied in its vertex shader as `clip_from_object * vec4<f32>(position, 1.0)`:
    ///   two matrices in turn round differently;
    /// - `@invariant @builtin(position)`, so that no compiler fuses the products otherwise here than there;
    /// - reversed depth, and with the far plane at infinity a third row of zeros but for its last entry, the near plane.
    ///
    /// [`Shadows::prepare`](crate::Shadows::prepare) checks that it shows what the view shows.
    pub clip_from_object: Option<Mat4>,
}

impl Caster {
    /// A mesh at a place, drawn with [`View::clip_from_object`].
    #[must_use]
    pub const fn new(mesh: MeshId, world_from_object: DAffine3) -> Self {
        Self { mesh, world_from_object, clip_from_object: None }
    }

    /// The same, drawn with a matrix of the host's own.
    #[must_use]
    pub const fn drawn_with(self, clip_from_object: Mat4) -> Self {
        Self { clip_from_object: Some(clip_from_object), ..self }
    }

    /// The matrix with which `view` draws it.
    pub(crate) fn clip_from_object(&self, view: &View) -> Mat4 {
        self.clip_from_object.unwrap_or_else(|| view.clip_from_object(&self.world_from_object))
    }

    /// Refuses a matrix of the host's own that does not show, within f32 rounding, what `view` shows of `bounds` (object
    /// space), or that gives depth to what is infinitely far.
    pub(crate) fn check(&self, index: usize, view: &View, bounds: &Bounds) -> Result<(), Error> {
        /// Of the largest coordinate: room for matrices that were multiplied in f32 several times.
        const TOLERANCE: f64 = 1e-3;
        let Some(own) = self.clip_from_object.map(|matrix| matrix.as_dmat4()) else { return Ok(()) };
        let depth = own.row(2).truncate();
        if !view.has_far_plane() && depth != DVec3::ZERO {
            return Err(Error::ClipDepth { caster: index });
        }
        let expected = view.clip_from_object(&self.world_from_object).as_dmat4();
        let shows = bounds.corners().into_iter().all(|corner| {
            let [a, b] = [own, expected].map(|matrix| matrix * corner.extend(1.0));
            (a - b).abs().max_element() <= TOLERANCE * a.abs().max_element().max(b.abs().max_element())
        });
        if shows { Ok(()) } else { Err(Error::ClipMatrix { caster: index }) }
    }
}

/// Everything that one frame's shadows depend on.
///
/// ```
/// # use zfail::{Bounds, Caster, Frame, ShadowLight, Technique, View};
/// # fn frame<'a>(view: &'a View, casters: &'a [Caster], lights: &'a [ShadowLight<'a>], room: &'a [Bounds]) -> Frame<'a> {
/// // Whatever is not said is taken as it is best.
/// Frame::new(view, casters, lights).receivers(room).technique(Technique::Mcguire)
/// # }
/// ```
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub struct Frame<'a> {
    /// The camera.
    pub view: &'a View,
    /// What blocks light.
    pub casters: &'a [Caster],
    /// What shines, in the order in which [`Prepared::draw`](crate::Prepared::draw) counts.
    pub lights: &'a [ShadowLight<'a>],
    /// Boxes in world space that together hold every surface in the depth buffer; empty if they are not known.
    pub receivers: &'a [Bounds],
    /// Which steps to take.
    pub steps: Steps,
    /// What the stencil is to hold.
    pub counting: Counting,
    /// Whether the host encodes [`Prepared::count_tiles`](crate::Prepared::count_tiles).
    pub tile_pass: bool,
}

impl<'a> Frame<'a> {
    /// A frame with every step of [`Technique::Auto`], verdicts in the stencil, and no tile pass.
    #[must_use]
    pub fn new(view: &'a View, casters: &'a [Caster], lights: &'a [ShadowLight<'a>]) -> Self {
        let (steps, counting) = (Steps::default(), Counting::Verdict);
        Self { view, casters, lights, receivers: &[], steps, counting, tile_pass: false }
    }

    /// Boxes in world space that together hold every surface in the depth buffer. They save drawing volumes where there is
    /// nothing to shadow, and the tile pass needs them.
    #[must_use]
    pub const fn receivers(self, receivers: &'a [Bounds]) -> Self {
        Self { receivers, ..self }
    }

    /// The steps of a technique, to compare; verdicts do not depend on it.
    #[must_use]
    pub const fn technique(self, technique: Technique) -> Self {
        self.steps(technique.steps())
    }

    /// Steps one by one, to compare; verdicts do not depend on them.
    #[must_use]
    pub const fn steps(self, steps: Steps) -> Self {
        Self { steps, ..self }
    }

    /// What the stencil is to hold: verdicts unless you look at counts.
    #[must_use]
    pub const fn counting(self, counting: Counting) -> Self {
        Self { counting, ..self }
    }

    /// Whether sides may be counted in a compute pass where that is cheaper: then the host encodes
    /// [`Prepared::count_tiles`](crate::Prepared::count_tiles), and draws to targets with one sample.
    #[must_use]
    pub const fn tile_pass(self, tile_pass: bool) -> Self {
        Self { tile_pass, ..self }
    }
}
