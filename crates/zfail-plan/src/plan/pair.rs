//! One light and one caster: facing, silhouette and caps, kept while the light stands still in object space.

use super::caps::Clusters;
use super::{Caster, Frame};
use crate::casting::{self, Casting, ObjectLight};
use crate::scene::LightKind;
use crate::view::Projection;
use crate::volume::{self, Volume};
use glam::DVec3;

/// The state of one light-caster pair between frames.
#[derive(Debug, Default)]
pub(super) struct Pair {
    pub light_index: usize,
    pub caster: usize,
    pub light: ObjectLight,
    mesh: u64,
    /// Whether `weights` belong to `mesh`, `light` and `planar`.
    weighed: bool,
    castings: Vec<Casting>,
    pub weights: Vec<i8>,
    /// Batch of each casting triangle, parallel to `weights`; empty while everything is in batch 0.
    pub batch_of: Vec<u16>,
    /// Whether `pieces` belong to `weights` and `batch_of`.
    built: bool,
    /// Whether dark caps are planes, because the view is orthographic.
    planar: bool,
    clusters: Clusters,
    pieces: Vec<Piece>,
    masked: Vec<i8>,
    cap: Vec<i8>,
    /// The visible one of each group of coincident triangles for which `pieces` were built, and scratch.
    visible: Vec<u32>,
    now_visible: Vec<u32>,
}

/// A closed volume of some of the pair's triangles.
#[derive(Debug, Default)]
pub(super) struct Piece {
    batch: u16,
    /// Normal of its planar dark cap, object space; `None` for a cap at infinity.
    pub cap: Option<DVec3>,
    pub volume: Volume,
    pub indices: Vec<u32>,
}

impl Pair {
    /// Points the pair at a light and a caster; `None` if the caster's transform cannot be inverted.
    pub fn aim(&mut self, light_index: usize, c: usize, caster: &Caster<'_>, kind: &LightKind) -> Option<()> {
        let light = object_light(caster, kind)?;
        if self.mesh != caster.mesh || self.light != light {
            self.weighed = false;
        }
        if self.mesh != caster.mesh {
            self.now_visible.clear();
        }
        self.mesh = caster.mesh;
        self.light = light;
        self.light_index = light_index;
        self.caster = c;
        Some(())
    }

    /// Decides the facing of every triangle, unless it is known.
    pub fn weigh(&mut self, frame: &Frame<'_>) {
        // Clusters take the weight of triangles that no plane can cap.
        let planar = matches!(frame.view.projection, Projection::Orthographic { .. });
        if self.weighed && self.planar == planar {
            return;
        }
        self.planar = planar;
        let topology = frame.casters[self.caster].topology;
        casting::castings(topology, self.light, &mut self.castings);
        casting::weights(topology, &self.castings, self.light, &mut self.weights);
        self.batch_of.clear();
        self.weighed = true;
        self.built = false;
    }

    /// Replaces the division into batches.
    pub fn divide(&mut self, batch_of: impl FnOnce(&mut Vec<u16>)) {
        batch_of(&mut self.batch_of);
        self.built = false;
    }

    /// Puts everything into one batch.
    pub fn unite(&mut self) {
        if !self.batch_of.is_empty() {
            self.batch_of.clear();
            self.built = false;
        }
    }

    /// Builds the volume of every batch (and every planar cap), unless they are known.
    pub fn build(&mut self, frame: &Frame<'_>) {
        let caster = &frame.casters[self.caster];
        let topology = caster.topology;
        if !topology.twins.is_empty() {
            let object_from_world = caster.world_from_object.inverse();
            let eye = match frame.view.projection {
                Projection::Perspective { .. } => object_from_world.transform_point3(frame.view.eye()).extend(1.0),
                Projection::Orthographic { .. } => {
                    object_from_world.transform_vector3(frame.view.world_from_view.matrix3.z_axis).extend(0.0)
                }
            };
            volume::visible_twins(topology, eye, &mut self.now_visible);
        }
        if self.built && self.visible == self.now_visible {
            return;
        }
        self.visible.clone_from(&self.now_visible);
        self.clusters.clear();
        if self.planar {
            self.clusters.fill(topology, &mut self.weights, self.light);
        }
        let batches = self.batch_of.iter().copied().max().unwrap_or(0);
        let caps = self.clusters.normals.len().max(1) as u16;
        let mut used = 0;
        for (batch, cap) in (0..=batches).flat_map(|batch| (0..caps).map(move |cap| (batch, cap))) {
            let mine = |t: usize| {
                self.batch_of.get(t).is_none_or(|&b| b == batch) && self.clusters.of.get(t).is_none_or(|&c| c == cap)
            };
            self.masked.clear();
            self.masked.extend(self.weights.iter().enumerate().map(|(t, &c)| if mine(t) { c } else { 0 }));
            if self.masked.iter().all(|&c| c == 0) {
                continue;
            }
            if used == self.pieces.len() {
                self.pieces.push(Piece::default());
            }
            volume::cap_weights(topology, &self.masked, &self.visible, &mut self.cap);
            let piece = &mut self.pieces[used];
            piece.batch = batch;
            piece.cap = self.clusters.normals.get(usize::from(cap)).copied();
            piece.indices.clear();
            let converging = self.light.w == 0.0 && !self.planar;
            piece.volume = volume::build(topology, &self.masked, &self.cap, converging, &mut piece.indices);
            used += 1;
        }
        self.pieces.truncate(used);
        self.built = true;
    }

    /// One more than the last batch in which the pair draws anything.
    pub fn batches(&self) -> usize {
        self.pieces.last().map_or(0, |p| p.batch as usize + 1)
    }

    /// What the pair draws in `batch`.
    pub fn pieces(&self, batch: usize) -> impl Iterator<Item = &Piece> {
        self.pieces.iter().filter(move |p| p.batch as usize == batch)
    }
}

/// The light in the caster's object space, computed in f64 and rounded once.
fn object_light(caster: &Caster<'_>, kind: &LightKind) -> Option<ObjectLight> {
    let light = kind.homogeneous();
    let object_from_world = caster.world_from_object.matrix3.inverse();
    let to_object = object_from_world * (light.truncate() - caster.world_from_object.translation * light.w);
    // Only the direction of a directional light matters; its length must not overflow f32.
    let to_object = if light.w == 0.0 { to_object.try_normalize()? } else { to_object };
    let rounded = to_object.extend(light.w).as_vec4();
    rounded.is_finite().then_some(rounded)
}
