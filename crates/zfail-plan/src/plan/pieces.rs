//! A pair's volume as index lists: closed pieces, one for each batch.
//!
//! In: weights, batches, and which caps a frame draws. Out: sides, dark caps and light caps by piece, kept while weights and
//! batches are the same; caps are added once a frame wants them.

use super::off_screen::Parts;
use super::pair::{Pair, Role};
use super::store::Place;
use super::weights::Weights;
use crate::topology::{Cover, NONE, Part, Topology};
use crate::volume::{self, Volume};
use glam::DVec4;
use std::collections::BTreeMap;

/// A closed volume of some of the pair's triangles: those of a batch.
#[derive(Debug, Default)]
pub(super) struct Piece {
    pub batch: u16,
    /// The parts that `volume` has.
    have: Parts,
    volume: Volume,
    /// Ends of the light cap's triangles that may be missing from the depth buffer, within its two lists.
    exposed: [u32; 2],
    pub indices: Vec<u32>,
    pub place: Place,
    pub fresh: bool,
}

/// All pieces of a pair, and memory for making them.
#[derive(Debug, Default)]
pub(super) struct Pieces {
    /// The first `live` are in use.
    list: Vec<Piece>,
    live: usize,
    masked: Vec<i8>,
    cap: Vec<i8>,
    /// The visible one of each group of coincident triangles for which light caps were built, and scratch.
    visible: Vec<u32>,
    now_visible: Vec<u32>,
}

impl Pieces {
    /// Those in use.
    pub fn all(&self) -> &[Piece] {
        &self.list[..self.live]
    }

    /// One of them.
    pub fn piece_mut(&mut self, p: usize) -> &mut Piece {
        &mut self.list[p]
    }

    /// Forgets which of coincident triangles were visible: the mesh is another.
    pub fn forget_twins(&mut self) {
        self.now_visible.clear();
    }

    /// Makes pieces with their sides and nothing else; `converging` if extruded vertices are one point.
    pub fn build_sides(&mut self, topology: &Topology, weights: &Weights, batch_of: &[u16], converging: bool) {
        self.live = 0;
        if batch_of.is_empty() {
            if weights.casting > 0 {
                let (states, weights) = (weights.states(), &weights.by_triangle);
                let silhouette = volume::sides_where_facing_turns;
                self.add(0, |sides| silhouette(topology, weights, states, converging, sides));
            }
            return;
        }
        let weights = &weights.by_triangle;
        for (batch, silhouette) in silhouettes(topology, weights, batch_of) {
            self.add(batch, |sides| {
                for (edge, times) in silhouette {
                    volume::side(edge, times, converging, sides);
                }
            });
        }
    }

    /// Adds a piece with the sides that `fill` makes.
    fn add(&mut self, batch: u16, fill: impl FnOnce(&mut Vec<u32>)) {
        if self.live == self.list.len() {
            self.list.push(Piece::default());
        }
        let piece = &mut self.list[self.live];
        self.live += 1;
        (piece.batch, piece.fresh) = (batch, true);
        piece.have = Parts { sides: true, ..Parts::default() };
        piece.indices.clear();
        fill(&mut piece.indices);
        let end = piece.indices.len() as u32;
        piece.volume = Volume { sides: 0..end, dark_cap: end..end, light_cap: end..end, light_cap_reversed: end..end };
        piece.exposed = [end; 2];
    }

    /// Adds the `wanted` caps to the sides, unless they are there. `eye` is homogeneous, object space; `dark_caps` says whether
    /// fans may close volumes, `None` that they close by themselves.
    pub fn build_caps(
        &mut self,
        topology: &Topology,
        weights: &[i8],
        batch_of: &[u16],
        eye: DVec4,
        wanted: Parts,
        dark_caps: Option<bool>,
    ) {
        if wanted.light_cap && !topology.twins.is_empty() {
            volume::visible_twins(topology, eye, &mut self.now_visible);
        }
        let same_twins = self.visible == self.now_visible;
        self.visible.clone_from(&self.now_visible);
        for piece in &mut self.list[..self.live] {
            let needed = piece.have.union(wanted);
            if needed == piece.have && (same_twins || !needed.light_cap) {
                continue;
            }
            let weights = if batch_of.is_empty() {
                weights
            } else {
                let of_batch = |(&weight, &batch): (&i8, &u16)| if batch == piece.batch { weight } else { 0 };
                self.masked.clear();
                self.masked.extend(weights.iter().zip(batch_of).map(of_batch));
                &self.masked
            };
            (piece.have, piece.fresh) = (needed, true);
            piece.indices.truncate(piece.volume.sides.end as usize);
            piece.add_dark_cap(topology, weights, dark_caps.filter(|_| needed.dark_cap));
            if needed.light_cap {
                volume::cap_weights(topology, weights, &self.visible, &mut self.cap);
            } else {
                self.cap.clear();
            }
            piece.add_light_caps(topology, &self.cap);
        }
    }
}

impl Piece {
    /// The index list of the sides.
    pub fn sides(&self) -> &[u32] {
        &self.indices[..self.volume.sides.end as usize]
    }

    fn end(&self) -> u32 {
        self.indices.len() as u32
    }

    /// Closes the volume at infinity, by a fan if that is allowed and smaller; not at all for `None`.
    fn add_dark_cap(&mut self, topology: &Topology, weights: &[i8], fan: Option<bool>) {
        if let Some(fan) = fan {
            let sides = self.indices.len() / volume::side_len(false);
            let casting = weights.iter().filter(|&&c| c != 0).count();
            if fan && sides < casting {
                volume::dark_fan(0..self.indices.len(), &mut self.indices);
            } else {
                volume::dark_cap(topology, weights, &mut self.indices);
            }
        }
        self.volume.dark_cap = self.volume.sides.end..self.end();
    }

    /// Adds the casting triangles in place, those that may be missing from the depth buffer first; none without weights.
    fn add_light_caps(&mut self, topology: &Topology, weights: &[i8]) {
        let covered = |t: usize| {
            let part = topology.part_of[t];
            part != NONE && is_covered(&topology.parts[part as usize])
        };
        let mut ranges = [0..0, 0..0];
        for (i, sign) in [(0, 1), (1, -1)] {
            let start = self.end();
            volume::light_cap(topology, weights, sign, |t| !covered(t), &mut self.indices);
            self.exposed[i] = self.end();
            volume::light_cap(topology, weights, sign, covered, &mut self.indices);
            ranges[i] = start..self.end();
        }
        [self.volume.light_cap, self.volume.light_cap_reversed] = ranges;
    }
}

impl Pair {
    /// The caps that this frame draws.
    pub fn wanted(&self, topology: &Topology) -> Parts {
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
}

/// The silhouette of every batch. Of a caster among many, there are few; of a caster alone, perhaps hundreds, so that edges are
/// gone through once.
fn silhouettes(topology: &Topology, weights: &[i8], batch_of: &[u16]) -> BTreeMap<u16, Vec<([u32; 2], i32)>> {
    let mut silhouettes = BTreeMap::<u16, Vec<([u32; 2], i32)>>::new();
    for (t, &batch) in batch_of.iter().enumerate() {
        if weights[t] != 0 {
            silhouettes.entry(batch).or_default();
        }
    }
    let mut sums: Vec<(u16, i32)> = Vec::new();
    for (edge, incident) in topology.incidence() {
        sums.clear();
        for (t, orientation) in incident.iter().filter(|&(t, _)| weights[t] != 0) {
            let (batch, times) = (batch_of[t], i32::from(weights[t]) * orientation);
            match sums.iter_mut().find(|sum| sum.0 == batch) {
                Some(sum) => sum.1 += times,
                None => sums.push((batch, times)),
            }
        }
        for &(batch, times) in sums.iter().filter(|sum| sum.1 != 0) {
            silhouettes.entry(batch).or_default().push((edge, times));
        }
    }
    silhouettes
}

/// Whether a part's triangles never lie before the visible surface, seen from outside.
fn is_covered(part: &Part) -> bool {
    part.cover != Cover::Nowhere
}
