//! A rendering system around the shadow determination of [`zfail`], after that of McGuire, Hughes, Egan, Kilgard and Everitt,
//! "Fast, Practical and Robust Shadows" (2003), section 8.
//!
//! In: a [`Scene`](zfail_scene::Scene) and a [`View`](zfail_plan::view::View). Out: a [`Picture`] with
//! [`FrameStats`], or [`Aovs`]. Shading is forward, all lights in one draw: the verdict pass counts every light's volumes
//! after the other and keeps a bit per light and sample; the forward pass adds up the lights whose bit says lit, and
//! where exposure is known beforehand it writes the finished picture.

mod device;
mod error;
mod output;
mod passes;
mod renderer;
mod scene;
mod settings;
mod srgb;

pub use device::gpu::{Adapter, Gpu, GpuOptions};
pub use error::RenderError;
pub use output::aov::{AovKind, Aovs, UnknownAov};
pub use output::picture::Picture;
pub use output::stats::{FrameStats, LightFigures, SectionFigures, TriangleFigures};
pub use output::tone_map::displayed;
pub use renderer::Renderer;
pub use settings::{Exposure, Settings, Terminator};
pub use wgpu;
pub use zfail;
pub use zfail::{Silhouettes, Technique, Tiles, UnknownTechnique};
