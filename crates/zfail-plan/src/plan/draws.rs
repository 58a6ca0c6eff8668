//! The draws of a light, batch by batch, z-pass before z-fail.
//!
//! In: pairs with their roles and volumes. Out: draws, with the index lists that changed put into the store.

use super::caps;
use super::extraction;
use super::pair::{Pair, Role};
use super::stage::Stage;
use super::store::Store;
use super::{Draw, FramePlan, LightStats, PlanError};
use crate::volume::{self, Volume};

/// Appends the draws of light `l`.
pub(super) fn append(
    stage: &Stage<'_>,
    l: usize,
    pairs: &mut [Pair],
    store: &mut Store,
    plan: &mut FramePlan,
) -> Result<(), PlanError> {
    plan.lights[l].stats.tell(stage, pairs);
    let batches = pairs.iter().map(Pair::batches).max().unwrap_or(0);
    for batch in 0..batches {
        let first = plan.draws.len() as u32;
        for pass in [true, false] {
            for (c, pair) in pairs.iter_mut().enumerate() {
                match pair.role {
                    Role::Active { z_pass, .. } if z_pass == pass && pair.on_device => {
                        extracted(stage, l, c, pair, plan);
                    }
                    Role::Active { z_pass, .. } if z_pass == pass => planned(stage, l, c, pair, batch, store, plan)?,
                    _ => {}
                }
            }
        }
        plan.lights[l].batches.push(first..plan.draws.len() as u32);
    }
    Ok(())
}

/// A draw of caster `c` without anything to draw yet.
fn empty(stage: &Stage<'_>, c: usize, pair: &Pair) -> Draw {
    let (within, z_pass) = match pair.role {
        Role::Active { within, z_pass, .. } => (within, z_pass),
        Role::Culled(_) => ([0; 4], false),
    };
    Draw {
        caster: stage.placed[c].caster,
        light: pair.light,
        reach: 0.0,
        z_pass,
        near_layers: 0,
        scissor: within,
        volume: Volume::default(),
        extraction: None,
        mirrored: stage.placed[c].mirrored,
    }
}

/// Appends what the device finds.
fn extracted(stage: &Stage<'_>, l: usize, c: usize, pair: &Pair, plan: &mut FramePlan) {
    let fan = extraction::may_fan(stage.steps, &stage.placed[c], pair.light);
    let extraction = Some(pair.extraction(l as u32, fan, &mut plan.castings));
    plan.lights[l].stats.extracted += 1;
    plan.draws.push(Draw { extraction, ..empty(stage, c, pair) });
}

/// Appends the pieces of one batch.
fn planned(
    stage: &Stage<'_>,
    l: usize,
    c: usize,
    pair: &mut Pair,
    batch: usize,
    store: &mut Store,
    plan: &mut FramePlan,
) -> Result<(), PlanError> {
    let caster = &stage.placed[c];
    let to_object = caster.object_from_relative();
    let offset = volume::near(caster.first_vertex);
    let reach = caps::reach(&caster.bounds, pair.nearest(), pair.light, stage.view(), &to_object);
    for p in 0..pair.pieces().len() {
        let piece = &pair.pieces()[p];
        let drawn = pair.drawn(piece);
        if usize::from(piece.batch) != batch || drawn.triangles() == [0; 3] {
            continue;
        }
        let near_layers = if p == 0 { pair.start.layers } else { 0 };
        let mut draw = Draw { reach, near_layers, ..empty(stage, c, pair) };
        let piece = pair.pieces.value_mut().piece_mut(p);
        let base = store
            .put(&mut piece.place, &piece.indices, offset, piece.fresh, &mut plan.indices, &mut plan.changed)
            .ok_or(PlanError::TooManyIndices)?;
        piece.fresh = false;
        plan.lights[l].stats.add(drawn.triangles());
        draw.volume = drawn.shifted(base);
        plan.draws.push(draw);
    }
    Ok(())
}

impl LightStats {
    /// Counts casters by what became of them: one whose sections differ by that of them which came farthest.
    fn tell(&mut self, stage: &Stage<'_>, pairs: &[Pair]) {
        let mut c = 0;
        while let Some(placed) = stage.placed.get(c) {
            let sections = stage.placed[c..].iter().take_while(|other| other.caster == placed.caster).count();
            let (mut case, mut culled) = (None, None);
            for pair in &pairs[c..c + sections] {
                match pair.role {
                    Role::Culled(reason) => culled = culled.max(Some(reason)),
                    Role::Active { parts, z_pass, .. } if pair.batches() > 0 => {
                        let drawn = if z_pass { 0 } else { 1 + usize::from(parts.light_cap) };
                        case = case.max(Some(drawn));
                        self.sections.cases[drawn] += 1;
                    }
                    Role::Active { .. } => {}
                }
            }
            self.casters += 1;
            self.sections.considered += sections as u32;
            match (case, culled) {
                (Some(case), _) => self.cases[case] += 1,
                (None, Some(reason)) => self.culled[reason as usize] += 1,
                (None, None) => {}
            }
            c += sections;
        }
    }

    fn add(&mut self, [sides, dark_cap, light_cap]: [u32; 3]) {
        self.triangles.sides += sides;
        self.triangles.dark_cap += dark_cap;
        self.triangles.light_cap += light_cap;
        self.vertices += 3 * (sides + dark_cap + light_cap);
    }
}
