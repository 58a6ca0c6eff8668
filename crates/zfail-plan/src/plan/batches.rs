//! The division of a light's casting triangles into batches whose counts cannot wrap.
//!
//! In: weights of every pair of one light. Out: a batch number per triangle, or none where one batch will do.

use super::Counting;
use super::meridians::{self, Crossings, Lines};
use super::pair::Pair;
use super::placed::{Placed, Source};
use super::spread::spread;
use super::stage::Stage;
use crate::bounds::Bounds;
use crate::light::LightKind;
use crate::stack::{self, Outline, Work};
use crate::view::Projection;
use glam::{DAffine3, DVec4};

/// Layers a stencil of 8 bits can tell from zero, less a few for pixels on rounded silhouettes.
pub(super) const SINGLE: usize = 250;
/// What the search for a proof, and for a division, may look at: a second or so.
const WORK: u64 = 1 << 25;

/// Remembers one light's division while nothing moves.
#[derive(Debug, Default)]
pub(super) struct Batching {
    /// What the division was made for.
    key: Vec<(u32, Source, DAffine3)>,
    light: Option<LightKind>,
    /// Orthographic views change weights, and with them the pairs' batches.
    orthographic: bool,
    divided: bool,
    crossings: Crossings,
}

impl Batching {
    /// Whether one batch will do for the planner's pairs of light `l` beside others on the device, which have at most so
    /// many `layers`. Builds their sides.
    pub fn has_room_for(&mut self, layers: usize, stage: &Stage<'_>, l: usize, pairs: &mut [Pair]) -> bool {
        pairs.iter_mut().for_each(Pair::unite);
        self.light = None;
        let casting: usize = pairs.iter().filter(|p| p.is_planned()).map(|p| p.casting()).sum();
        let kind = &stage.light(l).kind;
        stage.input.counting == Counting::Raw
            || casting + layers <= SINGLE
            || layers < SINGLE && quickly_within(stage, kind, pairs, &mut self.crossings, SINGLE - layers)
    }

    /// Sets the batches of `pairs`, all of light `l`, one per caster. Builds their sides. Returns what it looked at.
    pub fn divide(&mut self, stage: &Stage<'_>, l: usize, pairs: &mut [Pair]) -> u64 {
        let placed = stage.placed;
        let active = Pair::is_active;
        let casting: usize = pairs.iter().filter(|p| active(p)).map(|p| p.casting()).sum();
        if stage.input.counting == Counting::Raw || casting <= SINGLE {
            pairs.iter_mut().for_each(Pair::unite);
            self.light = None;
            return 0;
        }
        let kind = stage.light(l).kind;
        let orthographic = matches!(stage.view().projection, Projection::Orthographic { .. });
        let key = || {
            let active = pairs.iter().zip(placed).enumerate().filter(|(_, (pair, _))| active(pair));
            active.map(|(c, (_, placed))| (c as u32, placed.source, placed.world_from_object))
        };
        // Pairs forget their batches with the weights they belong to.
        let kept = !self.divided || pairs.iter().filter(|p| active(p)).all(|pair| !pair.batch_of.is_empty());
        let same = self.orthographic == orthographic && self.light == Some(kind);
        if kept && same && self.key.iter().copied().eq(key()) {
            if !self.divided {
                pairs.iter_mut().for_each(Pair::unite);
            }
            return 0;
        }
        self.key.clear();
        self.key.extend(key());
        self.light = Some(kind);
        self.orthographic = orthographic;

        let mut work = Work::of(WORK);
        let quick = quickly_within(stage, &kind, pairs, &mut self.crossings, SINGLE)
            || bodies_within(stage, &kind, pairs, &mut self.crossings, &mut work);
        self.divided = !quick && {
            let shape = directions(kind.homogeneous(), pairs, placed);
            let mut outline = Outline::new(shape.clone());
            for (c, (pair, caster)) in pairs.iter().zip(placed).enumerate().filter(|(_, (pair, _))| active(pair)) {
                pair.outline(stage.topology(c), caster, &mut outline);
            }
            let within = outline.is_within(SINGLE, &mut work);
            if !within {
                spread(stage, &kind, pairs, &shape, &mut work);
            }
            !within
        };
        if !self.divided {
            pairs.iter_mut().for_each(Pair::unite);
        }
        work.spent()
    }
}

/// Whether silhouettes alone prove that no ray crosses more than `most` layers.
fn quickly_within(stage: &Stage<'_>, kind: &LightKind, pairs: &mut [Pair], sum: &mut Crossings, most: usize) -> bool {
    let mut bounds = Bounds::EMPTY;
    for caster in stage.placed.iter().filter(|p| !p.world.is_empty()) {
        bounds.add(caster.world.min);
        bounds.add(caster.world.max);
    }
    let lines = Lines::new(kind.homogeneous(), &bounds);
    sum.clear(meridians::COARSE);
    let planned = |(_, (pair, _)): &(usize, (&mut Pair, &Placed))| pair.is_planned();
    for (c, (pair, caster)) in pairs.iter_mut().zip(stage.placed).enumerate().filter(planned) {
        let topology = stage.topology(c);
        // Batches would put sides between triangles that have none.
        pair.unite();
        pair.build_sides(topology);
        sum.merge(pair.crossings(topology, &caster.world_from_object, lines));
    }
    if sum.bound() <= most {
        return true;
    }
    sum.clear(meridians::FINE);
    for (c, (pair, caster)) in pairs.iter().zip(stage.placed).enumerate().filter(|(_, (pair, _))| pair.is_planned()) {
        pair.count_crossings(stage.topology(c), &caster.world_from_object, lines, sum);
    }
    sum.bound() <= most
}

/// Whether the layers of every caster by itself, and where casters hide one another from the light, prove it: for many
/// casters that are small as the light sees them, of which lines right across the scene meet too many.
fn bodies_within(
    stage: &Stage<'_>,
    kind: &LightKind,
    pairs: &[Pair],
    scratch: &mut Crossings,
    work: &mut Work,
) -> bool {
    let (light, eye) = (kind.homogeneous(), stage.view().eye());
    let active = || pairs.iter().zip(stage.placed).enumerate().filter(|(_, (pair, _))| pair.is_active());
    if active().nth(1).is_none() {
        return false;
    }
    let shape = directions(light, pairs, stage.placed);
    let body = |(c, (pair, caster)): (usize, (&Pair, &Placed))| {
        scratch.clear(meridians::COARSE);
        let lines = Lines::of(light, eye, caster);
        pair.count_crossings(stage.topology(c), &caster.world_from_object, lines, scratch);
        let layers = scratch.bound().min(pair.casting());
        stack::Body::new(caster.corners.map(|corner| corner + eye), layers, light, &shape)
    };
    let bodies: Vec<stack::Body> = active().map(body).collect();
    stack::are_within(&bodies, &shape, SINGLE, work)
}

/// How directions from a light to the casters that draw anything are told apart.
fn directions(light: DVec4, pairs: &[Pair], placed: &[Placed]) -> stack::Chart {
    let mut bounds = Bounds::EMPTY;
    let active = pairs.iter().zip(placed).filter(|(pair, caster)| pair.is_active() && !caster.bounds.is_empty());
    for (_, caster) in active {
        let world = caster.bounds.transformed(&caster.world_from_object);
        bounds.add(world.min);
        bounds.add(world.max);
    }
    stack::Chart::new(light, &bounds)
}
