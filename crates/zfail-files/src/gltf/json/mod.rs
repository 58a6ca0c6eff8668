//! From JSON text to the typed document.
//!
//! In: the text. Out: the document, without optional parts that could not be understood; each is named in a notice.
//! A sound file is parsed once. Otherwise `text` mends what is no JSON, and parts of the wrong shape are taken out one by
//! one (`optional`) until the rest can be read, or the fault is one that the scene cannot do without.

mod optional;
mod text;

use super::schema::Root;
use crate::shared::error::{Fault, Result, invalid};
use crate::shared::limits::Budget;
use serde::Deserialize;
use serde_json::{Deserializer, Value};

/// Parses the document of a glTF file.
pub(super) fn parse(text: &[u8], budget: &Budget, notices: &mut Vec<String>) -> Result<Root> {
    // Some exporters pad the JSON chunk with zeros instead of spaces.
    let end = text.iter().rposition(|byte| *byte != 0 && !byte.is_ascii_whitespace()).map_or(0, |last| last + 1);
    let text = &text[..end];
    charge(text, budget)?;
    let first = match typed(text) {
        Ok(root) => return Ok(root),
        Err(fault) => fault,
    };
    // Now as a tree, which is larger, beside what will be made of it.
    charge(text, budget)?;
    budget.charge(count(text, b',').saturating_add(count(text, b':')), 96, || "the JSON".into())?;
    let mut tree: Value = match serde_json::from_slice(text) {
        Ok(tree) => tree,
        Err(_) => {
            let (mended, what) = text::mend(text);
            let Ok(tree) = serde_json::from_slice(mended.as_bytes()) else { return Err(first) };
            notices.push(format!("the JSON is mended: {what}"));
            tree
        }
    };
    remove_nulls(&mut tree);
    check_generation(&tree)?;
    without_what_cannot_be_read(tree, text.len(), notices)
}

/// Parsed JSON is larger than its text: `{}` may become a material. Commas bound the other values.
fn charge(text: &[u8], budget: &Budget) -> Result<()> {
    budget.charge(count(text, b'{'), 1024, || "the JSON".into())?;
    budget.charge(count(text, b','), size_of::<Value>() as u64, || "the JSON".into())
}

fn count(text: &[u8], byte: u8) -> u64 {
    text.iter().filter(|b| **b == byte).count() as u64
}

fn typed(text: &[u8]) -> Result<Root> {
    let mut deserializer = Deserializer::from_slice(text);
    let root = serde_path_to_error::deserialize(&mut deserializer).map_err(|e| fault(&e))?;
    deserializer.end().map_err(|e| invalid("the JSON", e.to_string()))?;
    Ok(root)
}

fn fault(error: &serde_path_to_error::Error<serde_json::Error>) -> Fault {
    let path = error.path().to_string();
    invalid(if path == "." { "the JSON" } else { &path }, error.inner().to_string())
}

fn without_what_cannot_be_read(mut tree: Value, length: usize, notices: &mut Vec<String>) -> Result<Root> {
    /// Parts that are taken out, and how much may be read again for it.
    const MOST_PARTS: usize = 500;
    const MOST_BYTES: usize = 1 << 28;
    for _ in 0..MOST_PARTS.min(MOST_BYTES / length.max(1)) {
        let error = match serde_path_to_error::deserialize::<_, Root>(&tree) {
            Ok(root) => return Ok(root),
            Err(error) => error,
        };
        let problem = error.inner().to_string();
        if !optional::take_out(&mut tree, error.path(), &problem) {
            return Err(fault(&error));
        }
        notices.push(format!("{} is left out: {problem}", error.path()));
    }
    serde_path_to_error::deserialize(&tree).map_err(|error| fault(&error))
}

/// A member that is null is as good as absent.
fn remove_nulls(tree: &mut Value) {
    match tree {
        Value::Array(list) => list.iter_mut().for_each(remove_nulls),
        Value::Object(members) => {
            members.retain(|_, value| !value.is_null());
            members.values_mut().for_each(remove_nulls);
        }
        _ => {}
    }
}

/// Refuses glTF 1.0, which has objects where glTF 2.0 has arrays.
fn check_generation(tree: &Value) -> Result<()> {
    #[derive(Deserialize)]
    struct Head {
        version: Value,
    }
    let version = tree.get("asset").and_then(|asset| Head::deserialize(asset).ok()).map(|head| match head.version {
        Value::String(text) => text,
        other => other.to_string(),
    });
    let is_old = version.as_ref().is_some_and(|version| version.starts_with("1.") || version.starts_with("0."));
    let has_maps = ["meshes", "nodes", "accessors"].iter().any(|list| tree.get(list).is_some_and(Value::is_object));
    if is_old || version.is_none() && has_maps { Err(Fault::old(version.as_deref().unwrap_or("1.0"))) } else { Ok(()) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Limits;

    fn read(text: &str) -> (std::result::Result<Root, String>, Vec<String>) {
        let mut notices = Vec::new();
        let root = parse(text.as_bytes(), &Budget::new(Limits::default()), &mut notices);
        (root.map_err(|fault| fault.to_string()), notices)
    }

    #[test]
    fn optional_parts_of_the_wrong_shape_are_left_out() {
        let (root, notices) = read(
            r#"{"asset": {"version": "2.0", "generator": 7}, "extensionsUsed": "none", "scene": "main",
                "nodes": [{"name": 5, "mesh": 0, "camera": "c", "extensions": {"KHR_lights_punctual": [], "X": 1}}],
                "meshes": [{"name": [], "primitives": [{"attributes": {"POSITION": 0, "NORMAL": -1}, "material": "red"}]}],
                "materials": [{"name": "kept", "emissiveFactor": [0, "x", 0], "alphaMode": "FOO", "normalTexture": {}}, 3],
                "cameras": [{"perspective": {"yfov": "wide"}}], "animations": [{"channels": [{"sampler": -1}]}],
                "accessors": [{"componentType": 5130, "count": 3, "type": "VEC3"}], "skins": [],
                "extensions": {"KHR_lights_punctual": {"lights": [{"type": "moon"}, {"type": "point"}]}}}"#,
        );
        let root = root.unwrap();
        assert_eq!((root.nodes[0].mesh, root.nodes[0].camera, root.scene), (Some(0), None, None));
        assert_eq!(root.meshes[0].primitives[0].attributes.len(), 1);
        assert_eq!((root.materials.len(), root.materials[0].name.as_deref()), (2, Some("kept")));
        assert_eq!((root.cameras.len(), root.animations[0].channels.len()), (1, 1));
        let lights = root.extensions.lights.unwrap().lights;
        assert!(lights[0].kind.is_none() && lights[1].kind.is_some(), "indices stay");
        assert!(root.accessors[0].fault.as_ref().is_some_and(|fault| fault.contains("5130")));
        assert!(notices.iter().any(|notice| notice.starts_with("materials[0].emissiveFactor[1] is left out: invalid")));
    }

    #[test]
    fn what_the_scene_needs_is_an_error() {
        for (text, expected) in [
            (r#"{"nodes": [{"translation": [0, "x", 0]}]}"#, "nodes[0].translation[1]: invalid type"),
            (r#"{"nodes": [{"mesh": -1}]}"#, "nodes[0].mesh: invalid value"),
            (r#"{"meshes": [{}]}"#, "meshes[0]: missing field `primitives`"),
            (r#"{"meshes": [{"primitives": [{"attributes": {"POSITION": "a"}}]}]}"#, "attributes.POSITION: invalid"),
            (r#"{"buffers": [{"byteLength": -1}]}"#, "buffers[0].byteLength: invalid value"),
            ("{} {}", "the JSON: trailing characters"),
            (r#"{"nodes": ["#, "EOF while parsing"),
        ] {
            let (root, notices) = read(text);
            let error = root.expect_err(text);
            assert!(error.contains(expected) && notices.is_empty(), "{error} lacks {expected}; {notices:?}");
        }
    }

    #[test]
    fn text_that_is_no_json_is_mended() {
        let (root, notices) =
            read("{\"nodes\": [{\"name\": \"a\tb\", \"scale\": [1, .5, 1e999]},], \"accessors\": null}\0\0");
        let root = root.unwrap();
        assert_eq!(root.nodes[0].name.as_deref(), Some("a b"));
        assert_eq!(root.nodes[0].scale, Some([1.0, 0.5, f64::MAX]));
        assert_eq!(notices.len(), 1, "{notices:?}");
    }

    #[test]
    fn the_older_generation_is_named() {
        for text in [
            r#"{"asset": {"version": "1.0"}, "meshes": {}, "nodes": {}}"#,
            r#"{"asset": {"version": 1.1}, "nodes": {"a": {}}}"#,
            r#"{"nodes": {"a": {}}}"#,
        ] {
            let error = read(text).0.expect_err(text);
            assert!(error.contains("is glTF 1.") && error.contains("gltf-pipeline"), "{error}");
        }
        assert!(read(r#"{"asset": {"version": "2.0"}, "nodes": {"a": {}}}"#).0.is_err_and(|e| !e.contains("glTF 1.")));
    }
}
