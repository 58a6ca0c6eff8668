//! Meshes as a host describes them.

use zfail_plan::topology::{Blocking, Topology, TopologyError};

/// A mesh registered with one [`Shadows`](crate::Shadows).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct MeshId {
    pub(crate) slot: usize,
    pub(crate) serial: u64,
}

/// What [`Shadows::add_mesh`](crate::Shadows::add_mesh) is told of a mesh: the very triangles that the depth pass draws.
///
/// ```
/// # use zfail::{Blocking, MeshBlocking, MeshDescriptor};
/// let positions = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
/// let triangles = [[0, 1, 2], [0, 3, 1]];
/// // A sheet that is drawn from both sides, and a pane of glass.
/// let blocking = [Blocking::BothSides, Blocking::Nothing];
/// let mesh = MeshDescriptor {
///     positions: &positions,
///     triangles: &triangles,
///     blocking: MeshBlocking::PerTriangle(&blocking),
///     ..MeshDescriptor::default()
/// };
/// # assert_eq!(mesh.alike, None);
/// ```
#[derive(Clone, Copy, Debug, Default)]
pub struct MeshDescriptor<'a> {
    /// Object space, best kept near its origin; they may repeat, because the mesh is welded by bit-equal position.
    pub positions: &'a [[f32; 3]],
    /// Three positions each, in the order in which the depth pass draws them, counter-clockwise where the front is seen.
    pub triangles: &'a [[u32; 3]],
    /// What of it blocks light.
    pub blocking: MeshBlocking<'a>,
    /// For meshes whose vertices move against each other ([`Shadows::move_vertices`](crate::Shadows::move_vertices)): a number
    /// per vertex, equal for those whose positions are bit-equal in every pose, and for no others. `None` for rigid ones.
    pub alike: Option<&'a [u32]>,
}

/// What of a mesh blocks light.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MeshBlocking<'a> {
    /// All triangles alike.
    Uniform(Blocking),
    /// One entry per triangle.
    PerTriangle(&'a [Blocking]),
}

impl Default for MeshBlocking<'_> {
    /// Every triangle blocks light, and the depth pass may cull its back.
    fn default() -> Self {
        Self::Uniform(Blocking::Front)
    }
}

impl MeshDescriptor<'_> {
    /// Its topology.
    pub(crate) fn topology(&self) -> Result<Topology, TopologyError> {
        let Self { positions, triangles, blocking, alike } = *self;
        if let MeshBlocking::PerTriangle(list) = blocking
            && list.len() != triangles.len()
        {
            return Err(TopologyError::WrongBlocking { triangles: triangles.len(), found: list.len() });
        }
        let of = |t: usize| match blocking {
            MeshBlocking::Uniform(blocking) => blocking,
            MeshBlocking::PerTriangle(list) => list[t],
        };
        match alike {
            None => Topology::new(positions, triangles, of),
            Some(alike) => Topology::bending(positions, triangles, alike, of),
        }
    }
}
