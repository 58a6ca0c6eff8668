//! The pass before trust: after it, every index that is left in the document leads somewhere.
//!
//! In: the parsed document and its nodes as they will be visited. Out: the document without what nothing drawn uses, which is
//! not looked at, and without optional parts that lead nowhere, with notices; or the first fault, by its JSON path, that
//! the scene cannot be drawn with. Bytes are checked later, as they are read.

use super::graph::Graph;
use super::schema::{Animation, Camera, Node, Primitive, Root};
use crate::shared::error::{Fault, Result, invalid, refused};
use std::fmt::Display;

/// Refuses what is of another version; what the version says is only a word otherwise.
pub(super) fn check_version(root: &Root, notices: &mut Vec<String>) -> Result<()> {
    let numbers = |text: &str| {
        let (major, minor) = text.split_once('.').unwrap_or((text, "0"));
        Some((major.trim().parse::<u32>().ok()?, minor.trim().parse::<u32>().unwrap_or(0)))
    };
    let version = &root.asset.version;
    match numbers(version) {
        Some((2, _)) => {}
        Some((0 | 1, _)) => return Err(Fault::old(version)),
        Some(_) => {
            let problem = format!("this is glTF {version}; only 2.x can be read");
            return Err(refused("asset.version", problem, "convert the file"));
        }
        None if root.nodes.is_empty() && root.meshes.is_empty() => {
            return Err(invalid("asset.version", "is missing or not of the form `2.0`"));
        }
        None => notices.push("asset.version is missing or not of the form `2.0`: read as glTF 2.0".into()),
    }
    match root.asset.min_version.as_deref().map(numbers) {
        Some(Some(least)) if least > (2, 0) => {
            let problem = "asks for more than glTF 2.0, which is what can be read";
            Err(refused("asset.minVersion", problem, "export the file for glTF 2.0"))
        }
        _ => Ok(()),
    }
}

/// Checks references, and takes out what is not needed and what can be spared.
pub(super) fn check(root: &mut Root, graph: &Graph, notices: &mut Vec<String>) -> Result<()> {
    let nodes = nodes(root, graph, notices)?;
    meshes(root, &nodes, notices)?;
    skins(root, notices)?;
    let counts = Counts::of(root);
    for (i, animation) in root.animations.iter_mut().enumerate() {
        channels(i, animation, &counts, notices);
    }
    textures(root, notices);
    for (i, camera) in root.cameras.iter_mut().enumerate() {
        if let Err(problem) = projection(camera) {
            notices.push(format!("cameras[{i}] is left out: {problem}"));
            *camera = Camera::default();
        }
    }
    Ok(())
}

/// How much there is of what can be referred to.
struct Counts {
    accessors: usize,
    nodes: usize,
}

impl Counts {
    fn of(root: &Root) -> Self {
        Self { accessors: root.accessors.len(), nodes: root.nodes.len() }
    }
}

fn within(index: usize, count: usize, what: &str, element: impl Display) -> Result<()> {
    if index < count { Ok(()) } else { Err(invalid(element.to_string(), dangling(index, count, what))) }
}

fn optional(index: Option<usize>, count: usize, what: &str, element: impl Display) -> Result<()> {
    index.map_or(Ok(()), |index| within(index, count, what, element))
}

fn dangling(index: usize, count: usize, what: &str) -> String {
    format!("refers to {what}[{index}], but the file has {count}")
}

/// Clears `slot` with a notice if it leads nowhere.
fn spare(slot: &mut Option<usize>, count: usize, what: &str, element: impl Display, notices: &mut Vec<String>) {
    if let Some(index) = slot.filter(|&index| index >= count) {
        notices.push(format!("{element} {}: left out", dangling(index, count, what)));
        *slot = None;
    }
}

/// Checks what drawn nodes hold and empties the others. Returns which meshes are drawn.
fn nodes(root: &mut Root, graph: &Graph, notices: &mut Vec<String>) -> Result<Vec<bool>> {
    let (mut visited, mut visible) = (vec![false; root.nodes.len()], vec![false; root.nodes.len()]);
    for visit in &graph.visits {
        visited[visit.node] = true;
        visible[visit.node] |= visit.is_visible;
    }
    let (meshes, skins, cameras) = (root.meshes.len(), root.skins.len(), root.cameras.len());
    let (lights, accessors) = (root.extensions.lights.as_ref().map_or(0, |l| l.lights.len()), root.accessors.len());
    let mut drawn = vec![false; meshes];
    for (i, node) in root.nodes.iter_mut().enumerate() {
        if !visited[i] {
            node.camera = None;
        }
        if !visible[i] {
            let Node { mesh, skin, extensions, .. } = node;
            (*mesh, *skin, extensions.light, extensions.instancing) = (None, None, None, None);
        }
        optional(node.mesh, meshes, "meshes", format_args!("nodes[{i}].mesh"))?;
        node.skin = node.skin.filter(|_| node.mesh.is_some());
        optional(node.skin, skins, "skins", format_args!("nodes[{i}].skin"))?;
        spare(&mut node.camera, cameras, "cameras", format_args!("nodes[{i}].camera"), notices);
        if let Some(light) = node.extensions.light.take_if(|light| light.light >= lights) {
            let element = format!("nodes[{i}].extensions.KHR_lights_punctual.light");
            let problem = dangling(light.light, lights, "extensions.KHR_lights_punctual.lights");
            notices.push(format!("{element} {problem}: left out"));
        }
        if let Some(instancing) = &node.extensions.instancing {
            let path = format!("nodes[{i}].extensions.EXT_mesh_gpu_instancing.attributes");
            for (name, &accessor) in &instancing.attributes {
                within(accessor, accessors, "accessors", format_args!("{path}.{name}"))?;
            }
        }
        node.mesh.iter().for_each(|&mesh| drawn[mesh] = true);
    }
    Ok(drawn)
}

fn meshes(root: &mut Root, drawn: &[bool], notices: &mut Vec<String>) -> Result<()> {
    let (accessors, materials, views) = (root.accessors.len(), root.materials.len(), root.buffer_views.len());
    for (i, mesh) in root.meshes.iter_mut().enumerate() {
        if !drawn[i] {
            mesh.primitives.clear();
        }
        for (j, primitive) in mesh.primitives.iter_mut().enumerate() {
            let path = format!("meshes[{i}].primitives[{j}]");
            spare(&mut primitive.material, materials, "materials", format_args!("{path}.material"), notices);
            optional(primitive.indices, accessors, "accessors", format_args!("{path}.indices"))?;
            attributes(primitive, accessors, &path, notices)?;
            if let Some(draco) = &primitive.extensions.draco {
                let element = format_args!("{path}.extensions.KHR_draco_mesh_compression.bufferView");
                within(draco.buffer_view, views, "bufferViews", element)?;
            }
        }
    }
    Ok(())
}

/// Attributes that lead nowhere can be spared if they move no vertex.
fn attributes(primitive: &mut Primitive, accessors: usize, path: &str, notices: &mut Vec<String>) -> Result<()> {
    let Primitive { attributes, targets, extensions, .. } = primitive;
    let targets = targets.iter_mut().enumerate().map(|(t, target)| (format!("targets[{t}]"), target));
    for (list, attributes) in std::iter::once(("attributes".to_owned(), attributes)).chain(targets) {
        let lost: Vec<(String, usize)> =
            attributes.iter().filter(|(_, a)| **a >= accessors).map(|(name, &a)| (name.clone(), a)).collect();
        for (name, accessor) in lost {
            let (element, problem) = (format!("{path}.{list}.{name}"), dangling(accessor, accessors, "accessors"));
            if moves_vertices(&name) {
                return Err(invalid(element, problem));
            }
            notices.push(format!("{element} {problem}: left out"));
            attributes.remove(&name);
            if let Some(draco) = &mut extensions.draco {
                draco.attributes.remove(&name);
            }
        }
    }
    Ok(())
}

/// Whether an attribute decides where vertices are. The others can be spared.
pub(super) fn moves_vertices(attribute: &str) -> bool {
    attribute == "POSITION" || attribute.starts_with("JOINTS_") || attribute.starts_with("WEIGHTS_")
}

/// Checks skins of drawn nodes and empties the others.
fn skins(root: &mut Root, notices: &mut Vec<String>) -> Result<()> {
    let (nodes, accessors) = (root.nodes.len(), root.accessors.len());
    let mut worn = vec![false; root.skins.len()];
    root.nodes.iter().filter_map(|node| node.skin).for_each(|skin| worn[skin] = true);
    for (i, skin) in root.skins.iter_mut().enumerate() {
        if !worn[i] {
            *skin = Default::default();
            continue;
        }
        for (j, &joint) in skin.joints.iter().enumerate() {
            within(joint, nodes, "nodes", format_args!("skins[{i}].joints[{j}]"))?;
        }
        optional(skin.inverse_bind_matrices, accessors, "accessors", format_args!("skins[{i}].inverseBindMatrices"))?;
        if skin.joints.is_empty() {
            notices.push(format!("skins[{i}] has no joints: its meshes are left in their own space"));
            root.nodes.iter_mut().filter(|node| node.skin == Some(i)).for_each(|node| node.skin = None);
        }
    }
    Ok(())
}

/// Marks channels that lead nowhere.
fn channels(i: usize, animation: &mut Animation, counts: &Counts, notices: &mut Vec<String>) {
    for (j, sampler) in animation.samplers.iter_mut().enumerate() {
        let path = format!("animations[{i}].samplers[{j}]");
        spare(&mut sampler.input, counts.accessors, "accessors", format_args!("{path}.input"), notices);
        spare(&mut sampler.output, counts.accessors, "accessors", format_args!("{path}.output"), notices);
    }
    for (j, channel) in animation.channels.iter_mut().enumerate() {
        let path = format!("animations[{i}].channels[{j}]");
        let samplers = animation.samplers.len();
        spare(&mut channel.sampler, samplers, "samplers", format_args!("{path}.sampler"), notices);
        let target = &mut channel.target.node;
        if target.is_some_and(|node| node >= counts.nodes) {
            spare(target, counts.nodes, "nodes", format_args!("{path}.target.node"), notices);
            channel.sampler = None;
        }
    }
}

/// Takes out what leads nowhere; all of it can be spared. Texture slots of materials are looked up when they are read.
fn textures(root: &mut Root, notices: &mut Vec<String>) {
    let (samplers, images, views) = (root.samplers.len(), root.images.len(), root.buffer_views.len());
    for (i, texture) in root.textures.iter_mut().enumerate() {
        spare(&mut texture.sampler, samplers, "samplers", format_args!("textures[{i}].sampler"), notices);
        let extensions = &mut texture.extensions;
        for (source, path) in [
            (&mut texture.source, "source"),
            (&mut extensions.basisu.source, "extensions.KHR_texture_basisu.source"),
            (&mut extensions.webp.source, "extensions.EXT_texture_webp.source"),
        ] {
            spare(source, images, "images", format_args!("textures[{i}].{path}"), notices);
        }
    }
    for (i, image) in root.images.iter_mut().enumerate() {
        spare(&mut image.buffer_view, views, "bufferViews", format_args!("images[{i}].bufferView"), notices);
    }
}

fn projection(camera: &Camera) -> std::result::Result<(), &'static str> {
    let require = |holds: bool, problem| if holds { Ok(()) } else { Err(problem) };
    match (&camera.perspective, &camera.orthographic) {
        (Some(p), None) => {
            require(p.yfov > 0.0 && p.yfov < std::f64::consts::PI, "perspective.yfov must lie between 0 and pi")?;
            require(p.znear > 0.0, "perspective.znear must be positive")?;
            require(p.zfar.is_none_or(|far| far > p.znear), "perspective.zfar must exceed znear")
        }
        (None, Some(o)) => {
            require(o.ymag != 0.0, "orthographic.ymag must not be zero")?;
            require(o.zfar > o.znear, "orthographic.zfar must exceed znear")
        }
        _ => Err("it needs exactly one of `perspective` and `orthographic`"),
    }
}
