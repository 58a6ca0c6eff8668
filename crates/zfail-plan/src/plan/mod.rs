//! What each light draws this frame.
//!
//! In: the view, placed topologies, lights, and the steps to take. Out: index lists and, per light, batches of draws
//! into them, the scissor rectangle and figures. Nothing that stays as it was is computed again: a caster whose light did
//! not move in its object space keeps its silhouette, its caps and their place in the index array.
//!
//! One light's casters pass these stages, which are McGuire et al. 2003, section 6, and more: [`reach`](self) of the
//! light, parts off screen, receivers, occluders, extraction by the device, facing, batches, z-pass or z-fail, caps.

mod ball;
mod batches;
mod caps;
mod choice;
mod draws;
mod extraction;
mod kept;
mod meridians;
mod near_count;
mod occluders;
mod off_screen;
mod pair;
mod pieces;
mod placed;
mod pyramid;
mod reach;
mod receivers;
mod sheets;
mod spread;
mod stage;
mod stages;
mod stats;
mod store;
mod technique;
mod unchanged;
mod weights;
mod z_pass;

pub use extraction::{DarkCap, Extraction, LightCap};
pub use stats::{Culled, LightStats, Sections, Triangles};
pub use technique::{Counting, Silhouettes, Steps, Technique, Tiles, UnknownTechnique, ZPass};

use crate::bounds::{Bounds, OrientedBox};
use crate::casting::{Casting, ObjectLight};
use crate::light::LightKind;
use crate::scissor::Rectangle;
use crate::topology::Topology;
use crate::view::View;
use crate::volume::Volume;
use glam::{DAffine3, DVec3, DVec4};
use std::ops::Range;

pub use stages::Planner;

/// A mesh placed in the world that blocks light.
#[derive(Clone, Copy, Debug)]
pub struct Caster<'a> {
    /// Its incidence and positions.
    pub topology: &'a Topology,
    /// Tells meshes apart: the same number always comes with the same topology in the same place.
    pub mesh: u64,
    /// Object to world, invertible.
    pub world_from_object: DAffine3,
}

/// A light, what bounds it, and the casters it ignores.
///
/// ```
/// use zfail_plan::bounds::OrientedBox;
/// use zfail_plan::glam::DVec3;
/// use zfail_plan::light::LightKind;
/// use zfail_plan::plan::ShadowLight;
///
/// let position = DVec3::new(0.0, 2.0, 0.0);
/// let room = OrientedBox { center: position, half_axes: [DVec3::X * 3.0, DVec3::Y * 2.0, DVec3::Z * 4.0] };
/// // A lamp that lights one room, and lets the torch that holds it (caster 0) be.
/// let lamp = ShadowLight::new(LightKind::Point { position, range: f64::INFINITY }).within(room).excluding(&[0]);
/// assert_eq!(lamp.bounds, Some(room));
/// ```
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub struct ShadowLight<'a> {
    /// Placement and reach, world space.
    pub kind: LightKind,
    /// Beyond which the light lights nothing, world space (McGuire et al. 2003, section 4, `Light.bounds`).
    pub bounds: Option<OrientedBox>,
    /// Indices into the frame's casters.
    pub excluded: &'a [usize],
}

impl<'a> ShadowLight<'a> {
    /// A light that all casters block, and that only its kind bounds.
    #[must_use]
    pub const fn new(kind: LightKind) -> Self {
        Self { kind, bounds: None, excluded: &[] }
    }

    /// One that lights nothing beyond a box, world space: wherever it is, and whatever its kind. Casters and pixels beyond it
    /// are left out, and what the host draws has to be dark there.
    #[must_use]
    pub fn within(self, bounds: impl Into<Option<OrientedBox>>) -> Self {
        Self { bounds: bounds.into(), ..self }
    }

    /// One that ignores casters, by their indices in the frame.
    #[must_use]
    pub const fn excluding(self, excluded: &'a [usize]) -> Self {
        Self { excluded, ..self }
    }
}

/// Everything that a frame's shadows depend on.
#[derive(Clone, Copy, Debug)]
pub struct Input<'a> {
    /// The camera.
    pub view: &'a View,
    /// What may block light.
    pub casters: &'a [Caster<'a>],
    /// What shines.
    pub lights: &'a [ShadowLight<'a>],
    /// Boxes in world space that together hold every surface in the depth buffer; empty where that is not known.
    pub receivers: &'a [Bounds],
    /// Which steps to take; [`Technique`]s are made of them.
    pub steps: Steps,
    /// What the stencil is to hold afterwards.
    pub counting: Counting,
}

/// Why a frame cannot be planned.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum PlanError {
    /// The light cannot be brought into the caster's object space.
    #[error("the transform of caster {caster} is singular or not finite; bake its vertices into world space instead")]
    Singular {
        /// Which caster.
        caster: usize,
    },
    /// The frame's index lists exceed 2^32 entries.
    #[error("the shadow volumes of this frame have more than 2^32 indices; cast from fewer or simpler meshes")]
    TooManyIndices,
}

/// One caster's volume, or a closed piece of it, for one light.
#[derive(Clone, Debug, PartialEq)]
pub struct Draw {
    /// Index into the frame's casters.
    pub caster: u32,
    /// Light in the caster's object space.
    pub light: ObjectLight,
    /// To what distance from a point light, or along the rays of a directional one, vertices are extruded, object space; 0
    /// for infinity.
    pub reach: f32,
    /// Whether fragments count that pass the depth test instead of those that fail it.
    pub z_pass: bool,
    /// Layers of the volume over the near rectangle, from which z-pass has to start; part of [`LightStats::near_count`].
    pub near_layers: u32,
    /// Pixels in which the volume is to be drawn.
    pub scissor: Rectangle,
    /// Ranges into [`FramePlan::indices`].
    pub volume: Volume,
    /// What the device makes of the caster instead, if `volume` is empty because the device finds its silhouette.
    pub extraction: Option<Extraction>,
    /// Whether the caster's transform mirrors, so that outside is clockwise.
    pub mirrored: bool,
}

impl Draw {
    /// Where the vertex at `p`, object space, is extruded to: as the vertex shader does it, without its rounding.
    #[must_use]
    pub fn extruded(&self, p: DVec3) -> DVec4 {
        let light = self.light.as_dvec4();
        let away = p * light.w - light.truncate();
        match f64::from(self.reach) {
            0.0 => away.extend(0.0),
            reach if light.w == 0.0 => (p + away * reach).extend(1.0),
            reach => (light.truncate() * away.length() + away * reach).extend(away.length()),
        }
    }
}

/// What one light draws.
#[derive(Clone, Debug, Default)]
pub struct LightPlan {
    /// Ranges into [`FramePlan::draws`]. With more than one, each is folded into a sticky stencil bit before the next,
    /// because their counts together might wrap around 8 bits.
    pub batches: Vec<Range<u32>>,
    /// Pixels the light may reach; `None` where it reaches none.
    pub scissor: Option<Rectangle>,
    /// Figures for reports.
    pub stats: LightStats,
}

/// All lights of one frame.
#[derive(Clone, Debug, Default)]
pub struct FramePlan {
    /// Vertex indices as [`crate::volume`] defines them, in no particular order, with gaps.
    pub indices: Vec<u32>,
    /// From which side parts cast, for [`Extraction`]s.
    pub castings: Vec<Casting>,
    /// Volumes, grouped by light and batch.
    pub draws: Vec<Draw>,
    /// One entry per light of the frame.
    pub lights: Vec<LightPlan>,
    /// Ranges of `indices` that differ from those of the planner's frame before; everything else is as it was.
    pub changed: Vec<Range<u32>>,
    /// Whether all of it is the plan of the frame before, because nothing has moved.
    pub unchanged: bool,
}
