//! What becomes of each glTF extension.

use super::schema::Root;
use Treatment::{Approximated, Ignored, Read};

/// How the loader treats an extension.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Treatment {
    /// Read in full, or without influence on what is shown.
    Read,
    /// Shown so.
    Approximated(&'static str),
    /// Left out, which means this.
    Ignored(&'static str),
}

/// What the loader makes of the extension `name`.
#[must_use]
pub fn extension_treatment(name: &str) -> Treatment {
    match name {
        "EXT_mesh_gpu_instancing"
        | "EXT_meshopt_compression"
        | "EXT_texture_webp"
        | "KHR_draco_mesh_compression"
        | "KHR_lights_punctual"
        | "KHR_materials_emissive_strength"
        | "KHR_materials_ior"
        | "KHR_materials_pbrSpecularGlossiness"
        | "KHR_materials_unlit"
        | "KHR_materials_variants"
        | "KHR_mesh_quantization"
        | "KHR_meshopt_compression"
        | "KHR_node_visibility"
        | "KHR_texture_basisu"
        | "KHR_texture_transform"
        | "KHR_xmp"
        | "KHR_xmp_json_ld" => Read,
        "KHR_materials_clearcoat" => Approximated("without textures of the coat's roughness and normals"),
        "KHR_materials_sheen" => Approximated("without a texture of the sheen's roughness"),
        "KHR_materials_specular" => Approximated("without a texture of the specular strength"),
        "KHR_materials_transmission" => {
            Approximated("seen through in a straight line and sharply; opaque if little light passes on average")
        }
        "KHR_materials_volume" => Approximated("a tint by the thickness factor, without refraction"),
        "KHR_materials_anisotropy" => Ignored("highlights are round"),
        "KHR_materials_dispersion" => Ignored("light is not split into colours"),
        "KHR_materials_iridescence" => Ignored("reflections do not change colour with the angle"),
        "KHR_materials_diffuse_transmission" => Ignored("no light is scattered through the surface"),
        "KHR_animation_pointer" => Ignored("only nodes and morph weights move"),
        name if name.starts_with("KHR_materials_") => Ignored("materials are shown without it"),
        _ => Ignored("what it adds is missing"),
    }
}

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
    // What is approximated is noted with the material that uses it.
    let Ignored(consequence) = extension_treatment(name) else { return None };
    let name: String = name.chars().take(80).collect();
    let required = if required { " although the file requires it" } else { "" };
    Some(format!("{name} is ignored{required}: {consequence}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_extension_has_a_treatment() {
        assert_eq!(extension_treatment("KHR_materials_unlit"), Read);
        assert!(matches!(extension_treatment("KHR_materials_volume"), Approximated(_)));
        assert!(matches!(extension_treatment("KHR_materials_iridescence"), Ignored(_)));
        assert!(matches!(extension_treatment("ACME_teapot"), Ignored(_)));
    }
}
