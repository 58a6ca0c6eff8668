//! The layers of casters from their silhouettes.
//!
//! In: the silhouettes of any number of casters, each a closed chain of edges with its layer on the left, and how many
//! layers lie over one direction. Out: whether there are more than a given number anywhere. The number of layers changes
//! only across silhouettes: within a cell, on the straight way from a direction with a known number, each edge is crossed
//! once at most, and only those raise the number that the direction lies to the right of. What lies within the outlines does
//! not matter: neither how finely a surface is divided nor how many of its triangles meet in one vertex.

use super::cell::{self, Cell, NOISE};
use super::star::Spokes;
use super::{Chart, DEPTH, Sight, Work};
use crate::casting::ObjectLight;
use crate::topology::Topology;
use glam::{DAffine3, DVec3};
use std::ops::Range;

/// An edge of a silhouette as seen from the light.
#[derive(Clone, Copy, Debug)]
pub(super) struct Edge {
    /// Unit vectors; the layers lie to the left of the way from the first to the second.
    pub ends: [DVec3; 2],
    /// Of the plane of the edge and the light, on the left.
    normal: DVec3,
    /// Which vertices they are, different in different casters.
    pub vertices: [u32; 2],
    /// How many layers end here.
    pub times: u32,
}

impl Edge {
    fn turned(&self, face: usize) -> Self {
        let ends = self.ends.map(|h| cell::turn(h, face));
        Self { ends, normal: cell::turn(self.normal, face), ..*self }
    }

    fn may_meet(&self, cell: &Cell) -> bool {
        !cell.is_beside(&self.ends) && !cell.is_apart(self.normal)
    }

    /// How many layers more there may be beyond the edge than at `p`.
    pub fn rise(&self, p: DVec3) -> u32 {
        if self.normal.dot(p) > NOISE { 0 } else { self.times }
    }

    /// By how much the number of layers grows on the straight way from `p` to `q`; in doubt too much.
    fn step(&self, p: DVec3, q: DVec3) -> i64 {
        let [from, to] = [p, q].map(|x| sign(self.normal.dot(x), NOISE));
        if from != 0 && from == to {
            return 0;
        }
        let across = p.cross(q);
        let [a, b] = self.ends.map(|end| sign(across.dot(end), 4.0 * NOISE));
        let times = i64::from(self.times);
        match (from, to, a, b) {
            (_, _, 1, 1) | (_, _, -1, -1) => 0,
            (-1, 1, 1, -1) => times,
            (1, -1, -1, 1) => -times,
            // The way crosses the edge's circle on the other side of the light.
            (-1, 1, -1, 1) | (1, -1, 1, -1) => 0,
            // From the left it cannot grow.
            (1, ..) => 0,
            _ => times,
        }
    }
}

fn sign(x: f64, noise: f64) -> i8 {
    i8::from(x > noise) - i8::from(x < -noise)
}

/// What is needed of a caster.
#[derive(Clone, Copy, Debug)]
pub struct Caster<'a> {
    /// Its mesh.
    pub topology: &'a Topology,
    /// Its weights under the light.
    pub weights: &'a [i8],
    /// Its place.
    pub world_from_object: &'a DAffine3,
    /// The light in its object space.
    pub light: ObjectLight,
}

/// Silhouettes of casters, together.
#[derive(Clone, Debug)]
pub struct Outline {
    chart: Chart,
    edges: Vec<Edge>,
    vertices: u32,
    /// At [`Cell::reference`] of every face.
    layers: Vec<u32>,
}

impl Outline {
    /// Of nothing.
    #[must_use]
    pub fn new(chart: Chart) -> Self {
        Self { layers: vec![0; chart.faces()], chart, edges: Vec::new(), vertices: 0 }
    }

    /// Adds those `triangles` of a caster that have a weight, given their `silhouette`: every edge as often as it has sides,
    /// the same one on end, along the way that triangles with weight 1 run.
    pub fn add(
        &mut self,
        caster: &Caster<'_>,
        silhouette: impl Iterator<Item = [u32; 2]>,
        triangles: impl Iterator<Item = usize>,
    ) {
        let sight = self.chart.sight(caster.world_from_object, caster.light);
        let first = self.edges.len();
        for edge in silhouette {
            let vertices =
                if sight.turn > 0.0 { edge } else { [edge[1], edge[0]] }.map(|v| self.vertices.wrapping_add(v));
            match self.edges[first..].last_mut() {
                Some(last) if last.vertices == vertices => last.times += 1,
                _ => {
                    let ends = edge.map(|v| sight.direction(caster.topology.position(v)));
                    let ends = if sight.turn > 0.0 { ends } else { [ends[1], ends[0]] };
                    self.edges.push(Edge { ends, normal: ends[0].cross(ends[1]), vertices, times: 1 });
                }
            }
        }
        self.vertices = self.vertices.wrapping_add(caster.topology.positions.len() as u32);
        self.count(caster, &sight, triangles);
    }

    /// Counts what lies over the references.
    fn count(&mut self, caster: &Caster<'_>, sight: &Sight, triangles: impl Iterator<Item = usize>) {
        let corners = caster.topology.bounds().corners().map(|p| sight.direction(p));
        let reference = Cell::FACE.reference();
        let under = |face: usize| !Cell::at(reference).is_beside(&corners.map(|h| cell::turn(h, face)));
        let faces: Vec<usize> = (0..self.layers.len()).filter(|&face| under(face)).collect();
        if faces.is_empty() {
            return;
        }
        for t in triangles.filter(|&t| caster.weights[t] != 0) {
            let [a, b, c] = caster.topology.corners(t).map(|p| sight.direction(p));
            let [b, c] = if f64::from(caster.weights[t]) * sight.turn > 0.0 { [b, c] } else { [c, b] };
            let normals = [a.cross(b), b.cross(c), c.cross(a)];
            for &face in &faces {
                // In doubt it counts.
                let within = normals.iter().all(|n| cell::turn(*n, face).dot(reference) >= -NOISE);
                self.layers[face] += u32::from(within);
            }
        }
    }

    /// Whether no ray crosses more than `limit` layers (a "no" may be mistaken, a "yes" never is).
    #[must_use]
    pub fn is_within(&self, limit: usize, work: &mut Work) -> bool {
        let mut search =
            Search { edges: Vec::new(), limit: limit as i64, stack: Vec::new(), spokes: Spokes::default(), work };
        (0..self.chart.faces()).all(|face| {
            search.edges.clear();
            let turned = self.edges.iter().map(|edge| edge.turned(face));
            search.edges.extend(turned.filter(|edge| edge.may_meet(&Cell::FACE)));
            search.stack.clear();
            search.stack.extend(0..search.edges.len() as u32);
            let all = 0..search.stack.len();
            search.work.take(self.edges.len())
                && search.is_within(&Cell::FACE, all, i64::from(self.layers[face]), DEPTH)
        })
    }
}

/// A search on one face.
struct Search<'a> {
    edges: Vec<Edge>,
    limit: i64,
    stack: Vec<u32>,
    spokes: Spokes,
    work: &'a mut Work,
}

impl Search<'_> {
    /// `members` of the stack may meet `cell`, at whose reference there are no more than so many layers; children's members
    /// are pushed above them and popped again.
    fn is_within(&mut self, cell: &Cell, members: Range<usize>, layers: i64, depth: u32) -> bool {
        let p = cell.reference();
        let rises = self.stack[members.clone()].iter().map(|&i| i64::from(self.edges[i as usize].rise(p)));
        if layers + rises.sum::<i64>() <= self.limit {
            return true;
        }
        if layers > self.limit || depth == 0 || !self.work.take(8 * members.len()) {
            return false;
        }
        let here = &self.stack[members.clone()];
        if layers + self.spokes.rise_seen(p, &self.edges, here) <= self.limit
            || layers + self.spokes.rise(cell, p, &self.edges, here) <= self.limit
        {
            return true;
        }
        cell.quarters().iter().all(|child| {
            let (start, q) = (self.stack.len(), child.reference());
            let mut there = layers;
            for i in members.clone() {
                let edge = &self.edges[self.stack[i] as usize];
                there += edge.step(p, q);
                if edge.may_meet(child) {
                    self.stack.push(self.stack[i]);
                }
            }
            let end = self.stack.len();
            let within = self.is_within(child, start..end, there, depth - 1);
            self.stack.truncate(start);
            within
        })
    }
}
