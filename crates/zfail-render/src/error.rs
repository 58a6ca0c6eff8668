//! What can go wrong between a scene and its picture.

/// Why a picture could not be rendered.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum RenderError {
    /// No usable graphics adapter.
    #[error(
        "no graphics adapter found{detail}; install a graphics driver, or a software one: on Debian and Ubuntu \
         `apt-get install mesa-vulkan-drivers`"
    )]
    NoAdapter {
        /// What was asked for and what there is instead, or empty.
        detail: String,
    },
    /// The adapter gave no device.
    #[error("the graphics adapter {adapter} gave no device: {message}")]
    NoDevice {
        /// Name of the adapter.
        adapter: String,
        /// The driver's words.
        message: String,
    },
    /// The image has no pixels.
    #[error("the image size {}x{} is empty: both sides must be at least 1", size[0], size[1])]
    EmptySize {
        /// Width and height in pixels.
        size: [u32; 2],
    },
    /// The image does not fit the device.
    #[error("the image size {}x{} is too large: {limit}", size[0], size[1])]
    TooLarge {
        /// Width and height in pixels.
        size: [u32; 2],
        /// Which limit it exceeds.
        limit: String,
    },
    /// A sample count that cannot be rendered.
    #[error("{0} samples per pixel are not supported: use 1 or 4")]
    Samples(u32),
    /// The interface cannot read what it has rendered with several samples.
    #[error("several samples per pixel are not supported on {backend}: use 1, or another graphics interface")]
    NoMultisampling {
        /// The graphics interface.
        backend: wgpu::Backend,
    },
    /// A light index out of range.
    #[error("there is no light {index}: the scene has {count}, counted from 0")]
    UnknownLight {
        /// What was asked for.
        index: usize,
        /// How many lights the scene has.
        count: usize,
    },
    /// The scene breaks a rule of its own types.
    #[error("the scene is inconsistent: {0}")]
    Scene(String),
    /// The shadow library refused.
    #[error(transparent)]
    Shadows(#[from] zfail::Error),
    /// The device reported an error: out of memory, or a bug in this crate or the driver.
    #[error("the graphics device failed: {0}")]
    Device(String),
}
