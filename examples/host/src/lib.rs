//! A renderer that is not zfail's: a forward renderer of its own, four samples, one colour target, that takes its
//! shadows from the crate `zfail` in a few calls (search for `shadows.` and `zfail::`).
//!
//! In: the objects and lights of [`scene`]. Out: an image.

mod forward;
pub mod scene;

pub use forward::Host;

/// Why there is no image.
pub type Error = Box<dyn std::error::Error>;
