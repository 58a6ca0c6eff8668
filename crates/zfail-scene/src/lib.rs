//! Scenes for zfail: glTF 2.0 files and generated ones.
//!
//! In: a `.glb` or `.gltf` file. Out: a [`zfail_plan::scene::Scene`] and the notices about what was repaired or left
//! out; with [`load_animated`] also its animations, as poses at any time. A [`Setting`] adds the light and the camera
//! that a file may lack, [`cut`] makes geometry of masked surfaces, and a [`SavedView`] sets a scene up as a user left it.

mod animate;
pub mod builtin;
mod complete;
pub mod cut;
mod deform;
mod placement;
pub mod read;
mod saved_view;
pub mod write;

pub use animate::{Animated, Animation};
pub use complete::{Framing, GroundChoice, Setting, Sun, complete, fitting_ambient, fitting_ground, fitting_sky};
pub use read::{
    FileInfo, Limits, LoadError, Treatment, extension_treatment, load, load_animated, load_variant, load_with,
};
pub use saved_view::{SavedView, SavedViewError, Surroundings};
