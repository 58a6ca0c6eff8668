//! The developed picture.

/// A rendered picture; rows from top to bottom.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Linear RGB after exposure, before tone mapping (sRGB primaries); one per pixel.
    pub hdr: Vec<[f32; 3]>,
    /// Tone-mapped, sRGB-encoded RGBA, alpha 255; four bytes per pixel.
    pub rgba8: Vec<u8>,
}
