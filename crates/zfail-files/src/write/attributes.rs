//! Meshes: each run of triangles with one material becomes a primitive with the vertices that it uses.

use super::Document;
use serde_json::{Value, json};
use zfail_scene::{Mesh, Primitive, Scene};

/// Writes all meshes; returns, per mesh of the scene, its index in the file. One without triangles has none.
pub(super) fn write(document: &mut Document, scene: &Scene) -> Vec<Option<usize>> {
    scene
        .meshes
        .iter()
        .map(|mesh| {
            let runs = mesh.primitives.iter().filter(|run| !run.triangles.is_empty());
            let primitives: Vec<Value> = runs.map(|run| primitive(document, mesh, run)).collect();
            if primitives.is_empty() {
                return None;
            }
            document.meshes.push(json!({ "name": mesh.name, "primitives": primitives }));
            Some(document.meshes.len() - 1)
        })
        .collect()
}

fn primitive(document: &mut Document, mesh: &Mesh, run: &Primitive) -> Value {
    let triangles = &mesh.triangles[run.triangles.start as usize..run.triangles.end as usize];
    let mut used: Vec<u32> = triangles.iter().flatten().copied().collect();
    used.sort_unstable();
    used.dedup();
    let local = |v: u32| used.partition_point(|&u| u < v) as u32;
    let triangles: Vec<[u32; 3]> = triangles.iter().map(|t| t.map(local)).collect();

    let buffer = &mut document.buffer;
    let mut attributes = json!({
        "POSITION": buffer.positions(&gather(&used, &mesh.positions)),
        "NORMAL": buffer.floats(&gather(&used, &mesh.normals)),
    });
    // Attributes that say nothing are left out; tangents must then be missing altogether, for zero is no tangent.
    let tangents = gather(&used, &mesh.tangents);
    if !tangents.contains(&[0.0; 4]) {
        attributes["TANGENT"] = json!(buffer.floats(&tangents));
    }
    let uv1 = gather(&used, &mesh.uv1);
    let has_uv1 = uv1.iter().any(|&uv| uv != [0.0; 2]);
    let uv0 = gather(&used, &mesh.uv0);
    if has_uv1 || uv0.iter().any(|&uv| uv != [0.0; 2]) {
        attributes["TEXCOORD_0"] = json!(buffer.floats(&uv0));
    }
    if has_uv1 {
        attributes["TEXCOORD_1"] = json!(buffer.floats(&uv1));
    }
    let colors = gather(&used, &mesh.colors);
    if colors.iter().any(|&color| color != [1.0; 4]) {
        attributes["COLOR_0"] = json!(buffer.floats(&colors));
    }
    let mut primitive = json!({ "attributes": attributes, "indices": buffer.indices(&triangles, used.len()) });
    if let Some(material) = run.material {
        primitive["material"] = json!(material);
    }
    primitive
}

fn gather<const N: usize>(used: &[u32], values: &[[f32; N]]) -> Vec<[f32; N]> {
    used.iter().map(|&v| values[v as usize]).collect()
}
