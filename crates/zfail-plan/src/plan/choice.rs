//! Which casters of a light draw what, and where, as far as boxes tell (McGuire et al. 2003, section 6, lines 5 to 13, and more).
//!
//! In: a light, the placed casters, and the view. Out: a role for every pair, and why others have none.

use super::near_count::NearCount;
use super::occluders::Occlusion;
use super::off_screen::{self, Parts};
use super::pair::{Pair, Role};
use super::reach::Reach;
use super::receivers::Receivers;
use super::stage::Stage;
use super::z_pass;
use super::{Culled, LightPlan, PlanError, ZPass};
use crate::scissor::{self, Rectangle};
use glam::DVec4;

/// Memory for choosing.
#[derive(Debug, Default)]
pub(super) struct Choice {
    reach: Reach,
    receivers: Receivers,
    occlusion: Occlusion,
}

impl Choice {
    /// Takes what is the same for all lights of a frame.
    pub fn begin(&mut self, stage: &Stage<'_>) {
        if self.bounds_receivers(stage) {
            self.receivers.fit(stage.input.receivers);
        }
    }

    /// Gives the pairs of light `l` their roles.
    pub fn choose(
        &mut self,
        stage: &Stage<'_>,
        l: usize,
        pairs: &mut [Pair],
        plan: &mut LightPlan,
    ) -> Result<(), PlanError> {
        let view = stage.view();
        if stage.steps.reach {
            self.reach.set(stage.light(l), view.eye());
        } else {
            self.reach.clear();
        }
        plan.begin(self.reach.scissor(view));
        if self.bounds_receivers(stage) {
            self.receivers.set(view, &self.reach);
        }
        let relative = stage.relative_light(l);
        for (c, pair) in pairs.iter_mut().enumerate() {
            pair.start = NearCount::default();
            pair.role = match self.pixels(stage, l, c, relative, plan.scissor) {
                Ok(within) => {
                    let caster = &stage.placed[c];
                    let singular = PlanError::Singular { caster: caster.caster as usize };
                    pair.aim(caster, &stage.light(l).kind).ok_or(singular)?;
                    role(stage, c, pair, within)
                }
                Err(reason) => Role::Culled(reason),
            };
        }
        if stage.steps.z_pass == ZPass::ByLight {
            z_pass::all_or_none(pairs);
        }
        self.occlusion.leave_out(stage, relative, pairs);
        Ok(())
    }

    fn bounds_receivers(&self, stage: &Stage<'_>) -> bool {
        stage.steps.receivers && !stage.input.receivers.is_empty()
    }

    /// The pixels in which caster `c` may matter, or why there are none.
    fn pixels(
        &mut self,
        stage: &Stage<'_>,
        l: usize,
        c: usize,
        relative: DVec4,
        scissor: Option<Rectangle>,
    ) -> Result<Rectangle, Culled> {
        let caster = &stage.placed[c];
        if stage.light(l).excluded.contains(&(caster.caster as usize)) {
            return Err(Culled::Excluded);
        }
        if caster.bounds.is_empty() {
            return Err(Culled::Empty);
        }
        let within = scissor.ok_or(Culled::LightOffScreen)?;
        if stage.steps.reach && self.reach.excludes(&caster.world, caster.center, caster.axes) {
            return Err(Culled::OutOfReach);
        }
        if !self.bounds_receivers(stage) {
            return Ok(within);
        }
        let shadowed = self.receivers.shadowed(stage.view(), &caster.corners, relative);
        shadowed.and_then(|pixels| scissor::intersection(within, pixels)).ok_or(Culled::NoReceiver)
    }
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
