//! Exact stencil shadows, planned on the CPU.
//!
//! Data flows one way through this crate, and no GPU type enters it:
//! [`scene`] (plain data) -> [`topology`] (welded edges) -> [`casting`] (integer weight per triangle)
//! -> [`volume`] (sides, light cap, dark cap as index lists) -> [`plan`] (what each light draws).
//! [`closure`] proves volumes closed. [`view`] is the camera that every pass and every test shares.
//!
//! Conventions: right-handed, glTF axes (+y up, a camera looks along -z); metres; radians; transforms are named
//! destination-from-source (`world_from_object`) and are `f64` until the last step before the GPU.

pub mod casting;
pub mod closure;
pub mod convex;
pub mod plan;
pub mod scene;
pub mod scissor;
pub mod stack;
pub mod topology;
pub mod view;
pub mod volume;

pub use glam;
