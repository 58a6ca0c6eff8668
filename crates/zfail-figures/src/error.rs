//! What can go wrong between a scene and a figure of it.

use zfail_plan::plan::PlanError;
use zfail_plan::topology::TopologyError;
use zfail_render::RenderError;

/// Why a figure could not be drawn.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A mesh has no topology.
    #[error("mesh {name:?} has no shadow volumes")]
    Topology {
        /// The mesh's name.
        name: String,
        /// Why.
        source: TopologyError,
    },
    /// The volumes could not be planned.
    #[error(transparent)]
    Plan(#[from] PlanError),
    /// A light index out of range.
    #[error("there is no light {index}: the scene has {count}, counted from 0")]
    UnknownLight {
        /// What was asked for.
        index: usize,
        /// How many lights the scene has.
        count: usize,
    },
    /// Scene, pose or target do not fit what they are for.
    #[error("a figure cannot be drawn: {0}")]
    Unfit(String),
    /// The device reported an error.
    #[error(transparent)]
    Device(#[from] RenderError),
}
