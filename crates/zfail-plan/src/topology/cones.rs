//! Facing by the cone: which groups of triangles a light sees from one side, all of them.
//!
//! In: a rigid mesh. Out: a tree over its triangles, of whose nodes each knows a ball around its triangles and a cone around their
//! normals. Where the ball and the cone say that all of a node's triangles face the light, or none, no triangle of it is
//! looked at, nor any edge between two of them: a silhouette passes only through the other nodes, so finding it under a light
//! that moves costs what the silhouette is long, and not what the mesh is large. McGuire et al. 2003, section 4, cite Barequet et
//! al. for the same; cones of normals are of Shirman & Abi-Ezzi 1993, "The Cone of Normals Technique".
//!
//! The answers are those of looking at every triangle: what a cone decides, it decides by more than rounding.

use super::{Edge, NONE, Topology, orientation};
use crate::bounds::Bounds;
use crate::casting::{self, Casting};
use glam::{DVec3, DVec4};
use std::ops::Range;

/// Triangles of which one may as well look at each.
const LEAF: usize = 32;
/// Triangles below which looking at all of them is as fast.
const SMALL: usize = 1024;
/// By how much a cone has to clear the light's horizon; far above the rounding of f64, also for normals of slivers.
const CLEAR: f64 = 1e-8;
/// The least sine of an angle of a triangle that has a normal to rely on.
const SLIVER: f64 = 1e-6;

/// How a node's triangles face a light: +1 or -1 all of them, 0 some this way and some that.
pub type NodeFacing = i8;

/// A tree over a mesh's casting triangles; parents come before children.
#[derive(Clone, Debug)]
pub struct ConeTree {
    nodes: Vec<Node>,
    /// Triangles in the order of the nodes.
    order: Vec<u32>,
    /// So many edges, the first, are no business of the tree: not between two triangles that traverse them either way.
    odd: u32,
}

#[derive(Clone, Debug)]
struct Node {
    /// Around its triangles.
    center: DVec3,
    radius: f64,
    /// Around their normals; as wide as there is if the half angle has no cosine above 0.
    axis: DVec3,
    sin: f64,
    cos: f64,
    /// Range of the tree's order.
    triangles: Range<u32>,
    /// Range of the mesh's edges: those between its children's triangles, or between its own.
    edges: Range<u32>,
    /// One past its last descendant.
    end: u32,
    /// The second child; the first follows its parent. Leaves have none.
    upper: Option<u32>,
}

impl Node {
    /// How all of the node's triangles face the homogeneous `light`; 0 if they may differ.
    fn facing(&self, light: DVec4) -> NodeFacing {
        let way = light.truncate() - self.center * light.w;
        let distance = way.length();
        // Of the angle by which the way to the light turns within the ball.
        let sin = self.radius * light.w / distance;
        if !(sin < 1.0 && self.cos > 0.0) {
            return 0;
        }
        let cos = (1.0 - sin * sin).sqrt();
        if self.cos * cos - self.sin * sin <= 0.0 {
            return 0;
        }
        let horizon = (self.sin * cos + self.cos * sin + CLEAR) * distance;
        let height = self.axis.dot(way);
        NodeFacing::from(height > horizon) - NodeFacing::from(height < -horizon)
    }
}

impl ConeTree {
    /// The tree of a rigid `topology`, whose edges are put into the order of its nodes; `None` if it is small.
    pub(super) fn new(topology: &mut Topology) -> Option<Self> {
        if topology.by_part.len() < SMALL {
            return None;
        }
        let mut leaves: Vec<(u32, DVec3)> = topology
            .by_part
            .iter()
            .map(|&t| {
                let [a, b, c] = topology.corners(t as usize);
                (t, (a + b + c) / 3.0)
            })
            .collect();
        let mut tree = Self { nodes: Vec::new(), order: Vec::new(), odd: 0 };
        tree.divide(topology, &mut leaves);
        tree.sort_edges(topology);
        Some(tree)
    }

    /// Appends the nodes over some triangles; returns their bounds.
    fn divide(&mut self, topology: &Topology, leaves: &mut [(u32, DVec3)]) -> Bounds {
        let n = self.nodes.len();
        let start = self.order.len() as u32;
        self.nodes.push(Node {
            center: DVec3::ZERO,
            radius: 0.0,
            axis: DVec3::Z,
            sin: 1.0,
            cos: 0.0,
            triangles: start..start,
            edges: 0..0,
            end: 0,
            upper: None,
        });
        let (bounds, (axis, half_angle)) = if leaves.len() <= LEAF {
            self.order.extend(leaves.iter().map(|leaf| leaf.0));
            let triangles = || leaves.iter().map(|leaf| topology.corners(leaf.0 as usize));
            (Bounds::of(triangles().flatten()), cone(triangles().map(normal)))
        } else {
            let half = Bounds::of(leaves.iter().map(|leaf| leaf.1)).half();
            let axis = (0..3).fold(0, |longest, axis| if half[axis] > half[longest] { axis } else { longest });
            let middle = leaves.len() / 2;
            leaves.select_nth_unstable_by(middle, |a, b| a.1[axis].total_cmp(&b.1[axis]).then(a.0.cmp(&b.0)));
            let (lower, upper) = leaves.split_at_mut(middle);
            let lower = self.divide(topology, lower);
            let second = self.nodes.len();
            self.nodes[n].upper = Some(second as u32);
            let upper = self.divide(topology, upper);
            let cones = [n + 1, second].map(|child| (self.nodes[child].axis, self.nodes[child].cos.acos()));
            (Bounds::of([lower.min, lower.max, upper.min, upper.max]), around(cones))
        };
        let end = self.nodes.len() as u32;
        let node = &mut self.nodes[n];
        (node.center, node.radius) = (bounds.center(), bounds.half().length());
        node.axis = axis;
        (node.sin, node.cos) = half_angle.sin_cos();
        node.triangles.end = self.order.len() as u32;
        node.end = end;
        bounds
    }

    /// Puts the edges that this tree knows behind the others, each to the least node that has both of its triangles.
    fn sort_edges(&mut self, topology: &mut Topology) {
        let mut place = vec![NONE; topology.triangles.len()];
        for (i, &t) in (0..).zip(&self.order) {
            place[t as usize] = i;
        }
        let mut keyed: Vec<(u32, Edge)> = topology
            .edges
            .iter()
            .map(|&edge| {
                let [t, u] = edge.triangles;
                let balanced = u != NONE && orientation(t) + orientation(u) == 0;
                let node = || {
                    let [p, q] = edge.triangles.map(|reference| place[(reference & !super::REVERSED) as usize]);
                    self.least(p.min(q)..p.max(q) + 1) + 1
                };
                (if balanced { node() } else { 0 }, edge)
            })
            .collect();
        keyed.sort_by_key(|&(node, edge)| (node, edge.vertices));
        self.odd = keyed.partition_point(|entry| entry.0 == 0) as u32;
        let mut start = self.odd as usize;
        for (n, node) in self.nodes.iter_mut().enumerate() {
            let end = start + keyed[start..].partition_point(|entry| entry.0 as usize == n + 1);
            node.edges = start as u32..end as u32;
            start = end;
        }
        topology.edges = keyed.into_iter().map(|entry| entry.1).collect();
    }

    /// The least node with these places of the order.
    fn least(&self, places: Range<u32>) -> u32 {
        let mut n = 0;
        while let Some(upper) = self.nodes[n as usize].upper {
            let middle = self.nodes[upper as usize].triangles.start;
            if places.end <= middle {
                n += 1;
            } else if places.start >= middle {
                n = upper;
            } else {
                break;
            }
        }
        n
    }

    /// How every node faces the homogeneous `light`, into `states`.
    pub(crate) fn look(&self, light: DVec4, states: &mut Vec<NodeFacing>) {
        states.clear();
        states.resize(self.nodes.len(), 0);
        let mut n = 0;
        while let Some(node) = self.nodes.get(n) {
            let facing = node.facing(light);
            let end = if facing == 0 { n + 1 } else { node.end as usize };
            states[n..end].fill(facing);
            n = end;
        }
    }

    /// Turns weights of one light into those of another, of which parts cast from the same sides: looks only at triangles
    /// where the cones leave it open, or have changed their mind.
    pub(crate) fn turn(
        &self,
        topology: &Topology,
        castings: &[Casting],
        light: DVec4,
        states: &mut [NodeFacing],
        weights: &mut [i8],
    ) {
        let weight = |t: usize, facing: i8| castings[topology.part_of[t] as usize].weight(facing);
        let mut n = 0;
        while let Some(node) = self.nodes.get(n) {
            let facing = node.facing(light);
            let triangles = &self.order[node.triangles.start as usize..node.triangles.end as usize];
            if facing != 0 {
                let subtree = &mut states[n..node.end as usize];
                if subtree[0] != facing {
                    subtree.fill(facing);
                    triangles.iter().for_each(|&t| weights[t as usize] = weight(t as usize, facing));
                }
                n = node.end as usize;
                continue;
            }
            states[n] = 0;
            if node.upper.is_none() {
                for t in triangles.iter().map(|&t| t as usize) {
                    weights[t] = weight(t, casting::facing(topology.corners(t), light));
                }
            }
            n += 1;
        }
    }

    /// Calls `each` for every edge that may not be balanced under the weights to which `states` belong.
    pub(super) fn open_edges(&self, states: &[NodeFacing], edges: &[Edge], mut each: impl FnMut(&Edge)) {
        edges[..self.odd as usize].iter().for_each(&mut each);
        let mut n = 0;
        while let Some(node) = self.nodes.get(n) {
            if states[n] == 0 {
                edges[node.edges.start as usize..node.edges.end as usize].iter().for_each(&mut each);
                n += 1;
            } else {
                n = node.end as usize;
            }
        }
    }

    /// Bytes held, for memory reports.
    pub(super) fn bytes(&self) -> usize {
        size_of_val(&*self.nodes) + size_of_val(&*self.order)
    }
}

/// The unit normal of a triangle, if it is no sliver.
fn normal([a, b, c]: [DVec3; 3]) -> Option<DVec3> {
    let (p, q, r) = (b - a, c - b, a - c);
    let normal = p.cross(q);
    let mut sides = [p.length_squared(), q.length_squared(), r.length_squared()];
    sides.sort_by(f64::total_cmp);
    // Twice the area is the sine of the least angle times the two longest sides.
    let reliable = normal.length_squared() > SLIVER * SLIVER * sides[1] * sides[2];
    if reliable { normal.try_normalize() } else { None }
}

/// Half the angle of a cone that excludes nothing.
const WIDE: f64 = std::f64::consts::FRAC_PI_2;

/// A cone around directions: its axis, and half its angle.
fn cone(normals: impl Iterator<Item = Option<DVec3>> + Clone) -> (DVec3, f64) {
    let sum = normals.clone().map(|n| n.unwrap_or(DVec3::NAN)).sum::<DVec3>();
    let Some(axis) = sum.try_normalize() else { return (DVec3::Z, WIDE) };
    let least = normals.map(|n| n.map_or(-1.0, |n| n.dot(axis))).fold(1.0, f64::min);
    (axis, least.clamp(0.0, 1.0).acos())
}

/// A cone around two.
fn around([(a, p), (b, q)]: [(DVec3, f64); 2]) -> (DVec3, f64) {
    match (a + b).try_normalize() {
        Some(axis) if p < WIDE && q < WIDE => {
            let reach = |other: DVec3, half: f64| axis.dot(other).clamp(-1.0, 1.0).acos() + half;
            (axis, reach(a, p).max(reach(b, q)).min(WIDE))
        }
        _ => (DVec3::Z, WIDE),
    }
}

#[cfg(test)]
mod tests;
