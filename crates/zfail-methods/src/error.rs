//! What can go wrong between a scene and its shadows.

use crate::Method;
use zfail_plan::plan::PlanError;
use zfail_plan::topology::TopologyError;
use zfail_render::RenderError;

/// Why there is no [`Shadow`](crate::Shadow).
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The method does not run here, or not under this view.
    #[error(transparent)]
    Unavailable(#[from] Unavailable),
    /// The device failed, or the scene is inconsistent.
    #[error(transparent)]
    Render(#[from] RenderError),
    /// A mesh is invalid.
    #[error(transparent)]
    Topology(#[from] TopologyError),
    /// A caster's light cannot be brought into its object space.
    #[error(transparent)]
    Plan(#[from] PlanError),
    /// An option makes no sense.
    #[error("the option {option} is {value}; {remedy}")]
    BadOption {
        /// Its name.
        option: &'static str,
        /// What it was.
        value: f64,
        /// What it may be.
        remedy: &'static str,
    },
}

/// A method that does not run, and why.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{method} is not available: {reason}")]
pub struct Unavailable {
    /// Which one.
    pub method: Method,
    /// What is missing.
    pub reason: String,
}

impl From<zfail_render::zfail::Error> for Error {
    fn from(error: zfail_render::zfail::Error) -> Self {
        Self::Render(error.into())
    }
}
