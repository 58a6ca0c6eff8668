//! glTF 2.0 files to scenes; .obj, .stl and .ply files too.
//!
//! Data flow one way: `container` (bytes to JSON and binary chunk) -> `json` (to the types of `schema`) -> `extensions`,
//! `variants` -> `graph` from its `roots` (what is drawn, and where) -> `validate` (no index is trusted before) -> `document`
//! (`buffers` with `meshopt`, `draco`, then accessors) -> `images` with `ktx`, `materials` -> `animations` -> `surface` ->
//! `shading` -> `pose` -> `mesh` -> `instances`, `lights`. The other formats, `obj` with `mtl`, `stl` and `ply`, become a glTF document first (`plain`).
//!
//! Whatever the bytes are, the result is a scene that satisfies the scene types' invariants or a [`LoadError`]; what
//! was repaired or left out is in [`Scene::notices`].
//!
//! # What is not looked at
//! Whatever nothing in the scene to draw uses: other scenes and their nodes, what hidden nodes hold, and meshes, skins,
//! accessors and buffer views that are left over. Broken ones do no harm.
//!
//! # Repairs
//! What is there is loaded, with a notice that says what was wrong; an error is only what cannot be drawn truthfully.
//! - Left out: points and lines, primitives without positions, what remains of a triangle list after the last whole
//!   triangle, triangles with vertices that are not there, not finite, or moved by joints that are not there, meshes that a
//!   node's scale shrinks to a line or a point, images that are missing, unreadable, too large or of other formats than PNG,
//!   JPEG, WebP and KTX 2.0, normals, tangents, texture coordinates and colours that cannot be read, cameras and lights
//!   that make no sense, what [`extension_treatment`] says is ignored, animations of what extensions add and of nodes that
//!   have a matrix, channels that move something a second time or whose data are broken, and any optional part of the JSON
//!   that is not of its type.
//! - Replaced: missing normals (flat ones, on vertices of their own) and those without a direction, texture
//!   coordinates and colours that are not finite, rotations without length, joint weights that do not add up to 1, inverse
//!   bind matrices of zeros (the identity). Textures without a readable image: by plain factors, but without metal or glow
//!   where the texture was to confine these, and opaque where it was to mask or to let light through.
//! - Sorted: key frames.
//! - Chosen: all nodes where the file has no scene, or one that names none. A node that hangs below two others is drawn
//!   below both; one that the scene lists beside its parent is drawn below it, once.
//! - Approximated: materials, as [`extension_treatment`] says of each extension.
//! - Tolerated: text that is nearly JSON, byte order marks, chunks and accessors that are not aligned, missing bounds of
//!   accessors, the restart value as a vertex in lists of triangles, lengths that promise more than anything needs, bytes
//!   after the end, key frames before time 0 and two at the same time.
//! - Told, but drawn as it is: normals that disagree with the triangles.
//! - Baked into meshes of their own, in world space: skins (at rest, until an animation bends them) and meshes that their
//!   node flattens into a plane.
//! - Moved: a mesh far from its own origin, exactly, with the translation in its instances.
//! - While an animation flattens a mesh or makes it vanish, it keeps an invisible thickness, so that transforms stay
//!   invertible; what an animation takes beyond 10^15 m stays at its place of rest, or in its rest pose, meanwhile.
//!
//! # Extensions
//! - Geometry: KHR_draco_mesh_compression, EXT_meshopt_compression, KHR_meshopt_compression (what is compressed replaces
//!   the fallback, which need not exist), KHR_mesh_quantization, EXT_mesh_gpu_instancing.
//! - Images: KHR_texture_basisu, EXT_texture_webp (each before the texture's own source, which takes over where the
//!   extension's image cannot be read), KHR_texture_transform.
//! - Nodes: KHR_node_visibility; what is hidden neither is drawn nor casts, and hidden lights do not shine.
//! - Lights and materials: KHR_lights_punctual and what [`extension_treatment`] tells.
//!
//! # Other formats
//! - .obj with .mtl: groups become one mesh. y is up. Missing libraries and textures leave a surface grey or plain.
//! - .stl, binary or ASCII, and .ply with polygons or strips, normals, colours (sRGB) and texture coordinates: z is up.
//! - None has units: one unit is one metre. All surfaces are shown from both sides. Polygons are cut
//!   into triangles, concave ones without overlaps.
//! - Text is in any superset of ASCII, or UTF-16; lines end in LF, CR LF or CR. A face, an attribute of a face or a line
//!   of a library that cannot be used is left out, and counted in a notice.
//! - A model that lies far from its file's origin keeps that origin in double precision.
//!
//! # Extras
//! What glTF has no word for, in the extras of nodes:
//! - `castShadow`, a boolean: whether the meshes at and below the node block light, unless a node between says otherwise.
//!
//! And on the nodes of lights:
//! - `shadowExclude`, an array of names: what is at and below nodes of these names casts no shadow from the light.
//! - `falloff`, an array of two or more numbers, not negative: irradiance per intensity from the light to its range, which
//!   must be given, at equal steps and linear between. It replaces the inverse-square law of a point or spot light.
//! - `cookie`, the index of a texture whose colours (sRGB) a spot light projects, over the square around its outer cone,
//!   upright as seen from the light: right is the node's +x, up its +y. A mirrored node does not mirror it.
//! - `box`, three numbers above 0: half extents, in metres along the node's axes, of a box around the light beyond which a
//!   point or spot light reaches nothing. As with the range, a node's scale does not change it.
//!
//! A value of the last three that does not fit is left out, with a notice: it may mean something else to its author.
//!
//! Everything else that breaks the specification and bears on where the scene's surfaces are is an error.

#[cfg(not(feature = "codecs"))]
mod absent;
mod animations;
#[cfg_attr(not(feature = "codecs"), expect(dead_code))]
mod buffers;
mod container;
mod document;
#[cfg(feature = "codecs")]
mod draco;
mod error;
mod extensions;
mod fence;
mod graph;
mod images;
mod info;
mod instances;
mod json;
#[cfg(feature = "codecs")]
mod ktx;
mod lights;
mod limits;
mod materials;
mod mesh;
#[cfg(feature = "codecs")]
mod meshopt;
mod obj;
mod plain;
mod ply;
mod polygon;
mod pose;
mod raster;
mod roots;
#[cfg_attr(not(feature = "codecs"), expect(dead_code))]
mod schema;
mod shading;
mod skins;
mod stl;
mod surface;
mod uri;
mod validate;
mod variants;

pub use error::{Fault, LoadError};
pub use extensions::{Treatment, extension_treatment};
pub use info::{ChannelInfo, FileInfo, MorphInfo, SkinInfo};
pub use limits::Limits;

#[cfg(not(feature = "codecs"))]
use absent::{draco, ktx, meshopt};

use crate::animate::Animated;
use document::Document;
use error::{Result, one_line};
use graph::Graph;
use limits::Budget;
use schema::Root;
use std::borrow::Cow;
use std::fs;
use std::io;
use std::path::Path;
use zfail_plan::scene::Scene;

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
    let Opened { mut root, bin, info } = open(&bytes, path, folder, &name, &budget, &mut notices)?;
    variants::choose(&mut root, variant, &mut notices)?;
    let graph = Graph::new(&root, &budget, &mut notices)?;
    validate::check(&mut root, &graph, &mut notices)?;
    let document = Document::open(root, bin, folder, budget, &mut notices)?;

    let mut scene = Scene { name, notices, ..Scene::default() };
    let textures = read_materials(&document, folder, &mut scene)?;
    let mut motion = animations::read(&document, &graph, &mut scene.notices)?;
    let held = instances::read(&document, &graph, &mut motion, &mut scene)?;
    lights::read_lights(&document.root, &graph, &held, &textures, &document.budget, &mut motion, &mut scene)?;
    lights::read_cameras(&document.root, &graph, &mut motion, &mut scene);
    read_surroundings(&document.root, &mut scene);
    if scene.instances.is_empty() {
        scene.notices.push("the scene has no triangles".into());
    }
    tidy(&mut scene.notices);
    Ok((motion.animate(scene), info))
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
            let container = container::open(bytes, notices)?;
            let root = json::parse(container.json, budget, notices)?;
            validate::check_version(&root, notices)?;
            extensions::check(&root, notices);
            let info = FileInfo::of(&root);
            return Ok(Opened { root, bin: container.bin.map(Cow::Borrowed), info });
        }
    };
    notices.extend_from_slice(&plain.notices);
    let format = plain.format;
    let (root, bin) = plain.into_document(name, budget)?;
    let info = FileInfo { format, version: String::new(), ..FileInfo::of(&root) };
    Ok(Opened { root, bin: Some(Cow::Owned(bin)), info })
}

/// Returns the scene's textures by the document's index.
fn read_materials(document: &Document<'_>, folder: &Path, scene: &mut Scene) -> Result<Vec<Option<usize>>> {
    let mut index = Vec::new();
    for image in images::read(document, folder, &mut scene.notices)? {
        index.push(image.map(|image| {
            scene.images.push(image);
            scene.images.len() - 1
        }));
    }
    let (textures, index) = materials::textures(&document.root, &index);
    scene.textures = textures;
    scene.materials = materials::materials(&document.root, &index, scene);
    Ok(index)
}

/// The ambient and background radiance that [`crate::write`] keeps in the scene's extras.
fn read_surroundings(root: &Root, scene: &mut Scene) {
    let Some(roots) = root.scenes.get(root.scene.unwrap_or(0)) else { return };
    let color = |name: &str| -> Option<[f32; 3]> {
        let color: [f32; 3] = serde_json::from_value(roots.extras.get(name)?.clone()).ok()?;
        color.iter().all(|c| c.is_finite() && *c >= 0.0).then_some(color)
    };
    scene.ambient = color("ambient").unwrap_or_default();
    scene.background = color("background").unwrap_or_default();
}

/// More notices than anybody reads are cut short.
const MAX_NOTICES: usize = 50;

fn tidy(notices: &mut Vec<String>) {
    notices.iter_mut().for_each(|notice| *notice = one_line(notice));
    let mut seen = rustc_hash::FxHashSet::default();
    notices.retain(|notice| seen.insert(notice.clone()));
    if notices.len() > MAX_NOTICES {
        let more = notices.len() - MAX_NOTICES;
        notices.truncate(MAX_NOTICES);
        notices.push(format!("... and {more} more"));
    }
}
