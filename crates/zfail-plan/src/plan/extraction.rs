//! Which casters' silhouettes the device finds, instead of the planner.
//!
//! In: the pairs of one light, and the casters that the device can extract. Out: what those pairs ask of the device. Facing,
//! silhouette and caps are the device's; the planner decides which parts are drawn, from which side parts cast, and proves
//! that 8-bit counts cannot wrap (decision record 0016). Where it cannot, casters stay with the planner.

use super::ball::Ball;
use super::batches::SINGLE;
use super::off_screen::Parts;
use super::pair::{Pair, Role};
use super::placed::Placed;
use super::stage::Stage;
use super::{Counting, Silhouettes, Steps};
use crate::casting::{self, Casting, ObjectLight};
use crate::parallel;
use crate::topology::Topology;
use crate::view::Projection;
use std::ops::Range;

/// What the device is to make of one caster: the parts of [`crate::volume`], from a facing of its own.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Extraction {
    /// Which light of the plan.
    pub light: u32,
    /// [`super::Caster::mesh`] of the caster.
    pub mesh: u64,
    /// Range of [`super::FramePlan::castings`]: that of each part.
    pub castings: Range<u32>,
    /// Whether silhouette edges are extruded.
    pub sides: bool,
    /// What closes the volume at infinity.
    pub dark_cap: DarkCap,
    /// Which casting triangles are drawn in place.
    pub light_cap: LightCap,
}

/// What closes an extracted volume at infinity.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum DarkCap {
    /// Nothing: it is not seen, or sides converge.
    None,
    /// A triangle per side, from any one vertex that casts.
    Fan,
    /// The extruded casting triangles.
    Triangles,
}

/// Which casting triangles an extracted volume has in place.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum LightCap {
    /// None.
    None,
    /// Those of parts that the depth pass may leave out ([`crate::topology::Cover::Nowhere`]).
    Exposed,
    /// All.
    Whole,
}

/// Layers that all casters of a light may have on the device; the rest of what a stencil can count is left to others.
const LAYERS: usize = 160;
/// The largest ball that is tried: its radius as a part of the way to the middle of the caster, or of a unit direction.
const LARGEST: f64 = 1.0 / 8.0;
/// How many balls are tried, each half as large as the one before.
const BALLS: i32 = 9;
/// Moves of the light that a proof has to outlast to be worth its cost.
const WORTH: f64 = 8.0;
/// Moves of the light after which a caster that had to stay with the planner is tried again.
const PATIENCE: u32 = 64;

/// What a pair on the device needs to know between frames.
#[derive(Debug, Default)]
pub(super) struct Extracted {
    /// From which side each part casts.
    pub castings: Vec<Casting>,
    /// For what they were found.
    found_for: Option<(u64, ObjectLight)>,
    proof: Option<Proof>,
    /// Radius of the last ball that was tried.
    tried: Option<f64>,
    /// Moves of the light until the device is tried again.
    wait: u32,
}

/// Lights for which the castings hold, and a bound on layers.
#[derive(Debug)]
struct Proof {
    mesh: u64,
    ball: Ball,
    layers: usize,
}

impl Extracted {
    /// The layers that are proved for `light`.
    fn proved(&self, mesh: u64, light: ObjectLight) -> Option<usize> {
        self.proof.as_ref().filter(|proof| proof.mesh == mesh && proof.ball.holds(light)).map(|proof| proof.layers)
    }

    /// Finds castings, unless they are known.
    fn cast(&mut self, topology: &Topology, mesh: u64, light: ObjectLight) {
        if self.found_for != Some((mesh, light)) {
            casting::castings(topology, light, &mut self.castings);
            self.found_for = Some((mesh, light));
            self.proof = None;
        }
    }

    /// Looks for the largest ball about `light` in which there are at most `most` layers, no smaller than `least`.
    fn prove(&mut self, topology: &Topology, mesh: u64, light: ObjectLight, most: usize, least: f64) {
        self.proof = None;
        self.cast(topology, mesh, light);
        let to_middle = topology.bounds().center() - light.truncate().as_dvec3();
        let distance = if light.w == 0.0 { 1.0 } else { to_middle.length() };
        // What failed the last time is likely to fail again: at most one step further out.
        let largest = self.tried.map_or(f64::INFINITY, |radius| 2.5 * radius);
        let radii = (0..BALLS).map(|halvings| distance * LARGEST * 0.5_f64.powi(halvings));
        for radius in radii.filter(|&radius| radius <= largest && radius >= least) {
            self.tried = Some(radius);
            let ball = Ball { center: light, radius };
            if let Some(layers) = ball.most_layers(topology, &self.castings).filter(|&layers| layers <= most) {
                self.proof = Some(Proof { mesh, ball, layers });
                return;
            }
        }
        self.give_up();
    }

    /// Leaves the pair to the planner for a while.
    pub fn give_up(&mut self) {
        self.wait = PATIENCE;
    }
}

impl Pair {
    /// Whether the device is to be asked, as far as no proof is needed.
    fn is_candidate(&mut self, silhouettes: Silhouettes) -> bool {
        if self.moves > 0 {
            self.extracted.wait = self.extracted.wait.saturating_sub(1);
        }
        let ready = self.extracted.wait == 0;
        match silhouettes {
            Silhouettes::Cpu => false,
            Silhouettes::Gpu => ready,
            // What stands still costs nothing on either side, and the planner knows more of it.
            Silhouettes::WhereCheaper => ready && self.moves > 1,
        }
    }

    /// What the device is to make of the pair, with castings in `castings`.
    pub fn extraction(&self, light: u32, fan: bool, castings: &mut Vec<Casting>) -> Extraction {
        let start = castings.len() as u32;
        castings.extend_from_slice(&self.extracted.castings);
        let (parts, z_pass) = match self.role {
            Role::Active { parts, z_pass, .. } => (parts, z_pass),
            Role::Culled(_) => (Parts::default(), false),
        };
        Extraction {
            light,
            mesh: self.mesh(),
            castings: start..castings.len() as u32,
            sides: parts.sides,
            dark_cap: match parts.dark_cap && !z_pass && self.light.w != 0.0 {
                false => DarkCap::None,
                true if fan => DarkCap::Fan,
                true => DarkCap::Triangles,
            },
            // Covered triangles never lie before the visible surface.
            light_cap: match parts.light_cap {
                false => LightCap::None,
                true if z_pass => LightCap::Exposed,
                true => LightCap::Whole,
            },
        }
    }
}

/// Chooses which pairs of a light go to the device. Returns how many layers they have at most, if there are any.
pub(super) fn choose(stage: &Stage<'_>, extractable: &[bool], pairs: &mut [Pair]) -> Option<usize> {
    let perspective = matches!(stage.view().projection, Projection::Perspective { .. });
    let mut candidates = 0;
    for (c, pair) in pairs.iter_mut().enumerate() {
        let placed = &stage.placed[c];
        let whole = placed.source.section.is_none();
        let known = extractable.get(placed.caster as usize).is_some_and(|&can| can);
        let can = perspective && pair.is_active() && whole && known;
        // Which of coincident triangles is visible would have to be known.
        let can = can && stage.topology(c).twins.is_empty();
        pair.on_device = can && pair.is_candidate(stage.steps.silhouettes);
        candidates += usize::from(pair.on_device);
    }
    if candidates == 0 {
        return None;
    }
    let triangles = |c: usize| stage.topology(c).by_part.len();
    let active = pairs.iter().enumerate().filter(|(_, pair)| pair.is_active());
    let most: usize = active.map(|(c, _)| triangles(c)).sum();
    if stage.input.counting == Counting::Raw || most <= SINGLE {
        let mut layers = 0;
        for (c, pair) in pairs.iter_mut().enumerate().filter(|(_, pair)| pair.on_device) {
            pair.extracted.cast(stage.topology(c), pair.mesh(), pair.light);
            layers += triangles(c);
        }
        return Some(layers);
    }
    let unproved = |pair: &Pair| pair.on_device && pair.extracted.proved(pair.mesh(), pair.light).is_none();
    let prove = |c: usize, pair: &mut Pair| {
        if unproved(pair) {
            let topology = stage.topology(c);
            let least = if stage.steps.silhouettes == Silhouettes::Gpu { 0.0 } else { WORTH * pair.step };
            pair.extracted.prove(topology, pair.mesh(), pair.light, LAYERS / candidates, least);
        }
    };
    match pairs.iter().filter(|pair| unproved(pair)).count() {
        0 => {}
        1 => pairs.iter_mut().enumerate().for_each(|(c, pair)| prove(c, pair)),
        _ => parallel::for_each(pairs, prove),
    }
    let mut sum = 0;
    for pair in pairs.iter_mut().filter(|pair| pair.on_device) {
        let layers = pair.extracted.proved(pair.mesh(), pair.light).filter(|layers| sum + layers <= LAYERS);
        pair.on_device = layers.is_some();
        sum += layers.unwrap_or(0);
    }
    pairs.iter().any(|pair| pair.on_device).then_some(sum)
}

/// Whether the fan closes a caster's volume, too.
pub(super) fn may_fan(steps: Steps, caster: &Placed, light: ObjectLight) -> bool {
    steps.fan && caster.is_strictly_outside(light)
}
