//! A file by its name to a scene: which reader it is for, and what all of them end in.
//!
//! In: a path, limits, a variant of the materials. Out: the scene with its animations, and what the file says about itself.

use crate::gltf::{self, schema::Root};
use crate::info::FileInfo;
use crate::shared::error::{Fault, LoadError, Result};
use crate::shared::limits::{Budget, Limits};
use crate::shared::uri;
use crate::{obj, ply, stl};
use std::borrow::Cow;
use std::fs;
use std::io;
use std::path::Path;
use zfail_scene::{Animated, Scene};

/// Loads the default scene of a `.glb` or `.gltf` file, or all of an `.obj`, `.stl` or `.ply` file.
///
/// # Errors
/// If the file, or one it refers to, cannot be read, breaks the specification of its format or exceeds the default
/// [`Limits`].
pub fn load(path: &Path) -> std::result::Result<Scene, LoadError> {
    load_with(path, &Limits::default())
}

/// [`load`] with other limits.
///
/// # Errors
/// As [`load`].
pub fn load_with(path: &Path, limits: &Limits) -> std::result::Result<Scene, LoadError> {
    load_animated(path, limits).map(|(animated, _)| animated.scene)
}

/// [`load_with`] with the file's animations and what it says about itself.
///
/// # Errors
/// As [`load`].
pub fn load_animated(path: &Path, limits: &Limits) -> std::result::Result<(Animated, FileInfo), LoadError> {
    load_variant(path, limits, None)
}

/// [`load_animated`] with the materials of a variant (KHR_materials_variants), by its name or its number from 0; those that
/// the file shows by default if `None`.
///
/// # Errors
/// As [`load`], and if there is no such variant.
pub fn load_variant(
    path: &Path,
    limits: &Limits,
    variant: Option<&str>,
) -> std::result::Result<(Animated, FileInfo), LoadError> {
    read(path, limits, variant).map_err(|fault| LoadError { file: path.into(), fault })
}

fn read(path: &Path, limits: &Limits, variant: Option<&str>) -> Result<(Animated, FileInfo)> {
    let budget = Budget::new(*limits);
    let length = uri::regular_file_length(path).map_err(|problem| Fault::Unreadable(io::Error::other(problem)))?;
    budget.charge(length, 1, || "the file".into())?;
    let bytes = fs::read(path).map_err(Fault::Unreadable)?;
    let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let folder = path.parent().unwrap_or(Path::new("."));

    let mut notices = Vec::new();
    let Opened { root, bin, info } = open(&bytes, path, folder, &name, &budget, &mut notices)?;
    let scene = Scene { name, notices, ..Scene::default() };
    let animated = gltf::scene(root, bin, folder, variant, budget, scene)?;
    Ok((animated, info))
}

/// A document without the bytes of its buffers, except the binary chunk.
struct Opened<'a> {
    root: Root,
    bin: Option<Cow<'a, [u8]>>,
    info: FileInfo,
}

/// The document in `bytes`. The name decides on the format; what has no known one must be glTF.
fn open<'a>(
    bytes: &'a [u8],
    path: &Path,
    folder: &Path,
    name: &str,
    budget: &Budget,
    notices: &mut Vec<String>,
) -> Result<Opened<'a>> {
    let extension = path.extension().unwrap_or_default().to_ascii_lowercase();
    let plain = match extension.to_str() {
        Some("obj") => obj::read(bytes, folder, budget)?,
        Some("stl") => stl::read(bytes, budget)?,
        Some("ply") => ply::read(bytes, folder, budget)?,
        _ => {
            let (root, bin) = gltf::document(bytes, budget, notices)?;
            let info = FileInfo::of(&root);
            return Ok(Opened { root, bin: bin.map(Cow::Borrowed), info });
        }
    };
    notices.extend_from_slice(&plain.notices);
    let format = plain.format;
    let (root, bin) = plain.into_document(name, budget)?;
    let info = FileInfo { format, version: String::new(), ..FileInfo::of(&root) };
    Ok(Opened { root, bin: Some(Cow::Owned(bin)), info })
}
