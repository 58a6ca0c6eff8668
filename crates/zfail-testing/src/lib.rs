//! What the tests of the workspace share: the rule for what a machine lacks, random numbers, pictures of what went wrong,
//! and the checks of WGSL.
//!
//! It depends on no other crate of the workspace, so that each can use it, also in the tests beside its code.

mod needed;
mod picture;
mod random;
pub mod wgsl;

pub use naga;
pub use needed::{Raw, browser, device, display, gpu};
pub use picture::{assert_alike, compare, keep};
pub use random::Random;
