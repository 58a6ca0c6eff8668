//! Scenes as plain data, and what moves and completes them.
//!
//! In: what a loader or a generator fills. Out: a [`Scene`] to be planned, rendered and judged, and a [`Pose`] of it at any
//! time. No file format, no decoder and no GPU type enters this crate.
//!
//! The model: [`Scene`], which places [`Mesh`]es with their [`Material`]s, [`Light`]s and [`Camera`]s in world space, and what
//! it stands in ([`Sky`], [`Ground`]). [`check`] says whether one keeps the rules that its types state.
//!
//! What moves it: [`animate`] (key frames to a [`Pose`]) with [`deform`] (skins and morph targets) and [`placement`] (what
//! transforms do to meshes). What completes it: [`cut`] makes geometry of masked surfaces, a [`Setting`] adds the light and
//! the camera that a file may lack, and a [`SavedView`] sets a scene up as a user left it.

pub mod animate;
mod camera;
mod casters;
mod check;
mod complete;
pub mod cut;
pub mod deform;
mod light;
mod material;
mod mesh;
pub mod placement;
mod pose;
mod receivers;
mod saved_view;
mod scene;
mod surroundings;

pub use animate::{Animated, Animation};
pub use camera::Camera;
pub use check::{Unsound, check};
pub use complete::{Framing, GroundChoice, Setting, Sun, complete, fitting_ambient, fitting_ground, fitting_sky};
pub use light::{Light, LightShape};
pub use material::{
    AlphaMode, Clearcoat, Filter, Image, MaskCasting, Material, Sheen, Specular, SpecularGlossiness, Texture,
    TextureRef, Transmission, Wrap,
};
pub use mesh::{Mesh, Primitive};
pub use pose::{BentMesh, Pose};
pub use receivers::Receivers;
pub use saved_view::{SavedView, SavedViewError, Surroundings};
pub use scene::{Instance, Scene, world_triangle};
pub use surroundings::{Ground, Sky};
