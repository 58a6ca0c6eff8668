//! Primitives, accessors and attributes.

use crate::build::{Gltf, TRIANGLE, assert_sound};
use serde_json::json;

#[test]
fn absent_indices_count_up() {
    let scene = Gltf::triangle().scene();
    assert_sound(&scene);
    assert_eq!(scene.meshes[0].triangles, [[0, 1, 2]]);
    assert_eq!(scene.meshes[0].normals, [[0.0, 0.0, 1.0]; 3], "flat normals");
    assert_eq!(scene.meshes[0].positions, TRIANGLE);
}

#[test]
fn modes() {
    let strip = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0]];
    let fan = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
    for (mode, positions, triangles) in [(4, strip, 1), (5, strip, 2), (6, fan, 2), (0, strip, 0), (1, strip, 0)] {
        let gltf = Gltf::with_primitive(|g| json!({"attributes": {"POSITION": g.floats(&positions)}, "mode": mode}));
        let scene = gltf.scene();
        assert_sound(&scene);
        assert_eq!(scene.meshes.iter().map(|m| m.triangles.len()).sum::<usize>(), triangles, "mode {mode}");
        assert!(scene.meshes.iter().all(|m| m.normals.iter().all(|n| *n == [0.0, 0.0, 1.0])), "mode {mode}: winding");
        let noted = !scene.notices.is_empty();
        assert_eq!(noted, mode <= 4, "mode {mode}: {:?}", scene.notices);
    }
    let mut gltf = Gltf::triangle();
    gltf.json["meshes"][0]["primitives"][0]["mode"] = json!(7);
    gltf.fails_with("meshes[0].primitives[0].mode: 7 is not a primitive mode");
}

#[test]
fn primitives_are_concatenated_with_their_materials() {
    let mut gltf = Gltf::triangle();
    let indices = gltf.indices(&[0, 2, 1]);
    let normals = gltf.floats(&[[0.0, 0.0, 2.0]; 3]);
    gltf.push("materials", json!({}));
    let primitives = gltf.json["meshes"][0]["primitives"].as_array_mut().unwrap();
    primitives.push(json!({"attributes": {"NORMAL": normals}}));
    primitives.push(json!({"attributes": {"POSITION": 0, "NORMAL": normals}, "indices": indices, "material": 0}));
    let scene = gltf.scene();
    assert_sound(&scene);
    let mesh = &scene.meshes[0];
    assert_eq!(mesh.triangles, [[0, 1, 2], [3, 5, 4]]);
    assert_eq!([mesh.material_of(0), mesh.material_of(1)], [None, Some(0)]);
    let told = "mesh \"mesh 0\": 1 primitive whose normals disagree with its triangles: it may be shaded wrong";
    assert_eq!(scene.notices, ["mesh \"mesh 0\": 1 primitive without POSITION: not drawn", told]);
}

#[test]
fn shared_vertices_without_normals_are_split() {
    let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let gltf = Gltf::with_primitive(|g| {
        let uv = g.floats(&[[0.25, 0.5], [1.0, 0.0], [0.0, 1.0], [0.5, 0.5]]);
        json!({"attributes": {"POSITION": g.floats(&corners), "TEXCOORD_0": uv}, "indices": g.indices(&[0, 1, 2, 0, 2, 3])})
    });
    let scene = gltf.scene();
    assert_sound(&scene);
    let mesh = &scene.meshes[0];
    assert_eq!(mesh.triangles, [[0, 1, 2], [3, 4, 5]]);
    assert_eq!((mesh.normals[0], mesh.normals[3]), ([0.0, 0.0, 1.0], [1.0, 0.0, 0.0]));
    assert_eq!((mesh.positions[5], mesh.uv0[3]), ([0.0, 0.0, 1.0], [0.25, 0.5]));
}

#[test]
fn bad_normals_are_replaced_with_a_notice() {
    let gltf = Gltf::with_primitive(|g| {
        let normals = g.floats(&[[0.0; 3], [f32::NAN, 0.0, 0.0], [0.0, 3.0, 0.0]]);
        json!({"attributes": {"POSITION": g.floats(&TRIANGLE), "NORMAL": normals}})
    });
    let scene = gltf.scene();
    assert_sound(&scene);
    assert_eq!(scene.meshes[0].normals, [[0.0, 0.0, 1.0], [0.0, 0.0, 1.0], [0.0, 1.0, 0.0]]);
    let told = "mesh \"mesh 0\": 1 primitive whose normals disagree with its triangles: it may be shaded wrong";
    assert_eq!(scene.notices, ["mesh \"mesh 0\": 2 vertex normals without a direction: replaced", told]);
}

#[test]
fn normalized_and_quantized_attributes() {
    let gltf = Gltf::with_primitive(|g| {
        let positions = g.shorts(&[[0, 0, 0], [1000, 0, 0], [0, 65535, 0]]);
        let uv = g.bytes(&[[0, 255], [51, 0], [255, 255]]);
        let colors = g.shorts(&[[65535, 0, 13107], [0, 0, 0], [0, 0, 0]]);
        g.json["accessors"][uv]["normalized"] = json!(true);
        g.json["accessors"][colors]["normalized"] = json!(true);
        json!({"attributes": {"POSITION": positions, "TEXCOORD_1": uv, "COLOR_0": colors}})
    });
    let mesh = &gltf.scene().meshes[0];
    assert_eq!(mesh.positions, [[0.0, 0.0, 0.0], [1000.0, 0.0, 0.0], [0.0, 65535.0, 0.0]]);
    assert_eq!(mesh.uv1, [[0.0, 1.0], [0.2, 0.0], [1.0, 1.0]]);
    assert_eq!(mesh.uv0, [[0.0; 2]; 3]);
    assert_eq!(mesh.colors[0], [1.0, 0.0, 0.2, 1.0]);
}

#[test]
fn signed_normalized_values_reach_minus_one() {
    let gltf = Gltf::with_primitive(|g| {
        let normals = g.accessor(&[0, 0, 0x80, 0, 0, 0x81, 0, 0, 0x7f], 5120, "VEC3", 3);
        g.json["accessors"][normals]["normalized"] = json!(true);
        json!({"attributes": {"POSITION": g.floats(&TRIANGLE), "NORMAL": normals}})
    });
    assert_eq!(gltf.scene().meshes[0].normals, [[0.0, 0.0, -1.0], [0.0, 0.0, -1.0], [0.0, 0.0, 1.0]]);
}

/// KHR_mesh_quantization: small integers with padding between them, also in morph targets.
#[test]
fn quantized_morphs_and_padded_strides() {
    let gltf = Gltf::with_primitive(|g| {
        let positions = g.accessor(&[0, 0, 0, 9, 127, 0, 0, 9, 0, 0x81, 64, 9], 5120, "VEC3", 3);
        g.json["accessors"][positions]["normalized"] = json!(true);
        g.json["bufferViews"][positions]["byteStride"] = json!(4);
        let shorts: Vec<u8> = [0i16, 0, 4, 9, 0, 0, -8, 9, 2, 0, 0, 9].iter().flat_map(|x| x.to_le_bytes()).collect();
        let deltas = g.accessor(&shorts, 5122, "VEC3", 3);
        g.json["bufferViews"][deltas]["byteStride"] = json!(8);
        json!({"attributes": {"POSITION": positions}, "targets": [{"POSITION": deltas}]})
    });
    let mut gltf = gltf;
    gltf.json["meshes"][0]["weights"] = json!([0.5]);
    gltf.json["extensionsRequired"] = json!(["KHR_mesh_quantization"]);
    let scene = gltf.scene();
    assert!(scene.notices.is_empty(), "{:?}", scene.notices);
    let expected = [[0.0, 0.0, 2.0], [1.0, 0.0, -4.0], [1.0, -1.0, 64.0 / 127.0]];
    assert_eq!(scene.meshes[0].positions, expected);
}

#[test]
fn interleaved_and_misaligned_data() {
    // Position, then two bytes of something else: a stride of 14, which misaligns every second vertex.
    let mut gltf = Gltf::new();
    let bytes: Vec<u8> = TRIANGLE
        .iter()
        .flat_map(|p| p.iter().flat_map(|x| x.to_le_bytes()).chain([0xff; 2]).collect::<Vec<_>>())
        .collect();
    let positions = gltf.accessor(&bytes, 5126, "VEC3", 3);
    gltf.json["bufferViews"][0]["byteStride"] = json!(14);
    gltf.push("meshes", json!({"primitives": [{"attributes": {"POSITION": positions}}]}));
    gltf.push("nodes", json!({"mesh": 0}));
    assert_eq!(gltf.scene().meshes[0].positions, TRIANGLE);
    gltf.json["bufferViews"][0]["byteStride"] = json!(11);
    gltf.fails_with("bufferViews[0].byteStride: is 11, less than the 12 bytes");
    gltf.json["bufferViews"][0]["byteStride"] = json!(16);
    gltf.fails_with("accessors[0]: 3 elements");
}

#[test]
fn sparse_accessors() {
    let mut gltf = Gltf::triangle();
    let indices = gltf.view(&[2]);
    let values = gltf.view(&[5.0f32, 6.0, 7.0].map(f32::to_le_bytes).concat());
    gltf.json["accessors"][0]["sparse"] = json!({"count": 1,
        "indices": {"bufferView": indices, "componentType": 5121}, "values": {"bufferView": values}});
    assert_eq!(gltf.scene().meshes[0].positions, [TRIANGLE[0], TRIANGLE[1], [5.0, 6.0, 7.0]]);

    let mut zeros = gltf.clone();
    zeros.json["accessors"][0].as_object_mut().unwrap().remove("bufferView");
    assert_eq!(zeros.scene().meshes[0].positions, [[0.0; 3], [0.0; 3], [5.0, 6.0, 7.0]]);

    let sparse = |gltf: &Gltf, path: &str, value: serde_json::Value| {
        let mut gltf = gltf.clone();
        *gltf.json.pointer_mut(&format!("/accessors/0/sparse/{path}")).unwrap() = value;
        gltf
    };
    sparse(&gltf, "count", json!(4)).fails_with("accessors[0].sparse.count: is 4");
    sparse(&gltf, "count", json!(2)).fails_with("accessors[0].sparse.indices: 2 elements");
    sparse(&gltf, "indices/componentType", json!(5126)).fails_with("accessors[0].sparse.indices.componentType");
    sparse(&gltf, "indices/bufferView", json!(9))
        .fails_with("accessors[0].sparse.indices: needs bufferViews[9]: is not there");
    let out = gltf.json["bufferViews"][indices]["byteOffset"].as_u64().unwrap() as usize;
    gltf.bin[out] = 3;
    gltf.fails_with("accessors[0].sparse.indices: element 0 is 3, but the accessor has 3 elements");
}

#[test]
fn faulty_geometry_is_named() {
    let mut far = TRIANGLE;
    far[0][0] = 1e20;
    let gltf = Gltf::with_primitive(|g| json!({"attributes": {"POSITION": g.floats(&far)}}));
    gltf.fails_with("meshes[0]: reaches more than");

    let mut gltf = Gltf::triangle();
    gltf.json["accessors"][0]["type"] = json!("VEC2");
    gltf.fails_with("accessors[0].type: is Vec2, but 3 components are needed here");
    gltf.json["accessors"][0]["type"] = json!("VEC5");
    gltf.fails_with("accessors[0].type: unknown variant `VEC5`");
    let mut gltf = Gltf::triangle();
    gltf.json["accessors"][0]["byteOffset"] = json!(4);
    gltf.fails_with("accessors[0]: 3 elements");
    gltf.json["accessors"][0]["byteOffset"] = json!(-4);
    gltf.fails_with("accessors[0].byteOffset: invalid value");
}

#[test]
fn normal_maps_get_tangents() {
    let make = |with_map: bool| {
        let mut gltf = Gltf::with_primitive(|g| {
            let normals = g.floats(&[[0.0, 0.0, 1.0]; 3]);
            let uv = g.floats(&[[0.0, 0.0], [0.0, 1.0], [1.0, 0.0]]);
            json!({"attributes": {"POSITION": g.floats(&TRIANGLE), "NORMAL": normals, "TEXCOORD_0": uv}, "material": 0})
        });
        let png = "data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mNk+M9QDwADhgGAWjR9awAAAABJRU5ErkJggg==";
        gltf.push("images", json!({"uri": png}));
        gltf.push("textures", json!({"source": 0}));
        gltf.push("materials", if with_map { json!({"normalTexture": {"index": 0}}) } else { json!({}) });
        gltf.scene()
    };
    let scene = make(true);
    assert_sound(&scene);
    assert_eq!(scene.meshes[0].tangents, [[0.0, 1.0, 0.0, 1.0]; 3]);
    assert_eq!((scene.images[0].width, scene.images[0].height), (1, 1));
    assert_eq!(make(false).meshes[0].tangents, [[0.0; 4]; 3]);
}
