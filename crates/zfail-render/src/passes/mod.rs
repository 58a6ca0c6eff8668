//! Passes, each a module with pipelines and a function that encodes it, and what they share: targets, shaders, the frame.
//!
//! In: a scene on the device, and a view. Out: encoded work.

pub mod attribute_pass;
pub mod backdrop_pass;
pub mod develop_pass;
pub mod exposure;
pub mod forward_pass;
pub mod fragment_counter;
pub mod frame;
pub mod further_pass;
pub mod mask_pass;
pub mod own_shadow;
pub mod pipeline;
pub mod shader;
pub mod shadow_pass;
pub mod targets;
pub mod verdict_pass;
