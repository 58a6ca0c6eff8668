//! Meshes that bend: glTF 2.0, sections 3.7.2.2 (morph targets) and 3.7.3 (skins).
//!
//! In: vertices as the file has them, morph weights and joints. Out: the vertices of a pose, in `f64` until they are rounded
//! once; they are computed here and nowhere else, so that every reader of a pose sees the same bits.
//! Data flow: `section` (one primitive) -> `body` (a mesh, and where it stands); `alike` (which vertices move as one).

mod alike;
mod body;
mod section;

pub use alike::alike;
pub use body::{Body, Frame, Joint};
pub use section::{Influences, Section, Target};
