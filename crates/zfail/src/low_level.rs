//! What shadow determination is made of, for figures, comparisons and tests: the plan of a frame, to be looked at and changed,
//! and the passes by themselves. Nothing here is needed to draw shadows, and all of it may change with any release.

use crate::mesh::MeshId;
use crate::pipelines::{Pipelines, Target};
use crate::prepared::Prepared;
use crate::shadows::Shadows;
use zfail_plan::topology::Topology;

pub use crate::tiles::{Sides, TilePass, TileStats, VerdictPipeline};
pub use zfail_plan::plan::FramePlan;

/// What the prepared frame draws.
#[must_use]
pub fn plan<'a>(prepared: &Prepared<'a>) -> &'a FramePlan {
    prepared.shadows.planner.last()
}

/// Bytes that preparing the frame wrote to the device: index lists that changed, and records of draws. What the tile pass and
/// silhouettes on the device need comes on top.
#[must_use]
pub fn uploaded_bytes(prepared: &Prepared<'_>) -> u64 {
    prepared.shadows.buffers.uploaded
}

/// Changes what the prepared frame draws: for figures of what goes wrong without a step, and for tests that see whether anyone
/// would notice. Ranges of indices, scissors, z-pass and clear values may be changed, and draws emptied; indices, lights and
/// transforms are on the device already, and so are the lists of the tile pass.
pub fn edit_plan(shadows: &mut Shadows, edit: impl FnOnce(&mut FramePlan)) {
    edit(shadows.planner.last_mut());
}

/// Pipelines for [`Prepared::draw`] that leave the stencil as it is and add 1 to the first colour attachment, of a format that
/// can be blended, for every fragment of a volume, whether it passes the depth test or not: what the volumes cost in fill.
/// What the tile pass would count is rasterised too.
#[must_use]
pub fn fragment_counters(shadows: &Shadows, target: &Target<'_>) -> Pipelines {
    Pipelines::counting_fragments(&shadows.device, &shadows.layout, &shadows.module, target)
}

/// The topology of a registered mesh.
#[must_use]
pub fn topology(shadows: &Shadows, mesh: MeshId) -> Option<&Topology> {
    shadows.arena.get(mesh.slot, mesh.serial).map(|mesh| &mesh.topology)
}

/// Figures of the tile pass for one light of the prepared frame, if it takes part.
#[must_use]
pub fn tile_stats(prepared: &Prepared<'_>, light: usize) -> Option<TileStats> {
    prepared.shadows.tiled_light(light).map(|tiled| tiled.stats)
}
