//! What comes back: pictures, measured outputs, figures.

pub mod aov;
pub mod attribute_outputs;
pub mod picture;
pub mod stats;
pub mod tone_map;
