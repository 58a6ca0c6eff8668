//! Which glTF extensions are read, ignored or refused.

use super::error::{Fault, Result};
use super::schema::Root;
use super::treatment::{Treatment, extension_treatment};

/// Read in full, or without influence on a still picture.
const READ: &[&str] = &[
    "EXT_mesh_gpu_instancing",
    "KHR_lights_punctual",
    "KHR_materials_emissive_strength",
    "KHR_materials_unlit",
    "KHR_mesh_quantization",
    "KHR_texture_transform",
    "KHR_xmp_json_ld",
    "KHR_xmp",
];

/// Without these the data cannot be read at all, and how to get rid of them.
const COMPRESSION: &[(&str, &str)] = &[
    ("KHR_draco_mesh_compression", WITHOUT_MESH_COMPRESSION),
    ("EXT_meshopt_compression", WITHOUT_MESH_COMPRESSION),
    ("KHR_meshopt_compression", WITHOUT_MESH_COMPRESSION),
    ("KHR_texture_basisu", "export again with PNG or JPEG textures"),
];

pub(super) const WITHOUT_MESH_COMPRESSION: &str = "export again without mesh compression";

/// Refuses files whose data cannot be read, and notes every extension that is left out.
pub(super) fn check(root: &Root, notices: &mut Vec<String>) -> Result<()> {
    for (i, name) in root.extensions_required.iter().enumerate() {
        if let Some(&(_, remedy)) = COMPRESSION.iter().find(|(known, _)| known == name) {
            let element = format!("extensionsRequired[{i}]");
            return Err(Fault::Extension { element, extension: name.clone(), remedy });
        }
    }
    let mut named: Vec<&String> = Vec::new();
    for name in root.extensions_required.iter().chain(&root.extensions_used) {
        if !named.contains(&name) && named.len() < 64 {
            named.push(name);
            if let Some(notice) = notice(name, root.extensions_required.contains(name)) {
                notices.push(notice);
            }
        }
    }
    Ok(())
}

fn notice(name: &str, required: bool) -> Option<String> {
    // What is approximated is noted with the material that uses it.
    if READ.contains(&name) || !matches!(extension_treatment(name), Treatment::Ignored(_)) {
        return None;
    }
    let name: String = name.chars().take(80).collect();
    Some(if name == "EXT_texture_webp" {
        format!("{name}: WebP images cannot be read; other images are used where the file has them")
    } else if name.starts_with("KHR_materials_") {
        format!("{name} is ignored: the materials are shown without it")
    } else if required {
        format!("{name} is ignored although the file requires it: what it adds is missing")
    } else {
        format!("{name} is ignored")
    })
}
