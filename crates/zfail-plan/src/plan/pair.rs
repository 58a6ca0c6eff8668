//! One light and one caster: facing, silhouette and caps, kept while the light stands still in object space.

use super::caps;
use super::extraction::Extracted;
use super::meridians::{self, Crossings, Lines};
use super::near_count::{self, NearCount};
use super::off_screen::Parts;
use super::placed::Placed;
use super::pyramid::Pyramid;
use super::store::Place;
use crate::casting::{self, Casting, ObjectLight};
use crate::light::LightKind;
use crate::scissor::Rectangle;
use crate::stack::{self, Outline};
use crate::topology::{Cover, NONE, Part, Topology};
use crate::view::{Projection, View};
use crate::volume::{self, Volume};
use glam::DAffine3;
use std::collections::BTreeMap;

/// What becomes of a pair this frame.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum Role {
    /// Draws nothing.
    #[default]
    Idle,
    /// Draws some of its parts in some pixels.
    Active {
        within: Rectangle,
        parts: Parts,
        /// Whether the count starts at the near rectangle.
        z_pass: bool,
    },
}

/// The state of one light-caster pair between frames.
#[derive(Debug, Default)]
pub(super) struct Pair {
    pub role: Role,
    /// From which this frame's z-pass starts.
    pub start: NearCount,
    pub light: ObjectLight,
    mesh: u64,
    /// Frames on end in each of which light or mesh were not those of the frame before.
    pub moves: u32,
    /// How far the light has moved in the last of them, object space; infinite for another mesh or kind of light.
    pub step: f64,
    /// Whether the device finds silhouette and caps, so that nothing of them is known here.
    pub on_device: bool,
    pub extracted: Extracted,
    /// Whether `weights` belong to `mesh`, `light` and `finite`.
    weighed: bool,
    castings: Vec<Casting>,
    pub weights: Vec<i8>,
    /// How many triangles have a weight.
    pub casting: usize,
    /// Batch of each casting triangle, parallel to `weights`; empty while everything is in batch 0.
    pub batch_of: Vec<u16>,
    /// Whether `pieces` belong to `weights` and `batch_of`.
    built: bool,
    /// Whether dark caps lie at a finite distance, because the view is orthographic.
    finite: bool,
    /// How near to the light these would come at a distance of 1.
    pub nearest: f64,
    /// The first `live` are in use.
    pieces: Vec<Piece>,
    live: usize,
    masked: Vec<i8>,
    cap: Vec<i8>,
    /// The visible one of each group of coincident triangles for which light caps were built, and scratch.
    visible: Vec<u32>,
    now_visible: Vec<u32>,
    /// For what `crossings` were counted, if they are valid.
    crossed_as: Option<(DAffine3, Lines)>,
    crossings: Crossings,
    /// What is known of the near rectangle, if `near_valid`.
    near: Option<Box<(Pyramid, Option<NearCount>)>>,
    near_valid: bool,
}

/// A closed volume of some of the pair's triangles: those of a batch.
#[derive(Debug, Default)]
pub(super) struct Piece {
    pub batch: u16,
    /// The parts that `volume` has.
    have: Parts,
    pub volume: Volume,
    /// Ends of the light cap's triangles that may be missing from the depth buffer, within its two lists.
    pub exposed: [u32; 2],
    pub indices: Vec<u32>,
    pub place: Place,
    pub fresh: bool,
}

impl Pair {
    /// Points the pair at a light and a caster; `None` if the caster's transform cannot be inverted.
    pub fn aim(&mut self, caster: &Placed, kind: &LightKind) -> Option<()> {
        let light = caster.object_light(kind)?;
        if self.mesh != caster.mesh || self.light != light {
            let comparable = self.mesh == caster.mesh && self.light.w == light.w;
            let step = (light - self.light).truncate().as_dvec3().length();
            self.step = if comparable { step } else { f64::INFINITY };
            self.weighed = false;
            self.moves = self.moves.saturating_add(1);
        } else {
            self.moves = 0;
        }
        if self.mesh != caster.mesh {
            self.now_visible.clear();
        }
        self.mesh = caster.mesh;
        self.light = light;
        Some(())
    }

    /// The mesh, by [`super::Caster::mesh`].
    pub fn mesh(&self) -> u64 {
        self.mesh
    }

    /// Whether the pair draws anything whose index lists are made here.
    pub fn is_planned(&self) -> bool {
        self.role != Role::Idle && !self.on_device
    }

    /// Whether [`Self::weigh`] would have something to do.
    pub fn is_stale(&self, view: &View) -> bool {
        self.is_planned() && !(self.weighed && self.finite == is_finite(view))
    }

    /// Decides the facing of every triangle, unless it is known.
    pub fn weigh(&mut self, topology: &Topology, view: &View) {
        if !self.is_stale(view) {
            return;
        }
        self.finite = is_finite(view);
        casting::castings(topology, self.light, &mut self.castings);
        casting::weights(topology, &self.castings, self.light, &mut self.weights);
        if self.finite {
            self.nearest = caps::nearest(topology, &mut self.weights, self.light);
        }
        self.casting = self.weights.iter().filter(|&&c| c != 0).count();
        self.batch_of.clear();
        self.weighed = true;
        self.unbuild();
    }

    fn unbuild(&mut self) {
        self.built = false;
        self.near_valid = false;
        self.crossed_as = None;
    }

    /// Replaces the division into batches.
    pub fn divide(&mut self, batch_of: impl FnOnce(&mut Vec<u16>)) {
        batch_of(&mut self.batch_of);
        self.unbuild();
    }

    /// Puts everything into one batch.
    pub fn unite(&mut self) {
        if !self.batch_of.is_empty() {
            self.batch_of.clear();
            self.unbuild();
        }
    }

    /// Whether [`Self::build_sides`] has nothing to do.
    pub fn is_built(&self) -> bool {
        self.built || !self.is_planned()
    }

    /// Builds the sides of every batch, unless they are known.
    pub fn build_sides(&mut self, topology: &Topology) {
        if self.is_built() {
            return;
        }
        let converging = is_converging(self.light, self.finite);
        self.live = 0;
        if self.batch_of.is_empty() {
            if self.casting > 0 {
                let indices = self.open_piece(0);
                let mut sides = std::mem::take(indices);
                volume::sides(topology, &self.weights, converging, &mut sides);
                self.close_piece(sides);
            }
        } else {
            // Of a caster among many, few; of a caster alone, perhaps hundreds, so that edges are gone through once.
            let mut silhouettes = BTreeMap::<u16, Vec<([u32; 2], i32)>>::new();
            for (t, &batch) in self.batch_of.iter().enumerate() {
                if self.weights[t] != 0 {
                    silhouettes.entry(batch).or_default();
                }
            }
            let mut sums: Vec<(u16, i32)> = Vec::new();
            for (edge, incident) in topology.incidence() {
                sums.clear();
                for (t, orientation) in incident.iter().filter(|&(t, _)| self.weights[t] != 0) {
                    let (batch, times) = (self.batch_of[t], i32::from(self.weights[t]) * orientation);
                    match sums.iter_mut().find(|sum| sum.0 == batch) {
                        Some(sum) => sum.1 += times,
                        None => sums.push((batch, times)),
                    }
                }
                for &(batch, times) in sums.iter().filter(|sum| sum.1 != 0) {
                    silhouettes.entry(batch).or_default().push((edge, times));
                }
            }
            for (batch, silhouette) in silhouettes {
                let mut sides = std::mem::take(self.open_piece(batch));
                for (edge, times) in silhouette {
                    volume::side(edge, times, converging, &mut sides);
                }
                self.close_piece(sides);
            }
        }
        self.built = true;
    }

    /// Begins the next piece: its index list, empty.
    fn open_piece(&mut self, batch: u16) -> &mut Vec<u32> {
        if self.live == self.pieces.len() {
            self.pieces.push(Piece::default());
        }
        let piece = &mut self.pieces[self.live];
        (piece.batch, piece.fresh) = (batch, true);
        piece.have = Parts { sides: true, ..Parts::default() };
        piece.indices.clear();
        &mut piece.indices
    }

    /// Ends it with its sides.
    fn close_piece(&mut self, sides: Vec<u32>) {
        let piece = &mut self.pieces[self.live];
        let end = sides.len() as u32;
        piece.indices = sides;
        piece.volume = Volume { sides: 0..end, dark_cap: end..end, light_cap: end..end, light_cap_reversed: end..end };
        piece.exposed = [end; 2];
        self.live += 1;
    }

    /// The closed volumes that together are the pair's.
    pub fn pieces(&self) -> &[Piece] {
        &self.pieces[..self.live]
    }

    /// One of [`Self::pieces`].
    pub fn piece_mut(&mut self, p: usize) -> &mut Piece {
        &mut self.pieces[p]
    }

    /// The weights of one batch, alone.
    fn mask(&mut self, batch: u16) {
        let mine = |t: usize| self.batch_of.get(t).is_none_or(|&b| b == batch);
        self.masked.clear();
        self.masked.extend(self.weights.iter().enumerate().map(|(t, &c)| if mine(t) { c } else { 0 }));
    }

    /// The number of layers over the near rectangle, if it is one number.
    pub fn near_count(&mut self, topology: &Topology, pyramid: Pyramid) -> Option<NearCount> {
        let [piece] = self.pieces() else { return None };
        if self.finite || !self.batch_of.is_empty() {
            return None;
        }
        if let Some(known) = self.near.as_ref().filter(|known| self.near_valid && known.0 == pyramid) {
            return known.1;
        }
        let sides = &piece.indices[..piece.volume.sides.end as usize];
        let stride = volume::side_len(is_converging(self.light, self.finite));
        let count = near_count::near_count(topology, &self.weights, sides, stride, &pyramid);
        match &mut self.near {
            Some(near) => **near = (pyramid, count),
            None => self.near = Some(Box::new((pyramid, count))),
        }
        self.near_valid = true;
        count
    }

    /// The caps that this frame draws.
    fn wanted(&self, topology: &Topology) -> Parts {
        let Role::Active { parts, z_pass, .. } = self.role else { return Parts::default() };
        // Counting in front, covered triangles never count, and infinity neither.
        let hidden = z_pass && !self.start.within_solid && topology.parts.iter().all(is_covered);
        Parts { sides: true, dark_cap: parts.dark_cap && !z_pass, light_cap: parts.light_cap && !hidden }
    }

    /// Whether [`Self::build_caps`] may have something to do.
    pub fn lacks_caps(&self, topology: &Topology) -> bool {
        let wanted = self.wanted(topology);
        self.is_planned()
            && (wanted.light_cap && !topology.twins.is_empty()
                || self.pieces().iter().any(|p| p.have.union(wanted) != p.have))
    }

    /// Adds the caps that this frame draws to the sides, unless they are there.
    pub fn build_caps(&mut self, topology: &Topology, view: &View, caster: &Placed, fan: bool) {
        let wanted = self.wanted(topology);
        if wanted.light_cap && !topology.twins.is_empty() {
            volume::visible_twins(topology, caster.object_eye(view), &mut self.now_visible);
        }
        let same_twins = self.visible == self.now_visible;
        self.visible.clone_from(&self.now_visible);
        let outside = self.light.w != 0.0 && caster.is_strictly_outside(self.light);
        let single = self.batch_of.is_empty();
        for p in 0..self.live {
            let piece = &self.pieces[p];
            let needed = piece.have.union(wanted);
            if needed == piece.have && (same_twins || !needed.light_cap) {
                continue;
            }
            if !single {
                let batch = piece.batch;
                self.mask(batch);
            }
            let weights = if single { &self.weights } else { &self.masked };
            let piece = &mut self.pieces[p];
            (piece.have, piece.fresh) = (needed, true);
            let mark = |indices: &Vec<u32>| indices.len() as u32;
            let indices = &mut piece.indices;
            indices.truncate(piece.volume.sides.end as usize);
            if needed.dark_cap && !is_converging(self.light, self.finite) {
                let sides = indices.len() / volume::side_len(false);
                let casting = weights.iter().filter(|&&c| c != 0).count();
                if fan && outside && !self.finite && sides < casting {
                    volume::dark_fan(0..indices.len(), indices);
                } else {
                    volume::dark_cap(topology, weights, indices);
                }
            }
            piece.volume.dark_cap = piece.volume.sides.end..mark(indices);
            let mut ranges = [0..0, 0..0];
            if needed.light_cap {
                volume::cap_weights(topology, weights, &self.visible, &mut self.cap);
                let covered = |t: usize| {
                    let part = topology.part_of[t];
                    part != NONE && is_covered(&topology.parts[part as usize])
                };
                for (i, sign) in [(0, 1), (1, -1)] {
                    let start = mark(indices);
                    volume::light_cap(topology, &self.cap, sign, |t| !covered(t), indices);
                    piece.exposed[i] = mark(indices);
                    volume::light_cap(topology, &self.cap, sign, covered, indices);
                    ranges[i] = start..mark(indices);
                }
            } else {
                ranges = [mark(indices)..mark(indices), mark(indices)..mark(indices)];
                piece.exposed = [mark(indices); 2];
            }
            [piece.volume.light_cap, piece.volume.light_cap_reversed] = ranges;
        }
    }

    /// What a piece draws this frame, as ranges of its own list.
    pub fn drawn(&self, piece: &Piece) -> Volume {
        let Role::Active { parts, z_pass, .. } = self.role else { return Volume::default() };
        let mut drawn = piece.volume.clone();
        if !parts.sides {
            drawn.sides.start = drawn.sides.end;
        }
        if !parts.dark_cap || z_pass {
            drawn.dark_cap = drawn.sides.end..drawn.sides.end;
        }
        if !parts.light_cap {
            drawn.light_cap.end = drawn.light_cap.start;
            drawn.light_cap_reversed.end = drawn.light_cap_reversed.start;
        } else if z_pass && !self.start.within_solid {
            // Covered triangles never lie before the visible surface.
            drawn.light_cap.end = piece.exposed[0];
            drawn.light_cap_reversed.end = piece.exposed[1];
        }
        drawn
    }

    /// How often lines of directions cross the silhouette, coarsely.
    pub fn crossings(&mut self, topology: &Topology, world_from_object: &DAffine3, lines: Lines) -> &Crossings {
        if self.crossed_as != Some((*world_from_object, lines)) {
            let mut crossings = std::mem::take(&mut self.crossings);
            crossings.clear(meridians::COARSE);
            self.count_crossings(topology, world_from_object, lines, &mut crossings);
            self.crossings = crossings;
            self.crossed_as = Some((*world_from_object, lines));
        }
        &self.crossings
    }

    /// Adds how often lines of directions cross the silhouette.
    pub fn count_crossings(
        &self,
        topology: &Topology,
        world_from_object: &DAffine3,
        lines: Lines,
        crossings: &mut Crossings,
    ) {
        crossings.count(topology, &self.weights, self.silhouette(), world_from_object, self.light, lines);
    }

    /// Adds the silhouette of the whole.
    pub fn outline(&self, topology: &Topology, caster: &Placed, outline: &mut Outline) {
        let (weights, world_from_object) = (&self.weights, &caster.world_from_object);
        let caster = stack::Caster { topology, weights, world_from_object, light: self.light };
        outline.add(&caster, self.silhouette(), 0..weights.len());
    }

    /// Edges as often as they have sides, along the way of triangles with weight 1.
    fn silhouette(&self) -> impl Iterator<Item = [u32; 2]> {
        let stride = volume::side_len(is_converging(self.light, self.finite));
        self.pieces().iter().flat_map(move |piece| {
            let sides = &piece.indices[..piece.volume.sides.end as usize];
            sides.chunks_exact(stride).map(|side| [side[1] >> 1, side[0] >> 1])
        })
    }

    /// Whether everything is in one batch, and its sides are built.
    pub fn is_united(&self) -> bool {
        self.built && self.batch_of.is_empty()
    }

    /// One more than the last batch in which the pair draws anything.
    pub fn batches(&self) -> usize {
        match self.role {
            Role::Idle => return 0,
            Role::Active { .. } if self.on_device => return 1,
            Role::Active { .. } => {}
        }
        self.pieces().last().map_or(0, |p| p.batch as usize + 1)
    }
}

/// Whether a part's triangles never lie before the visible surface, seen from outside.
fn is_covered(part: &Part) -> bool {
    part.cover != Cover::Nowhere
}

/// Whether infinity has no area on the image.
fn is_finite(view: &View) -> bool {
    matches!(view.projection, Projection::Orthographic { .. })
}

/// Whether extruded vertices are one point.
fn is_converging(light: ObjectLight, finite: bool) -> bool {
    light.w == 0.0 && !finite
}
