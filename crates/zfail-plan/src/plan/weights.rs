//! The weights of one caster's triangles under one light, turned with the light instead of found anew.

use super::caps;
use super::placed::Source;
use crate::casting::{self, Casting, ObjectLight};
use crate::topology::{NodeFacing, Topology};

/// One integer per triangle.
#[derive(Debug, Default)]
pub(super) struct Weights {
    castings: Vec<Casting>,
    /// Scratch: the next ones.
    next: Vec<Casting>,
    pub by_triangle: Vec<i8>,
    /// How many are not 0.
    pub casting: usize,
    /// How near to the light planar dark caps would come at a distance of 1.
    pub nearest: f64,
    /// How the nodes of a topology's tree face the light, and whose they are.
    states: Vec<NodeFacing>,
    states_of: Option<Source>,
}

impl Weights {
    /// Decides the facing of every triangle; `planar` if dark caps are.
    pub fn weigh(&mut self, topology: &Topology, source: Source, light: ObjectLight, planar: bool) {
        casting::castings(topology, light, &mut self.next);
        std::mem::swap(&mut self.castings, &mut self.next);
        // Planar caps take weights away.
        let tree = topology.cones().filter(|_| !planar);
        match tree {
            Some(tree) if self.states_of == Some(source) && self.castings == self.next => {
                let light = light.as_dvec4();
                tree.turn(topology, &self.castings, light, &mut self.states, &mut self.by_triangle);
            }
            _ => {
                casting::weights(topology, &self.castings, light, &mut self.by_triangle);
                self.states.clear();
                if let Some(tree) = tree {
                    tree.look(light.as_dvec4(), &mut self.states);
                }
                self.states_of = tree.map(|_| source);
            }
        }
        if planar {
            self.nearest = caps::nearest(topology, &mut self.by_triangle, light);
        }
        self.casting = self.by_triangle.iter().filter(|&&c| c != 0).count();
    }

    /// How the nodes of the topology's tree face the light, if it has one and that is known.
    pub fn states(&self) -> Option<&[NodeFacing]> {
        self.states_of.map(|_| &*self.states)
    }
}
