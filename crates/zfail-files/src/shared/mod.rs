//! What the readers of all formats share.
//!
//! `limits` (what a file may cost), `error` (why it cannot be loaded), `uri` (files and data that it refers to) and `fence`
//! (around decoders that are not ours).

pub(crate) mod error;
pub(crate) mod fence;
pub(crate) mod limits;
pub(crate) mod uri;

pub use error::{Fault, LoadError};
pub use limits::Limits;
