//! The scene that a command works on, and what of it is asked for.
//!
//! Data flow: `scene` (a file or a name, loaded and completed) -> `choice` (animation, camera and lights in it) -> `shot` (one
//! picture of it). `effort` says what takes long.

mod choice;
mod effort;
mod scene;
mod shot;

pub use choice::{animation, at_moment, camera, eye, lights};
pub use effort::effort;
pub use scene::{complete, read};
pub use shot::{Shot, shot};
