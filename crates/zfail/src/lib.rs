//! Exact, bias-free stencil shadows for [`wgpu`] renderers.
//!
//! Give [`Shadows`] your meshes once and, every frame, the camera, the casters and the lights. Then, for each light,
//! clear the stencil of your depth-stencil target, let [`Shadows::draw`] encode the shadow volumes into your pass, and
//! light the surfaces with [`lit_stencil`] and stencil reference 0: a sample passes exactly where a ray from the visible
//! point reaches the light. There is no bias, no resolution and no filter to tune.
//!
//! The algorithms are those of Everitt & Kilgard 2002 and McGuire et al. 2003, on any mesh (see [`zfail_plan`]).
//!
//! # What a host renderer has to respect
//! - Depth is reversed and comes from [`View::clip_from_object`], one `f32` matrix per object, applied in the vertex
//!   shader as `clip_from_object * vec4<f32>(position, 1.0)` to an `@invariant @builtin(position)`. Volumes start at the
//!   rendered triangles, so their depths have to agree to the last bit.
//! - The depth pass draws the very triangles given to [`Shadows::add_mesh`], each with its three vertices in the same
//!   order, and clears depth to 0.
//! - The depth-stencil format has 8 stencil bits: [`depth_stencil_format`].
//! - Illumination ends at the light's range and cone: casters and pixels beyond them are not looked at.
//! - A camera with a far plane that is not at infinity (orthographic, or a finite perspective) works everywhere; it is
//!   faster where the device has `DEPTH_CLIP_CONTROL`: [`wanted_features`].

mod arena;
mod cost;
mod error;
mod features;
mod frame_buffers;
mod pipelines;
mod shadows;
mod silhouettes;
mod tiled;
pub mod tiles;

pub use cost::CostModel;
pub use error::Error;
pub use features::{depth_stencil_format, wanted_features};
pub use pipelines::{Pipelines, Target, lit_stencil};
pub use shadows::{Caster, Frame, MeshId, Shadows};
pub use zfail_plan::bounds::Bounds;
pub use zfail_plan::light::LightKind;
pub use zfail_plan::plan::{
    Counting, Culled, FramePlan, LightStats, ShadowLight, Silhouettes, Steps, Technique, Tiles, Triangles,
    UnknownTechnique, ZPass,
};
pub use zfail_plan::topology::{Blocking, Topology, TopologyError};
pub use zfail_plan::view::{Projection, View};
pub use zfail_plan::{self, glam};
