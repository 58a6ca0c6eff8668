//! glTF 2.0 files to scenes.
//!
//! Data flow one way: `container` (bytes to JSON and binary chunk) -> `schema` (typed JSON) -> `extensions` and
//! `validate` (nothing is trusted before) -> `document` (buffers and accessors) -> `images`, `materials`
//! -> `graph` (world transforms) -> `animations` -> `surface` -> `shading` -> `pose` -> `mesh` -> `instances`, `lights`.
//!
//! Whatever the bytes are, the result is a scene that satisfies the scene types' invariants or a [`LoadError`]; what
//! was repaired or left out is in [`Scene::notices`].
//!
//! # Repairs
//! - Left out: points and lines, primitives without positions, what remains of a triangle list after the last whole
//!   triangle, meshes that a node's scale shrinks to a line or a point, images other than PNG and JPEG or damaged
//!   inside, every extension that only changes looks, animations of what extensions add and of nodes that have a matrix.
//! - Replaced: missing normals (flat ones, on vertices of their own) and those without a direction, texture
//!   coordinates and colours that are not finite, rotations without length, joint weights that do not add up to 1.
//! - Approximated: specular-glossiness (diffuse colour alone) and transmission (blending).
//! - Tolerated: a byte order mark, misaligned accessors, missing bounds of accessors, bytes after the end, a mesh or
//!   a skin that nothing uses, key frames before time 0 and two at the same time.
//! - Baked into meshes of their own, in world space: skins (at rest, until an animation bends them) and meshes that their
//!   node flattens into a plane.
//! - Moved: a mesh far from its own origin, exactly, with the translation in its instances.
//! - While an animation flattens a mesh or makes it vanish, it keeps an invisible thickness, so that transforms stay
//!   invertible; what an animation takes beyond 10^15 m stays at its place of rest, or in its rest pose, meanwhile.
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
//! Everything else that breaks the specification and bears on the scene is an error.

mod animations;
mod container;
mod document;
mod error;
mod extensions;
mod graph;
mod images;
mod info;
mod instances;
mod lights;
mod limits;
mod materials;
mod mesh;
mod pose;
mod schema;
mod shading;
mod surface;
mod uri;
mod validate;

pub use error::{Fault, LoadError};
pub use info::{ChannelInfo, FileInfo, MorphInfo, SkinInfo};
pub use limits::Limits;

use crate::animate::Animated;
use document::Document;
use error::{Result, invalid, one_line};
use graph::Graph;
use limits::Budget;
use schema::Root;
use std::fs;
use std::io;
use std::path::Path;
use zfail_plan::scene::Scene;

/// Loads the default scene of a `.glb` or `.gltf` file.
///
/// # Errors
/// If the file, or one it refers to, cannot be read, breaks the specification, requires a compression extension or
/// exceeds the default [`Limits`].
pub fn load(path: &Path) -> std::result::Result<Scene, LoadError> {
    load_with(path, &Limits::default())
}

/// [`load`] with other limits.
///
/// # Errors
/// As [`load`].
pub fn load_with(path: &Path, limits: &Limits) -> std::result::Result<Scene, LoadError> {
    load_with_info(path, limits).map(|(scene, _)| scene)
}

/// [`load_with`] that also tells what the file says about itself.
///
/// # Errors
/// As [`load`].
pub fn load_with_info(path: &Path, limits: &Limits) -> std::result::Result<(Scene, FileInfo), LoadError> {
    load_animated(path, limits).map(|(animated, info)| (animated.scene, info))
}

/// [`load_with_info`] with the file's animations.
///
/// # Errors
/// As [`load`].
pub fn load_animated(path: &Path, limits: &Limits) -> std::result::Result<(Animated, FileInfo), LoadError> {
    read(path, limits).map_err(|fault| LoadError { file: path.into(), fault })
}

fn read(path: &Path, limits: &Limits) -> Result<(Animated, FileInfo)> {
    let budget = Budget::new(*limits);
    let length = uri::regular_file_length(path).map_err(|problem| Fault::Unreadable(io::Error::other(problem)))?;
    budget.charge(length, 1, || "the file".into())?;
    let bytes = fs::read(path).map_err(Fault::Unreadable)?;
    let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let folder = path.parent().unwrap_or(Path::new("."));

    let mut notices = Vec::new();
    let container = container::open(&bytes, &mut notices)?;
    charge_json(container.json, &budget)?;
    let root = parse(container.json)?;
    extensions::check(&root, &mut notices)?;
    validate::check(&root)?;
    let info = FileInfo::of(&root);
    let document = Document::open(root, container.bin, folder, budget)?;

    let mut scene = Scene { name, notices, ..Scene::default() };
    let textures = read_materials(&document, folder, &mut scene)?;
    let graph = Graph::new(&document.root, &mut scene.notices)?;
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

/// Parsed JSON is larger than its text: `{}` may become a material. Commas bound the other values.
fn charge_json(json: &[u8], budget: &Budget) -> Result<()> {
    let count = |byte: u8| json.iter().filter(|b| **b == byte).count() as u64;
    budget.charge(count(b'{'), 1024, || "the JSON".into())?;
    budget.charge(count(b','), size_of::<serde_json::Value>() as u64, || "the JSON".into())
}

fn parse(json: &[u8]) -> Result<Root> {
    let mut deserializer = serde_json::Deserializer::from_slice(json);
    let root = serde_path_to_error::deserialize(&mut deserializer).map_err(|e| {
        let path = e.path().to_string();
        let element = if path == "." { "the JSON".into() } else { path };
        invalid(element, e.into_inner().to_string())
    })?;
    deserializer.end().map_err(|e| invalid("the JSON", e.to_string()))?;
    Ok(root)
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
    let (textures, index) = materials::textures(&document.root, &index, &mut scene.notices);
    scene.textures = textures;
    scene.materials = materials::materials(&document.root, &index, &mut scene.notices);
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
