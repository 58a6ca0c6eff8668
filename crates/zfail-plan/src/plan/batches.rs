//! The division of a light's casting triangles into batches whose counts cannot wrap.
//!
//! In: weights of every pair of one light. Out: a batch number per triangle, or none where one batch will do.

use super::meridians::{self, Crossings, Lines};
use super::pair::{Pair, Role};
use super::placed::Placed;
use super::sheets::sheets;
use super::{Counting, Frame};
use crate::scene::{Bounds, LightKind};
use crate::stack::{self, Cone};
use crate::view::Projection;
use glam::{DAffine3, DVec4};

/// Layers a stencil of 8 bits can tell from zero, less a few for pixels on rounded silhouettes.
pub(super) const SINGLE: usize = 250;
/// The same for 7 bits, when the eighth is the sticky one.
const FOLDED: usize = 120;

/// Remembers one light's division while nothing moves.
#[derive(Debug, Default)]
pub(super) struct Batching {
    /// What the division was made for.
    key: Vec<(u32, u64, DAffine3)>,
    light: Option<LightKind>,
    /// Orthographic views change weights, and with them the pairs' batches.
    orthographic: bool,
    divided: bool,
    crossings: Crossings,
}

/// A casting triangle with its directions from the light.
struct Item {
    pair: usize,
    triangle: usize,
    /// With which others it hangs together.
    sheet: u32,
    /// Of the sheet's nearest triangle.
    distance: f64,
}

impl Batching {
    /// Whether one batch will do for the planner's pairs of light `l` beside others on the device, which have at most so
    /// many `layers`. Builds their sides.
    pub fn has_room_for(
        &mut self,
        layers: usize,
        frame: &Frame<'_>,
        l: usize,
        pairs: &mut [Pair],
        placed: &[Placed],
    ) -> bool {
        pairs.iter_mut().for_each(Pair::unite);
        self.light = None;
        let casting: usize = pairs.iter().filter(|p| p.is_planned()).map(|p| p.casting).sum();
        let kind = &frame.lights[l].kind;
        frame.counting == Counting::Raw
            || casting + layers <= SINGLE
            || layers < SINGLE && quickly_within(frame, kind, pairs, placed, &mut self.crossings, SINGLE - layers)
    }

    /// Sets the batches of `pairs`, all of light `l`, one per caster. Builds their sides.
    pub fn divide(&mut self, frame: &Frame<'_>, l: usize, pairs: &mut [Pair], placed: &[Placed]) {
        let active = |pair: &Pair| pair.role != Role::Idle;
        let casting: usize = pairs.iter().filter(|p| active(p)).map(|p| p.casting).sum();
        if frame.counting == Counting::Raw || casting <= SINGLE {
            pairs.iter_mut().for_each(Pair::unite);
            self.light = None;
            return;
        }
        let kind = frame.lights[l].kind;
        let orthographic = matches!(frame.view.projection, Projection::Orthographic { .. });
        let key = || {
            let active = pairs.iter().zip(placed).enumerate().filter(|(_, (pair, _))| active(pair));
            active.map(|(c, (_, placed))| (c as u32, placed.mesh, placed.world_from_object))
        };
        // Pairs forget their batches with the weights they belong to.
        let kept = !self.divided || pairs.iter().filter(|p| active(p)).all(|pair| !pair.batch_of.is_empty());
        let same = self.orthographic == orthographic && self.light == Some(kind);
        if kept && same && self.key.iter().copied().eq(key()) {
            if !self.divided {
                pairs.iter_mut().for_each(Pair::unite);
            }
            return;
        }
        self.key.clear();
        self.key.extend(key());
        self.light = Some(kind);
        self.orthographic = orthographic;

        let quick = quickly_within(frame, &kind, pairs, placed, &mut self.crossings, SINGLE)
            || bodies_within(frame, &kind, pairs, placed, &mut self.crossings);
        self.divided = !quick && {
            let (items, cones, shape) = cones(frame, &kind, pairs, placed);
            let within = stack::is_within(&cones, &shape, SINGLE);
            if !within {
                spread(pairs, &items, &cones, &shape);
            }
            !within
        };
        if !self.divided {
            pairs.iter_mut().for_each(Pair::unite);
        }
    }
}

/// Whether silhouettes alone prove that no ray crosses more than `most` layers.
fn quickly_within(
    frame: &Frame<'_>,
    kind: &LightKind,
    pairs: &mut [Pair],
    placed: &[Placed],
    sum: &mut Crossings,
    most: usize,
) -> bool {
    let mut bounds = Bounds::EMPTY;
    for caster in placed.iter().filter(|p| !p.world.is_empty()) {
        bounds.add(caster.world.min);
        bounds.add(caster.world.max);
    }
    let lines = Lines::new(kind.homogeneous(), &bounds);
    sum.clear(meridians::COARSE);
    let planned = |(_, (pair, _)): &(usize, (&mut Pair, &Placed))| pair.is_planned();
    for (c, (pair, caster)) in pairs.iter_mut().zip(placed).enumerate().filter(planned) {
        let topology = frame.casters[c].topology;
        // Batches would put sides between triangles that have none.
        pair.unite();
        pair.build_sides(topology);
        sum.merge(pair.crossings(topology, &caster.world_from_object, lines));
    }
    if sum.bound() <= most {
        return true;
    }
    sum.clear(meridians::FINE);
    for (c, (pair, caster)) in pairs.iter().zip(placed).enumerate().filter(|(_, (pair, _))| pair.is_planned()) {
        pair.count_crossings(frame.casters[c].topology, &caster.world_from_object, lines, sum);
    }
    sum.bound() <= most
}

/// Whether the layers of every caster by itself, and where casters hide one another from the light, prove it: for many
/// casters that are small as the light sees them, of which lines right across the scene meet too many.
fn bodies_within(
    frame: &Frame<'_>,
    kind: &LightKind,
    pairs: &[Pair],
    placed: &[Placed],
    scratch: &mut Crossings,
) -> bool {
    let (light, eye) = (kind.homogeneous(), frame.view.eye());
    let active = || pairs.iter().zip(placed).enumerate().filter(|(_, (pair, _))| pair.role != Role::Idle);
    if active().nth(1).is_none() {
        return false;
    }
    let shape = directions(light, active().map(|(_, (_, caster))| caster));
    let body = |(c, (pair, caster)): (usize, (&Pair, &Placed))| {
        scratch.clear(meridians::COARSE);
        let lines = Lines::of(light, eye, caster);
        pair.count_crossings(frame.casters[c].topology, &caster.world_from_object, lines, scratch);
        let layers = scratch.bound().min(pair.casting);
        stack::Body::new(caster.corners.map(|corner| corner + eye), layers, light, &shape)
    };
    let bodies: Vec<stack::Body> = active().map(body).collect();
    stack::is_within(&bodies, &shape, SINGLE)
}

/// How directions from a light to `casters` are told apart.
fn directions<'a>(light: DVec4, casters: impl Iterator<Item = &'a Placed>) -> stack::Frame {
    let mut bounds = Bounds::EMPTY;
    for caster in casters.filter(|caster| !caster.bounds.is_empty()) {
        let world = caster.bounds.transformed(&caster.world_from_object);
        bounds.add(world.min);
        bounds.add(world.max);
    }
    stack::Frame::new(light, &bounds)
}

/// Distributes casting triangles over batches.
fn spread(pairs: &mut [Pair], items: &[Item], cones: &[Cone], shape: &stack::Frame) {
    let mut batches = Vec::new();
    halve(items, cones, shape, &mut batches);
    for pair in pairs.iter_mut().filter(|pair| pair.role != Role::Idle) {
        let triangles = pair.weights.len();
        pair.divide(|batch_of| {
            batch_of.clear();
            batch_of.resize(triangles, 0);
        });
    }
    for (batch, range) in batches.into_iter().enumerate() {
        for item in &items[range] {
            // More batches than 16 bits would need 8 million stacked layers; the last one takes the rest.
            pairs[item.pair].batch_of[item.triangle] = batch.min(usize::from(u16::MAX)) as u16;
        }
    }
}

/// All casting triangles of one light as cones, nearest caster first, nearest sheet first.
fn cones(
    frame: &Frame<'_>,
    kind: &LightKind,
    pairs: &[Pair],
    placed: &[Placed],
) -> (Vec<Item>, Vec<Cone>, stack::Frame) {
    let light = kind.homogeneous();
    let active = || pairs.iter().zip(placed).enumerate().filter(|(_, (pair, _))| pair.role != Role::Idle);
    let shape = directions(light, active().map(|(_, (_, caster))| caster));
    let mut items = Vec::new();
    for (p, (pair, caster)) in active() {
        let sheets = sheets(frame.casters[p].topology, &pair.weights);
        let first = items.len();
        for triangle in (0..pair.weights.len()).filter(|&t| pair.weights[t] != 0) {
            let corners = frame.casters[p].topology.corners(triangle);
            let center = caster.world_from_object.transform_point3((corners[0] + corners[1] + corners[2]) / 3.0);
            let distance =
                if light.w == 0.0 { -light.truncate().dot(center) } else { light.truncate().distance(center) };
            items.push(Item { pair: p, triangle, sheet: sheets[triangle], distance });
        }
        let mut of_sheet = vec![f64::INFINITY; sheets.len()];
        for item in &items[first..] {
            let nearest = &mut of_sheet[item.sheet as usize];
            *nearest = nearest.min(item.distance);
        }
        items[first..].iter_mut().for_each(|item| item.distance = of_sheet[item.sheet as usize]);
    }
    let mut nearest = vec![f64::INFINITY; pairs.len()];
    for item in &items {
        nearest[item.pair] = nearest[item.pair].min(item.distance);
    }
    items.sort_by(|a, b| {
        let pairs = nearest[a.pair].total_cmp(&nearest[b.pair]).then(a.pair.cmp(&b.pair));
        pairs.then(a.distance.total_cmp(&b.distance)).then(a.sheet.cmp(&b.sheet))
    });
    let cones = items
        .iter()
        .map(|item| {
            let corners = frame.casters[item.pair].topology.corners(item.triangle);
            let place = placed[item.pair].world_from_object;
            stack::cone(corners.map(|p| place.transform_point3(p)), light, &shape)
        })
        .collect();
    (items, cones, shape)
}

/// Halves the sequence of items until no ray crosses more than [`FOLDED`] of any run, between casters where possible, or else
/// between sheets.
fn halve(items: &[Item], cones: &[Cone], shape: &stack::Frame, out: &mut Vec<std::ops::Range<usize>>) {
    let mut rest = Vec::new();
    let mut next = Some(0..items.len());
    while let Some(range) = next.take().or_else(|| rest.pop()) {
        if stack::is_within(&cones[range.clone()], shape, FOLDED) {
            out.push(range);
            continue;
        }
        let middle = usize::midpoint(range.start, range.end);
        let casters = |i: usize| items[i - 1].pair != items[i].pair;
        let sheets = |i: usize| casters(i) || items[i - 1].sheet != items[i].sheet;
        let cut = nearest(&range, middle, casters).or_else(|| nearest(&range, middle, sheets)).unwrap_or(middle);
        rest.push(cut..range.end);
        next = Some(range.start..cut);
    }
}

/// The border within `range` that is nearest to its middle.
fn nearest(range: &std::ops::Range<usize>, middle: usize, border: impl Fn(usize) -> bool) -> Option<usize> {
    let before = (range.start + 1..=middle).rev().find(|&i| border(i));
    let after = (middle..range.end).find(|&i| i > range.start && border(i));
    match (before, after) {
        (Some(b), Some(a)) if middle - b <= a - middle => Some(b),
        (_, Some(i)) | (Some(i), None) => Some(i),
        (None, None) => None,
    }
}
