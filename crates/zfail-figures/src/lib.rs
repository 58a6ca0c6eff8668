//! Pictures of what shadow volumes do, after the figures of Everitt & Kilgard 2002 (E&K) and McGuire et al. 2003 (McG).
//!
//! In: a scene, a view, kinds of [`Overlay`]. Out: the figure, drawn on the device over a picture or instead of it.
//! Data flow: `model` (positions) -> `plans`, `volumes` (what [`zfail_plan`] makes of them) -> `over_picture`, `alternate`,
//! `clip_space`, `pyramid` (display lists of one kind of figure each) -> `canvas` (passes).
//!
//! Colours have one place, [`palette`]; [`lettering`] writes legends, and serves whoever else puts text on an image.

mod alternate;
mod canvas;
mod clip_space;
mod clipped;
mod clipping;
mod drawing;
mod error;
mod figures;
mod legend;
pub mod lettering;
mod light_bounds;
mod model;
mod options;
mod over_picture;
mod overlay;
pub mod palette;
mod paper;
mod plans;
mod pyramid;
mod surface_color;
#[cfg(test)]
mod test_scene;
mod third_person;
mod volumes;

pub use error::Error;
pub use figures::Figures;
pub use options::{Options, ThirdPerson};
pub use overlay::{Overlay, UnknownOverlay};
