//! The stages of planning, in order.
//!
//! In: a frame. Out: the plan. Scratch memory is kept, so that a frame allocates nothing once its like has been planned.

use super::batches::Batching;
use super::extraction;
use super::near_count::NearCount;
use super::occluders::Shadow;
use super::off_screen::{self, Parts};
use super::pair::{Pair, Role};
use super::placed::Placed;
use super::pyramid::{self, Pyramid};
use super::reach::Reach;
use super::receivers::Receivers;
use super::store::Store;
use super::{Counting, Culled, Draw, FramePlan, Input, LightPlan, LightStats, PlanError, Steps, ZPass, caps};
use crate::parallel;
use crate::scissor::{self, Rectangle};
use crate::volume::Volume;
use glam::DVec4;

/// Plans frame after frame, keeping memory and what has not changed.
#[derive(Debug, Default)]
pub struct Planner {
    /// By light and caster.
    pairs: Vec<Pair>,
    batching: Vec<Batching>,
    /// By light, the most layers of pairs on the device.
    layers: Vec<Option<usize>>,
    store: Store,
    plan: FramePlan,
    placed: Vec<Placed>,
    reach: Reach,
    receivers: Receivers,
    occluders: Vec<(f64, usize)>,
    shadows: Vec<Shadow>,
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
        &mut self.plan
    }

    /// Plans `frame`.
    ///
    /// # Errors
    /// A caster's transform that cannot be inverted, or more indices than 32 bits can count.
    pub fn plan(&mut self, frame: &Input<'_>) -> Result<&FramePlan, PlanError> {
        self.plan_extracting(frame, &[])
    }

    /// Plans `frame` for a device that can find the silhouettes of those casters that are `extractable`, of meshes without
    /// coincident triangles; the rest of the slice may be missing. [`Steps::silhouettes`] says whether it is asked to.
    ///
    /// # Errors
    /// As [`Self::plan`].
    pub fn plan_extracting(&mut self, frame: &Input<'_>, extractable: &[bool]) -> Result<&FramePlan, PlanError> {
        let outcome = self.fill(frame, extractable);
        if outcome.is_err() {
            // Nothing half-planned may be drawn.
            *self = Self::default();
        }
        outcome.map(|()| &self.plan)
    }

    fn fill(&mut self, frame: &Input<'_>, extractable: &[bool]) -> Result<(), PlanError> {
        let steps = match frame.counting {
            Counting::Verdict => frame.steps,
            Counting::Raw => frame.steps.keeping_counts(),
        };
        let (casters, lights) = (frame.casters.len(), frame.lights.len());
        if self.pairs.len() != casters * lights || self.plan.lights.len() != lights {
            self.pairs.clear();
            self.store = Store::default();
            self.plan.indices.clear();
        }
        self.pairs.resize_with(casters * lights, Pair::default);
        self.batching.resize_with(lights, Batching::default);
        self.plan.lights.resize_with(lights, LightPlan::default);
        self.plan.draws.clear();
        self.plan.castings.clear();
        self.store.begin(&mut self.plan.indices, &mut self.plan.changed);
        let mut placed = std::mem::take(&mut self.placed);
        placed.clear();
        placed.extend(frame.casters.iter().map(|caster| Placed::new(caster, frame.view)));
        let outcome = self.fill_placed(frame, steps, extractable, &placed);
        self.placed = placed;
        outcome
    }

    fn fill_placed(
        &mut self,
        frame: &Input<'_>,
        steps: Steps,
        extractable: &[bool],
        placed: &[Placed],
    ) -> Result<(), PlanError> {
        let (casters, lights) = (placed.len(), frame.lights.len());
        if casters == 0 {
            for light in &mut self.plan.lights {
                light.begin(Some(scissor::full(frame.view)));
            }
            return Ok(());
        }

        for l in 0..lights {
            self.choose(frame, steps, l, placed)?;
        }
        self.extract(frame, steps, extractable, placed);
        self.weigh(frame);
        // Where the device takes part, one batch is known to do.
        for (l, pairs) in self.pairs.chunks_mut(casters).enumerate().filter(|&(l, _)| self.layers[l].is_none()) {
            self.plan.lights[l].stats.searched = self.batching[l].divide(frame, l, pairs, placed);
        }
        self.in_parallel(frame, |pair, _| !pair.is_built(), |pair, c| pair.build_sides(frame.casters[c].topology));
        for (l, pairs) in self.pairs.chunks_mut(casters).enumerate() {
            count_from_near_rectangle(frame, steps, &mut self.plan.lights[l], pairs, placed);
        }
        self.in_parallel(
            frame,
            |pair, c| pair.lacks_caps(frame.casters[c].topology),
            |pair, c| {
                pair.build_caps(frame.casters[c].topology, frame.view, &placed[c], steps.fan);
            },
        );
        for l in 0..lights {
            self.append(frame, steps, l, placed)?;
        }
        Ok(())
    }

    /// Leaves silhouettes to the device where that is chosen and counts cannot wrap.
    fn extract(&mut self, frame: &Input<'_>, steps: Steps, extractable: &[bool], placed: &[Placed]) {
        self.layers.clear();
        let lights = self.pairs.chunks_mut(placed.len());
        self.layers.extend(lights.map(|pairs| extraction::choose(frame, steps, extractable, pairs)));
        if self.layers.iter().all(Option::is_none) {
            return;
        }
        self.weigh(frame);
        for (l, pairs) in self.pairs.chunks_mut(placed.len()).enumerate() {
            let Some(layers) = self.layers[l] else { continue };
            if !self.batching[l].has_room_for(layers, frame, l, pairs, placed) {
                for pair in pairs.iter_mut().filter(|pair| pair.on_device) {
                    pair.on_device = false;
                    pair.extracted.give_up();
                }
                self.layers[l] = None;
            }
        }
    }

    /// Decides the facing of all triangles of pairs that stay here and builds their sides, where they are not known.
    fn weigh(&mut self, frame: &Input<'_>) {
        self.in_parallel(
            frame,
            |pair, _| pair.is_stale(frame.view),
            |pair, c| {
                pair.weigh(frame.casters[c].topology, frame.view);
                pair.build_sides(frame.casters[c].topology);
            },
        );
    }

    /// Runs `work` on every pair that wants it; on several threads only if there is anything to do.
    fn in_parallel(
        &mut self,
        frame: &Input<'_>,
        wanted: impl Fn(&Pair, usize) -> bool + Sync,
        work: impl Fn(&mut Pair, usize) + Sync,
    ) {
        let casters = frame.casters.len();
        let waiting = self.pairs.iter().enumerate().filter(|(i, pair)| wanted(pair, i % casters)).count();
        let each = |i: usize, pair: &mut Pair| {
            if wanted(pair, i % casters) {
                work(pair, i % casters);
            }
        };
        if waiting > 1 {
            parallel::for_each(&mut self.pairs, each);
        } else if waiting == 1 {
            self.pairs.iter_mut().enumerate().for_each(|(i, pair)| each(i, pair));
        }
    }

    /// Decides which casters of light `l` draw what and where, as far as boxes tell.
    fn choose(&mut self, frame: &Input<'_>, steps: Steps, l: usize, placed: &[Placed]) -> Result<(), PlanError> {
        let (view, light) = (frame.view, &frame.lights[l]);
        if steps.reach {
            self.reach.set(&light.kind, view.eye());
        } else {
            self.reach.clear();
        }
        let plan = &mut self.plan.lights[l];
        plan.begin(self.reach.scissor(view));
        let receivers = steps.receivers && !frame.receivers.is_empty();
        if receivers {
            self.receivers.set(frame.receivers, view, &self.reach);
        }
        let homogeneous = light.kind.homogeneous();
        let relative = DVec4::from((homogeneous.truncate() - view.eye() * homogeneous.w, homogeneous.w));
        let pairs = &mut self.pairs[l * placed.len()..(l + 1) * placed.len()];
        for (c, (pair, caster)) in pairs.iter_mut().zip(placed).enumerate() {
            plan.stats.casters += 1;
            (pair.role, pair.start) = (Role::Idle, NearCount::default());
            let role = (|| {
                if light.excluded.contains(&c) {
                    return Err(Culled::Excluded);
                }
                if caster.bounds.is_empty() {
                    return Err(Culled::Empty);
                }
                let mut within = plan.scissor.ok_or(Culled::LightOffScreen)?;
                if steps.reach && self.reach.excludes(&caster.world, caster.center, caster.axes) {
                    return Err(Culled::OutOfReach);
                }
                if receivers {
                    let shadowed = self.receivers.shadowed(view, &caster.corners, relative);
                    let pixels = shadowed.and_then(|pixels| scissor::intersection(within, pixels));
                    within = pixels.ok_or(Culled::NoReceiver)?;
                }
                Ok(within)
            })();
            let within = match role {
                Ok(within) => within,
                Err(reason) => {
                    plan.stats.cull(reason);
                    continue;
                }
            };
            pair.aim(caster, &light.kind).ok_or(PlanError::Singular { caster: c })?;
            let parts = if steps.off_screen {
                off_screen::visible_parts(view, within, &caster.world_from_object, &caster.bounds, pair.light)
            } else {
                Parts::ALL
            };
            // A volume of which nothing is in view still darkens the whole image where the near rectangle is inside, but
            // then its dark cap or its sides come into view.
            if parts == Parts::default() {
                plan.stats.cull(Culled::OffScreen);
                continue;
            }
            let z_pass = steps.z_pass != ZPass::Never && is_clear(frame, caster, pair, within);
            pair.role = Role::Active { within, parts, z_pass };
        }
        let z_fail = |pair: &Pair| matches!(pair.role, Role::Active { z_pass: false, .. });
        if steps.z_pass == ZPass::ByLight && pairs.iter().any(z_fail) {
            for pair in pairs.iter_mut() {
                if let Role::Active { z_pass, .. } = &mut pair.role {
                    *z_pass = false;
                }
            }
        }
        self.leave_out_occluded(frame, steps, l, placed, relative);
        Ok(())
    }

    /// Idles casters in the shadow of convex ones.
    fn leave_out_occluded(&mut self, frame: &Input<'_>, steps: Steps, l: usize, placed: &[Placed], light: DVec4) {
        let pairs = &mut self.pairs[l * placed.len()..(l + 1) * placed.len()];
        let most = usize::from(steps.occluders);
        if most == 0 || pairs.iter().filter(|pair| pair.role != Role::Idle).count() < 2 {
            return;
        }
        let distance = |caster: &Placed| {
            let way = |p: glam::DVec3| {
                if light.w == 0.0 { -light.truncate().dot(p) } else { light.truncate().distance(p) }
            };
            caster.corners.iter().map(|c| way(*c)).fold(f64::INFINITY, f64::min)
        };
        // Those that look largest from the light.
        self.occluders.clear();
        for (c, (_, caster)) in pairs.iter().zip(placed).enumerate().filter(|(_, (pair, _))| pair.role != Role::Idle) {
            if frame.casters[c].topology.convex.is_some() {
                let size = caster.axes.iter().map(|axis| axis.length_squared()).sum::<f64>();
                let away = if light.w == 0.0 { 1.0 } else { light.truncate().distance_squared(caster.center) };
                self.occluders.push((-size / away.max(f64::MIN_POSITIVE), c));
            }
        }
        self.occluders.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        self.occluders.truncate(most);
        for entry in &mut self.occluders {
            entry.0 = distance(&placed[entry.1]);
        }
        self.occluders.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));

        let stats = &mut self.plan.lights[l].stats;
        let mut kept = 0;
        for &(_, c) in &self.occluders {
            let caster = &placed[c];
            if self.shadows[..kept].iter().any(|shadow| shadow.holds(&caster.exact_corners)) {
                pairs[c].role = Role::Idle;
                stats.cull(Culled::Occluded);
                continue;
            }
            if kept == self.shadows.len() {
                self.shadows.push(Shadow::default());
            }
            let topology = frame.casters[c].topology;
            if let Some(part) = &topology.convex {
                self.shadows[kept].set(topology, part, &caster.relative_from_object, light);
                kept += 1;
            }
        }
        for (c, (pair, caster)) in pairs.iter_mut().zip(placed).enumerate() {
            let itself = self.occluders.iter().any(|entry| entry.1 == c);
            let occluded = |shadow: &Shadow| shadow.holds(&caster.exact_corners);
            if pair.role != Role::Idle && !itself && self.shadows[..kept].iter().any(occluded) {
                pair.role = Role::Idle;
                stats.cull(Culled::Occluded);
            }
        }
    }

    /// Appends the draws of one light, batch by batch, z-pass before z-fail.
    fn append(&mut self, frame: &Input<'_>, steps: Steps, l: usize, placed: &[Placed]) -> Result<(), PlanError> {
        let Self { pairs, plan, store, .. } = self;
        let pairs = &mut pairs[l * placed.len()..(l + 1) * placed.len()];
        let FramePlan { indices, castings, draws, lights, changed } = plan;
        let light = &mut lights[l];
        for pair in pairs.iter() {
            if let Role::Active { parts, z_pass, .. } = pair.role
                && pair.batches() > 0
            {
                let case = if z_pass { 0 } else { 1 + usize::from(parts.light_cap) };
                light.stats.cases[case] += 1;
            }
        }
        let batches = pairs.iter().map(Pair::batches).max().unwrap_or(0);
        for batch in 0..batches {
            let first = draws.len() as u32;
            for pass in [true, false] {
                for (c, pair) in pairs.iter_mut().enumerate() {
                    let Role::Active { within, z_pass, .. } = pair.role else { continue };
                    if z_pass != pass {
                        continue;
                    }
                    if pair.on_device {
                        let fan = extraction::may_fan(steps, &placed[c], pair.light);
                        light.stats.extracted += 1;
                        draws.push(Draw {
                            caster: c as u32,
                            light: pair.light,
                            reach: 0.0,
                            z_pass,
                            near_layers: 0,
                            scissor: within,
                            volume: Volume::default(),
                            extraction: Some(pair.extraction(l as u32, fan, castings)),
                            mirrored: placed[c].mirrored,
                        });
                        continue;
                    }
                    let to_object = placed[c].object_from_relative();
                    let reach = caps::reach(&placed[c].bounds, pair.nearest, pair.light, frame.view, &to_object);
                    for p in 0..pair.pieces().len() {
                        let drawn = pair.drawn(&pair.pieces()[p]);
                        let object_light = pair.light;
                        let near_layers = if p == 0 { pair.start.layers } else { 0 };
                        let piece = pair.piece_mut(p);
                        if usize::from(piece.batch) != batch || drawn.triangles() == [0; 3] {
                            continue;
                        }
                        let base = store
                            .put(&mut piece.place, &piece.indices, piece.fresh, indices, changed)
                            .ok_or(PlanError::TooManyIndices)?;
                        piece.fresh = false;
                        light.stats.add(drawn.triangles());
                        draws.push(Draw {
                            caster: c as u32,
                            light: object_light,
                            reach,
                            z_pass,
                            near_layers,
                            scissor: within,
                            volume: drawn.shifted(base),
                            extraction: None,
                            mirrored: placed[c].mirrored,
                        });
                    }
                }
            }
            light.batches.push(first..draws.len() as u32);
        }
        Ok(())
    }
}

/// Whether nothing of a caster stands between the light and the near rectangle behind pixels `within`.
fn is_clear(frame: &Input<'_>, caster: &Placed, pair: &Pair, within: Rectangle) -> bool {
    pyramid_of(frame, caster, pair, within).excludes(&caster.bounds)
}

fn pyramid_of(frame: &Input<'_>, caster: &Placed, pair: &Pair, within: Rectangle) -> Pyramid {
    let slab = pyramid::near_slab(frame.view, within, pyramid::pad(frame.view, caster.reach));
    Pyramid::new(slab, &caster.object_from_relative(), pair.light)
}

/// Turns z-fail into z-pass where the count at the near rectangle is known, and adds those counts up.
fn count_from_near_rectangle(
    frame: &Input<'_>,
    steps: Steps,
    light: &mut LightPlan,
    pairs: &mut [Pair],
    placed: &[Placed],
) {
    let Some(scissor) = light.scissor.filter(|_| steps.near_count) else { return };
    let mut sum = 0;
    for (c, (pair, caster)) in pairs.iter_mut().zip(placed).enumerate() {
        let Role::Active { within, parts, z_pass: false } = pair.role else { continue };
        if pair.on_device {
            continue;
        }
        let pyramid = pyramid_of(frame, caster, pair, scissor);
        let Some(start) = pair.near_count(frame.casters[c].topology, pyramid) else { continue };
        sum += start.layers;
        pair.start = start;
        // What every pixel starts with has to be counted in every pixel.
        let (within, parts) = if start.layers == 0 { (within, parts) } else { (scissor, Parts::ALL) };
        pair.role = Role::Active { within, parts, z_pass: true };
    }
    light.stats.near_count = sum;
}

impl LightPlan {
    fn begin(&mut self, scissor: Option<Rectangle>) {
        self.batches.clear();
        self.scissor = scissor;
        self.stats = LightStats { scissor: scissor.unwrap_or_default(), ..LightStats::default() };
    }
}

impl LightStats {
    fn add(&mut self, [sides, dark_cap, light_cap]: [u32; 3]) {
        self.triangles.sides += sides;
        self.triangles.dark_cap += dark_cap;
        self.triangles.light_cap += light_cap;
        self.vertices += 3 * (sides + dark_cap + light_cap);
    }
}
