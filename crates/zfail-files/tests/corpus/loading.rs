//! Bytes that nobody vouches for, loaded: what the fuzz targets do, and the replay of what they have found.
//!
//! In: a target's name and bytes. Out: nothing, or a panic where loading breaks one of its promises: an error of one line
//! or a sound scene, whatever the bytes are.

use serde_json::{Value, json};
use std::cell::OnceCell;
use std::fs;
use std::path::PathBuf;
use tempfile::TempDir;
use zfail_files::{Limits, load_animated};
use zfail_scene::{Scene, complete};

/// Small, so that a file that asks for too much is found out soon.
pub const LIMITS: Limits = Limits { bytes: 64 << 20, image_side: 256 };

/// What loading may take: the limit, and as much again for what is not charged to the byte.
pub const MEMORY: usize = 2 * (64 << 20);

/// Takes bytes and does with them what its name says.
pub type Target = fn(&[u8]);

/// Every fuzz target.
pub const TARGETS: [(&str, Target); 9] = [
    ("glb", glb),
    ("gltf", gltf),
    ("scene", scene),
    ("image", image),
    ("draco", draco),
    ("meshopt", meshopt),
    ("obj", obj),
    ("ply", ply),
    ("stl", stl),
];

/// A `.glb` file.
pub fn glb(bytes: &[u8]) {
    load("glb", bytes);
}

/// A `.gltf` file, with its data in data URIs.
pub fn gltf(bytes: &[u8]) {
    load("gltf", bytes);
}

/// The JSON of a `.glb` file, a zero byte, and its binary chunk. The container and the length of the buffer are made to
/// fit, so that every change gets past them.
pub fn scene(bytes: &[u8]) {
    let Some((mut json, binary)) = unpack(bytes) else { return };
    if let Some(length) = json.pointer_mut("/buffers/0/byteLength") {
        *length = json!(binary.len());
    }
    load("glb", &container(&json, binary));
}

/// JSON and binary chunk of a [`scene`].
pub fn unpack(bytes: &[u8]) -> Option<(Value, &[u8])> {
    let end = bytes.iter().position(|byte| *byte == 0)?;
    Some((serde_json::from_slice(&bytes[..end]).ok()?, &bytes[end + 1..]))
}

/// A file of an image.
pub fn image(bytes: &[u8]) {
    let mut gltf = triangle(&[bytes]);
    let ktx = bytes.starts_with(b"\xabKTX 20");
    let webp = bytes.starts_with(b"RIFF");
    let extension = match (ktx, webp) {
        (true, _) => "KHR_texture_basisu",
        (_, true) => "EXT_texture_webp",
        _ => "none",
    };
    gltf["images"] = json!([{ "bufferView": 1, "mimeType": if ktx { "image/ktx2" } else { "image/png" } }]);
    gltf["textures"] = json!([{ "source": 0, "extensions": { extension: { "source": 0 } } }]);
    gltf["materials"] = json!([{ "pbrMetallicRoughness": { "baseColorTexture": { "index": 0 } } }]);
    gltf["extensionsUsed"] = json!([extension]);
    load("glb", &container(&gltf, &binary(&[bytes])));
}

/// The numbers of points and of triangles, a byte that chooses attributes beside the position, and a mesh as Draco packs
/// it.
pub fn draco(bytes: &[u8]) {
    let Some((&[points, triangles, choice], packed)) = bytes.split_first_chunk() else { return };
    let mut gltf = triangle(&[packed]);
    let mut attributes = json!({ "POSITION": 0 });
    let mut accessors = json!({ "POSITION": 1 });
    let mut accessor = |component: u32, shape: &str, count: usize| {
        let list = gltf["accessors"].as_array_mut().expect("a list");
        list.push(json!({ "componentType": component, "type": shape, "count": count }));
        list.len() - 1
    };
    accessor(5126, "VEC3", points.into());
    for (bit, (name, component, shape)) in
        [("TEXCOORD_0", 5126, "VEC2"), ("NORMAL", 5126, "VEC3"), ("JOINTS_0", 5121, "VEC4")].into_iter().enumerate()
    {
        if choice >> bit & 1 == 1 {
            attributes[name] = json!(bit + 1);
            accessors[name] = json!(accessor(component, shape, points.into()));
        }
    }
    let indices = accessor(5123, "SCALAR", 3 * usize::from(triangles));
    let draco = json!({ "KHR_draco_mesh_compression": { "bufferView": 1, "attributes": attributes } });
    gltf["meshes"][0]["primitives"][0] = json!({ "attributes": accessors, "indices": indices, "extensions": draco });
    gltf["extensionsUsed"] = json!(["KHR_draco_mesh_compression"]);
    gltf["extensionsRequired"] = json!(["KHR_draco_mesh_compression"]);
    load("glb", &container(&gltf, &binary(&[packed])));
}

/// A byte that chooses mode and filter, one for the stride, one for the count, and a buffer as meshoptimizer packs it.
pub fn meshopt(bytes: &[u8]) {
    let Some((&[choice, stride, count], packed)) = bytes.split_first_chunk() else { return };
    let (stride, count) = (usize::from(stride), usize::from(count));
    let mut gltf = triangle(&[packed]);
    let mode = ["ATTRIBUTES", "TRIANGLES", "INDICES"][usize::from(choice % 3)];
    let filter = ["NONE", "OCTAHEDRAL", "QUATERNION", "EXPONENTIAL", "COLOR"][usize::from(choice / 3 % 5)];
    let name = if choice < 128 { "EXT_meshopt_compression" } else { "KHR_meshopt_compression" };
    gltf["extensionsUsed"] = json!([name]);
    gltf["extensionsRequired"] = json!([name]);
    gltf["buffers"].as_array_mut().expect("a list").push(json!({
        "byteLength": stride * count, "extensions": { name: { "fallback": true } },
    }));
    let mut view = gltf["bufferViews"][1].clone();
    view["byteStride"] = json!(stride);
    view["count"] = json!(count);
    view["mode"] = json!(mode);
    view["filter"] = json!(filter);
    gltf["bufferViews"][1] = json!({ "buffer": 1, "byteLength": stride * count, "extensions": { name: view } });
    let primitive = &mut gltf["meshes"][0]["primitives"][0];
    let (component, shape) = if mode == "ATTRIBUTES" {
        primitive["attributes"]["POSITION"] = json!(1);
        gltf["bufferViews"][1]["byteStride"] = json!(stride);
        (5126, "VEC3")
    } else {
        primitive["indices"] = json!(1);
        (if stride == 2 { 5123 } else { 5125 }, "SCALAR")
    };
    gltf["accessors"].as_array_mut().expect("a list").push(json!({
        "bufferView": 1, "componentType": component, "type": shape, "count": count,
    }));
    load("glb", &container(&gltf, &binary(&[packed])));
}

/// An `.obj` file, two zero bytes, and the library `case.mtl` beside it.
pub fn obj(bytes: &[u8]) {
    let end = bytes.windows(2).position(|pair| pair == [0, 0]).unwrap_or(bytes.len());
    fs::write(path("mtl"), bytes.get(end + 2..).unwrap_or_default()).expect("a file beside it");
    load("obj", &bytes[..end]);
}

/// A `.ply` file.
pub fn ply(bytes: &[u8]) {
    load("ply", bytes);
}

/// An `.stl` file.
pub fn stl(bytes: &[u8]) {
    load("stl", bytes);
}

/// A glTF document with one triangle, whose corners are at the begin of the buffer, and a buffer view for each of `more`.
fn triangle(more: &[&[u8]]) -> Value {
    let mut end = CORNERS.len();
    let mut views = vec![json!({ "buffer": 0, "byteLength": end })];
    for bytes in more {
        end = end.next_multiple_of(4);
        views.push(json!({ "buffer": 0, "byteOffset": end, "byteLength": bytes.len() }));
        end += bytes.len();
    }
    json!({
        "asset": { "version": "2.0" },
        "buffers": [{ "byteLength": end }],
        "bufferViews": views,
        "accessors": [{ "bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 3 }],
        "meshes": [{ "primitives": [{ "attributes": { "POSITION": 0 }, "material": 0 }] }],
        "materials": [{}],
        "nodes": [{ "mesh": 0 }],
    })
}

/// (0 0 0), (1 0 0) and (0 1 0).
const CORNERS: [u8; 36] = {
    let mut bytes = [0; 36];
    (bytes[14], bytes[15], bytes[30], bytes[31]) = (0x80, 0x3f, 0x80, 0x3f);
    bytes
};

/// The buffer of [`triangle`].
fn binary(more: &[&[u8]]) -> Vec<u8> {
    let mut bytes = CORNERS.to_vec();
    for more in more {
        bytes.resize(bytes.len().next_multiple_of(4), 0);
        bytes.extend(*more);
    }
    bytes
}

/// A `.glb` file.
pub fn container(json: &Value, binary: &[u8]) -> Vec<u8> {
    let chunk = |kind: &[u8; 4], data: &[u8], padding: u8| {
        let mut data = data.to_vec();
        data.resize(data.len().next_multiple_of(4), padding);
        [&(data.len() as u32).to_le_bytes(), kind.as_slice(), &data].concat()
    };
    let chunks = [chunk(b"JSON", json.to_string().as_bytes(), b' '), chunk(b"BIN\0", binary, 0)].concat();
    [b"glTF".as_slice(), &2_u32.to_le_bytes(), &(12 + chunks.len() as u32).to_le_bytes(), &chunks].concat()
}

/// The file `case` with this extension, in a folder that it shares with no other thread.
fn path(extension: &str) -> PathBuf {
    thread_local!(static FOLDER: OnceCell<TempDir> = const { OnceCell::new() });
    FOLDER.with(|folder| {
        let folder = folder.get_or_init(|| TempDir::new().expect("a temporary folder"));
        folder.path().join(format!("case.{extension}"))
    })
}

/// Loads `bytes` as a file with this extension, and checks what is made of it.
fn load(extension: &str, bytes: &[u8]) {
    let file = path(extension);
    fs::write(&file, bytes).expect("a file in it");
    match load_animated(&file, &LIMITS) {
        Ok((mut animated, _)) => {
            assert_sound(&animated.scene);
            complete(&mut animated.scene);
            assert_sound(&animated.scene);
            let mut posed = animated.scene.clone();
            for (i, animation) in animated.animations.iter().enumerate().take(4) {
                assert!(animation.duration.is_finite(), "{}", animation.name);
                for time in [-1.0, 0.0, 0.3 * animation.duration, animation.duration, 1e9] {
                    posed.set_pose(&animated.pose(i, time));
                    assert_sound(&posed);
                }
            }
        }
        Err(error) => {
            let message = error.to_string();
            assert!(message.contains("case.") && !message.contains('\n'), "{message:?}");
        }
    }
}

/// Asserts what the scene types promise.
pub fn assert_sound(scene: &Scene) {
    if let Err(error) = zfail_scene::check(scene) {
        panic!("{error}");
    }
}
