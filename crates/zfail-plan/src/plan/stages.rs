//! The stages of planning, in order.
//!
//! In: a frame. Out: the plan. Scratch memory is kept, so that a frame allocates nothing once its like has been planned.

use super::batches::Batching;
use super::choice::Choice;
use super::draws;
use super::extraction;
use super::pair::Pair;
use super::placed::Placed;
use super::stage::Stage;
use super::store::Store;
use super::unchanged::Unchanged;
use super::z_pass;
use super::{Counting, FramePlan, Input, LightPlan, LightStats, PlanError, Silhouettes};
use crate::parallel;
use crate::scissor::{self, Rectangle};
use crate::topology::Topology;

/// Plans frame after frame, keeping memory and what has not changed.
#[derive(Debug, Default)]
pub struct Planner {
    lights: Vec<Light>,
    store: Store,
    plan: FramePlan,
    placed: Vec<Placed>,
    choice: Choice,
    unchanged: Unchanged,
}

/// What is known of one light between frames.
#[derive(Debug, Default)]
struct Light {
    /// By caster.
    pairs: Vec<Pair>,
    batching: Batching,
    /// The most layers of pairs on the device, if there are such pairs.
    layers: Option<usize>,
    /// Whether everything is as in the frame before, so that what was chosen stays.
    unchanged: bool,
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

    /// The last frame planned, to be changed before it is drawn. The next frame is planned as if it had not been.
    pub fn last_mut(&mut self) -> &mut FramePlan {
        self.unchanged.forget();
        &mut self.plan
    }

    /// Plans a frame.
    ///
    /// # Errors
    /// A caster's transform that cannot be inverted, or more indices than 32 bits can count.
    pub fn plan(&mut self, input: &Input<'_>) -> Result<&FramePlan, PlanError> {
        self.plan_extracting(input, &[])
    }

    /// Plans a frame for a device that can find the silhouettes of those casters that are `extractable`, of meshes without
    /// coincident triangles; the rest of the slice may be missing. [`super::Steps::silhouettes`] says whether it is asked to.
    ///
    /// # Errors
    /// As [`Self::plan`].
    pub fn plan_extracting(&mut self, input: &Input<'_>, extractable: &[bool]) -> Result<&FramePlan, PlanError> {
        let alike = self.unchanged.is_but_for_lights(input, extractable);
        for (l, light) in self.lights.iter_mut().enumerate() {
            light.unchanged = alike && self.unchanged.has_light(input, l);
        }
        if alike && self.lights.iter().all(|light| light.unchanged) {
            self.rest();
            return Ok(&self.plan);
        }
        self.plan.unchanged = false;
        let outcome = self.fill(input, extractable);
        match &outcome {
            // What the device finds is the planner's again once it stands still.
            Ok(()) if self.lights.iter().all(|light| light.layers.is_none()) => self.unchanged.keep(input, extractable),
            Ok(()) => self.unchanged.forget(),
            // Nothing half-planned may be drawn.
            Err(_) => *self = Self::default(),
        }
        outcome.map(|()| &self.plan)
    }

    /// The frame before is this frame, too.
    fn rest(&mut self) {
        if !self.plan.unchanged {
            self.plan.unchanged = true;
            self.plan.changed.clear();
            self.plan.lights.iter_mut().for_each(|light| light.stats.searched = 0);
            self.lights.iter_mut().flat_map(|light| &mut light.pairs).for_each(|pair| pair.moves = 0);
        }
    }

    fn fill(&mut self, input: &Input<'_>, extractable: &[bool]) -> Result<(), PlanError> {
        let steps = match input.counting {
            Counting::Verdict => input.steps,
            Counting::Raw => input.steps.keeping_counts(),
        };
        let mut placed = std::mem::take(&mut self.placed);
        placed.clear();
        for (c, caster) in input.casters.iter().enumerate() {
            // The device finds silhouettes of whole meshes.
            let left = steps.silhouettes == Silhouettes::Gpu && extractable.get(c).is_some_and(|&can| can);
            placed.extend(Placed::all(c, caster, input.view, steps.by_section && !left));
        }
        self.fit(placed.len(), input.lights.len());
        let outcome = self.stages(&Stage { input, steps, placed: &placed }, extractable);
        self.placed = placed;
        outcome
    }

    /// Makes room for pairs, and forgets all of them if there are others now.
    fn fit(&mut self, casters: usize, lights: usize) {
        if self.lights.len() != lights || self.lights.iter().any(|light| light.pairs.len() != casters) {
            self.lights.iter_mut().for_each(|light| light.pairs.clear());
            self.store = Store::default();
            self.plan.indices.clear();
        }
        self.lights.resize_with(lights, Light::default);
        for light in &mut self.lights {
            light.pairs.resize_with(casters, Pair::default);
        }
        self.plan.lights.resize_with(lights, LightPlan::default);
        self.plan.draws.clear();
        self.plan.castings.clear();
        self.store.begin(&mut self.plan.indices, &mut self.plan.changed);
    }

    fn stages(&mut self, stage: &Stage<'_>, extractable: &[bool]) -> Result<(), PlanError> {
        if stage.placed.is_empty() {
            for plan in &mut self.plan.lights {
                plan.begin(Some(scissor::full(stage.view())));
            }
            return Ok(());
        }
        self.choice.begin(stage);
        for (l, (light, plan)) in self.lights.iter_mut().zip(&mut self.plan.lights).enumerate() {
            if light.unchanged {
                Choice::keep(&mut light.pairs, plan);
            } else {
                self.choice.choose(stage, l, &mut light.pairs, plan)?;
            }
        }
        self.extract(stage, extractable);
        self.weigh(stage);
        // Where the device takes part, one batch is known to do.
        for (l, light) in self.lights.iter_mut().enumerate().filter(|(_, light)| light.layers.is_none()) {
            self.plan.lights[l].stats.searched = light.batching.divide(stage, l, &mut light.pairs);
        }
        self.in_parallel(stage, |pair, _| !pair.is_built(), |pair, topology, _| pair.build_sides(topology));
        for (light, plan) in self.lights.iter_mut().zip(&mut self.plan.lights) {
            z_pass::count_from_near_rectangle(stage, plan, &mut light.pairs);
        }
        self.in_parallel(
            stage,
            |pair, topology| pair.lacks_caps(topology),
            |pair, topology, placed| pair.build_caps(topology, stage.view(), placed, stage.steps.fan),
        );
        for (l, light) in self.lights.iter_mut().enumerate() {
            draws::append(stage, l, &mut light.pairs, &mut self.store, &mut self.plan)?;
        }
        Ok(())
    }

    /// Leaves silhouettes to the device where that is chosen and counts cannot wrap.
    fn extract(&mut self, stage: &Stage<'_>, extractable: &[bool]) {
        for light in &mut self.lights {
            light.layers = extraction::choose(stage, extractable, &mut light.pairs);
        }
        if self.lights.iter().all(|light| light.layers.is_none()) {
            return;
        }
        self.weigh(stage);
        for (l, Light { pairs, batching, layers, .. }) in self.lights.iter_mut().enumerate() {
            let Some(most) = *layers else { continue };
            if !batching.has_room_for(most, stage, l, pairs) {
                for pair in pairs.iter_mut().filter(|pair| pair.on_device) {
                    pair.on_device = false;
                    pair.extracted.give_up();
                }
                *layers = None;
            }
        }
    }

    /// Decides the facing of all triangles of pairs that stay here and builds their sides, where they are not known.
    fn weigh(&mut self, stage: &Stage<'_>) {
        self.in_parallel(
            stage,
            |pair, _| pair.is_stale(stage.view()),
            |pair, topology, _| {
                pair.weigh(topology, stage.view());
                pair.build_sides(topology);
            },
        );
    }

    /// Runs `work` on every pair that wants it; on several threads only if there is anything to do.
    fn in_parallel(
        &mut self,
        stage: &Stage<'_>,
        wanted: impl Fn(&Pair, &Topology) -> bool + Sync,
        work: impl Fn(&mut Pair, &Topology, &Placed) + Sync,
    ) {
        let wants = |(c, pair): (usize, &Pair)| wanted(pair, stage.topology(c));
        let waiting = |light: &Light| light.pairs.iter().enumerate().filter(|&pair| wants(pair)).count();
        let each = |c: usize, pair: &mut Pair| {
            if wants((c, pair)) {
                work(pair, stage.topology(c), &stage.placed[c]);
            }
        };
        match self.lights.iter().map(waiting).sum::<usize>() {
            0 => {}
            1 => {
                let pairs = self.lights.iter_mut().flat_map(|light| light.pairs.iter_mut().enumerate());
                pairs.for_each(|(c, pair)| each(c, pair));
            }
            _ => parallel::for_each(&mut self.lights, |_, light| parallel::for_each(&mut light.pairs, each)),
        }
    }
}

impl LightPlan {
    pub(super) fn begin(&mut self, scissor: Option<Rectangle>) {
        self.batches.clear();
        self.scissor = scissor;
        self.stats = LightStats { scissor: scissor.unwrap_or_default(), ..LightStats::default() };
    }
}
