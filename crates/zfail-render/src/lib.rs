//! The complete rendering system of McGuire, Hughes, Egan, Kilgard and Everitt, "Fast, Practical and Robust Shadows"
//! (2003), section 8, around the shadow determination of [`zfail`].
//!
//! In: a [`Scene`](zfail_plan::scene::Scene) and a [`View`](zfail_plan::view::View). Out: a [`Picture`] with
//! [`FrameStats`], or [`Aovs`]. Shading is deferred, so a texture is read once per pixel however many lights there are:
//! the ambient pass keeps what it has read, each light's illumination pass adds to a half-float sum where the stencil
//! says lit, and the final pass lays blended materials over it.

mod ambient_pass;
mod aov;
mod check;
mod develop_pass;
mod draw_list;
mod error;
mod exposure;
mod final_pass;
mod frame;
mod geometry;
mod gpu;
mod gpu_data;
mod illuminate_pass;
mod layouts;
mod lights;
mod mask_pass;
mod materials;
mod mip_maps;
mod picture;
mod pipeline;
mod read_back;
mod renderer;
mod scene;
mod settings;
mod shader;
mod shadow_pass;
mod srgb;
mod stats;
mod surface_outputs;
mod targets;
mod textures;
mod timing;

pub use aov::{AovKind, Aovs, UnknownAov};
pub use error::RenderError;
pub use gpu::{Gpu, GpuOptions};
pub use picture::Picture;
pub use renderer::Renderer;
pub use settings::{Exposure, Settings};
pub use stats::{FrameStats, LightFigures, TriangleFigures};
pub use wgpu;
pub use zfail::{Technique, UnknownTechnique};
pub use zfail_plan;
