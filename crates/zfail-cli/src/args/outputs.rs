//! Results: how large, of which kind, and into which files.

use crate::names;
use std::path::{Path, PathBuf};
use zfail_render::AovKind;

/// Width and height in pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Size(pub [u32; 2]);

impl Size {
    /// No GPU of today makes larger images; the renderer knows what the one at hand can do.
    const MAX_SIDE: u32 = 16_384;

    pub(super) fn parse(text: &str) -> Result<Self, String> {
        let parsed = text.split_once(['x', 'X']).and_then(|(w, h)| Some([w.parse().ok()?, h.parse().ok()?]));
        let Some([width, height]) = parsed else {
            return Err("write it as WIDTHxHEIGHT, such as 1280x720".to_owned());
        };
        let side = 1..=Self::MAX_SIDE;
        if !side.contains(&width) || !side.contains(&height) {
            return Err(format!("each side must be from 1 to {} pixels", Self::MAX_SIDE));
        }
        Ok(Self([width, height]))
    }
}

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
    fn of(path: &Path) -> Option<Self> {
        if path.as_os_str().to_string_lossy().ends_with(std::path::is_separator) {
            return None;
        }
        match path.extension()?.to_str()?.to_ascii_lowercase().as_str() {
            "png" => Some(Self::Png),
            "exr" => Some(Self::Exr),
            _ => None,
        }
    }
}

/// Where the picture goes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Picture {
    /// The file.
    pub path: PathBuf,
    /// As its extension says.
    pub format: Format,
}

impl Picture {
    pub(super) fn parse(text: &str) -> Result<Self, String> {
        let path = PathBuf::from(text);
        let format = Format::of(&path).ok_or("the name must end in .png or .exr")?;
        Ok(Self { path, format })
    }
}

/// A result other than the picture, and where it goes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Aov {
    /// What.
    pub kind: AovKind,
    /// The file, or the folder for results that come per light.
    pub path: PathBuf,
    /// Of the file, or of each file in the folder.
    pub format: Format,
}

impl Aov {
    pub(super) fn parse(text: &str) -> Result<Self, String> {
        let Some((name, path)) = text.split_once('=') else {
            return Err("write it as KIND=PATH, such as shadow=masks".to_owned());
        };
        let Ok(kind) = name.parse() else {
            let kinds = AovKind::ALL.map(AovKind::name);
            let hint = names::nearest(name, &kinds).map(|kind| format!(" (did you mean '{kind}'?)"));
            return Err(format!("unknown kind '{name}'{}; there are: {}", hint.unwrap_or_default(), kinds.join(", ")));
        };
        if path.is_empty() {
            return Err(format!("nothing follows '{name}='; name a file or a folder"));
        }
        let path = PathBuf::from(path);
        let format = match (kind, Format::of(&path)) {
            (AovKind::Shadow | AovKind::Stencil, _) => Format::Png,
            (AovKind::Depth | AovKind::Position, Some(Format::Exr)) => Format::Exr,
            (AovKind::Depth | AovKind::Position, _) => return Err(format!("the file for {name} must end in .exr")),
            (AovKind::Normal | AovKind::Albedo, Some(format)) => format,
            (AovKind::Normal | AovKind::Albedo, None) => {
                return Err(format!("the file for {name} must end in .exr or .png"));
            }
        };
        Ok(Self { kind, path, format })
    }

    /// Whether there is a file per light in a folder.
    pub fn is_folder(&self) -> bool {
        matches!(self.kind, AovKind::Shadow | AovKind::Stencil)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes() {
        assert_eq!(Size::parse("640x480"), Ok(Size([640, 480])));
        assert_eq!(Size::parse("1X16384"), Ok(Size([1, 16_384])));
        for wrong in ["", "640", "640x", "x480", "0x480", "640x0", "16385x1", "1x100000", "-1x5", "1x2x3"] {
            assert!(Size::parse(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn formats_follow_the_extension() {
        assert_eq!(Picture::parse("a/b.PNG").unwrap().format, Format::Png);
        assert_eq!(Picture::parse("b.exr").unwrap().format, Format::Exr);
        for wrong in ["b.jpg", "png", ".png", "a.png/", "b"] {
            assert!(Picture::parse(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn aov_kinds_and_their_formats() {
        let parse = |text| Aov::parse(text).map(|aov| (aov.kind, aov.format, aov.is_folder()));
        assert_eq!(parse("shadow=masks"), Ok((AovKind::Shadow, Format::Png, true)));
        assert_eq!(parse("stencil=a.b"), Ok((AovKind::Stencil, Format::Png, true)));
        assert_eq!(parse("depth=d.exr"), Ok((AovKind::Depth, Format::Exr, false)));
        assert_eq!(parse("normal=n.png"), Ok((AovKind::Normal, Format::Png, false)));
        assert_eq!(parse("albedo=a=b.exr"), Ok((AovKind::Albedo, Format::Exr, false)));
        for wrong in ["depth=d.png", "position=p", "normal=n", "albedo=a.jpg", "shadow=", "shadow", "=x", "dept=d.exr"]
        {
            assert!(parse(wrong).is_err(), "{wrong}");
        }
        assert!(parse("dept=d.exr").unwrap_err().contains("did you mean 'depth'"));
    }
}
