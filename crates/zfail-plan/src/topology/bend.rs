//! Meshes that bend: the same incidence over positions that change.
//!
//! In: new positions of all vertices. Out: the welded ones and their bounds. Who meets whom stays, so that silhouettes of
//! any pose follow from the facing in that pose; whether a part is a simple solid does not, and is never asked.

use super::{Topology, TopologyError, check_finite};
use crate::bounds::Bounds;

/// Where welded positions come from.
#[derive(Clone, Debug)]
pub(super) struct Bend {
    /// Vertices before the weld.
    vertices: usize,
    /// By welded vertex, one of the vertices that it stands for.
    sources: Vec<u32>,
}

impl Bend {
    pub fn new(vertices: usize, sources: Vec<u32>) -> Self {
        Self { vertices, sources }
    }

    pub fn bytes(&self) -> usize {
        size_of_val(&*self.sources)
    }
}

impl Topology {
    /// Moves the vertices of a mesh made by [`Topology::bending`]; `positions` are in the order in which it was made.
    /// Returns whether any has moved.
    ///
    /// # Errors
    /// Another number of positions, coordinates that are not finite, or a rigid mesh. Nothing has moved then.
    pub fn move_vertices(&mut self, positions: &[[f32; 3]]) -> Result<bool, TopologyError> {
        let Some(bend) = &self.bend else { return Err(TopologyError::Rigid) };
        if positions.len() != bend.vertices {
            return Err(TopologyError::WrongLength { vertices: bend.vertices, found: positions.len() });
        }
        check_finite(positions)?;
        let mut moved = false;
        for (welded, &source) in self.positions.iter_mut().zip(&bend.sources) {
            // -0.0 becomes 0.0, as in the weld.
            let position = positions[source as usize].map(|x| x + 0.0);
            moved |= *welded != position;
            *welded = position;
        }
        if moved {
            for part in 0..self.parts.len() {
                let corners = self.triangles_of(part).iter().flat_map(|&t| self.corners(t as usize));
                self.parts[part].bounds = Bounds::of(corners);
            }
            self.bounds = Bounds::of(self.parts.iter().flat_map(|part| [part.bounds.min, part.bounds.max]));
        }
        Ok(moved)
    }
}
