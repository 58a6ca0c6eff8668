//! Which draws of a prepared frame the tile pass counts instead of the rasteriser.
//!
//! In: the plan, and what a device's times are. Out: the tile pass filled, and for every light and draw which way it goes.
//! Only draws that consist of sides before the visible surface can go there: z-pass without caps. Lights in several batches
//! stay with the rasteriser: their volumes end within others, so that errors of rounding could cancel in one sum, which
//! folding each batch by itself prevents (decision record 0021).

use crate::arena::Arena;
use crate::cost::CostModel;
use crate::error::Error;
use crate::frame::{Caster, Frame};
use crate::tiles::{Sides, TilePass, TileStats};
use wgpu::{Device, Queue};
use zfail_plan::bounds::Bounds;
use zfail_plan::plan::{Counting, Draw, FramePlan, Steps, Tiles};
use zfail_plan::view::{Projection, View};

/// What the draws of a frame refer to.
#[derive(Clone, Debug)]
pub(crate) struct Staged {
    pub view: View,
    pub casters: Vec<Caster>,
    pub steps: Steps,
    pub counting: Counting,
    /// Bounds of all visible surfaces; empty if they are not known.
    pub visible: Bounds,
    pub tile_pass: bool,
    /// [`Arena::layout`].
    pub arena: u64,
    pub costs: CostModel,
}

impl Staged {
    /// `frame`, its casters in memory that is kept.
    pub fn new(frame: &Frame<'_>, casters: Vec<Caster>, arena: u64, costs: CostModel) -> Self {
        let mut visible = Bounds::EMPTY;
        for receivers in frame.receivers.iter().filter(|bounds| !bounds.is_empty()) {
            visible.add(receivers.min);
            visible.add(receivers.max);
        }
        let Frame { steps, counting, tile_pass, .. } = *frame;
        Self { view: *frame.view, casters, steps, counting, visible, tile_pass, arena, costs }
    }

    /// Whether `frame` is this one, as far as the planner does not know.
    pub fn is(&self, frame: &Frame<'_>) -> bool {
        self.tile_pass == frame.tile_pass && self.casters == frame.casters
    }
}

/// The tile pass and who takes part in it.
#[derive(Debug)]
pub(crate) struct Tiled {
    pub pass: TilePass,
    /// By light of the plan.
    pub lights: Vec<Option<TiledLight>>,
}

/// One light that the tile pass counts.
#[derive(Clone, Copy, Debug)]
pub(crate) struct TiledLight {
    /// Its number in the tile pass.
    pub index: usize,
    pub stats: TileStats,
}

/// Whether `draw` consists of nothing but sides in front of the visible surface.
pub(crate) fn can_tile(draw: &Draw) -> bool {
    let volume = &draw.volume;
    draw.extraction.is_none()
        && draw.z_pass
        && volume.dark_cap.is_empty()
        && volume.light_cap.is_empty()
        && volume.light_cap_reversed.is_empty()
}

impl Tiled {
    pub fn new(device: &Device) -> Self {
        Self { pass: TilePass::new(device), lights: Vec::new() }
    }

    /// Chooses and uploads; returns whether any light takes part.
    pub fn choose(
        &mut self,
        device: &Device,
        queue: &Queue,
        staged: &Staged,
        plan: &FramePlan,
        arena: &Arena,
        costs: CostModel,
    ) -> Result<bool, Error> {
        self.lights.clear();
        self.lights.resize(plan.lights.len(), None);
        let steps = staged.steps;
        if steps.tiles == Tiles::Never
            || staged.counting == Counting::Raw
            || staged.visible.is_empty()
            || !matches!(staged.view.projection, Projection::Perspective { .. })
        {
            return Ok(false);
        }
        self.pass.begin(&staged.view, &staged.visible);
        let mut next = 0;
        for (slot, light) in self.lights.iter_mut().zip(&plan.lights) {
            let draws = || {
                let all = light.batches.iter().flat_map(|batch| &plan.draws[batch.start as usize..batch.end as usize]);
                all.filter(|draw| can_tile(draw))
            };
            let always = steps.tiles == Tiles::Always;
            let pixels = light.scissor.map_or(0, |[_, _, width, height]| width * height);
            if light.batches.len() > 1
                || draws().next().is_none()
                || !always && !costs.may_tile(draws().map(most_pairs).sum(), pixels)
            {
                continue;
            }
            let rasterised: u32 = light
                .batches
                .iter()
                .flat_map(|batch| &plan.draws[batch.start as usize..batch.end as usize])
                .filter(|draw| !can_tile(draw))
                .map(|draw| draw.near_layers)
                .sum();
            let base = light.stats.near_count - rasterised;
            let sides = draws().filter_map(|draw| sides(draw, staged, plan, arena));
            let worth = |pairs: usize| always || costs.may_tile(pairs as f64, pixels);
            if let Some(stats) = self.pass.add(device, base.cast_signed(), sides, worth) {
                *slot = Some(TiledLight { index: next, stats });
                next += 1;
            }
        }
        if next > 0 {
            self.pass.upload(device, queue)?;
        }
        Ok(next > 0)
    }
}

/// More pairs of a side and a tile than a draw can have, if its sides are thin.
fn most_pairs(draw: &Draw) -> f64 {
    let [_, _, width, height] = draw.scissor.map(f64::from);
    f64::from(draw.volume.triangles()[0]) * (width + height) / 8.0
}

fn sides<'a>(draw: &Draw, staged: &Staged, plan: &'a FramePlan, arena: &'a Arena) -> Option<Sides<'a>> {
    let caster = staged.casters.get(draw.caster as usize)?;
    let mesh = arena.get(caster.mesh.slot, caster.mesh.serial)?;
    Some(Sides {
        positions: mesh.topology.positions(),
        clip_from_object: caster.clip_from_object(&staged.view),
        world_from_object: caster.world_from_object,
        light: draw.light,
        indices: &plan.indices[draw.volume.sides.start as usize..draw.volume.sides.end as usize],
        converging: draw.light.w == 0.0,
        mirrored: draw.mirrored,
        scissor: draw.scissor,
    })
}
