//! Whole bodies whose layers are known, by the boxes that they lie in.

use super::cell::{self, Cell};
use super::{Chart, DEPTH, Work};
use glam::{DVec3, DVec4};
use std::ops::Range;

/// A body as seen from the light.
#[derive(Clone, Copy, Debug)]
pub struct Body {
    directions: [DVec3; 8],
    /// How many of its layers a ray from the light can cross.
    layers: usize,
}

impl Body {
    /// A body within the hull of `corners`, of which no ray crosses more than so many layers.
    #[must_use]
    pub fn new(corners: [DVec3; 8], layers: usize, light: DVec4, chart: &Chart) -> Self {
        Self { directions: corners.map(|p| chart.direction(p, light)), layers }
    }

    fn turned(&self, face: usize) -> Self {
        Self { directions: self.directions.map(|h| cell::turn(h, face)), layers: self.layers }
    }
}

/// Whether no ray crosses more than `limit` layers of `bodies` (a "no" may be mistaken, a "yes" never is).
#[must_use]
pub fn are_within(bodies: &[Body], chart: &Chart, limit: usize, work: &mut Work) -> bool {
    if bodies.iter().map(|body| body.layers).sum::<usize>() <= limit {
        return true;
    }
    let mut stack = Vec::new();
    (0..chart.faces()).all(|face| {
        let turned: Vec<Body> = bodies.iter().map(|body| body.turned(face)).collect();
        stack.clear();
        stack.extend((0..turned.len() as u32).filter(|&i| !Cell::FACE.is_beside(&turned[i as usize].directions)));
        let all = 0..stack.len();
        is_within(&turned, &Cell::FACE, &mut stack, all, limit, DEPTH, work)
    })
}

/// `members` of `stack` may overlap `cell`; children's members are pushed above them and popped again.
fn is_within(
    bodies: &[Body],
    cell: &Cell,
    stack: &mut Vec<u32>,
    members: Range<usize>,
    limit: usize,
    depth: u32,
    work: &mut Work,
) -> bool {
    if stack[members.clone()].iter().map(|&i| bodies[i as usize].layers).sum::<usize>() <= limit {
        return true;
    }
    depth > 0
        && work.take(4 * members.len())
        && cell.quarters().iter().all(|child| {
            let start = stack.len();
            for i in members.clone() {
                if !child.is_beside(&bodies[stack[i] as usize].directions) {
                    stack.push(stack[i]);
                }
            }
            let end = stack.len();
            let within = is_within(bodies, child, stack, start..end, limit, depth - 1, work);
            stack.truncate(start);
            within
        })
}
