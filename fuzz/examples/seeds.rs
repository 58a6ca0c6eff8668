//! Writes the seeds: small files that between them use everything that loaders know.
//!
//! In: a folder. Out: `TARGET/NAME` in it for every target and seed. Run it as
//! `cargo run --manifest-path fuzz/Cargo.toml --example seeds -- crates/zfail-files/tests/corpus/seeds`.

#[allow(dead_code, reason = "the loader's tests need more of it")]
#[path = "../../crates/zfail-files/tests/all/build.rs"]
mod build;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use build::{F32, Gltf, TRIANGLE};
use draco_core::{
    DataType, EncoderBuffer, EncoderOptions, FaceIndex, GeometryAttributeType, Mesh, MeshEncoder, PointAttribute,
    PointIndex,
};
use image::{DynamicImage, ImageFormat, RgbaImage};
use meshoptimizer_rs::Workspace;
use meshoptimizer_rs::codec::{
    ExpMode, IndexEncoding, VertexEncoding, encode_filter_exp, encode_index_buffer, encode_index_sequence,
    encode_vertex_buffer,
};
use serde_json::{Value, json};
use std::io::{Cursor, Error, Result};
use std::path::{Path, PathBuf};
use std::{env, fs};

fn main() -> Result<()> {
    let folder = PathBuf::from(env::args_os().nth(1).ok_or_else(|| Error::other("usage: seeds FOLDER"))?);
    let put = |target: &str, name: &str, bytes: &[u8]| {
        fs::create_dir_all(folder.join(target))?;
        fs::write(folder.join(target).join(name), bytes)
    };
    for (name, gltf) in documents() {
        let mut json = gltf.json.clone();
        if !gltf.bin.is_empty() {
            json["buffers"] = json!([{ "byteLength": gltf.bin.len() }]);
        }
        put("glb", name, &gltf.glb())?;
        put("scene", name, &[json.to_string().as_bytes(), &[0], &gltf.bin].concat())?;
        if !gltf.bin.is_empty() {
            json["buffers"][0]["uri"] =
                json!(format!("data:application/octet-stream;base64,{}", STANDARD.encode(&gltf.bin)));
        }
        put("gltf", name, json.to_string().as_bytes())?;
    }
    put("image", "png", &picture(ImageFormat::Png))?;
    put("image", "jpeg", &picture(ImageFormat::Jpeg))?;
    for (target, name, file) in models() {
        put(target, name, &file)?;
    }
    for (name, file) in packed_buffers() {
        put("meshopt", name, &file)?;
    }
    for (name, method) in [("sequential", 0), ("edgebreaker", 1)] {
        put("draco", name, &packed_mesh(method))?;
    }
    check(&folder)
}

/// Seeds that do not load show nothing.
fn check(folder: &Path) -> Result<()> {
    for entry in fs::read_dir(folder.join("glb"))? {
        let path = entry?.path();
        let bytes = fs::read(&path)?;
        let loaded = build::load_bytes(&bytes, &zfail_files::Limits::default());
        let notices = loaded.map_err(|e| Error::other(format!("{}: {e}", path.display())))?.notices;
        println!("{}: {} bytes, notices {notices:?}", path.display(), bytes.len());
    }
    Ok(())
}

fn documents() -> Vec<(&'static str, Gltf)> {
    vec![
        ("surfaces", surfaces()),
        ("geometry", geometry()),
        ("skin", skin()),
        ("morph", morph()),
        ("instances", instances()),
        ("extensions", extensions()),
    ]
}

/// A checkerboard of four pixels.
fn picture(format: ImageFormat) -> Vec<u8> {
    let pixels = vec![255, 0, 0, 255, 0, 255, 0, 128, 0, 0, 255, 0, 255, 255, 255, 255];
    let image = DynamicImage::ImageRgba8(RgbaImage::from_raw(2, 2, pixels).expect("four pixels"));
    let image = if format == ImageFormat::Jpeg { image.into_rgb8().into() } else { image };
    let mut file = Cursor::new(Vec::new());
    image.write_to(&mut file, format).expect("an encoder");
    file.into_inner()
}

/// Two triangles with every attribute, textures, lights of all kinds and shapes, and cameras.
fn surfaces() -> Gltf {
    let mut g = Gltf::new();
    let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
    let position = g.floats(&corners);
    let normal = g.floats(&[[0.0, 0.0, 1.0]; 4]);
    let tangent = g.floats(&[[1.0, 0.0, 0.0, 1.0]; 4]);
    let uv = g.floats(&corners.map(|[x, y, _]| [x, y]));
    let color = g.bytes(&[[255, 128, 0, 255]; 4]);
    g.json["accessors"][color]["normalized"] = json!(true);
    let indices = g.indices(&[0, 1, 2, 0, 2, 3]);
    let attributes = json!({
        "POSITION": position, "NORMAL": normal, "TANGENT": tangent, "TEXCOORD_0": uv, "TEXCOORD_1": uv, "COLOR_0": color,
    });
    let primitive = |material: usize| json!({ "attributes": attributes, "indices": indices, "material": material });
    g.push("meshes", json!({ "name": "sheet", "primitives": [primitive(0), primitive(1), primitive(2)] }));
    for (format, mime) in [(ImageFormat::Png, "image/png"), (ImageFormat::Jpeg, "image/jpeg")] {
        let view = g.view(&picture(format));
        g.push("images", json!({ "bufferView": view, "mimeType": mime }));
    }
    g.push("samplers", json!({ "magFilter": 9728, "minFilter": 9987, "wrapS": 33071, "wrapT": 33648 }));
    g.push("textures", json!({ "source": 0, "sampler": 0 }));
    g.push("textures", json!({ "source": 1 }));
    let transform =
        json!({ "KHR_texture_transform": { "offset": [0.1, 0.2], "rotation": 0.3, "scale": [2, 3], "texCoord": 1 } });
    g.push(
        "materials",
        json!({
            "pbrMetallicRoughness": {
                "baseColorFactor": [1, 0.5, 0.25, 1], "metallicFactor": 0.5, "roughnessFactor": 0.5,
                "baseColorTexture": { "index": 0, "extensions": transform }, "metallicRoughnessTexture": { "index": 1 },
            },
            "normalTexture": { "index": 0, "scale": 0.5 }, "occlusionTexture": { "index": 1, "strength": 0.5 },
            "emissiveFactor": [1, 1, 1], "emissiveTexture": { "index": 1, "texCoord": 1 },
            "extensions": { "KHR_materials_emissive_strength": { "emissiveStrength": 2 } },
        }),
    );
    g.push(
        "materials",
        json!({
            "alphaMode": "MASK", "alphaCutoff": 0.25, "doubleSided": true,
            "pbrMetallicRoughness": { "baseColorTexture": { "index": 0 } },
        }),
    );
    g.push("materials", json!({ "alphaMode": "BLEND", "extensions": { "KHR_materials_unlit": {} } }));
    g.json["extensions"] = json!({ "KHR_lights_punctual": { "lights": [
        { "type": "directional", "intensity": 2 },
        { "type": "point", "range": 9, "color": [1, 0.5, 0] },
        { "type": "spot", "range": 9, "spot": { "innerConeAngle": 0.2, "outerConeAngle": 0.6 } },
    ] } });
    g.json["extensionsUsed"] = json!([
        "KHR_lights_punctual",
        "KHR_texture_transform",
        "KHR_materials_emissive_strength",
        "KHR_materials_unlit",
    ]);
    g.push("cameras", json!({ "type": "perspective", "perspective": { "yfov": 0.8, "znear": 0.1, "zfar": 10 } }));
    g.push(
        "cameras",
        json!({ "type": "orthographic", "orthographic": { "xmag": 2, "ymag": 1, "znear": 0, "zfar": 9 } }),
    );
    let light = |light: usize| json!({ "KHR_lights_punctual": { "light": light } });
    g.push("nodes", json!({ "name": "sheet", "mesh": 0, "scale": [1, -2, 1], "extras": { "castShadow": true } }));
    g.push("nodes", json!({ "extensions": light(0), "rotation": [0, 0.6, 0, 0.8], "children": [2] }));
    g.push(
        "nodes",
        json!({ "extensions": light(1), "extras": { "shadowExclude": ["sheet"], "falloff": [1, 0.5, 0] } }),
    );
    g.push(
        "nodes",
        json!({ "extensions": light(2), "extras": { "cookie": 0, "box": [1, 2, 3] }, "translation": [0, 0, 3] }),
    );
    g.push("nodes", json!({ "camera": 0, "matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 1, 2, 3, 1] }));
    g.push("nodes", json!({ "camera": 1, "translation": [0, 0, 5] }));
    g.push("scenes", json!({ "nodes": [0, 1, 3, 4, 5], "extras": { "ambient": [0.1, 0.1, 0.1] } }));
    g.json["scene"] = json!(0);
    g
}

/// Every primitive mode, type of index and way to store an attribute.
fn geometry() -> Gltf {
    let mut g = Gltf::new();
    let position = g.floats(&[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.5], [0.0, 2.0, 1.0]]);
    let bytes = g.bytes(&[[0], [1], [2], [1], [3], [2], [2], [3], [4]]);
    let words: Vec<u8> = [0_u32, 1, 2, 3, 4].iter().flat_map(|i| i.to_le_bytes()).collect();
    let words = g.accessor(&words, 5125, "SCALAR", 5);
    let shorts = g.indices(&[0, 1, 2, 3, 4]);
    let mut primitives = Vec::new();
    for (mode, indices) in
        [(4, Some(bytes)), (5, Some(words)), (6, Some(shorts)), (4, None), (0, None), (1, Some(shorts))]
    {
        let mut primitive = json!({ "attributes": { "POSITION": position }, "mode": mode });
        if let Some(indices) = indices {
            primitive["indices"] = json!(indices);
        }
        primitives.push(primitive);
    }
    // Quantised and interleaved: a position in three shorts, a normal in three bytes.
    let interleaved: Vec<u8> = (0..5_i16)
        .flat_map(|i| {
            [(i * 100).to_le_bytes(), (i * i * 50).to_le_bytes(), [0, 0]]
                .concat()
                .into_iter()
                .chain([0, 0, 0, 0, 127, 0])
        })
        .collect();
    let view = g.view(&interleaved);
    g.json["bufferViews"][view]["byteStride"] = json!(12);
    let quantised = g.push(
        "accessors",
        json!({ "bufferView": view, "componentType": 5122, "type": "VEC3", "count": 5, "normalized": true }),
    );
    let normal = g.push(
        "accessors",
        json!({
            "bufferView": view, "byteOffset": 8, "componentType": 5120, "type": "VEC3", "count": 5, "normalized": true,
        }),
    );
    primitives.push(json!({ "attributes": { "POSITION": quantised, "NORMAL": normal }, "indices": bytes }));
    // Sparse, with and without a base.
    let (at, values) = (g.view(&[1, 3]), g.view(&[0; 24]));
    let sparse = json!({
        "count": 2, "indices": { "bufferView": at, "componentType": 5121 }, "values": { "bufferView": values },
    });
    let base = g.json["accessors"][position]["bufferView"].clone();
    for view in [Some(base), None] {
        let mut accessor = json!({ "componentType": F32, "type": "VEC3", "count": 5, "sparse": sparse });
        if let Some(view) = view {
            accessor["bufferView"] = view;
        }
        let accessor = g.push("accessors", accessor);
        primitives.push(json!({ "attributes": { "POSITION": accessor }, "indices": bytes }));
    }
    g.push("meshes", json!({ "primitives": primitives }));
    g.push("nodes", json!({ "mesh": 0, "scale": [1, 0, 1] }));
    g.push("nodes", json!({ "mesh": 0, "matrix": [1, 0, 0, 0, 1, 1, 0, 0, 0, 0, -1, 0, 1e6, 0, 0, 1] }));
    g.json["extensionsUsed"] = json!(["KHR_mesh_quantization"]);
    g.json["extensionsRequired"] = json!(["KHR_mesh_quantization"]);
    g
}

/// A strip of two triangles with two joints and two sets of influences, bent by every kind of interpolation.
fn skin() -> Gltf {
    let mut g = Gltf::new();
    let position = g.floats(&[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 2.0, 0.0]]);
    let joints = g.bytes(&[[0, 1, 0, 0]; 4]);
    let weights = g.floats(&[[1.0, 0.0, 0.0, 0.0], [1.0, 0.0, 0.0, 0.0], [0.5, 0.25, 0.0, 0.0], [0.0, 0.75, 0.0, 0.0]]);
    let more = g.floats(&[[0.0, 0.0, 0.0, 0.0], [0.0; 4], [0.25, 0.0, 0.0, 0.0], [0.25, 0.0, 0.0, 0.0]]);
    let indices = g.indices(&[0, 1, 2, 2, 1, 3]);
    let identity = |y: f32| [1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, y, 0.0, 1.0];
    let inverse = g.floats(&[identity(0.0), identity(-1.0)]);
    let attributes = json!({
        "POSITION": position, "JOINTS_0": joints, "WEIGHTS_0": weights, "JOINTS_1": joints, "WEIGHTS_1": more,
    });
    g.push("meshes", json!({ "primitives": [{ "attributes": attributes, "indices": indices }] }));
    g.push("skins", json!({ "joints": [1, 2], "inverseBindMatrices": inverse, "skeleton": 1 }));
    g.push("nodes", json!({ "mesh": 0, "skin": 0 }));
    g.push("nodes", json!({ "children": [2], "translation": [0, 0, 0] }));
    g.push("nodes", json!({ "translation": [0, 1, 0] }));
    let times = g.floats(&[[0.0], [0.5], [1.0]]);
    let turns = g.floats(&[[0.0, 0.0, 0.0, 1.0], [0.0, 0.0, 0.6, 0.8], [0.0, 0.0, 0.0, -1.0]]);
    let moves = g.floats(&[[0.0, 1.0, 0.0], [0.0, 1.5, 0.0], [0.0, 1.0, 0.0]]);
    let scales =
        g.floats(&[[0.1, 0.0, 0.0], [1.0; 3], [0.0; 3], [0.0; 3], [2.0; 3], [0.0; 3], [0.0; 3], [1.0; 3], [0.0; 3]]);
    let target = |node: usize, path: &str, sampler: usize| json!({ "sampler": sampler, "target": { "node": node, "path": path } });
    g.push("animations", json!({
        "name": "bend",
        "samplers": [
            { "input": times, "output": turns, "interpolation": "LINEAR" },
            { "input": times, "output": moves, "interpolation": "STEP" },
            { "input": times, "output": scales, "interpolation": "CUBICSPLINE" },
        ],
        "channels": [target(2, "rotation", 0), target(2, "translation", 1), target(1, "scale", 2), target(0, "translation", 1)],
    }));
    g
}

/// A triangle with two morph targets, one of them sparse, whose weights are animated.
fn morph() -> Gltf {
    let mut g = Gltf::new();
    let position = g.floats(&TRIANGLE);
    let normal = g.floats(&[[0.0, 0.0, 1.0]; 3]);
    let shift = g.floats(&[[0.0, 0.0, 0.5]; 3]);
    let (at, values) = (g.view(&[2]), g.view(&[0; 12]));
    let sparse = g.push("accessors", json!({
        "componentType": F32, "type": "VEC3", "count": 3,
        "sparse": { "count": 1, "indices": { "bufferView": at, "componentType": 5121 }, "values": { "bufferView": values } },
    }));
    g.push(
        "meshes",
        json!({
            "primitives": [{
                "attributes": { "POSITION": position, "NORMAL": normal },
                "targets": [{ "POSITION": shift, "NORMAL": shift }, { "POSITION": sparse }],
            }],
            "weights": [0.25, 0.5], "extras": { "targetNames": ["a", "b"] },
        }),
    );
    g.push("nodes", json!({ "mesh": 0, "weights": [0.5, 0] }));
    g.push("nodes", json!({ "mesh": 0, "translation": [2, 0, 0] }));
    let times = g.floats(&[[0.0], [1.0]]);
    let weights = g.floats(&[[0.0], [1.0], [1.0], [0.0]]);
    g.push(
        "animations",
        json!({
            "samplers": [{ "input": times, "output": weights }],
            "channels": [{ "sampler": 0, "target": { "node": 0, "path": "weights" } }],
        }),
    );
    g
}

/// Three instances by EXT_mesh_gpu_instancing, and a second scene that shares them.
fn instances() -> Gltf {
    let mut g = Gltf::triangle();
    let translation = g.floats(&[[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [4.0, 0.0, 0.0]]);
    let rotation = g.floats(&[[0.0, 0.0, 0.0, 1.0], [0.6, 0.0, 0.0, 0.8], [0.0, 1.0, 0.0, 0.0]]);
    let scale = g.floats(&[[1.0; 3], [2.0; 3], [-1.0, 1.0, 0.5]]);
    let attributes = json!({ "TRANSLATION": translation, "ROTATION": rotation, "SCALE": scale, "_ID": translation });
    g.json["nodes"][0]["extensions"] = json!({ "EXT_mesh_gpu_instancing": { "attributes": attributes } });
    g.push("nodes", json!({ "children": [0], "name": "parent" }));
    g.push("scenes", json!({ "nodes": [1] }));
    g.push("scenes", json!({ "nodes": [1] }));
    g.json["scene"] = json!(1);
    g.json["extensionsUsed"] = json!(["EXT_mesh_gpu_instancing"]);
    g
}

/// One material for each extension that changes it, and variants.
fn extensions() -> Gltf {
    let mut g = Gltf::triangle();
    let view = g.view(&picture(ImageFormat::Png));
    g.push("images", json!({ "bufferView": view, "mimeType": "image/png" }));
    g.push("textures", json!({ "source": 0 }));
    let texture = json!({ "index": 0 });
    let extensions: [(&str, Value); 11] = [
        (
            "KHR_materials_pbrSpecularGlossiness",
            json!({
                "diffuseFactor": [1, 0, 0, 1], "specularFactor": [1, 1, 1], "glossinessFactor": 0.5,
                "diffuseTexture": texture, "specularGlossinessTexture": texture,
            }),
        ),
        ("KHR_materials_transmission", json!({ "transmissionFactor": 0.5, "transmissionTexture": texture })),
        (
            "KHR_materials_volume",
            json!({ "thicknessFactor": 1, "attenuationDistance": 2, "attenuationColor": [1, 0, 0] }),
        ),
        ("KHR_materials_ior", json!({ "ior": 1.4 })),
        (
            "KHR_materials_clearcoat",
            json!({ "clearcoatFactor": 1, "clearcoatTexture": texture, "clearcoatNormalTexture": texture }),
        ),
        ("KHR_materials_sheen", json!({ "sheenColorFactor": [1, 1, 0], "sheenRoughnessFactor": 0.5 })),
        ("KHR_materials_specular", json!({ "specularFactor": 0.5, "specularColorFactor": [1, 0.5, 2] })),
        ("KHR_materials_anisotropy", json!({ "anisotropyStrength": 0.5 })),
        ("KHR_materials_iridescence", json!({ "iridescenceFactor": 1 })),
        ("KHR_materials_unlit", json!({})),
        ("KHR_materials_emissive_strength", json!({ "emissiveStrength": 5 })),
    ];
    let attributes = g.json["meshes"][0]["primitives"][0]["attributes"].clone();
    let mut primitives = Vec::new();
    for (name, value) in &extensions {
        let material =
            g.push("materials", json!({ "name": name, "emissiveFactor": [1, 1, 1], "extensions": { *name: value } }));
        primitives.push(json!({ "attributes": attributes, "material": material }));
    }
    let mappings = json!([{ "material": 1, "variants": [0] }, { "material": 2, "variants": [1] }]);
    primitives[0]["extensions"] = json!({ "KHR_materials_variants": { "mappings": mappings } });
    g.json["meshes"][0]["primitives"] = json!(primitives);
    g.json["extensions"] = json!({ "KHR_materials_variants": { "variants": [{ "name": "a" }, { "name": "b" }] } });
    let mut used: Vec<&str> = extensions.iter().map(|(name, _)| *name).collect();
    used.push("KHR_materials_variants");
    g.json["extensionsUsed"] = json!(used);
    g
}

/// A triangle in each of the formats that are not glTF, and what programs make of them.
fn models() -> Vec<(&'static str, &'static str, Vec<u8>)> {
    let obj = "mtllib case.mtl\no a\ng b\nv 0 0 0 1 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nvn 0 0 1\n\
               usemtl red\ns 1\nf 1/1/1 2/2/1 3/3/1\nf 2//1 -1//1 \\\n3//1\nusemtl\nf 1 2 4 3 # a quad\nl 1 2\n\0\0\
               newmtl red\nKd 1 0.5 0\nd 0.5\nmap_Kd -s 2 2 -o .5 case.mtl\n";
    let wide: Vec<u8> = "\u{feff}v 1e+5 2. 0\rv 0 1 +.5\rv nan 0 0\rf 1 2 2\rf 1 2 3\r"
        .encode_utf16()
        .flat_map(u16::to_le_bytes)
        .collect();
    let stl = "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid a\n";
    let odd = stl.replace('\n', " ").replace("endloop", "vertex 1 1 0 end loop") + stl;
    let mut packed = vec![0; 80];
    packed.extend(1_u32.to_le_bytes());
    packed.extend([0.0, 0.0, 1.0].iter().chain(TRIANGLE.as_flattened()).flat_map(|x: &f32| x.to_le_bytes()));
    packed.extend([0; 2]);
    let header = |format: &str| {
        format!(
            "ply\nformat {format} 1.0\ncomment a\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
             property uchar red\nproperty uchar green\nproperty uchar blue\nelement face 1\n\
             property list uchar int vertex_indices\nend_header\n"
        )
    };
    let ascii = header("ascii") + "0 0 0 255 0 0\n1 0 0 0 255 0\n# a\n\n0 1 0 0 0 255\n3 0 1 2\n";
    let strips = "ply\rformat ascii 1.0\rvendor\relement tristrips 1\rproperty list int int vertex_indices\relement vertex 4\r\
                  property double nx\rproperty list uchar float spare\rproperty double x\rproperty double y\rproperty double z\r\
                  end_header\r8 0 1 2 3 -1 1 2 3\r0 1 7 0 0 0\r0 0 1 0 0\r0 0 0 1 0\r0 0 1e6 1.1 0\r";
    let ply = |format: &str, float: fn(f32) -> [u8; 4], int: fn(i32) -> [u8; 4]| {
        let mut file = header(format).into_bytes();
        for corner in TRIANGLE {
            file.extend(corner.iter().flat_map(|x| float(*x)).chain([255, 128, 0]));
        }
        file.push(3);
        file.extend([0, 1, 2].into_iter().flat_map(int));
        file
    };
    vec![
        ("obj", "faces", obj.into()),
        ("obj", "wide", wide),
        ("stl", "ascii", stl.into()),
        ("stl", "odd", odd.into()),
        ("stl", "binary", packed),
        ("ply", "ascii", ascii.into()),
        ("ply", "strips", strips.into()),
        ("ply", "little", ply("binary_little_endian", f32::to_le_bytes, i32::to_le_bytes)),
        ("ply", "big", ply("binary_big_endian", f32::to_be_bytes, i32::to_be_bytes)),
    ]
}

/// A strip of quads in the plane z = 0.
fn strip() -> (Vec<[f32; 3]>, Vec<u32>) {
    let positions = (0..12_u8).map(|i| [f32::from(i / 2), f32::from(i % 2) + 0.125 * f32::from(i), 0.0]).collect();
    let quad = |q: u32| [2 * q, 2 * q + 2, 2 * q + 1, 2 * q + 1, 2 * q + 2, 2 * q + 3];
    (positions, (0..5).flat_map(quad).collect())
}

/// Buffers in each of meshoptimizer's modes, behind the bytes that say what they are.
fn packed_buffers() -> Vec<(&'static str, Vec<u8>)> {
    let (positions, indices) = strip();
    let bytes: Vec<u8> = positions.iter().flatten().flat_map(|x| x.to_le_bytes()).collect();
    let (count, workspace) = (positions.len(), &mut Workspace::default());
    let vertices = |version: u8, workspace: &mut Workspace| {
        let encoding = VertexEncoding::new(version, 2).expect("a version that there is");
        encode_vertex_buffer(&bytes, count, 12, encoding, workspace).expect("an encoder")
    };
    let buffers = [
        ("vertices-0", [0, 12, count], vertices(0, workspace)),
        ("vertices-1", [135, 12, count], vertices(1, workspace)),
        ("exponential", [9, 12, count], {
            let filtered = encode_filter_exp(count, 12, 20, positions.as_flattened(), ExpMode::Separate, workspace);
            let encoding = VertexEncoding::new(0, 2).expect("a version that there is");
            encode_vertex_buffer(&filtered.expect("a filter"), count, 12, encoding, workspace).expect("an encoder")
        }),
        (
            "triangles",
            [1, 4, indices.len()],
            encode_index_buffer(&indices, IndexEncoding::DEFAULT, workspace).expect("an encoder"),
        ),
        (
            "indices",
            [2, 4, indices.len()],
            encode_index_sequence(&indices, IndexEncoding::DEFAULT, workspace).expect("an encoder"),
        ),
    ];
    buffers
        .into_iter()
        .map(|(name, head, packed)| (name, [head.map(|n| n as u8).as_slice(), &packed].concat()))
        .collect()
}

/// The strip with texture coordinates as Draco packs it, behind the bytes that say what is in it.
fn packed_mesh(method: i32) -> Vec<u8> {
    let (positions, indices) = strip();
    let mut mesh = Mesh::new();
    let uv: Vec<[f32; 2]> = positions.iter().map(|p| [p[0] / 8.0, p[1] / 4.0]).collect();
    let values = |kind, lists: Vec<&[f32]>| {
        let mut attribute = PointAttribute::new();
        attribute.init(kind, lists[0].len() as u8, DataType::Float32, false, lists.len());
        for (i, list) in lists.iter().enumerate() {
            let bytes: Vec<u8> = list.iter().flat_map(|x| x.to_le_bytes()).collect();
            attribute.buffer_mut().write(i * bytes.len(), &bytes);
        }
        attribute
    };
    mesh.add_attribute(values(GeometryAttributeType::Position, positions.iter().map(|p| p.as_slice()).collect()));
    mesh.add_attribute(values(GeometryAttributeType::TexCoord, uv.iter().map(|t| t.as_slice()).collect()));
    mesh.set_num_faces(indices.len() / 3);
    for (i, face) in (0..).zip(indices.as_chunks::<3>().0) {
        mesh.set_face(FaceIndex(i), face.map(PointIndex));
    }
    let mut encoder = MeshEncoder::new();
    encoder.set_mesh(mesh);
    let mut options = EncoderOptions::new();
    options.set_encoding_method(method);
    options.set_compression_level(5);
    let mut packed = EncoderBuffer::new();
    encoder.encode(&options, &mut packed).expect("an encoder");
    [&[positions.len() as u8, indices.len() as u8 / 3, 1], packed.data()].concat()
}
