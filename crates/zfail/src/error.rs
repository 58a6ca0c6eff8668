//! What can go wrong, for the host to read.

use zfail_plan::plan::PlanError;
use zfail_plan::topology::TopologyError;

/// Why a mesh was not accepted or a frame not prepared.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The mesh's data is invalid.
    #[error(transparent)]
    Topology(#[from] TopologyError),
    /// The frame's data is invalid.
    #[error(transparent)]
    Plan(#[from] PlanError),
    /// A caster refers to a mesh that was removed or belongs to another [`crate::Shadows`].
    #[error("caster {caster} refers to a mesh that is not registered")]
    UnknownMesh {
        /// Index of the caster in the frame.
        caster: usize,
    },
    /// The vertices of a mesh were to move that was removed or belongs to another [`crate::Shadows`].
    #[error("the mesh is not registered")]
    NoMesh,
    /// A buffer would exceed the device's limits.
    #[error(
        "{what} need {bytes} bytes, but this device allows {limit} in one buffer; request higher limits or split the scene"
    )]
    TooLarge {
        /// Which buffer.
        what: &'static str,
        /// Its size.
        bytes: u64,
        /// The device's limit.
        limit: u64,
    },
    /// A matrix of the host's own shows something else than the view does.
    #[error(
        "the matrix of caster {caster} does not show what the frame's view shows: make both from one camera, and without \
         jitter on only one of them (`View::from_matrices`, `View::jittered`)"
    )]
    ClipMatrix {
        /// Index of the caster in the frame.
        caster: usize,
    },
    /// A matrix of the host's own gives depth to what is infinitely far.
    #[error(
        "the matrix of caster {caster} gives depth to directions, which have none in a view without a far plane: its third row \
         has to be 0, 0, 0 and the near plane's distance, so multiply the projection last and in f64, or put those zeros in"
    )]
    ClipDepth {
        /// Index of the caster in the frame.
        caster: usize,
    },
}
