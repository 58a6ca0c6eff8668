//! The files that are asked for: `--output` and `--aov`.

use crate::names;
use crate::output::Format;
use std::path::PathBuf;
use zfail_render::AovKind;

/// Where the picture goes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PictureFile {
    /// The file.
    pub path: PathBuf,
    /// As its extension says.
    pub format: Format,
}

impl PictureFile {
    /// Reads a file's name.
    ///
    /// # Errors
    /// If its extension is that of no picture.
    pub fn parse(text: &str) -> Result<Self, String> {
        let path = PathBuf::from(text);
        let format = Format::of(&path).ok_or("the name must end in .png or .exr")?;
        Ok(Self { path, format })
    }
}

/// A result other than the picture, and where it goes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct AovFiles {
    /// What.
    pub kind: AovKind,
    /// The file, or the folder for results that come per light.
    pub path: PathBuf,
    /// Of the file, or of each file in the folder.
    pub format: Format,
}

impl AovFiles {
    /// Reads KIND=PATH.
    ///
    /// # Errors
    /// If there is no such kind, or it does not go into such a file.
    pub fn parse(text: &str) -> Result<Self, String> {
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
    fn pictures_have_a_format() {
        assert_eq!(PictureFile::parse("b.EXR").unwrap().format, Format::Exr);
        assert!(PictureFile::parse("b.jpg").is_err());
    }

    #[test]
    fn aov_kinds_and_their_formats() {
        let parse = |text| AovFiles::parse(text).map(|aov| (aov.kind, aov.format, aov.is_folder()));
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
