//! A rendering system around the shadow determination of [`zfail`], after that of McGuire, Hughes, Egan, Kilgard and Everitt,
//! "Fast, Practical and Robust Shadows" (2003), section 8.
//!
//! In: a [`Scene`](zfail_scene::Scene) and a [`View`](zfail_plan::view::View). Out: a [`Picture`] with
//! [`FrameStats`], or [`Aovs`]. Shading is forward, all lights in one draw: the verdict pass counts every light's volumes
//! after the other and keeps a bit per light and sample; the forward pass adds up the lights whose bit says lit, and
//! where exposure is known beforehand it writes the finished picture.

mod aov;
mod attribute_outputs;
mod attribute_pass;
mod backdrop_pass;
mod blend_order;
mod check;
mod develop_pass;
mod draw_list;
mod error;
mod exposure;
mod forward_pass;
mod fragment_counter;
mod frame;
mod further_pass;
mod geometry;
mod gpu;
mod gpu_data;
mod layouts;
mod lights;
mod mask_pass;
mod materials;
mod mip_maps;
mod own_shadow;
mod picture;
mod pipeline;
mod read_back;
mod renderer;
mod scene;
mod settings;
mod shader;
mod shadow_pass;
mod shapes;
mod srgb;
mod stats;
mod surroundings;
mod targets;
mod terminator;
mod textures;
mod timing;
mod tone_map;
mod verdict_pass;

pub use aov::{AovKind, Aovs, UnknownAov};
pub use error::RenderError;
pub use gpu::{Adapter, Gpu, GpuOptions};
pub use picture::Picture;
pub use renderer::Renderer;
pub use settings::{Exposure, Settings, Terminator};
pub use stats::{FrameStats, LightFigures, TriangleFigures};
pub use tone_map::displayed;
pub use wgpu;
pub use zfail;
pub use zfail::{Silhouettes, Technique, Tiles, UnknownTechnique};
