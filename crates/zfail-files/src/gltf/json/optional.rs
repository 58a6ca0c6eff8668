//! Parts of a document that its geometry can do without.
//!
//! In: a document as a tree, and where it could not be understood. Out: the tree without the smallest part around that
//! place that can be spared. Elements that others name by index leave something in their place.

use serde_json::{Value, json};
use serde_path_to_error::{Path, Segment};

/// Takes the part at `path` out, because of `problem`; returns whether there is one.
pub(super) fn take_out(tree: &mut Value, path: &Path, problem: &str) -> bool {
    let segments: Vec<&Segment> = path.iter().collect();
    let words: Vec<&str> = segments.iter().map(|segment| word(segment)).collect();
    let Some(length) = spared(&words) else { return false };
    let Some((last, parents)) = segments[..length].split_last() else { return false };
    let mut parent = tree;
    for segment in parents {
        let child = match segment {
            Segment::Seq { index } => parent.get_mut(*index),
            Segment::Map { key } => parent.get_mut(key),
            _ => None,
        };
        let Some(child) = child else { return false };
        parent = child;
    }
    match (last, parent) {
        (Segment::Map { key }, Value::Object(members)) => members.remove(key).is_some(),
        (Segment::Seq { index }, Value::Array(list)) => {
            let Some(element) = list.get_mut(*index) else { return false };
            let stand_in = stand_in(words[0], &format!("{path}: {problem}"));
            // What stands in can be understood; were it not, this would never end.
            std::mem::replace(element, stand_in.clone()) != stand_in
        }
        _ => false,
    }
}

fn word(segment: &Segment) -> &str {
    match segment {
        Segment::Map { key } => key,
        // Stands for any index.
        _ => "#",
    }
}

/// What takes the place of an element of the document's array `list`, because of `fault`.
fn stand_in(list: &str, fault: &str) -> Value {
    match list {
        "accessors" => json!({ "componentType": 5126, "count": 0, "type": "SCALAR", "fault": fault }),
        "bufferViews" => json!({ "buffer": 0, "byteLength": 0, "fault": fault }),
        _ => json!({}),
    }
}

/// How much of `path` leads to the part that can be spared.
fn spared(path: &[&str]) -> Option<usize> {
    match path {
        ["asset"] | ["scene"] | ["extensionsUsed" | "extensionsRequired", ..] | ["extensions"] => Some(1),
        ["asset", ..] => Some(2),
        ["extensions", "KHR_lights_punctual", "lights", "#", ..] => Some(4),
        ["extensions", ..] => Some(2),
        ["scenes", "#", property, ..] if *property != "nodes" => Some(3),
        ["nodes", "#", "extensions", "EXT_mesh_gpu_instancing", ..] => None,
        ["nodes", "#", "extensions", _, ..] => Some(4),
        ["nodes", "#", "name" | "camera" | "extensions" | "extras", ..] => Some(3),
        ["meshes", "#", "primitives", "#", rest @ ..] => of_primitive(rest).map(|length| 4 + length),
        ["meshes", "#", "name", ..] => Some(3),
        ["cameras" | "animations" | "materials" | "textures" | "samplers" | "images"] => Some(1),
        ["cameras", "#", ..] | ["accessors" | "bufferViews", "#", ..] => Some(2),
        ["animations", "#", "channels" | "samplers", "#", ..] => Some(4),
        // The innermost property.
        ["animations" | "materials" | "textures" | "samplers" | "images", "#", ..] => {
            path.iter().rposition(|word| *word != "#").map(|last| if last == 0 { 2 } else { last + 1 })
        }
        _ => None,
    }
}

fn of_primitive(path: &[&str]) -> Option<usize> {
    match path {
        ["material", ..] | ["extensions"] => Some(1),
        ["extensions", extension, ..] if *extension != "KHR_draco_mesh_compression" => Some(2),
        ["attributes", attribute, ..] => {
            let moves =
                *attribute == "POSITION" || attribute.starts_with("JOINTS_") || attribute.starts_with("WEIGHTS_");
            (!moves).then_some(2)
        }
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_smallest_part_is_spared() {
        let spared = |path: &str| spared(&path.split('/').collect::<Vec<_>>());
        for (path, length) in [
            ("materials/#/pbrMetallicRoughness/baseColorFactor/#", 4),
            ("materials/#", 2),
            ("materials", 1),
            ("cameras/#/perspective/yfov", 2),
            ("nodes/#/extensions/KHR_lights_punctual/light", 4),
            ("animations/#/channels/#/target/node", 4),
            ("animations/#/name", 3),
            ("meshes/#/primitives/#/attributes/TEXCOORD_0", 6),
            ("images/#/uri", 3),
        ] {
            assert_eq!(spared(path), Some(length), "{path}");
        }
        for path in ["nodes", "nodes/#/matrix/#", "scenes/#/nodes/#", "meshes/#/primitives/#/indices", "buffers/#", "."]
        {
            assert_eq!(spared(path), None, "{path}");
        }
    }
}
