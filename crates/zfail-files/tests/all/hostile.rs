//! Files made to do harm: the answer is an error, in bounded time and memory.

use crate::build::{Gltf, TRIANGLE, assert_sound, glb, load_animated_bytes, load_bytes};
use serde_json::{Value, json};
use std::path::Path;
use std::time::{Duration, Instant};
use zfail_files::Limits;
use zfail_testing::Random;

const SMALL: Limits = Limits { bytes: 1 << 20, image_side: 64 };

#[test]
fn counts_beyond_the_data_or_the_limits() {
    for count in [u64::MAX, u64::MAX / 12, 1 << 40, 4] {
        let mut gltf = Gltf::triangle();
        gltf.json["accessors"][0]["count"] = json!(count);
        gltf.fails_with("accessors[0]: ");
        // Without a buffer view there are no bytes that would bound the count.
        gltf.json["accessors"][0].as_object_mut().unwrap().remove("bufferView");
        if count > 4 {
            gltf.fails_with("needs more than the limit of 8192 MiB");
        }
    }
    let mut gltf = Gltf::triangle();
    gltf.json["bufferViews"][0]["byteOffset"] = json!(u64::MAX);
    gltf.fails_with("accessors[0]: needs bufferViews[0]: covers");
    let mut gltf = Gltf::triangle();
    gltf.json["bufferViews"][0]["byteStride"] = json!(u64::MAX);
    gltf.fails_with("accessors[0]: ");
    let mut gltf = Gltf::triangle();
    gltf.json["buffers"] = json!([{"byteLength": u64::MAX}]);
    assert_eq!(gltf.scene().notices, ["buffers[0].byteLength says 18446744073709551615 bytes, but there are 36"]);
}

#[test]
fn repetition_is_charged() {
    // 1000 primitives that share one accessor of 1000 vertices: 60 KB of file, 200 MB of scene.
    let mut gltf = Gltf::new();
    let positions = gltf.floats(&[[0.0; 3]; 999]);
    let primitive = json!({"attributes": {"POSITION": positions}});
    gltf.push("meshes", json!({"primitives": vec![primitive; 1000]}));
    gltf.push("nodes", json!({"mesh": 0}));
    let error = load_bytes(&gltf.glb(), &SMALL).unwrap_err().to_string();
    assert!(error.contains("needs more than the limit of 1 MiB"), "{error}");
    assert!(load_bytes(&gltf.glb(), &Limits::default()).is_ok());
}

#[test]
fn what_json_grows_into_is_charged() {
    let amplified = |gltf: &Gltf| {
        let error = load_bytes(&gltf.glb(), &SMALL).unwrap_err().to_string();
        assert!(error.contains("more than the limit of 1 MiB"), "{error}");
        assert!(gltf.load().is_ok());
    };
    let mut gltf = Gltf::new();
    gltf.json["materials"] = json!(vec![json!({}); 2000]);
    amplified(&gltf);
    // Every node takes its mesh's weights.
    let mut gltf = Gltf::triangle();
    gltf.json["meshes"][0]["primitives"][0]["targets"] = json!(vec![json!({}); 300]);
    gltf.json["meshes"][0]["weights"] = json!(vec![0; 300]);
    gltf.json["nodes"] = json!(vec![json!({"mesh": 0}); 300]);
    amplified(&gltf);
}

#[test]
fn large_images_are_left_out_before_they_are_decoded() {
    let png = |side: u32| {
        let mut bytes = Vec::new();
        let encoder = image::codecs::png::PngEncoder::new(&mut bytes);
        let pixels = vec![0; (side * side) as usize];
        image::ImageEncoder::write_image(encoder, &pixels, side, side, image::ExtendedColorType::L8).unwrap();
        bytes
    };
    let mut gltf = Gltf::triangle();
    let view = gltf.view(&png(65));
    gltf.push("images", json!({"bufferView": view, "mimeType": "image/png"}));
    let scene = load_bytes(&gltf.glb(), &SMALL).unwrap();
    let expected = "image \"image 0\" is 65 times 65 pixels, and the limit is 64 a side: left out";
    assert_eq!((scene.images.len(), scene.notices), (0, vec![expected.to_owned()]));
    assert_eq!(load_bytes(&gltf.glb(), &Limits { image_side: 65, ..SMALL }).unwrap().images.len(), 1);
}

#[test]
fn only_regular_files_are_read() {
    let missing = zfail_files::load(Path::new("/nonexistent/scene.glb")).unwrap_err().to_string();
    assert!(missing.starts_with("/nonexistent/scene.glb: cannot be read: "), "{missing}");
    let folder = zfail_files::load(Path::new("/")).unwrap_err().to_string();
    assert!(folder.contains("it is a folder"), "{folder}");
    #[cfg(unix)]
    {
        let endless = zfail_files::load(Path::new("/dev/zero")).unwrap_err().to_string();
        assert!(endless.contains("not a regular file"), "{endless}");
    }
}

#[test]
fn messages_are_one_line() {
    let mut gltf = Gltf::triangle();
    gltf.json["accessors"][0]["type"] = json!("A\n\u{1b}[31m".to_owned() + &"x".repeat(10_000));
    let error = gltf.load().unwrap_err().to_string();
    assert!(error.len() < 600 && !error.chars().any(char::is_control), "{error:?}");
    let mut gltf = Gltf::triangle();
    gltf.json["nodes"][0] = json!({"mesh": 0, "name": "a\nb", "scale": [0, 0, 0]});
    assert_eq!(gltf.scene().notices[0], "node \"a b\" shrinks its mesh to a line or a point: not drawn");
}

#[test]
fn nested_json_is_refused() {
    let nested = [r#"{"asset": {"version": "2.0"}, "nodes": [{"extras": "#, &"[".repeat(100_000)].concat();
    assert!(load_bytes(&glb(nested.as_bytes(), &[]), &Limits::default()).is_err());
}

#[test]
fn unknown_extensions_are_named() {
    let mut gltf = Gltf::triangle();
    gltf.json["extensionsRequired"] = json!(["ACME_magic"]);
    assert_eq!(gltf.scene().notices, ["ACME_magic is ignored although the file requires it: what it adds is missing"]);
}

/// A small file that exercises every part of the reader.
fn rich() -> Gltf {
    let mut gltf = Gltf::with_primitive(|g| {
        let joints = g.bytes(&[[0, 1, 0, 0]; 3]);
        let weights = g.floats(&[[0.5, 0.5, 0.0, 0.0]; 3]);
        let uv = g.shorts(&[[0, 0], [9, 0], [0, 9]]);
        let colors = g.bytes(&[[255, 0, 0, 255]; 3]);
        g.json["accessors"][uv]["normalized"] = json!(true);
        g.json["accessors"][colors]["normalized"] = json!(true);
        let tangents = g.floats(&[[1.0, 0.0, 0.0, 1.0]; 3]);
        json!({"attributes": {"POSITION": g.floats(&TRIANGLE), "NORMAL": g.floats(&[[0.0, 0.0, 1.0]; 3]),
            "TANGENT": tangents, "TEXCOORD_0": uv, "COLOR_0": colors, "JOINTS_0": joints, "WEIGHTS_0": weights},
            "indices": g.indices(&[0, 1, 2, 1, 2, 0]), "mode": 5, "material": 0,
            "targets": [{"POSITION": g.floats(&[[0.0, 0.0, 1.0]; 3])}]})
    });
    let (indices, values) = (gltf.view(&[1]), gltf.view(&[0; 12]));
    let position = gltf.json["meshes"][0]["primitives"][0]["attributes"]["POSITION"].as_u64().unwrap() as usize;
    gltf.json["accessors"][position]["sparse"] = json!({"count": 1,
        "indices": {"bufferView": indices, "componentType": 5121}, "values": {"bufferView": values}});
    gltf.json["meshes"][0]["weights"] = json!([0.5]);
    let plain = gltf.floats(&TRIANGLE);
    gltf.push("meshes", json!({"primitives": [{"attributes": {"POSITION": plain}, "mode": 6}]}));
    let mut identity = [0.0; 16];
    [0, 5, 10, 15].iter().for_each(|&i: &usize| identity[i] = 1.0);
    let matrices = gltf.floats(&[identity; 2]);
    let translations = gltf.floats(&[[1.0, 0.0, 0.0]; 4]);
    gltf.push("skins", json!({"joints": [1, 2], "inverseBindMatrices": matrices}));
    let png = "data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mNk+M9QDwADhgGAWjR9awAAAABJRU5ErkJggg==";
    gltf.push("images", json!({"uri": png, "name": "white"}));
    gltf.push("samplers", json!({"wrapS": 33071, "magFilter": 9728}));
    gltf.push("textures", json!({"source": 0, "sampler": 0}));
    gltf.push(
        "materials",
        json!({"pbrMetallicRoughness": {"baseColorTexture": {"index": 0, "extensions":
        {"KHR_texture_transform": {"offset": [0, 1], "rotation": 1, "scale": [2, 3]}}}}, "normalTexture": {"index": 0},
        "alphaMode": "MASK", "extensions": {"KHR_materials_transmission": {"transmissionFactor": 0.5}}}),
    );
    gltf.push("cameras", json!({"type": "perspective", "perspective": {"yfov": 1, "znear": 0.1, "zfar": 9}}));
    gltf.json["extensions"] =
        json!({"KHR_lights_punctual": {"lights": [{"type": "spot", "spot": {"outerConeAngle": 1}}]}});
    gltf.json["nodes"] = json!([
        {"mesh": 0, "skin": 0, "name": "body", "children": [1], "extras": {"castShadow": false}},
        {"rotation": [0, 0, 0, 1], "scale": [1, 2, 3], "children": [2]}, {"matrix": identity},
        {"camera": 0, "translation": [0, 0, 5]},
        {"extensions": {"KHR_lights_punctual": {"light": 0}}, "extras": {"shadowExclude": ["body"]}},
        {"mesh": 1, "extensions": {"EXT_mesh_gpu_instancing": {"attributes": {"TRANSLATION": translations}}}}
    ]);
    gltf.json["scenes"] = json!([{"nodes": [0, 3, 4, 5]}]);
    gltf.json["scene"] = json!(0);
    let times = gltf.floats(&[[0.0], [1.0]]);
    let vectors = gltf.floats(&[[1.0, 0.0, 2.0], [-1.0, 1.0, 3.0]]);
    let turns = gltf.bytes(&[[0, 0, 0, 255], [0, 255, 0, 0]]);
    gltf.json["accessors"][turns]["normalized"] = json!(true);
    let spline = gltf.floats(&[[0.5, 0.0, 1.0]; 6]);
    gltf.json["animations"] = json!([{"name": "all", "samplers": [
        {"input": times, "output": vectors}, {"input": times, "output": turns, "interpolation": "STEP"},
        {"input": times, "output": spline, "interpolation": "CUBICSPLINE"}], "channels": [
        {"sampler": 0, "target": {"node": 1, "path": "translation"}},
        {"sampler": 1, "target": {"node": 4, "path": "rotation"}},
        {"sampler": 0, "target": {"node": 5, "path": "scale"}},
        {"sampler": 2, "target": {"node": 3, "path": "translation"}}]}]);
    gltf.json["buffers"] = json!([{"byteLength": gltf.bin.len()}]);
    gltf
}

#[test]
fn the_rich_file_loads() {
    let scene = rich().scene();
    assert_sound(&scene);
    assert_eq!((scene.instances.len(), scene.lights.len(), scene.cameras.len(), scene.images.len()), (5, 1, 1, 1));
    assert_eq!(scene.lights[0].excluded, [0]);
}

/// Loads what is hostile; a scene that results must be sound, and neither may take long.
pub fn survive(bytes: &[u8], what: &dyn Fn() -> String) -> bool {
    let start = Instant::now();
    let limits = Limits { bytes: 64 << 20, image_side: 1024 };
    let result = std::panic::catch_unwind(|| {
        load_animated_bytes(bytes, &limits).map(|mut animated| {
            assert_sound(&animated.scene);
            let mut scene = animated.scene.clone();
            for (i, animation) in animated.animations.iter().enumerate() {
                for share in [0.0, 0.3, 0.9] {
                    scene.set_pose(&animated.pose(i, share * animation.duration));
                    assert_sound(&scene);
                }
            }
            zfail_scene::complete(&mut animated.scene);
        })
    });
    let loaded = result.unwrap_or_else(|_| panic!("panic: {}", what()));
    assert!(start.elapsed() < Duration::from_secs(5), "slow: {}", what());
    if let Err(e) = &loaded {
        let message = e.to_string();
        assert!(message.contains("test.glb: ") && !message.contains('\n'), "{message:?}");
    }
    loaded.is_ok()
}

#[test]
fn flipped_bytes() {
    let original = rich().glb();
    let mut random = Random(1);
    let mut loaded = 0;
    for round in 0..4000 {
        let mut bytes = original.clone();
        let flips: Vec<(usize, u8)> =
            (0..1 + random.below(4)).map(|_| (random.below(bytes.len()), 1 << random.below(8))).collect();
        flips.iter().for_each(|&(at, bit)| bytes[at] ^= bit);
        loaded += usize::from(survive(&bytes, &|| format!("round {round}, flips {flips:?}")));
    }
    assert!(loaded > 100 && loaded < 3900, "{loaded} of 4000 loaded: the test should reach both outcomes");
}

#[test]
fn cut_files() {
    let original = rich().glb();
    for length in 0..original.len() {
        assert!(!survive(&original[..length], &|| format!("cut to {length}")), "cut to {length}");
    }
}

/// Every place in the JSON, as a pointer.
fn places(value: &Value, path: &str, found: &mut Vec<String>) {
    found.push(path.to_owned());
    match value {
        Value::Array(list) => list.iter().enumerate().for_each(|(i, v)| places(v, &format!("{path}/{i}"), found)),
        Value::Object(map) => map.iter().for_each(|(k, v)| places(v, &format!("{path}/{k}"), found)),
        _ => {}
    }
}

#[test]
fn replaced_values() {
    let original = rich();
    let mut found = Vec::new();
    places(&original.json, "", &mut found);
    let values = [
        json!(null),
        json!(-1),
        json!(0),
        json!(1),
        json!(3),
        json!(255),
        json!(5123),
        json!(0.5),
        json!(1e30),
        json!(-1e300),
        json!(1e-200),
        json!(4_294_967_295_u64),
        json!(u64::MAX),
        json!("x"),
        json!([]),
        json!({}),
        json!(true),
        json!([0, 0, 0]),
    ];
    let mut loaded = 0;
    for place in &found {
        for value in &values {
            let mut gltf = original.clone();
            *gltf.json.pointer_mut(place).unwrap() = value.clone();
            let bytes = glb(gltf.json.to_string().as_bytes(), &gltf.bin);
            loaded += usize::from(survive(&bytes, &|| format!("{place} = {value}")));
        }
    }
    let total = found.len() * values.len();
    assert!(loaded > total / 20 && loaded < total * 19 / 20, "{loaded} of {total} loaded");
}
