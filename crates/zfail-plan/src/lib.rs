//! Exact stencil shadows, planned on the CPU.
//!
//! Data flows one way through this crate, and no GPU type enters it:
//! positions and triangles -> [`topology`] (welded edges) -> [`casting`] (integer weight per triangle)
//! -> [`volume`] (sides, light cap, dark cap as index lists) -> [`plan`] (what each light draws).
//! [`light`] is where a light is and how far it reaches, [`view`] the camera that every pass and every test shares.
//! [`closure`] proves volumes closed. Of scenes, materials and files nothing here knows.
//!
//! Conventions: right-handed, glTF axes (+y up, a camera looks along -z); metres; radians; transforms are named
//! destination-from-source (`world_from_object`) and are `f64` until the last step before the GPU.

pub mod bounds;
pub mod casting;
pub mod closure;
pub mod convex;
pub mod light;
mod parallel;
pub mod plan;
pub mod scissor;
pub mod stack;
pub mod topology;
pub mod view;
pub mod volume;

pub use glam;
