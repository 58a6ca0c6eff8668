//! What to ask a device for.

use wgpu::{Features, TextureFormat};

/// Those of the adapter's features that make shadows better; none is required.
///
/// `DEPTH32FLOAT_STENCIL8` gives reversed depth its even precision, `DEPTH_CLIP_CONTROL` lets the rasteriser clamp depth
/// for cameras with a finite far plane (E&K 2002, section 4.2, "Depth Clamping").
#[must_use]
pub fn wanted_features(adapter: Features) -> Features {
    adapter & (Features::DEPTH32FLOAT_STENCIL8 | Features::DEPTH_CLIP_CONTROL)
}

/// The best depth-stencil format of a device with these features: 32-bit float depth, or else 24 bits or more.
#[must_use]
pub fn depth_stencil_format(device: Features) -> TextureFormat {
    if device.contains(Features::DEPTH32FLOAT_STENCIL8) {
        TextureFormat::Depth32FloatStencil8
    } else {
        TextureFormat::Depth24PlusStencil8
    }
}
