//! glTF 2.0 documents to scenes.
//!
//! Data flow one way: `container` (bytes to JSON and binary chunk) -> `json` (to the types of `schema`) -> `extensions`,
//! `variants` -> `graph` from its `roots` (what is drawn, and where) -> `validate` (no index is trusted before) -> `document`
//! (`buffers` with `meshopt`, `draco`, then accessors) -> `images`, `materials` -> `animations` -> `surface` ->
//! `shading` -> `pose` -> `mesh` -> `instances`, `lights`. The other formats come in as a document ([`crate::plain`]).

mod animations;
#[cfg_attr(not(feature = "codecs"), expect(dead_code))]
pub(crate) mod buffers;
mod container;
mod document;
#[cfg(feature = "codecs")]
mod draco;
mod extensions;
mod graph;
mod images;
mod instances;
mod json;
mod lights;
mod materials;
mod mesh;
#[cfg(feature = "codecs")]
mod meshopt;
mod pose;
mod roots;
#[cfg_attr(not(feature = "codecs"), expect(dead_code))]
pub(crate) mod schema;
mod shading;
mod skins;
mod surface;
mod validate;
mod variants;

pub use extensions::{Treatment, extension_treatment};

#[cfg(not(feature = "codecs"))]
use crate::absent::{draco, meshopt};
use crate::shared::error::{Result, one_line};
use crate::shared::limits::Budget;
use document::Document;
use graph::Graph;
use schema::Root;
use std::borrow::Cow;
use std::path::Path;
use zfail_scene::{Animated, Scene};

/// The document in the bytes of a `.glb` or `.gltf` file, and its binary chunk.
pub(crate) fn document<'a>(
    bytes: &'a [u8],
    budget: &Budget,
    notices: &mut Vec<String>,
) -> Result<(Root, Option<&'a [u8]>)> {
    let container = container::open(bytes, notices)?;
    let root = json::parse(container.json, budget, notices)?;
    validate::check_version(&root, notices)?;
    extensions::check(&root, notices);
    Ok((root, container.bin))
}

/// The scene of a document in `folder`, with the materials of `variant`. It is `scene`, which has a name and the notices so
/// far, with everything else added.
pub(crate) fn scene(
    mut root: Root,
    bin: Option<Cow<'_, [u8]>>,
    folder: &Path,
    variant: Option<&str>,
    budget: Budget,
    mut scene: Scene,
) -> Result<Animated> {
    variants::choose(&mut root, variant, &mut scene.notices)?;
    let graph = Graph::new(&root, &budget, &mut scene.notices)?;
    validate::check(&mut root, &graph, &mut scene.notices)?;
    let document = Document::open(root, bin, folder, budget, &mut scene.notices)?;

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
    Ok(motion.animate(scene))
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
