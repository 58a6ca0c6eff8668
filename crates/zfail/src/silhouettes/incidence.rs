//! What the device needs to know of a mesh, whatever its pose and light: incidence as flat arrays.
//!
//! In: a topology. Out: triangles with their parts, edges with their triangles, and how long the lists of a volume may
//! become. Arrays are laid out as `extract.wgsl` reads them.

use zfail_plan::casting::Casting;
use zfail_plan::topology::{Cover, NONE, Topology};

/// Set in triangle references that run from the higher to the lower vertex, and in parts that hide themselves.
const HIGH: u32 = 1 << 31;

/// Incidence of one mesh.
#[derive(Clone, Debug)]
pub(super) struct Incidence {
    /// Three vertices, and the part or [`NONE`].
    pub triangles: Vec<[u32; 4]>,
    /// Two vertices and two triangle references, the second of which may be [`NONE`]; then, from `pairs` on, two vertices
    /// and a range of `fan_triangles`.
    pub edges: Vec<[u32; 4]>,
    /// How many edges have one or two triangles.
    pub pairs: usize,
    pub fan_triangles: Vec<u32>,
    /// Any vertex that casts.
    pub apex: u32,
    /// Casting triangles of each part.
    parts: Vec<u32>,
    /// The most sides, if every part casts from one side only, and if not.
    sides: [u64; 2],
}

/// The most indices that the lists of a volume can have: sides and dark cap, light cap, light cap reversed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Room(pub [u64; 3]);

impl Room {
    /// Indices of all lists.
    pub fn total(self) -> u64 {
        self.0.iter().sum()
    }

    /// Of a mesh with so many triangles, whatever its incidence.
    pub fn most(triangles: u64) -> Self {
        Self::of(3 * triangles, triangles, [triangles; 2])
    }

    fn of(sides: u64, triangles: u64, [lit, reversed]: [u64; 2]) -> Self {
        // With each side goes a triangle of the fan, or else the dark cap has all casting triangles.
        Self([(9 * sides).max(6 * sides + 3 * triangles), 3 * lit, 3 * reversed])
    }
}

impl Incidence {
    pub fn new(topology: &Topology) -> Self {
        let part = |t: usize| match topology.part_of()[t] {
            NONE => NONE,
            part if topology.parts()[part as usize].cover == Cover::Nowhere => part,
            part => part | HIGH,
        };
        let triangle = |(t, &[a, b, c]): (usize, &[u32; 3])| [a, b, c, part(t)];
        let mut incidence = Self {
            triangles: topology.triangles().iter().enumerate().map(triangle).collect(),
            edges: Vec::new(),
            pairs: 0,
            fan_triangles: Vec::new(),
            apex: topology.by_part().first().map_or(0, |&t| topology.triangles()[t as usize][0]),
            parts: topology.parts().iter().map(|part| part.triangles.end - part.triangles.start).collect(),
            sides: [0; 2],
        };
        let mut fans = Vec::new();
        let mut references: Vec<u32> = Vec::new();
        for ([lo, hi], incident) in topology.incidence() {
            references.clear();
            references.extend(incident.iter().map(|(t, o)| t as u32 | if o < 0 { HIGH } else { 0 }));
            let against = references.iter().filter(|&&t| t & HIGH != 0).count();
            incidence.sides[0] += against.max(references.len() - against) as u64;
            incidence.sides[1] += references.len() as u64;
            match references[..] {
                [t] => incidence.edges.push([lo, hi, t, NONE]),
                [t, u] => incidence.edges.push([lo, hi, t, u]),
                _ => {
                    let start = incidence.fan_triangles.len() as u32;
                    incidence.fan_triangles.extend_from_slice(&references);
                    fans.push([lo, hi, start, incidence.fan_triangles.len() as u32]);
                }
            }
        }
        incidence.pairs = incidence.edges.len();
        incidence.edges.extend(fans);
        incidence
    }

    /// Room for any volume of parts that cast as `castings` tell.
    pub fn room(&self, castings: &[Casting]) -> Room {
        let (mut double, mut lit, mut reversed) = (false, 0, 0);
        for (&triangles, casting) in self.parts.iter().zip(castings) {
            double |= *casting == Casting::Double;
            lit += u64::from(if *casting == Casting::Back { 0 } else { triangles });
            reversed += u64::from(if *casting == Casting::Front { 0 } else { triangles });
        }
        let triangles = self.parts.iter().map(|&triangles| u64::from(triangles)).sum();
        Room::of(self.sides[usize::from(double)], triangles, [lit, reversed])
    }
}
