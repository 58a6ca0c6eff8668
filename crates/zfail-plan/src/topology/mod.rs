//! Topology of any triangle mesh: exact-position weld, incidence per undirected edge, connected parts.
//!
//! In: positions and triangles as they are rendered. Out: what silhouettes need, independent of any light and pose:
//! for every edge the triangles that meet there and the direction in which each traverses it. Nothing is assumed of
//! the mesh: open borders, edges with any number of triangles, inconsistent winding, duplicates, degenerate triangles
//! and T-junctions are all just incidence, because the volume's boundary is `sum over e of m_e` with
//! `m_e = sum over t at e of c_t * o(t, e)` for *any* integer weights `c_t`.
//!
//! McGuire et al. 2003, section 4, stores the same for closed 2-manifolds only. The weld is by bit-equal position and
//! nothing else, so shadow geometry and rendered geometry can never differ.

mod bend;
mod closed;
mod cones;
mod convex;
mod embedded;
mod parts;
mod sections;
mod twins;
mod weld;

pub use cones::ConeTree;
pub(crate) use cones::NodeFacing;
pub use convex::ConvexPart;
pub use parts::{Cover, Part, Shape};
pub use sections::Section;
pub use twins::same_winding;

use crate::bounds::Bounds;
use crate::parallel;

/// Marks an edge record's missing second triangle.
pub const NONE: u32 = u32::MAX;
/// Set in a triangle reference when that triangle traverses the edge from its higher to its lower vertex.
const REVERSED: u32 = 1 << 31;

/// Why a mesh has no topology.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum TopologyError {
    /// An index points past the positions.
    #[error("triangle {triangle} refers to vertex {vertex}, but the mesh has {vertices} vertices")]
    IndexOutOfRange {
        /// Which triangle.
        triangle: usize,
        /// The index found there.
        vertex: u32,
        /// How many vertices there are.
        vertices: usize,
    },
    /// A coordinate is NaN or infinite.
    #[error("vertex {vertex} has a coordinate that is not finite")]
    NotFinite {
        /// Which vertex.
        vertex: usize,
    },
    /// Indices have to fit 30 bits (one bit selects the extruded copy, one the direction of an edge).
    #[error("the mesh has {count} {what}; at most {max} are supported", max = 1_u32 << 30)]
    TooLarge {
        /// "vertices" or "triangles".
        what: &'static str,
        /// How many.
        count: usize,
    },
    /// One number per vertex is needed.
    #[error("the mesh has {vertices} vertices, and the list for them has {found} entries")]
    WrongLength {
        /// How many vertices there are.
        vertices: usize,
        /// How many entries came.
        found: usize,
    },
    /// One entry per triangle is needed.
    #[error("the mesh has {triangles} triangles, and the list of what they block has {found} entries")]
    WrongBlocking {
        /// How many triangles there are.
        triangles: usize,
        /// How many entries came.
        found: usize,
    },
    /// Only meshes made by [`Topology::bending`] bend.
    #[error("the mesh is rigid; meshes whose vertices move have to be declared so")]
    Rigid,
}

/// What of light a triangle blocks, and where the depth pass draws it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Blocking {
    /// Light passes through.
    Nothing,
    /// Blocks light; the depth pass draws it wherever its front is in view, and may cull its back.
    Front,
    /// Blocks light; the depth pass draws both its sides.
    BothSides,
    /// Blocks light; the depth pass may leave out some of it or all.
    Partly,
}

impl From<bool> for Blocking {
    /// Whether it blocks light; the depth pass may cull its back.
    fn from(casts: bool) -> Self {
        if casts { Self::Front } else { Self::Nothing }
    }
}

/// An undirected edge with the one or two triangles that meet there.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Edge {
    /// Welded vertex ids, lower first.
    vertices: [u32; 2],
    triangles: [u32; 2],
}

/// An undirected edge where more than two triangles meet.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Fan {
    /// Welded vertex ids, lower first.
    vertices: [u32; 2],
    start: u32,
    end: u32,
}

/// Incidence of one mesh. What is in it belongs together, so it can be read, and only vertices that bend can be moved
/// ([`Topology::move_vertices`]).
#[derive(Clone, Debug)]
pub struct Topology {
    /// One position per distinct point, object space.
    pub(crate) positions: Vec<[f32; 3]>,
    /// Welded vertex ids of every triangle, in the order and rotation in which it is rendered.
    pub(crate) triangles: Vec<[u32; 3]>,
    /// Connected part of each triangle, or [`NONE`] if it never casts (degenerate, or excluded by the caller).
    pub(crate) part_of: Vec<u32>,
    /// Parts connected through edges.
    pub(crate) parts: Vec<Part>,
    /// Casting triangles, part by part.
    pub(crate) by_part: Vec<u32>,
    /// Groups of casting triangles over the same three points, in any order: duplicates and sheets with a back.
    pub(crate) twins: Vec<Vec<u32>>,
    /// Its largest convex part, if it has one of few faces.
    pub(crate) convex: Option<ConvexPart>,
    bounds: Bounds,
    /// Its parts by place, where it has several and is rigid.
    sections: Vec<Section>,
    /// Over its triangles, where it is rigid, large and one section.
    cones: Option<ConeTree>,
    /// Of a mesh that bends.
    bend: Option<bend::Bend>,
    edges: Vec<Edge>,
    fans: Vec<Fan>,
    fan_triangles: Vec<u32>,
}

impl Topology {
    /// Welds and connects a mesh. `surface` tells what a triangle is, or just whether it blocks light; those that do not
    /// take no part in any volume.
    ///
    /// # Errors
    /// An index out of range, a non-finite coordinate, or more than 2^30 vertices or triangles.
    pub fn new<S: Into<Blocking>>(
        positions: &[[f32; 3]],
        triangles: &[[u32; 3]],
        surface: impl Fn(usize) -> S,
    ) -> Result<Self, TopologyError> {
        Self::build(positions, triangles, None, |t| surface(t).into())
    }

    /// [`Self::new`] for a mesh whose vertices move against each other (skins, morph targets), given in any pose. `alike`
    /// has a number per vertex; those with equal numbers have bit-equal positions in every pose, and are welded. Nothing
    /// that follows from positions is assumed to last: all its parts cast from both sides.
    ///
    /// # Errors
    /// As [`Self::new`], and if `alike` has another length than `positions`.
    pub fn bending<S: Into<Blocking>>(
        positions: &[[f32; 3]],
        triangles: &[[u32; 3]],
        alike: &[u32],
        surface: impl Fn(usize) -> S,
    ) -> Result<Self, TopologyError> {
        if alike.len() != positions.len() {
            return Err(TopologyError::WrongLength { vertices: positions.len(), found: alike.len() });
        }
        Self::build(positions, triangles, Some(alike), |t| surface(t).into())
    }

    /// One position per distinct point, object space.
    #[must_use]
    pub fn positions(&self) -> &[[f32; 3]] {
        &self.positions
    }

    /// Welded vertex ids of every triangle, in the order and rotation in which it is rendered.
    #[must_use]
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// Connected part of each triangle, or [`NONE`] if it never casts (degenerate, or excluded by the caller).
    #[must_use]
    pub fn part_of(&self) -> &[u32] {
        &self.part_of
    }

    /// Parts connected through edges.
    #[must_use]
    pub fn parts(&self) -> &[Part] {
        &self.parts
    }

    /// Casting triangles, part by part.
    #[must_use]
    pub fn by_part(&self) -> &[u32] {
        &self.by_part
    }

    /// Groups of casting triangles over the same three points, in any order: duplicates and sheets with a back.
    #[must_use]
    pub fn twins(&self) -> &[Vec<u32>] {
        &self.twins
    }

    /// Its largest convex part, if it has one of few faces.
    #[must_use]
    pub fn convex(&self) -> Option<&ConvexPart> {
        self.convex.as_ref()
    }

    /// Parts that lie together, where the mesh is rigid and has several such groups: what can be decided on by itself.
    #[must_use]
    pub fn sections(&self) -> &[Section] {
        &self.sections
    }

    fn build(
        positions: &[[f32; 3]],
        triangles: &[[u32; 3]],
        alike: Option<&[u32]>,
        surface: impl Fn(usize) -> Blocking,
    ) -> Result<Self, TopologyError> {
        for (what, count) in [("vertices", positions.len()), ("triangles", triangles.len())] {
            if count > 1 << 30 {
                return Err(TopologyError::TooLarge { what, count });
            }
        }
        check_finite(positions)?;
        let vertices = positions.len();
        let weld::Welded { mut positions, sources, mut triangles } = weld::weld(positions, triangles, alike)?;
        let casts = |t: usize, [a, b, c]: [u32; 3]| a != b && b != c && c != a && surface(t) != Blocking::Nothing;
        let vertices_of_sections =
            if alike.is_some() { Vec::new() } else { sections::number(&mut positions, &mut triangles, casts) };
        let mut uses = Vec::with_capacity(triangles.len() * 3);
        for (t, &[a, b, c]) in triangles.iter().enumerate() {
            if casts(t, [a, b, c]) {
                for (from, to) in [(a, b), (b, c), (c, a)] {
                    let reversed = if from < to { 0 } else { REVERSED };
                    uses.push(([from.min(to), from.max(to)], t as u32 | reversed));
                }
            }
        }
        parallel::sort_unstable(&mut uses);

        let mut topology = Self {
            part_of: vec![NONE; triangles.len()],
            triangles,
            bend: alike.map(|_| bend::Bend::new(vertices, sources)),
            edges: Vec::with_capacity(uses.len() / 2),
            ..Self::of_nothing(positions)
        };
        for group in uses.chunk_by(|a, b| a.0 == b.0) {
            let vertices = group[0].0;
            match *group {
                [(_, t)] => topology.edges.push(Edge { vertices, triangles: [t, NONE] }),
                [(_, t), (_, u)] => topology.edges.push(Edge { vertices, triangles: [t, u] }),
                _ => {
                    let start = topology.fan_triangles.len() as u32;
                    topology.fan_triangles.extend(group.iter().map(|&(_, t)| t));
                    let end = topology.fan_triangles.len() as u32;
                    topology.fans.push(Fan { vertices, start, end });
                }
            }
        }
        parts::find(&mut topology);
        topology.twins = twins::find(&topology);
        parts::find_cover(&mut topology, surface);
        topology.convex = if topology.bends() { None } else { convex::largest(&topology) };
        topology.bounds = Bounds::of(topology.parts.iter().flat_map(|part| [part.bounds.min, part.bounds.max]));
        topology.sections = sections::cut(&topology, &vertices_of_sections);
        if topology.sections.is_empty() && !topology.bends() {
            topology.cones = ConeTree::new(&mut topology);
        }
        Ok(topology)
    }

    /// Points without triangles.
    fn of_nothing(positions: Vec<[f32; 3]>) -> Self {
        Self {
            positions,
            triangles: Vec::new(),
            part_of: Vec::new(),
            parts: Vec::new(),
            by_part: Vec::new(),
            twins: Vec::new(),
            convex: None,
            bounds: Bounds::EMPTY,
            sections: Vec::new(),
            cones: None,
            bend: None,
            edges: Vec::new(),
            fans: Vec::new(),
            fan_triangles: Vec::new(),
        }
    }

    /// Whether its vertices may move against each other.
    #[must_use]
    pub fn bends(&self) -> bool {
        self.bend.is_some()
    }

    /// Every edge at least one casting triangle uses, with the triangles there and `o(t, e)`: +1 if the triangle
    /// runs from the lower to the higher vertex, -1 if against.
    pub fn incidence(&self) -> impl Iterator<Item = ([u32; 2], Incident<'_>)> {
        let pairs = self.edges.iter().map(|e| (e.vertices, Incident(e.known())));
        let fans = self.fans.iter().map(|f| (f.vertices, Incident(self.at(f))));
        pairs.chain(fans)
    }

    /// The tree over the triangles of a large and rigid mesh of one section.
    pub(crate) fn cones(&self) -> Option<&ConeTree> {
        self.cones.as_ref()
    }

    /// [`Self::boundary`], without a look at edges that are balanced by how the tree's nodes face the light of `c`.
    pub(crate) fn silhouette(&self, c: &[i8], states: Option<&[NodeFacing]>, mut emit: impl FnMut([u32; 2], i32)) {
        let Some((tree, states)) = self.cones.as_ref().zip(states) else { return self.boundary(c, emit) };
        tree.open_edges(states, &self.edges, |edge| edge.boundary(c, &mut emit));
        self.fans.iter().for_each(|fan| self.boundary_of(fan, c, &mut emit));
    }

    /// Signed multiplicity `m_e` of every edge where it is not zero, for the weights `c` of the triangles.
    pub fn boundary(&self, c: &[i8], mut emit: impl FnMut([u32; 2], i32)) {
        self.edges.iter().for_each(|edge| edge.boundary(c, &mut emit));
        self.fans.iter().for_each(|fan| self.boundary_of(fan, c, &mut emit));
    }

    fn boundary_of(&self, fan: &Fan, c: &[i8], emit: &mut impl FnMut([u32; 2], i32)) {
        let m: i32 = self.at(fan).iter().map(|&t| signed(c, t)).sum();
        if m != 0 {
            emit(fan.vertices, m);
        }
    }

    /// Position of welded vertex `v`, exact.
    #[must_use]
    pub fn position(&self, v: u32) -> glam::DVec3 {
        let [x, y, z] = self.positions[v as usize];
        glam::DVec3::new(x.into(), y.into(), z.into())
    }

    /// The three corners of triangle `t`, exact.
    #[must_use]
    pub fn corners(&self, t: usize) -> [glam::DVec3; 3] {
        self.triangles[t].map(|v| self.position(v))
    }

    /// The triangles of part `part`.
    ///
    /// # Panics
    /// If there is no such part.
    #[must_use]
    pub fn triangles_of(&self, part: usize) -> &[u32] {
        let range = &self.parts[part].triangles;
        &self.by_part[range.start as usize..range.end as usize]
    }

    /// Object-space bounds of the casting parts.
    #[must_use]
    pub fn bounds(&self) -> Bounds {
        self.bounds
    }

    /// How many edges have one, two and more triangles.
    #[must_use]
    pub fn edge_counts(&self) -> [usize; 3] {
        let open = self.edges.iter().filter(|e| e.triangles[1] == NONE).count();
        [open, self.edges.len() - open, self.fans.len()]
    }

    /// Bytes held, for memory reports.
    #[must_use]
    pub fn bytes(&self) -> usize {
        size_of_val(&*self.positions)
            + size_of_val(&*self.triangles)
            + size_of_val(&*self.part_of)
            + size_of_val(&*self.parts)
            + size_of_val(&*self.by_part)
            + self.twins.iter().map(|group| size_of_val(group) + size_of_val(&**group)).sum::<usize>()
            + size_of_val(&*self.edges)
            + size_of_val(&*self.fans)
            + size_of_val(&*self.fan_triangles)
            + self.bend.as_ref().map_or(0, bend::Bend::bytes)
            + self.cones.as_ref().map_or(0, ConeTree::bytes)
            + self.sections.iter().map(|section| size_of_val(section) + section.topology.bytes()).sum::<usize>()
    }

    fn at(&self, fan: &Fan) -> &[u32] {
        &self.fan_triangles[fan.start as usize..fan.end as usize]
    }
}

impl Edge {
    fn boundary(&self, c: &[i8], emit: &mut impl FnMut([u32; 2], i32)) {
        let [t, u] = self.triangles;
        let m = signed(c, t) + if u == NONE { 0 } else { signed(c, u) };
        if m != 0 {
            emit(self.vertices, m);
        }
    }

    fn known(&self) -> &[u32] {
        if self.triangles[1] == NONE { &self.triangles[..1] } else { &self.triangles }
    }
}

/// The triangles at one edge.
#[derive(Clone, Copy, Debug)]
pub struct Incident<'a>(&'a [u32]);

impl Incident<'_> {
    /// Triangle index and `o(t, e)`.
    pub fn iter(&self) -> impl Iterator<Item = (usize, i32)> {
        self.0.iter().map(|&t| ((t & !REVERSED) as usize, orientation(t)))
    }
}

fn check_finite(positions: &[[f32; 3]]) -> Result<(), TopologyError> {
    match positions.iter().position(|p| p.iter().any(|x| !x.is_finite())) {
        None => Ok(()),
        Some(vertex) => Err(TopologyError::NotFinite { vertex }),
    }
}

fn orientation(reference: u32) -> i32 {
    if reference & REVERSED == 0 { 1 } else { -1 }
}

fn signed(c: &[i8], reference: u32) -> i32 {
    i32::from(c[(reference & !REVERSED) as usize]) * orientation(reference)
}
