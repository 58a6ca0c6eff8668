//! Which glTF extensions are read and which are left out.

use super::schema::Root;

/// Read in full, or without influence on a still picture.
const READ: &[&str] = &[
    "EXT_mesh_gpu_instancing",
    "EXT_meshopt_compression",
    "EXT_texture_webp",
    "KHR_draco_mesh_compression",
    "KHR_lights_punctual",
    "KHR_materials_emissive_strength",
    "KHR_materials_unlit",
    "KHR_mesh_quantization",
    "KHR_meshopt_compression",
    "KHR_texture_basisu",
    "KHR_texture_transform",
    "KHR_xmp_json_ld",
    "KHR_xmp",
];

/// Read in part; the loader says where it had to approximate.
const APPROXIMATED: &[&str] = &["KHR_materials_pbrSpecularGlossiness", "KHR_materials_transmission"];

/// Notes every extension that is left out.
pub(super) fn check(root: &Root, notices: &mut Vec<String>) {
    let mut named: Vec<&String> = Vec::new();
    for name in root.extensions_required.iter().chain(&root.extensions_used) {
        if !named.contains(&name) && named.len() < 64 {
            named.push(name);
            if let Some(notice) = notice(name, root.extensions_required.contains(name)) {
                notices.push(notice);
            }
        }
    }
}

fn notice(name: &str, required: bool) -> Option<String> {
    if READ.contains(&name) || APPROXIMATED.contains(&name) {
        return None;
    }
    let name: String = name.chars().take(80).collect();
    Some(if name.starts_with("KHR_materials_") {
        format!("{name} is ignored: the materials are shown without it")
    } else if required {
        format!("{name} is ignored although the file requires it: what it adds is missing")
    } else {
        format!("{name} is ignored")
    })
}
