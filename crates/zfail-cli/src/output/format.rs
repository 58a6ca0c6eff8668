//! Which kind of file an image becomes, by the file's name.

use super::encode::{self, Sealed};
use crate::error::Error;
use std::path::Path;
use zfail_render::Picture;

/// File formats for images.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// 8 bits per channel.
    Png,
    /// 32-bit float.
    Exr,
}

impl Format {
    /// As the extension says; `None` for any other, and for the name of a folder.
    pub fn of(path: &Path) -> Option<Self> {
        if path.as_os_str().to_string_lossy().ends_with(std::path::is_separator) {
            return None;
        }
        match path.extension()?.to_str()?.to_ascii_lowercase().as_str() {
            "png" => Some(Self::Png),
            "exr" => Some(Self::Exr),
            _ => None,
        }
    }

    /// What of a picture is in such a file, as bytes.
    pub fn pixels(self, picture: &Picture) -> Vec<u8> {
        match self {
            Self::Png => encode::rgb8(&picture.rgba8),
            Self::Exr => encode::rgb32f(picture.hdr.iter().copied()),
        }
    }

    /// The bytes of [`Self::pixels`] as a file that bears `seal`.
    ///
    /// # Errors
    /// If the encoder refuses.
    pub fn encode(self, size: [u32; 2], pixels: &[u8], seal: Option<&str>) -> Result<Vec<u8>, Error> {
        match self {
            Self::Png => encode::png_picture(size, pixels, seal),
            Self::Exr => encode::exr_rgb(size, pixels, seal),
        }
    }

    /// Reads a sealed picture of this size; `None` for any other file, and for one that is damaged.
    pub fn read(self, size: [u32; 2], file: &[u8]) -> Option<Sealed> {
        match self {
            Self::Png => encode::read_png(size, file),
            Self::Exr => encode::read_exr(size, file),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Format;
    use std::path::Path;

    #[test]
    fn formats_follow_the_extension() {
        let of = |name: &str| Format::of(Path::new(name));
        assert_eq!((of("a/b.PNG"), of("c.exr")), (Some(Format::Png), Some(Format::Exr)));
        for wrong in ["b.jpg", "png", ".png", "a.png/", "b"] {
            assert_eq!(of(wrong), None, "{wrong}");
        }
    }
}
