//! Bounds on what a file may cost to load.

use super::error::{Fault, Result};
use std::sync::atomic::{AtomicU64, Ordering};

/// What loading one file may cost. A few kilobytes of JSON can claim any number of vertices, so every allocation whose
/// size a file chooses is charged before it is made.
#[derive(Clone, Copy, Debug)]
pub struct Limits {
    /// Bytes of all buffers, decoded attributes, meshes, images and instances together, and of each file read.
    pub bytes: u64,
    /// Width and height of an image, pixels.
    pub image_side: u32,
}

impl Default for Limits {
    /// 8 GiB and 16384 pixels.
    fn default() -> Self {
        Self { bytes: 8 << 30, image_side: 16384 }
    }
}

/// What is left of [`Limits::bytes`].
pub(crate) struct Budget {
    limits: Limits,
    left: AtomicU64,
}

impl Budget {
    pub fn new(limits: Limits) -> Self {
        Self { limits, left: AtomicU64::new(limits.bytes) }
    }

    pub fn image_side(&self) -> u32 {
        self.limits.image_side
    }

    /// Takes `count` times `size` bytes on behalf of `element`, or fails if they are not left.
    pub fn charge(&self, count: u64, size: u64, element: impl FnOnce() -> String) -> Result<()> {
        let taken = count.checked_mul(size).is_some_and(|bytes| {
            self.left.fetch_update(Ordering::Relaxed, Ordering::Relaxed, |left| left.checked_sub(bytes)).is_ok()
        });
        if taken { Ok(()) } else { Err(self.exceeded(element())) }
    }

    pub fn exceeded(&self, element: String) -> Fault {
        let limit = match self.limits.bytes {
            bytes @ 0..1_048_576 => format!("{bytes} bytes"),
            bytes => format!("{} MiB", bytes >> 20),
        };
        Fault::TooLarge { element, limit }
    }
}
