//! Which casters of a light draw what, and where, as far as boxes tell (McGuire et al. 2003, section 6, lines 5 to 13, and more).
//!
//! In: a light, the placed casters, and the view. Out: a role for every pair, and why others have none.

use super::near_count::NearCount;
use super::occluders::Occlusion;
use super::off_screen::{self, Parts};
use super::pair::{Pair, Role};
use super::reach::Reach;
use super::receivers::{Looking, Receivers};
use super::stage::Stage;
use super::z_pass;
use super::{Culled, LightPlan, PlanError, ZPass};
use crate::parallel;
use crate::scissor::{self, Rectangle};
use glam::DVec4;

/// Memory for choosing.
#[derive(Debug, Default)]
pub(super) struct Choice {
    reach: Reach,
    receivers: Receivers,
    occlusion: Occlusion,
    threads: Vec<Thread>,
}

/// Memory of one thread.
#[derive(Debug, Default)]
struct Thread {
    looking: Looking,
    /// The caster with a transform that cannot be inverted.
    singular: Option<u32>,
}

impl Choice {
    /// Takes what is the same for all lights of a frame.
    pub fn begin(&mut self, stage: &Stage<'_>) {
        if bounds_receivers(stage) {
            self.receivers.fit(stage.input.receivers, stage.placed.len());
        }
        self.threads.resize_with(parallel::pieces(stage.placed.len()), Thread::default);
    }

    /// Gives the pairs of light `l` their roles.
    pub fn choose(
        &mut self,
        stage: &Stage<'_>,
        l: usize,
        pairs: &mut [Pair],
        plan: &mut LightPlan,
    ) -> Result<(), PlanError> {
        let Self { reach, receivers, occlusion, threads } = self;
        let view = stage.view();
        if stage.steps.reach {
            reach.set(stage.light(l), view.eye());
        } else {
            reach.clear();
        }
        plan.begin(reach.scissor(view));
        if bounds_receivers(stage) {
            receivers.set(view, reach);
        }
        let relative = stage.relative_light(l);
        threads.iter_mut().for_each(|thread| thread.singular = None);
        parallel::for_each_piece_with(pairs, threads, |first, pairs, thread| {
            for (c, pair) in (first..).zip(pairs) {
                pair.start = NearCount::default();
                let within = within(stage, l, c, relative, plan.scissor, reach, receivers, &mut thread.looking);
                let caster = &stage.placed[c];
                pair.role = match within {
                    Ok(_) if pair.aim(caster, &stage.light(l).kind).is_none() => {
                        thread.singular = thread.singular.or(Some(caster.caster));
                        Role::default()
                    }
                    Ok(within) => role(stage, c, pair, within),
                    Err(reason) => Role::Culled(reason),
                };
            }
        });
        if let Some(caster) = threads.iter().find_map(|thread| thread.singular) {
            return Err(PlanError::Singular { caster: caster as usize });
        }
        if stage.steps.z_pass == ZPass::ByLight {
            z_pass::all_or_none(pairs);
        }
        occlusion.leave_out(stage, relative, pairs);
        Ok(())
    }

    /// The same for a light under which nothing has changed since the last frame.
    pub fn keep(pairs: &mut [Pair], plan: &mut LightPlan) {
        plan.begin(plan.scissor);
        pairs.iter_mut().for_each(|pair| pair.moves = 0);
    }
}

fn bounds_receivers(stage: &Stage<'_>) -> bool {
    stage.steps.receivers && !stage.input.receivers.is_empty()
}

/// The pixels in which caster `c` may matter, or why there are none.
#[expect(clippy::too_many_arguments, reason = "what it depends on")]
fn within(
    stage: &Stage<'_>,
    l: usize,
    c: usize,
    relative: DVec4,
    scissor: Option<Rectangle>,
    reach: &Reach,
    receivers: &Receivers,
    looking: &mut Looking,
) -> Result<Rectangle, Culled> {
    let caster = &stage.placed[c];
    if stage.light(l).excluded.contains(&(caster.caster as usize)) {
        return Err(Culled::Excluded);
    }
    if caster.bounds.is_empty() {
        return Err(Culled::Empty);
    }
    let within = scissor.ok_or(Culled::LightOffScreen)?;
    if stage.steps.reach && reach.excludes(&caster.world, caster.center, caster.axes) {
        return Err(Culled::OutOfReach);
    }
    if !bounds_receivers(stage) {
        return Ok(within);
    }
    let shadowed = receivers.shadowed(looking, stage.view(), &caster.corners, relative);
    shadowed.and_then(|pixels| scissor::intersection(within, pixels)).ok_or(Culled::NoReceiver)
}

/// What a caster that matters in pixels `within` draws; nothing if no part of its volume comes into view.
fn role(stage: &Stage<'_>, c: usize, pair: &Pair, within: Rectangle) -> Role {
    let caster = &stage.placed[c];
    let parts = if stage.steps.off_screen {
        off_screen::visible_parts(stage.view(), within, &caster.world_from_object, &caster.bounds, pair.light)
    } else {
        Parts::ALL
    };
    // A volume of which nothing is in view still darkens the whole image where the near rectangle is inside, but then its
    // dark cap or its sides come into view.
    if parts == Parts::default() {
        return Role::Culled(Culled::OffScreen);
    }
    let z_pass = stage.steps.z_pass != ZPass::Never && z_pass::is_clear(stage, c, pair, within);
    Role::Active { within, parts, z_pass }
}
