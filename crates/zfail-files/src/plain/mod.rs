//! What the readers of .obj, .stl and .ply files share, and a document for files of formats that have none: these hold
//! triangles and little else.
//!
//! In: runs of triangles with their materials. Out: a glTF document and its binary chunk, so that whatever the reader
//! promises of glTF files (invariants, limits, repairs and notices) holds of these too.

mod document;
pub(crate) mod folder;
pub(crate) mod losses;
pub(crate) mod points;
pub(crate) mod text;

use crate::gltf::schema::{Material, MetallicRoughness, TextureInfo, TextureInfoExtensions};
use crate::shared::error::{Fault, malformed};

/// Triangles of one material. Attributes have the length of `positions`, or are absent.
#[derive(Default)]
pub(crate) struct Part {
    /// From [`Plain::origin`].
    pub positions: Vec<[f32; 3]>,
    pub normals: Option<Vec<[f32; 3]>>,
    /// As in glTF: v grows downwards.
    pub uv: Option<Vec<[f32; 2]>>,
    /// Linear RGBA.
    pub colors: Option<Vec<[f32; 4]>>,
    pub triangles: Vec<[u32; 3]>,
    /// Index into [`Plain::materials`].
    pub material: usize,
}

/// The file's axis that points up.
#[derive(Clone, Copy)]
pub(crate) enum Up {
    Y,
    Z,
}

/// The file of a picture.
pub(crate) struct Picture {
    pub name: String,
    pub bytes: Vec<u8>,
}

/// A picture as a material uses it.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Texture {
    /// Index into [`Plain::pictures`].
    pub picture: usize,
    /// Whether it ends at its edges instead of repeating.
    pub clamped: bool,
}

/// What such a file holds, checked: positions are finite and every index is in range.
pub(crate) struct Plain {
    /// Name of the format, for reports.
    pub format: &'static str,
    pub parts: Vec<Part>,
    pub materials: Vec<Material>,
    pub textures: Vec<Texture>,
    pub pictures: Vec<Picture>,
    pub up: Up,
    /// Where the parts lie, in the file's axes.
    pub origin: [f64; 3],
    pub notices: Vec<String>,
}

/// The material of surfaces without one: a grey that shows shading, from both sides, since these formats know no
/// one-sided surfaces.
pub(crate) fn grey(name: String) -> Material {
    let pbr_metallic_roughness = MetallicRoughness {
        base_color_factor: [0.8, 0.8, 0.8, 1.0],
        metallic_factor: 0.0,
        roughness_factor: 0.8,
        ..MetallicRoughness::default()
    };
    Material { name: Some(name), pbr_metallic_roughness, double_sided: true, ..Material::default() }
}

/// A material's reference to texture `index`.
pub(crate) fn texture(index: usize) -> TextureInfo {
    let extensions = TextureInfoExtensions::default();
    TextureInfo { index, tex_coord: 0, scale: 1.0, strength: 1.0, extensions }
}

/// The linear value of an sRGB-encoded one; vertex colours are stored as they were painted.
pub(crate) fn linear(encoded: f32) -> f32 {
    if encoded <= 0.04045 { encoded / 12.92 } else { ((encoded + 0.055) / 1.055).powf(2.4) }
}

/// What a full channel is in a file whose greatest value of a colour is `greatest`: some programs write bytes as numbers.
pub(crate) fn full_channel(greatest: f32) -> f32 {
    if greatest > 1.0 && greatest <= 255.0 { 255.0 } else { 1.0 }
}

/// The fault of a file of `format` that is something else altogether; `otherwise` if nobody can tell what.
pub(crate) fn not_of_format(format: &str, bytes: &[u8], otherwise: impl FnOnce() -> Fault) -> Fault {
    let begins = |with: &str| {
        let text = bytes.trim_ascii_start();
        text.get(..with.len()).is_some_and(|begin| begin.eq_ignore_ascii_case(with.as_bytes()))
    };
    let known: [(&[&str], &str, &'static str); 8] = [
        (&["version https://git-lfs"], "a pointer of Git LFS", "run `git lfs pull` in its repository"),
        (&["<!doctype html", "<html"], "a page of a web site", "download the file itself (the raw file)"),
        (&["<?xml", "<"], "XML", "export the model as glTF"),
        (&["glTF"], "binary glTF", "let its name end in .glb"),
        (&["ply\n", "ply\r"], "PLY", "let its name end in .ply"),
        (&["solid "], "STL", "let its name end in .stl"),
        (&["PK\u{3}\u{4}", "\u{1f}", "7z", "Rar!"], "an archive", "unpack it first"),
        (&["v ", "mtllib ", "# Blender"], "OBJ", "let its name end in .obj"),
    ];
    match known.into_iter().find(|(begin, ..)| begin.iter().any(|begin| begins(begin))) {
        Some((_, other, remedy)) if other != format => {
            malformed("the file", format!("is {other}, not {format}"), remedy)
        }
        _ => otherwise(),
    }
}
