//! Compressed geometry: meshopt buffer views and Draco primitives, encoded here and loaded back.

use crate::build::{Gltf, TRIANGLE, assert_sound, load_bytes};
use crate::hostile::survive;
use draco_core::{
    DataType, EncoderBuffer, EncoderOptions, FaceIndex, GeometryAttributeType, Mesh, MeshEncoder, PointAttribute,
    PointIndex,
};
use meshoptimizer_rs::Workspace;
use meshoptimizer_rs::codec::{
    ExpMode, IndexEncoding, VertexEncoding, encode_filter_color, encode_filter_exp, encode_filter_oct,
    encode_filter_quat, encode_index_buffer, encode_index_sequence, encode_vertex_buffer,
};
use serde_json::{Value, json};
use zfail_files::Limits;
use zfail_testing::Random;

/// A strip of quads in the plane z = 0 that does not compress to nothing.
fn strip() -> (Vec<[f32; 3]>, Vec<u32>) {
    let positions = (0..40u8).map(|i| [f32::from(i / 2), f32::from(i % 2) + f32::from(i) * 0.125, 0.0]).collect();
    let quad = |q: u32| [2 * q, 2 * q + 2, 2 * q + 1, 2 * q + 1, 2 * q + 2, 2 * q + 3];
    (positions, (0..19).flat_map(quad).collect())
}

fn bytes_of(values: &[[f32; 3]]) -> Vec<u8> {
    values.iter().flatten().flat_map(|x| x.to_le_bytes()).collect()
}

/// Adds a view of `count` elements that is stored as `data`, described by `extension`, over a buffer without bytes.
fn compressed_view(gltf: &mut Gltf, extension: &str, data: &[u8], [stride, count]: [usize; 2], more: &Value) -> usize {
    let stored = gltf.view(data);
    let mut meshopt = json!({"buffer": 0, "byteOffset": gltf.json["bufferViews"][stored]["byteOffset"],
        "byteLength": data.len(), "byteStride": stride, "count": count});
    meshopt.as_object_mut().unwrap().extend(more.as_object().unwrap().clone());
    gltf.json["bufferViews"][stored] =
        json!({"buffer": 1, "byteLength": stride * count, "extensions": {extension: meshopt}});
    stored
}

/// The document with its binary buffer, and the fallback that is not there.
fn with_fallback(mut gltf: Gltf, extension: &str) -> Gltf {
    gltf.json["extensionsRequired"] = json!([extension]);
    gltf.json["buffers"] =
        json!([{"byteLength": gltf.bin.len()}, {"byteLength": 1 << 20, "extensions": {extension: {"fallback": true}}}]);
    gltf
}

/// The strip with positions by the vertex codec of `version` and indices by `mode`.
fn meshopt(extension: &str, version: u8, mode: &str) -> Gltf {
    let (positions, indices) = strip();
    let workspace = &mut Workspace::default();
    let encoding = VertexEncoding::new(version, 2).unwrap();
    let vertices = encode_vertex_buffer(&bytes_of(&positions), positions.len(), 12, encoding, workspace).unwrap();
    let indexed = match mode {
        "TRIANGLES" => encode_index_buffer(&indices, IndexEncoding::DEFAULT, workspace),
        _ => encode_index_sequence(&indices, IndexEncoding::DEFAULT, workspace),
    };
    let gltf = Gltf::with_primitive(|g| {
        let view = compressed_view(g, extension, &vertices, [12, positions.len()], &json!({"mode": "ATTRIBUTES"}));
        g.push(
            "accessors",
            json!({"bufferView": view, "componentType": 5126, "type": "VEC3", "count": positions.len()}),
        );
        let view = compressed_view(g, extension, &indexed.unwrap(), [2, indices.len()], &json!({"mode": mode}));
        g.push(
            "accessors",
            json!({"bufferView": view, "componentType": 5123, "type": "SCALAR", "count": indices.len()}),
        );
        json!({"attributes": {"POSITION": 0}, "indices": 1})
    });
    with_fallback(gltf, extension)
}

/// Corners of every triangle as placed, so that shared and separate vertices compare alike.
fn corners(scene: &zfail_scene::Scene) -> Vec<[[f32; 3]; 3]> {
    let mesh = &scene.meshes[0];
    let turned = |t: &[u32; 3]| {
        let mut corners = t.map(|v| mesh.positions[v as usize]);
        let least = (0..3).min_by(|&a, &b| corners[a].partial_cmp(&corners[b]).unwrap()).unwrap();
        corners.rotate_left(least);
        corners
    };
    let mut all: Vec<_> = mesh.triangles.iter().map(turned).collect();
    all.sort_by(|a, b| a.partial_cmp(b).unwrap());
    all
}

fn expected_corners() -> Vec<[[f32; 3]; 3]> {
    let (positions, indices) = strip();
    let gltf = Gltf::with_primitive(|g| {
        let indices: Vec<u16> = indices.iter().map(|&i| i as u16).collect();
        json!({"attributes": {"POSITION": g.floats(&positions)}, "indices": g.indices(&indices)})
    });
    corners(&gltf.scene())
}

#[test]
fn meshopt_modes_and_versions() {
    for extension in ["EXT_meshopt_compression", "KHR_meshopt_compression"] {
        for version in [0, 1] {
            for mode in ["TRIANGLES", "INDICES"] {
                let scene = meshopt(extension, version, mode).scene();
                assert_sound(&scene);
                assert!(scene.notices.is_empty(), "{:?}", scene.notices);
                assert_eq!(corners(&scene), expected_corners(), "{extension} {version} {mode}");
            }
        }
    }
}

/// Loads a triangle whose attribute `name` is stored as `data` behind `filter`.
fn filtered(name: &str, filter: &str, data: &[u8], stride: usize, accessor: Value) -> zfail_scene::Mesh {
    let encoding = VertexEncoding::new(0, 2).unwrap();
    let stored = encode_vertex_buffer(data, 3, stride, encoding, &mut Workspace::default()).unwrap();
    let extension = "KHR_meshopt_compression";
    let gltf = Gltf::with_primitive(|g| {
        let positions = g.floats(&TRIANGLE);
        let more = json!({"mode": "ATTRIBUTES", "filter": filter});
        let view = compressed_view(g, extension, &stored, [stride, 3], &more);
        g.json["bufferViews"][view]["byteStride"] = json!(stride);
        let mut accessor = accessor;
        accessor["bufferView"] = json!(view);
        accessor["count"] = json!(3);
        let accessor = g.push("accessors", accessor);
        let positions = if name == "POSITION" { accessor } else { positions };
        json!({"attributes": {"POSITION": positions, name: accessor}})
    });
    with_fallback(gltf, extension).scene().meshes.remove(0)
}

#[test]
fn meshopt_filters() {
    let workspace = &mut Workspace::default();
    let near = |a: &[f32], b: &[f32], tolerance: f32| {
        assert!(a.iter().zip(b).all(|(a, b)| (a - b).abs() < tolerance), "{a:?} is not {b:?}");
    };
    let normals = [[0.6, 0.0, 0.8, 0.0], [0.0, -1.0, 0.0, 0.0], [0.48, 0.6, -0.64, 0.0]];
    for (stride, component, tolerance) in [(4, 5120, 2e-2), (8, 5122, 1e-4)] {
        let data = encode_filter_oct(3, stride, 2 * stride as u32, normals.as_flattened(), workspace).unwrap();
        let accessor = json!({"componentType": component, "normalized": true, "type": "VEC3"});
        let mesh = filtered("NORMAL", "OCTAHEDRAL", &data, stride, accessor);
        (0..3).for_each(|i| near(&mesh.normals[i], &normals[i][..3], tolerance));
    }
    let floats = [[0.125, -3.0, 1000.0], [1.5, 0.0, -0.25], [7.0, 2.0, 0.5]];
    let data = encode_filter_exp(3, 12, 20, floats.as_flattened(), ExpMode::Separate, workspace).unwrap();
    let mesh = filtered("POSITION", "EXPONENTIAL", &data, 12, json!({"componentType": 5126, "type": "VEC3"}));
    (0..3).for_each(|i| near(&mesh.positions[i], &floats[i], 1e-3));
    let colors = [[1.0, 0.0, 0.0, 1.0], [0.0, 0.5, 1.0, 0.5], [0.25, 0.25, 0.75, 1.0]];
    let data = encode_filter_color(3, 4, 8, colors.as_flattened(), workspace).unwrap();
    let accessor = json!({"componentType": 5121, "normalized": true, "type": "VEC4"});
    let mesh = filtered("COLOR_0", "COLOR", &data, 4, accessor);
    (0..3).for_each(|i| near(&mesh.colors[i], &colors[i], 2e-2));
    // As colours, because those are kept as they are.
    let turns = [[0.0, 0.0, 0.0, 1.0], [0.8, 0.0, -0.6, 0.0], [0.5, 0.5, -0.5, 0.5]];
    let data = encode_filter_quat(3, 8, 16, turns.as_flattened(), workspace).unwrap();
    let accessor = json!({"componentType": 5122, "normalized": true, "type": "VEC4"});
    let mesh = filtered("COLOR_0", "QUATERNION", &data, 8, accessor);
    (0..3).for_each(|i| near(&mesh.colors[i], &turns[i], 1e-3));
}

#[test]
fn meshopt_that_contradicts_its_view() {
    let extension = "EXT_meshopt_compression";
    let original = meshopt(extension, 0, "TRIANGLES");
    let change = |view: usize, property: &str, value: Value, expected: &str| {
        let mut gltf = original.clone();
        gltf.json["bufferViews"][view]["extensions"][extension][property] = value;
        gltf.fails_with(&format!("bufferViews[{view}].extensions.{extension}{expected}"));
    };
    change(0, "count", json!(39), ".count: 39 times the byteStride of 12 is not the 480 bytes");
    change(0, "count", json!(u64::MAX), ".count: ");
    change(0, "byteStride", json!(10), ".byteStride: must be a multiple of 4");
    change(0, "byteStride", json!(0), ".byteStride: must be a multiple of 4");
    change(0, "byteStride", json!(260), ".byteStride: must be a multiple of 4");
    change(0, "filter", json!("QUATERNION"), ".byteStride: does not fit the filter");
    change(0, "byteLength", json!(1 << 30), ": covers 1073741824 bytes");
    change(0, "byteLength", json!(20), ": cannot be decompressed");
    change(0, "mode", json!("INDICES"), ".byteStride: must be 2 or 4");
    change(1, "byteStride", json!(3), ".byteStride: must be 2 or 4");
    change(1, "filter", json!("OCTAHEDRAL"), ".filter: must be NONE");
    change(1, "count", json!(112), ".count: must be a multiple of 3");
    change(1, "buffer", json!(7), ": refers to buffers[7]");
    change(1, "mode", json!("MAGIC"), ".mode: unknown variant");
    let mut gltf = original.clone();
    gltf.json["bufferViews"][0]["byteStride"] = json!(16);
    gltf.fails_with(".byteStride: is not the byteStride of the buffer view itself");
    // A view without the extension needs the bytes that the fallback lacks.
    let mut gltf = original.clone();
    gltf.json["bufferViews"][0].as_object_mut().unwrap().remove("extensions");
    gltf.fails_with("buffers[1]: has neither a uri nor a binary chunk");
    let small = Limits { bytes: 1 << 12, ..Limits::default() };
    assert!(load_bytes(&original.glb(), &small).unwrap_err().to_string().contains("more than the limit"));
}

fn draco_attribute(kind: GeometryAttributeType, values: &[&[f32]]) -> PointAttribute {
    let mut attribute = PointAttribute::new();
    attribute.init(kind, values[0].len() as u8, DataType::Float32, false, values.len());
    for (i, value) in values.iter().enumerate() {
        let bytes: Vec<u8> = value.iter().flat_map(|x| x.to_le_bytes()).collect();
        attribute.buffer_mut().write(i * bytes.len(), &bytes);
    }
    attribute
}

/// The strip as a Draco primitive, by the encoding method (0 sequential, 1 edgebreaker) at a speed.
fn draco(method: i32, speed: i32) -> Gltf {
    let (positions, indices) = strip();
    let mut mesh = Mesh::new();
    let values: Vec<&[f32]> = positions.iter().map(|p| p.as_slice()).collect();
    mesh.add_attribute(draco_attribute(GeometryAttributeType::Position, &values));
    let uv: Vec<[f32; 2]> = positions.iter().map(|p| [p[0] / 32.0, p[1] / 16.0]).collect();
    let values: Vec<&[f32]> = uv.iter().map(|t| t.as_slice()).collect();
    mesh.add_attribute(draco_attribute(GeometryAttributeType::TexCoord, &values));
    mesh.set_num_faces(indices.len() / 3);
    for (i, face) in (0..).zip(indices.as_chunks::<3>().0) {
        mesh.set_face(FaceIndex(i), face.map(PointIndex));
    }
    let mut encoder = MeshEncoder::new();
    encoder.set_mesh(mesh);
    let mut options = EncoderOptions::new();
    options.set_encoding_method(method);
    options.set_compression_level(10 - speed);
    let mut out = EncoderBuffer::new();
    encoder.encode(&options, &mut out).unwrap();
    let mut gltf = Gltf::with_primitive(|g| {
        let view = g.view(out.data());
        let accessor = |shape: &str, component: u32, count: usize| json!({"componentType": component, "type": shape, "count": count});
        g.push("accessors", accessor("VEC3", 5126, positions.len()));
        g.push("accessors", accessor("VEC2", 5126, positions.len()));
        g.push("accessors", accessor("SCALAR", 5123, indices.len()));
        json!({"attributes": {"POSITION": 0, "TEXCOORD_0": 1}, "indices": 2, "extensions":
            {"KHR_draco_mesh_compression": {"bufferView": view, "attributes": {"POSITION": 0, "TEXCOORD_0": 1}}}})
    });
    gltf.json["extensionsRequired"] = json!(["KHR_draco_mesh_compression"]);
    gltf
}

#[test]
fn draco_methods() {
    for (method, speed) in [(0, 10), (1, 7), (1, 3), (1, 0)] {
        let scene = draco(method, speed).scene();
        assert_sound(&scene);
        assert!(scene.notices.is_empty(), "{:?}", scene.notices);
        assert_eq!(corners(&scene), expected_corners(), "method {method} at speed {speed}");
        let mesh = &scene.meshes[0];
        for (p, t) in mesh.positions.iter().zip(&mesh.uv0) {
            assert_eq!([p[0] / 32.0, p[1] / 16.0], *t, "attributes keep together");
        }
    }
}

#[test]
fn draco_that_contradicts_its_accessors() {
    let original = draco(1, 7);
    let path = "meshes[0].primitives[0].extensions.KHR_draco_mesh_compression";
    let with = |change: &dyn Fn(&mut Gltf)| {
        let mut gltf = original.clone();
        change(&mut gltf);
        gltf
    };
    let extension = |gltf: &mut Gltf, property: &str, value: Value| {
        gltf.json["meshes"][0]["primitives"][0]["extensions"]["KHR_draco_mesh_compression"][property] = value;
    };
    with(&|g| extension(g, "bufferView", json!(9))).fails_with(&format!("{path}.bufferView: refers to bufferViews[9]"));
    with(&|g| extension(g, "attributes", json!({"POSITION": 77})))
        .fails_with(&format!("{path}.attributes.POSITION: the stream has no attribute with the id 77"));
    let plain = with(&|g| extension(g, "attributes", json!({"POSITION": 0, "TEXCOORD_0": 77}))).scene();
    assert_eq!((corners(&plain), plain.meshes[0].uv0[7]), (expected_corners(), [0.0; 2]));
    let spared =
        "meshes[0].primitives[0].attributes.TEXCOORD_0 is left out: the stream has no attribute with the id 77";
    assert_eq!(plain.notices, [spared]);
    with(&|g| extension(g, "attributes", json!({"NORMAL": 0})))
        .fails_with(&format!("{path}.attributes.NORMAL: is not among the attributes"));
    let fewer = with(&|g| (0..2).for_each(|a| g.json["accessors"][a]["count"] = json!(39)));
    fewer.fails_with(&format!("{path}: "));
    with(&|g| g.json["accessors"][2]["count"] = json!(3)).fails_with(&format!("{path}: cannot be decompressed"));
    let enormous = with(&|g| g.json["accessors"][2]["count"] = json!(1u64 << 50));
    enormous.fails_with("needs more than the limit");
    // An attribute beside the stream counts by the stream's vertices.
    let beside = with(&|g| {
        let colors = g.floats(&[[0.5f32; 4]; 41]);
        let count = json!(41);
        (0..2).for_each(|a| g.json["accessors"][a]["count"] = count.clone());
        g.json["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] = json!(colors);
    });
    let spared = "mesh \"mesh 0\": COLOR_0 is left out: has 41 elements, but POSITION has 40";
    assert_eq!(beside.scene().notices, [spared]);
    let points = with(&|g| g.json["meshes"][0]["primitives"][0]["mode"] = json!(0));
    assert_eq!(points.scene().notices[0], "mesh \"mesh 0\": 1 primitive of points or lines: not drawn");
}

/// Flips bits within the compressed bytes only, where decoders look; returns how many files loaded all the same.
fn flip(gltf: &Gltf, rounds: usize, seed: u64) -> usize {
    let mut random = Random(seed);
    let flipped = (0..rounds).filter(|round| {
        let mut gltf = gltf.clone();
        let flips: Vec<(usize, u8)> =
            (0..1 + random.below(3)).map(|_| (random.below(gltf.bin.len()), 1 << random.below(8))).collect();
        flips.iter().for_each(|&(at, bit)| gltf.bin[at] ^= bit);
        survive(&gltf.glb(), &|| format!("round {round}, flips {flips:?}"))
    });
    flipped.count()
}

#[test]
fn flipped_bits_in_compressed_data() {
    let files = [
        meshopt("EXT_meshopt_compression", 0, "TRIANGLES"),
        meshopt("KHR_meshopt_compression", 1, "INDICES"),
        draco(0, 10),
        draco(1, 7),
        draco(1, 0),
    ];
    for (i, gltf) in files.iter().enumerate() {
        let loaded = flip(gltf, 500, i as u64);
        assert!(loaded < 500, "file {i}: no flip was noticed");
        // Flipped bits change what comes out, too: the comparison above can fail.
        let mut other = gltf.clone();
        let changed = (0..other.bin.len()).any(|at| {
            other.bin[at] ^= 1;
            let differs = other.load().is_ok_and(|scene| corners(&scene) != expected_corners());
            other.bin[at] ^= 1;
            differs
        });
        assert!(changed, "file {i}");
    }
}
