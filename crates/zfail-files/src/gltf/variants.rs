//! KHR_materials_variants: the same meshes in other materials.
//!
//! In: the parsed document and a choice. Out: the document with the chosen materials in its primitives, so that nothing after
//! knows of variants.

use super::schema::Root;
use crate::shared::error::{Fault, Result, one_line};

/// Gives primitives the materials of the variant that `wanted` names or numbers. Without a choice every primitive keeps its
/// own, and a notice lists what there is.
pub(super) fn choose(root: &mut Root, wanted: Option<&str>, notices: &mut Vec<String>) -> Result<()> {
    let variants = &root.extensions.variants.variants;
    let names = || variants.iter().map(|v| format!("'{}'", v.name)).collect::<Vec<_>>().join(", ");
    let Some(wanted) = wanted else {
        if !variants.is_empty() {
            notices.push(format!("the materials have variants, and the default is shown; there are: {}", names()));
        }
        return Ok(());
    };
    let named = variants.iter().position(|v| v.name == wanted);
    let numbered = || wanted.parse().ok().filter(|&n: &usize| n < variants.len());
    let Some(variant) = named.or_else(numbered) else {
        return Err(Fault::Variant { wanted: one_line(wanted), there_are: one_line(&names()) });
    };
    for primitive in root.meshes.iter_mut().flat_map(|mesh| &mut mesh.primitives) {
        let mappings = &primitive.extensions.variants.mappings;
        if let Some(mapping) = mappings.iter().find(|mapping| mapping.variants.contains(&variant)) {
            primitive.material = Some(mapping.material);
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn root() -> Root {
        serde_json::from_str(
            r#"{"extensions": {"KHR_materials_variants": {"variants": [{"name": "day"}, {"name": "night"}]}},
                "meshes": [{"primitives": [
                    {"attributes": {}, "material": 0, "extensions": {"KHR_materials_variants":
                        {"mappings": [{"material": 2, "variants": [1]}, {"material": 1, "variants": [0, 7]}]}}},
                    {"attributes": {}, "material": 3}]}]}"#,
        )
        .expect("a document")
    }

    fn materials(wanted: Option<&str>) -> std::result::Result<(Vec<Option<usize>>, usize), String> {
        let (mut root, mut notices) = (root(), Vec::new());
        choose(&mut root, wanted, &mut notices).map_err(|fault| fault.to_string())?;
        Ok((root.meshes[0].primitives.iter().map(|p| p.material).collect(), notices.len()))
    }

    #[test]
    fn variants_are_chosen_by_name_and_by_number() {
        assert_eq!(materials(None), Ok((vec![Some(0), Some(3)], 1)));
        assert_eq!(materials(Some("day")), Ok((vec![Some(1), Some(3)], 0)));
        assert_eq!(materials(Some("1")), Ok((vec![Some(2), Some(3)], 0)));
        for unknown in ["dusk", "2", ""] {
            assert!(materials(Some(unknown)).is_err_and(|e| e.contains("'day', 'night'")), "{unknown}");
        }
    }
}
