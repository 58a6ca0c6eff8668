//! One light and one caster: facing and silhouette, kept while the light stands still in object space.

use super::Culled;
use super::extraction::Extracted;
use super::kept::Kept;
use super::meridians::{self, Crossings, Lines};
use super::near_count::{self, NearCount};
use super::off_screen::Parts;
use super::pieces::{Piece, Pieces};
use super::placed::{Placed, Source};
use super::pyramid::Pyramid;
use super::weights::Weights;
use crate::casting::ObjectLight;
use crate::light::LightKind;
use crate::scissor::Rectangle;
use crate::stack::{self, Outline};
use crate::topology::Topology;
use crate::view::{Projection, View};
use crate::volume;
use glam::DAffine3;

/// What becomes of a pair this frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Role {
    /// Draws nothing, for a reason.
    Culled(Culled),
    /// Draws some of its parts in some pixels.
    Active {
        within: Rectangle,
        parts: Parts,
        /// Whether the count starts at the near rectangle.
        z_pass: bool,
    },
}

impl Default for Role {
    fn default() -> Self {
        Self::Culled(Culled::Empty)
    }
}

/// The state of one light-caster pair between frames.
#[derive(Debug, Default)]
pub(super) struct Pair {
    pub role: Role,
    /// From which this frame's z-pass starts.
    pub start: NearCount,
    pub light: ObjectLight,
    source: Source,
    /// Frames on end in each of which light or mesh were not those of the frame before.
    pub moves: u32,
    /// How far the light has moved in the last of them, object space; infinite for another mesh or kind of light.
    pub step: f64,
    /// Whether the device finds silhouette and caps, so that nothing of them is known here.
    pub on_device: bool,
    pub extracted: Extracted,
    weighed: Kept<Facing, Weights>,
    /// Batch of each triangle, parallel to the weights; empty while everything is in batch 0.
    pub batch_of: Vec<u16>,
    /// Another number for every change of weights or batches.
    division: Division,
    pub(super) pieces: Kept<Division, Pieces>,
    crossings: Kept<(Division, DAffine3, Lines), Crossings>,
    /// What is known of the near rectangle.
    near: Option<Box<KnownNear>>,
}

/// The number of layers over a near rectangle, if it is one number.
type KnownNear = Kept<(Division, Pyramid), Option<NearCount>>;

/// What weights depend on: mesh, light, and whether dark caps are planar.
type Facing = (Source, ObjectLight, bool);

/// Tells divisions of a pair's triangles apart.
pub(super) type Division = u64;

impl Pair {
    /// Points the pair at a light and a caster; `None` if the caster's transform cannot be inverted.
    pub fn aim(&mut self, caster: &Placed, kind: &LightKind) -> Option<()> {
        let light = caster.object_light(kind)?;
        if self.source != caster.source || self.light != light {
            let comparable = self.source == caster.source && self.light.w == light.w;
            let step = (light - self.light).truncate().as_dvec3().length();
            self.step = if comparable { step } else { f64::INFINITY };
            self.moves = self.moves.saturating_add(1);
        } else {
            self.moves = 0;
        }
        if self.source != caster.source {
            self.pieces.value_mut().forget_twins();
        }
        self.source = caster.source;
        self.light = light;
        Some(())
    }

    /// The mesh, by [`super::Caster::mesh`].
    pub fn mesh(&self) -> u64 {
        self.source.mesh
    }

    /// Whether it draws anything.
    pub fn is_active(&self) -> bool {
        matches!(self.role, Role::Active { .. })
    }

    /// Whether the pair draws anything whose index lists are made here.
    pub fn is_planned(&self) -> bool {
        self.is_active() && !self.on_device
    }

    fn facing(&self, view: &View) -> Facing {
        (self.source, self.light, has_planar_caps(view))
    }

    /// Whether [`Self::weigh`] would have something to do.
    pub fn is_stale(&self, view: &View) -> bool {
        self.is_planned() && !self.weighed.is_for(&self.facing(view))
    }

    /// Decides the facing of every triangle, unless it is known.
    pub fn weigh(&mut self, topology: &Topology, view: &View) {
        if !self.is_stale(view) {
            return;
        }
        let facing @ (source, light, planar) = self.facing(view);
        self.weighed.get(facing, |weights| weights.weigh(topology, source, light, planar));
        self.batch_of.clear();
        self.division += 1;
    }

    /// The weight of each triangle.
    pub fn weights(&self) -> &[i8] {
        &self.weighed.value().by_triangle
    }

    /// How many triangles have a weight.
    pub fn casting(&self) -> usize {
        self.weighed.value().casting
    }

    /// How near to the light planar dark caps would come at a distance of 1.
    pub fn nearest(&self) -> f64 {
        self.weighed.value().nearest
    }

    /// Replaces the division into batches.
    pub fn divide(&mut self, batch_of: impl FnOnce(&mut Vec<u16>)) {
        batch_of(&mut self.batch_of);
        self.division += 1;
    }

    /// Puts everything into one batch.
    pub fn unite(&mut self) {
        if !self.batch_of.is_empty() {
            self.divide(Vec::clear);
        }
    }

    /// Whether [`Self::build_sides`] has nothing to do.
    pub fn is_built(&self) -> bool {
        self.pieces.is_for(&self.division) || !self.is_planned()
    }

    /// Whether everything is in one batch, and its sides are built.
    pub fn is_united(&self) -> bool {
        self.pieces.is_for(&self.division) && self.batch_of.is_empty()
    }

    /// Builds the sides of every batch, unless they are known.
    pub fn build_sides(&mut self, topology: &Topology) {
        if !self.is_planned() {
            return;
        }
        let converging = self.is_converging();
        let Self { weighed, batch_of, pieces, division, .. } = self;
        let weights = weighed.value();
        pieces.get(*division, |pieces| pieces.build_sides(topology, weights, batch_of, converging));
    }

    /// The closed volumes that together are the pair's.
    pub fn pieces(&self) -> &[Piece] {
        self.pieces.value().all()
    }

    /// Whether extruded vertices are one point.
    pub fn is_converging(&self) -> bool {
        self.light.w == 0.0 && !self.is_planar()
    }

    /// Whether dark caps lie at a finite distance.
    fn is_planar(&self) -> bool {
        self.weighed.is_for(&(self.source, self.light, true))
    }

    /// Adds the caps that this frame draws to the sides, unless they are there.
    pub fn build_caps(&mut self, topology: &Topology, view: &View, caster: &Placed, fan: bool) {
        let wanted = self.wanted(topology);
        let outside = self.light.w != 0.0 && caster.is_strictly_outside(self.light);
        let fan = fan && outside && !self.is_planar();
        let dark_caps = !self.is_converging();
        let Self { weighed, batch_of, pieces, .. } = self;
        let eye = caster.object_eye(view);
        let weights = &weighed.value().by_triangle;
        pieces.value_mut().build_caps(topology, weights, batch_of, eye, wanted, dark_caps.then_some(fan));
    }

    /// The number of layers over the near rectangle, if it is one number.
    pub fn near_count(&mut self, topology: &Topology, pyramid: Pyramid) -> Option<NearCount> {
        if self.pieces().len() != 1 || self.is_planar() || !self.batch_of.is_empty() {
            return None;
        }
        let stride = volume::side_len(self.is_converging());
        let mut near = self.near.take().unwrap_or_default();
        let count = *near.get((self.division, pyramid), |count| {
            *count = near_count::near_count(topology, self.weights(), self.pieces()[0].sides(), stride, &pyramid);
        });
        self.near = Some(near);
        count
    }

    /// How often lines of directions cross the silhouette, coarsely.
    pub fn crossings(&mut self, topology: &Topology, world_from_object: &DAffine3, lines: Lines) -> &Crossings {
        let mut kept = std::mem::take(&mut self.crossings);
        kept.get((self.division, *world_from_object, lines), |crossings| {
            crossings.clear(meridians::COARSE);
            self.count_crossings(topology, world_from_object, lines, crossings);
        });
        self.crossings = kept;
        self.crossings.value()
    }

    /// Adds how often lines of directions cross the silhouette.
    pub fn count_crossings(
        &self,
        topology: &Topology,
        world_from_object: &DAffine3,
        lines: Lines,
        crossings: &mut Crossings,
    ) {
        crossings.count(topology, self.weights(), self.silhouette(), world_from_object, self.light, lines);
    }

    /// Adds the silhouette of the whole.
    pub fn outline(&self, topology: &Topology, caster: &Placed, outline: &mut Outline) {
        let (weights, world_from_object) = (self.weights(), &caster.world_from_object);
        let caster = stack::Caster { topology, weights, world_from_object, light: self.light };
        outline.add(&caster, self.silhouette(), 0..weights.len());
    }

    /// Edges as often as they have sides, along the way of triangles with weight 1.
    fn silhouette(&self) -> impl Iterator<Item = [u32; 2]> {
        let stride = volume::side_len(self.is_converging());
        let sides = self.pieces().iter().flat_map(move |piece| piece.sides().chunks_exact(stride));
        sides.map(|side| [side[1] >> 1, side[0] >> 1])
    }

    /// One more than the last batch in which the pair draws anything.
    pub fn batches(&self) -> usize {
        match self.role {
            Role::Culled(_) => return 0,
            Role::Active { .. } if self.on_device => return 1,
            Role::Active { .. } => {}
        }
        self.pieces().last().map_or(0, |p| p.batch as usize + 1)
    }
}

/// Whether infinity has no area on the image, so that dark caps lie at a finite distance.
fn has_planar_caps(view: &View) -> bool {
    matches!(view.projection, Projection::Orthographic { .. })
}
