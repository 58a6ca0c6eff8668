//! What each light draws this frame.
//!
//! In: the view, placed topologies, lights, technique. Out: one index list for the frame and, per light, batches of
//! draws into it, the scissor rectangle and figures. Scratch memory is kept between frames, and a caster whose light
//! did not move in its object space keeps its silhouette.

mod batches;
mod caps;
mod cull;
mod pair;
mod technique;

pub use technique::{Counting, Technique, UnknownTechnique};

use crate::casting::ObjectLight;
use crate::scene::LightKind;
use crate::scissor::Rectangle;
use crate::topology::Topology;
use crate::view::View;
use crate::volume::Volume;
use glam::{DAffine3, Vec4};
use pair::Pair;
use rayon::prelude::*;
use std::collections::BTreeMap;
use std::ops::Range;

/// A mesh placed in the world that blocks light.
#[derive(Clone, Copy, Debug)]
pub struct Caster<'a> {
    /// Its incidence and positions.
    pub topology: &'a Topology,
    /// Tells meshes apart: the same number always comes with the same topology.
    pub mesh: u64,
    /// Object to world, invertible.
    pub world_from_object: DAffine3,
}

/// A light and the casters it ignores.
#[derive(Clone, Copy, Debug)]
pub struct ShadowLight<'a> {
    /// Placement and reach, world space.
    pub kind: LightKind,
    /// Indices into the frame's casters.
    pub excluded: &'a [usize],
}

/// Everything that a frame's shadows depend on.
#[derive(Clone, Copy, Debug)]
pub struct Frame<'a> {
    /// The camera.
    pub view: &'a View,
    /// What may block light.
    pub casters: &'a [Caster<'a>],
    /// What shines.
    pub lights: &'a [ShadowLight<'a>],
    /// Which algorithm.
    pub technique: Technique,
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
#[derive(Clone, Debug)]
pub struct Draw {
    /// Index into the frame's casters.
    pub caster: u32,
    /// Light in the caster's object space.
    pub light: ObjectLight,
    /// Plane of the dark cap in object space, `dot(xyz, p) = w`; zero where the cap lies at infinity.
    pub cap: Vec4,
    /// Ranges into [`FramePlan::indices`].
    pub volume: Volume,
    /// Whether the caster's transform mirrors, so that outside is clockwise.
    pub mirrored: bool,
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

/// Figures of one light's plan.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct LightStats {
    /// Casters considered.
    pub casters: u32,
    /// Casters left out, by reason.
    pub culled: BTreeMap<&'static str, u32>,
    /// Casters drawn in case 1 (z-pass), 2 (z-fail without light cap) and 3 (z-fail) of McGuire et al., section 7.
    pub cases: [u32; 3],
    /// Triangles submitted.
    pub triangles: Triangles,
    /// Vertex indices submitted.
    pub vertices: u32,
    /// Pixels the light may reach: x, y, width, height; all zero where it reaches none.
    pub scissor: Rectangle,
}

/// Triangles of shadow volumes by part.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Triangles {
    /// Extruded silhouette edges.
    pub sides: u32,
    /// Casting triangles at infinity.
    pub dark_cap: u32,
    /// Casting triangles in place.
    pub light_cap: u32,
}

/// All lights of one frame.
#[derive(Clone, Debug, Default)]
pub struct FramePlan {
    /// Vertex indices as [`crate::volume`] defines them.
    pub indices: Vec<u32>,
    /// Volumes, grouped by light and batch.
    pub draws: Vec<Draw>,
    /// One entry per light of the frame.
    pub lights: Vec<LightPlan>,
}

/// Plans frame after frame, keeping memory and what has not changed.
#[derive(Debug, Default)]
pub struct Planner {
    pairs: Vec<Pair>,
    batching: Vec<batches::Batching>,
    plan: FramePlan,
}

impl Planner {
    /// A planner without any memory of frames.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// The last frame planned.
    #[must_use]
    pub fn last(&self) -> &FramePlan {
        &self.plan
    }

    /// Plans `frame`.
    ///
    /// # Errors
    /// A caster's transform that cannot be inverted, or more indices than 32 bits can count.
    pub fn plan(&mut self, frame: &Frame<'_>) -> Result<&FramePlan, PlanError> {
        let outcome = self.fill(frame);
        if outcome.is_err() {
            // Nothing half-planned may be drawn.
            *self = Self::default();
        }
        outcome.map(|()| &self.plan)
    }

    fn fill(&mut self, frame: &Frame<'_>) -> Result<(), PlanError> {
        self.plan.indices.clear();
        self.plan.draws.clear();
        self.plan.lights.resize_with(frame.lights.len(), LightPlan::default);
        self.batching.resize_with(frame.lights.len(), batches::Batching::default);

        // Which casters each light meets.
        let mut used = 0;
        for (l, light) in frame.lights.iter().enumerate() {
            let plan = &mut self.plan.lights[l];
            plan.batches.clear();
            plan.stats = LightStats::default();
            plan.scissor = cull::light_scissor(frame, light);
            plan.stats.scissor = plan.scissor.unwrap_or_default();
            for (c, caster) in frame.casters.iter().enumerate() {
                plan.stats.casters += 1;
                if let Some(reason) = cull::reason(frame, light, plan.scissor, c) {
                    *plan.stats.culled.entry(reason).or_default() += 1;
                    continue;
                }
                if used == self.pairs.len() {
                    self.pairs.push(Pair::default());
                }
                self.pairs[used].aim(l, c, caster, &light.kind).ok_or(PlanError::Singular { caster: c })?;
                used += 1;
            }
        }
        self.pairs.truncate(used);

        // Facing, then the division into batches, then silhouettes and caps.
        self.pairs.par_iter_mut().for_each(|pair| pair.weigh(frame));
        let lights: Vec<Range<usize>> = ranges(&self.pairs, frame.lights.len());
        for (l, range) in lights.iter().enumerate() {
            self.batching[l].divide(frame, l, &mut self.pairs[range.clone()]);
        }
        self.pairs.par_iter_mut().for_each(|pair| pair.build(frame));

        for (l, range) in lights.into_iter().enumerate() {
            self.plan.append(l, &self.pairs[range], frame)?;
        }
        Ok(())
    }
}

/// The run of pairs that belongs to each light.
fn ranges(pairs: &[Pair], lights: usize) -> Vec<Range<usize>> {
    let mut start = 0;
    (0..lights)
        .map(|l| {
            let end = start + pairs[start..].partition_point(|p| p.light_index <= l);
            let range = start..end;
            start = end;
            range
        })
        .collect()
}

impl FramePlan {
    /// Appends the pieces of one light's pairs, batch by batch.
    fn append(&mut self, light: usize, pairs: &[Pair], frame: &Frame<'_>) -> Result<(), PlanError> {
        let batches = pairs.iter().map(Pair::batches).max().unwrap_or(0);
        for batch in 0..batches {
            let first = self.draws.len() as u32;
            for (pair, piece) in pairs.iter().flat_map(|pair| pair.pieces(batch).map(move |piece| (pair, piece))) {
                let (volume, indices) = (&piece.volume, &piece.indices);
                let base = self.indices.len();
                if base + indices.len() > u32::MAX as usize {
                    return Err(PlanError::TooManyIndices);
                }
                self.indices.extend_from_slice(indices);
                let stats = &mut self.lights[light].stats;
                let [sides, dark_cap, light_cap] = volume.triangles();
                stats.triangles.sides += sides;
                stats.triangles.dark_cap += dark_cap;
                stats.triangles.light_cap += light_cap;
                stats.vertices += indices.len() as u32;
                let caster = &frame.casters[pair.caster];
                self.draws.push(Draw {
                    caster: pair.caster as u32,
                    light: pair.light,
                    cap: piece.cap.map_or(Vec4::ZERO, |u| caps::plane(u, pair.light, frame.view, caster)),
                    volume: volume.shifted(base as u32),
                    mirrored: caster.world_from_object.matrix3.determinant() < 0.0,
                });
            }
            self.lights[light].batches.push(first..self.draws.len() as u32);
        }
        self.lights[light].stats.cases[2] = pairs.iter().filter(|p| p.batches() > 0).count() as u32;
        Ok(())
    }
}
