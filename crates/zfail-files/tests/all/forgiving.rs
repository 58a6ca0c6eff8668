//! Files as people have them: what is there is drawn, and a notice says what was wrong.

use crate::build::{Gltf, TRIANGLE, assert_sound, glb, load_bytes};
use serde_json::{Value, json};
use std::fs;
use zfail_files::Limits;
use zfail_scene::{AlphaMode, Scene};

/// The scene of a `.gltf` file among `files`.
fn beside(gltf: &Gltf, files: &[(&str, &[u8])]) -> Result<Scene, String> {
    let folder = tempfile::tempdir().unwrap();
    files.iter().for_each(|(name, bytes)| fs::write(folder.path().join(name), bytes).unwrap());
    let path = folder.path().join("scene.glb");
    fs::write(&path, gltf.glb()).unwrap();
    zfail_files::load(&path).map_err(|e| e.to_string())
}

/// A triangle of one material with a texture over an image.
fn textured(image: Value, material: Value) -> Gltf {
    let mut gltf = Gltf::with_primitive(|g| json!({"attributes": {"POSITION": g.floats(&TRIANGLE)}, "material": 0}));
    gltf.push("images", image);
    gltf.push("textures", json!({"source": 0}));
    gltf.push("materials", material);
    gltf
}

fn plain_textured(image: Value) -> Gltf {
    textured(
        image,
        json!({"pbrMetallicRoughness": {"baseColorFactor": [0.5, 0.25, 1, 1], "baseColorTexture": {"index": 0}}}),
    )
}

#[test]
fn images_that_cannot_be_read_cost_only_the_texture() {
    let mut within = plain_textured(json!({"bufferView": 1}));
    within.push("bufferViews", json!({"buffer": 0, "byteOffset": 1000, "byteLength": 8}));
    for (gltf, what) in [
        (
            plain_textured(json!({"uri": "no where%2Etga"})),
            r#"image "no where.tga" cannot be read (there is no such file): left out"#,
        ),
        (
            plain_textured(json!({"uri": "a%20kind.tga"})),
            r#"image "a kind.tga" is neither PNG, JPEG, WebP nor KTX 2.0"#,
        ),
        (plain_textured(json!({"uri": "../wood.png"})), r#"image "../wood.png" cannot be read (a file may refer only"#),
        (
            plain_textured(json!({"uri": r"C:\tmp\wood.png"})),
            r#"image "C:\tmp\wood.png" cannot be read (only data URIs"#,
        ),
        (
            plain_textured(json!({"uri": "https://example.org/wood.png"})),
            r#"image "https://example.org/wood.png" cannot be read (only data URIs"#,
        ),
        (
            plain_textured(json!({"uri": "data:image/png;base64,*", "name": "wood"})),
            r#"image "wood" cannot be read (its base64 is damaged"#,
        ),
        (plain_textured(json!({"uri": "data:image/png;base64,AAAA"})), r#"image "image 0" is neither"#),
        (plain_textured(json!({})), r#"image "image 0" has neither a uri nor a bufferView"#),
        (plain_textured(json!({"bufferView": 9})), r#"images[0].bufferView refers to bufferViews[9]"#),
        (plain_textured(json!({"uri": 7})), r#"images[0].uri is left out: invalid type"#),
        (within, r#"image "image 0" needs bufferViews[1]: covers 8 bytes"#),
    ] {
        let scene = beside(&gltf, &[("a kind.tga", b"\0\0\x02 and pixels")]).unwrap();
        assert_sound(&scene);
        assert_eq!((scene.instances.len(), scene.images.len()), (1, 0), "{what}");
        assert_eq!(
            (scene.materials[0].base_color, scene.materials[0].base_color_texture),
            ([0.5, 0.25, 1.0, 1.0], None)
        );
        assert!(scene.notices[0].starts_with(what), "{:?} lack {what:?}", scene.notices);
        assert!(
            scene
                .notices
                .iter()
                .any(|n| n.starts_with("material \"material 0\": shown by plain factors instead of \""))
        );
    }
    for texture in [json!({"source": 3}), json!({}), json!(5)] {
        let mut gltf = plain_textured(json!({}));
        gltf.json["textures"][0] = texture;
        assert_eq!(gltf.scene().instances.len(), 1);
    }
    let mut gltf = plain_textured(json!({}));
    gltf.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["index"] = json!(4);
    assert!(gltf.scene().notices[1].contains("instead of \"texture 4\""), "{:?}", gltf.scene().notices);
}

#[test]
fn a_missing_buffer_is_an_error() {
    let mut gltf = Gltf::triangle();
    gltf.json["buffers"] = json!([{"uri": "the%20data.bin", "byteLength": 36}]);
    let bytes = gltf.bin.clone();
    assert!(beside(&gltf, &[("the data.bin", &bytes)]).is_ok());
    let error = beside(&gltf, &[]).unwrap_err();
    let expected =
        "buffers[0].uri: cannot read `the data.bin`: there is no such file; put the file there, or export as one .glb";
    assert!(error.ends_with(expected), "{error}");
    // One that is too short is none that lacks anything until something needs the rest.
    let scene = beside(&gltf, &[("the data.bin", &[&bytes[..], &[0; 4]].concat())]).unwrap();
    assert!(scene.notices.is_empty());
    let error = beside(&gltf, &[("the data.bin", &bytes[..35])]).unwrap_err();
    assert!(
        error.contains("accessors[0]: needs bufferViews[0]: covers 36 bytes from 0, but buffers[0] has 35"),
        "{error}"
    );
}

#[test]
fn surfaces_without_their_texture_are_not_black_nor_glowing_nor_gone() {
    let material = |json: Value| {
        let scene = textured(json!({"uri": "gone.png"}), json).scene();
        (scene.materials[0].clone(), scene.notices)
    };
    let (metal, notices) = material(json!({"pbrMetallicRoughness": {"metallicRoughnessTexture": {"index": 0}}}));
    assert_eq!((metal.metallic, metal.roughness, notices.len()), (0.0, 1.0, 2), "{notices:?}");
    let (glow, _) = material(json!({"emissiveFactor": [1, 1, 1], "emissiveTexture": {"index": 0}}));
    assert_eq!(glow.emissive, [0.0; 3]);
    let extensions =
        json!({"KHR_materials_transmission": {"transmissionFactor": 1, "transmissionTexture": {"index": 0}}});
    let (glass, notices) = material(json!({"extensions": extensions}));
    assert!(!glass.is_blended() && notices.iter().any(|n| n.contains("lost with the texture")), "{notices:?}");
    let (mask, notices) =
        material(json!({"alphaMode": "MASK", "pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}));
    assert_eq!(mask.alpha, AlphaMode::Opaque);
    assert!(notices.iter().any(|n| n.ends_with("its mask is gone with the texture: shown opaque")), "{notices:?}");
    // With nothing lost, factors say what they say.
    let (plain, notices) = material(json!({"alphaMode": "MASK", "emissiveFactor": [1, 1, 1]}));
    assert_eq!((plain.metallic, plain.emissive, plain.alpha), (1.0, [1.0; 3], AlphaMode::Mask(0.5)));
    assert_eq!(notices.len(), 1, "the image that nothing shows: {notices:?}");
}

#[test]
fn the_greatest_index_is_a_vertex_in_lists() {
    let corners: Vec<[f32; 3]> = (0..256_u16).map(|i| [f32::from(i), f32::from(i % 7), f32::from(i % 3)]).collect();
    let with = |indices: &[u8], vertices: usize, mode: u32| {
        let indices: Vec<[u8; 1]> = indices.iter().map(|&i| [i]).collect();
        Gltf::with_primitive(|g| {
            json!({"attributes": {"POSITION": g.floats(&corners[..vertices])}, "indices": g.bytes(&indices), "mode": mode})
        })
        .scene()
    };
    let triangles = |scene: &Scene| scene.meshes.first().map_or(0, |mesh| mesh.triangles.len());
    let list = with(&[0, 1, 255, 255, 2, 3], 256, 4);
    assert_eq!((triangles(&list), list.notices.len()), (2, 0));
    assert!(list.meshes[0].positions.contains(&corners[255]));
    let beyond = with(&[0, 1, 255, 0, 1, 2], 255, 4);
    assert_eq!(triangles(&beyond), 1);
    assert_eq!(beyond.notices, ["mesh \"mesh 0\": 1 triangle with a vertex that is not there: left out"]);
    // In a strip it can only be meant to begin another.
    let strip = with(&[0, 1, 2, 3, 255, 4, 5, 6], 255, 5);
    assert_eq!(triangles(&strip), 3);
    let notice = "mesh \"mesh 0\": 1 index with the forbidden restart value: a new strip or fan begins";
    assert_eq!(strip.notices, [notice]);
    let fan = with(&[0, 1, 2, 3, 255, 4, 5, 6], 256, 6);
    assert_eq!((triangles(&fan), fan.notices.len()), (3, 1));
}

#[test]
fn triangles_of_vertices_without_a_place_are_left_out() {
    let square = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0], [9.0, 9.0, f32::NAN]];
    let normals = [[0.0, 0.0, 1.0]; 5];
    for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        for with_normals in [false, true] {
            let mut positions = square;
            positions[1][1] = bad;
            let gltf = Gltf::with_primitive(|g| {
                let indices = g.indices(&[0, 1, 2, 0, 2, 3, 2, 1, 3]);
                let mut attributes = json!({"POSITION": g.floats(&positions)});
                if with_normals {
                    attributes["NORMAL"] = json!(g.floats(&normals));
                }
                json!({"attributes": attributes, "indices": indices})
            });
            let scene = gltf.scene();
            assert_sound(&scene);
            let mesh = &scene.meshes[0];
            let corners = mesh.triangles[0].map(|v| mesh.positions[v as usize]);
            assert_eq!((mesh.triangles.len(), corners), (1, [square[0], square[2], square[3]]));
            assert_eq!((mesh.positions.len(), scene.bounds().max.x), (3, 1.0));
            let what = "2 triangles with a vertex that is not finite or has no joint: left out";
            assert_eq!(scene.notices, [format!("mesh \"mesh 0\": {what}")]);
        }
    }
}

#[test]
fn skins_and_morphs_may_take_vertices_nowhere() {
    let corners = [TRIANGLE[0], TRIANGLE[1], TRIANGLE[2], [1.0, 1.0, 0.0]];
    let skinned = |joints: &[[u8; 4]; 4], weights: &[[f32; 4]; 4]| {
        let mut gltf = Gltf::with_primitive(|g| {
            let attributes =
                json!({"POSITION": g.floats(&corners), "JOINTS_0": g.bytes(joints), "WEIGHTS_0": g.floats(weights)});
            json!({"attributes": attributes, "indices": g.indices(&[0, 1, 2, 1, 3, 2])})
        });
        gltf.json["skins"] = json!([{"joints": [1]}]);
        gltf.json["nodes"] = json!([{"mesh": 0, "skin": 0}, {"translation": [5, 0, 0]}]);
        let scene = gltf.scene();
        assert_sound(&scene);
        (scene.meshes[0].triangles.len(), scene.notices.len())
    };
    let (joint, weight) = ([[0_u8; 4]; 4], [[0.25_f32; 4]; 4]);
    assert_eq!(skinned(&joint, &weight), (2, 0));
    let mut other = joint;
    other[3] = [0, 0, 0, 7];
    assert_eq!(skinned(&other, &weight), (1, 1), "a joint that is not there");
    for (bad, expected) in [(f32::NAN, (1, 1)), (f32::INFINITY, (1, 1)), (-1.0, (2, 0))] {
        let mut weight = weight;
        weight[3][1] = bad;
        assert_eq!(skinned(&joint, &weight), expected, "{bad}");
    }

    let mut gltf = Gltf::with_primitive(|g| {
        let to = g.floats(&[[0.0; 3], [0.0; 3], [0.0; 3], [f32::NAN, 0.0, 0.0]]);
        json!({"attributes": {"POSITION": g.floats(&corners)}, "indices": g.indices(&[0, 1, 2, 1, 3, 2]),
            "targets": [{"POSITION": to}]})
    });
    assert_eq!((gltf.scene().meshes[0].triangles.len(), gltf.scene().notices.len()), (2, 0), "not used");
    gltf.json["meshes"][0]["weights"] = json!([0.5]);
    assert_eq!((gltf.scene().meshes[0].triangles.len(), gltf.scene().notices.len()), (1, 1));
}

#[test]
fn inverse_bind_matrices_that_cannot_be_meant() {
    let identity: [f32; 16] = std::array::from_fn(|i| f32::from(u8::from(i % 5 == 0)));
    let with = |matrix: [f32; 16]| {
        let mut gltf = Gltf::with_primitive(|g| {
            let (joints, weights) = (g.bytes(&[[0_u8; 4]; 3]), g.floats(&[[1.0, 0.0, 0.0, 0.0]; 3]));
            json!({"attributes": {"POSITION": g.floats(&TRIANGLE), "JOINTS_0": joints, "WEIGHTS_0": weights}})
        });
        let matrices = gltf.floats(&[matrix]);
        gltf.json["skins"] = json!([{"joints": [1], "inverseBindMatrices": matrices}, {"joints": [9]}]);
        gltf.json["nodes"] = json!([{"mesh": 0, "skin": 0}, {"translation": [2, 0, 0]}]);
        let scene = gltf.scene();
        assert_sound(&scene);
        (scene.bounds().min.x, scene.bounds().max.x, scene.notices)
    };
    assert_eq!(with(identity), (2.0, 3.0, Vec::new()));
    let zeros = "skins[0].inverseBindMatrices has 1 matrix of zeros or not finite: replaced by the identity";
    assert_eq!(with([0.0; 16]), (2.0, 3.0, vec![zeros.into()]));
    assert_eq!(with([f32::NAN; 16]), (2.0, 3.0, vec![zeros.into()]));
    let mut last_row = identity;
    last_row[3] = 1.0;
    let cut = "skins[0].inverseBindMatrices has 1 matrix whose last row is not 0 0 0 1: read without it";
    assert_eq!(with(last_row), (2.0, 3.0, vec![cut.into()]));
    assert_eq!(with(identity.map(|x| 2.0 * x)).1, 4.0, "what can be meant stays");
}

#[test]
fn attributes_that_move_no_vertex_can_be_spared() {
    let notice = |make: &dyn Fn(&mut Gltf) -> (&'static str, usize)| {
        let gltf = Gltf::with_primitive(|g| {
            let mut attributes = json!({"POSITION": g.floats(&TRIANGLE)});
            let (name, accessor) = make(g);
            attributes[name] = json!(accessor);
            json!({"attributes": attributes})
        });
        let scene = gltf.scene();
        assert_sound(&scene);
        assert_eq!(scene.meshes[0].normals, [[0.0, 0.0, 1.0]; 3]);
        scene.notices.join(" | ")
    };
    assert_eq!(notice(&|g| ("NORMAL", g.floats(&[[0.0, 0.0, 1.0]; 3]))), "");
    let few = notice(&|g| ("NORMAL", g.floats(&[[0.0, 1.0, 0.0]; 2])));
    assert_eq!(few, "mesh \"mesh 0\": NORMAL is left out: has 2 elements, but POSITION has 3");
    assert!(
        notice(&|g| ("COLOR_0", g.floats(&[[0.0]; 3]))).contains("COLOR_0 is left out: accessors[1].type: is Scalar")
    );
    assert!(notice(&|_| ("TEXCOORD_0", 77)).contains("attributes.TEXCOORD_0 refers to accessors[77]"));
    let beyond = notice(&|g| {
        let uv = g.floats(&[[0.0; 2]; 3]);
        g.json["bufferViews"][1]["byteLength"] = json!(1 << 20);
        ("TEXCOORD_0", uv)
    });
    assert!(beyond.contains("TEXCOORD_0 is left out: accessors[1]: needs bufferViews[1]: covers"), "{beyond}");
    assert_eq!(notice(&|g| ("_CUSTOM", g.floats(&[[0.0; 4]; 9]))), "");
}

#[test]
fn normals_that_disagree_are_told() {
    let notices = |normal: [f32; 3]| {
        let gltf = Gltf::with_primitive(
            |g| json!({"attributes": {"POSITION": g.floats(&TRIANGLE), "NORMAL": g.floats(&[normal; 3])}}),
        );
        assert_eq!(gltf.scene().meshes[0].triangles.len(), 1);
        gltf.scene().notices
    };
    assert!(notices([0.0, 0.0, 1.0]).is_empty() && notices([0.8, 0.0, 0.6]).is_empty());
    let expected = "mesh \"mesh 0\": 1 primitive whose normals disagree with its triangles: it may be shaded wrong";
    for normal in [[0.0, 0.0, -1.0], [0.9, 0.0, 0.4], [1.0, 0.0, 0.0]] {
        assert_eq!(notices(normal), [expected], "{normal:?}");
    }
}

#[test]
fn what_nothing_uses_may_be_broken() {
    let mut gltf = Gltf::triangle();
    for (list, broken) in [
        ("buffers", json!({"byteLength": 36})),
        ("bufferViews", json!({"buffer": 9, "byteLength": 4})),
        ("bufferViews", json!({"buffer": 0, "byteOffset": 30, "byteLength": 7})),
        ("bufferViews", json!({"buffer": 0, "byteLength": "many"})),
        (
            "bufferViews",
            json!({"buffer": 0, "byteLength": 4, "extensions": {"EXT_meshopt_compression":
            {"buffer": 0, "byteLength": 4, "byteStride": 3, "count": 1, "mode": "ATTRIBUTES"}}}),
        ),
        ("accessors", json!({"bufferView": 77, "componentType": 5126, "type": "VEC3", "count": 1})),
        ("accessors", json!({"componentType": 5130, "type": "VEC5", "count": 1})),
        ("accessors", json!({"bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 1000, "min": "x"})),
        ("meshes", json!({"primitives": [{"attributes": {"POSITION": 99}, "indices": 98, "material": 97}]})),
        (
            "meshes",
            json!({"primitives": [{"attributes": {"POSITION": 0}, "extensions": {"KHR_draco_mesh_compression":
            {"bufferView": 0, "attributes": {"POSITION": 0}}}}]}),
        ),
        ("nodes", json!({"mesh": 55, "skin": 44, "children": [33], "matrix": vec![1; 16]})),
        ("nodes", json!({"children": [2]})),
        ("skins", json!({"joints": [99], "inverseBindMatrices": 99})),
        ("materials", json!({"alphaMode": "SOMETIMES", "normalTexture": {"index": "x"}, "extensions": 5})),
        ("samplers", json!({"magFilter": "fine"})),
        ("textures", json!({"sampler": 5, "source": 6})),
        ("cameras", json!({"type": "fisheye"})),
        (
            "animations",
            json!({"channels": [{"sampler": 0, "target": {"node": 88, "path": "rotation"}}], "samplers": []}),
        ),
        ("animations", json!("walk")),
        ("scenes", json!({"nodes": [0]})),
        ("scenes", json!({"nodes": [0, 1, 2, 77]})),
    ] {
        gltf.push(list, broken);
    }
    gltf.json["accessors"][0]["min"] = json!([1, "x"]);
    gltf.json["nodes"][0]["extras"] = json!([[7]]);
    gltf.json["nodes"][0]["extensions"] = json!({"ACME": [1], "KHR_lights_punctual": [7]});
    gltf.json["extensions"] =
        json!({"KHR_lights_punctual": {"lights": [{"type": "sun"}]}, "KHR_materials_variants": 3});
    gltf.json["asset"]["generator"] = json!({"name": 5});
    gltf.json["buffers"][0]["byteLength"] = json!(gltf.bin.len());
    let scene = gltf.scene();
    assert_sound(&scene);
    assert_eq!((scene.instances.len(), scene.meshes[0].positions.clone()), (1, TRIANGLE.to_vec()));
    // Were the scene to draw it, it would be an error.
    gltf.json["scene"] = json!(1);
    gltf.fails_with("scenes[1].nodes[3]: refers to nodes[77]");
    gltf.json["scenes"][1]["nodes"] = json!([0, 1]);
    gltf.fails_with("nodes[1].children[0]: refers to nodes[33]");
    gltf.json["nodes"][1]["children"] = json!([]);
    gltf.fails_with("nodes[1].matrix: its last row is not 0 0 0 1");
    gltf.json["nodes"][1]["matrix"] = Value::Null;
    gltf.fails_with("nodes[1].mesh: refers to meshes[55]");
    for (mesh, expected) in [
        (1, "meshes[1].primitives[0].indices: refers to accessors[98]"),
        (2, "KHR_draco_mesh_compression: cannot be decompressed"),
    ] {
        gltf.json["nodes"][1]["mesh"] = json!(mesh);
        gltf.json["nodes"][1]["skin"] = Value::Null;
        gltf.fails_with(expected);
    }
    for (accessor, expected) in [
        (1, "accessors[1]: needs bufferViews[77]: is not there: the file has 5"),
        (2, "accessors[2].componentType: 5130 is not a component type"),
        (3, "accessors[3]: 1000 elements"),
    ] {
        gltf.json["meshes"][2]["primitives"][0] = json!({"attributes": {"POSITION": accessor}});
        gltf.fails_with(expected);
    }
    for (view, expected) in [
        (1, "needs bufferViews[1]: refers to buffers[9]"),
        (2, "needs bufferViews[2]: covers 7 bytes from 30"),
        (3, "needs bufferViews[3].byteLength: invalid type"),
        (4, "needs bufferViews[4].extensions.EXT_meshopt_compression.byteStride: must be"),
    ] {
        gltf.json["accessors"][3]["bufferView"] = json!(view);
        gltf.fails_with(expected);
    }
}

#[test]
fn text_that_is_nearly_json() {
    let gltf = Gltf::triangle();
    let mut json = gltf.json.clone();
    json["buffers"] = json!([{"byteLength": gltf.bin.len()}]);
    let sound = json.to_string();
    let load = |json: &[u8]| load_bytes(&glb(json, &gltf.bin), &Limits::default());
    let mended = |json: &[u8]| {
        let scene = load(json).unwrap_or_else(|e| panic!("{e}: {}", String::from_utf8_lossy(json)));
        assert_sound(&scene);
        assert_eq!(scene.instances.len(), 1);
        scene.notices.len()
    };
    let with = |member: &[u8]| [b"{".as_slice(), member, b",", &sound.as_bytes()[1..]].concat();
    assert_eq!(mended(&with(b"\"extras\": 1")), 0);
    assert_eq!(mended(&[sound.as_bytes(), b"\0\0\0"].concat()), 0);
    for member in [
        b"\"x\": [NaN, -Infinity, 1.#QNAN]".as_slice(),
        b"\"animations\": [{\"name\": \"caf\xe9\"}]",
        b"\"x\": \"a\nb\"",
        b"\"x\": [1,]",
        b"\"x\": \"C:\\Users\"",
    ] {
        assert_eq!(mended(&with(member)), 1, "{}", String::from_utf8_lossy(member));
    }
    for broken in [b"\"x\" 1".as_slice(), b"\"x\": [", b"x: 1"] {
        assert!(load(&with(broken)).is_err(), "{}", String::from_utf8_lossy(broken));
    }
}

#[test]
fn versions() {
    let with = |asset: Value| {
        let mut gltf = Gltf::triangle();
        gltf.json["asset"] = asset;
        gltf.load().map(|scene| scene.notices.len()).map_err(|e| e.to_string())
    };
    for (asset, count) in [(json!({"version": "2.0"}), 0), (json!({"version": "2.1"}), 0), (json!({"version": "2"}), 0)]
    {
        assert_eq!(with(asset.clone()), Ok(count), "{asset}");
    }
    for asset in [json!({}), Value::Null, json!({"version": "two"})] {
        assert_eq!(with(asset.clone()), Ok(1), "{asset}");
    }
    for (asset, expected) in [
        (
            json!({"version": "1.0"}),
            "this is glTF 1.0, an older format with another structure; only 2.x can be read; convert",
        ),
        (json!({"version": "3.0"}), "this is glTF 3.0; only 2.x can be read; convert the file"),
        (json!({"version": "2.0", "minVersion": "2.1"}), "asks for more than glTF 2.0"),
    ] {
        assert!(with(asset.clone()).is_err_and(|e| e.contains(expected)), "{:?}", with(asset));
    }
}

#[test]
fn remedies_fit_the_fault() {
    let ends = |gltf: &Gltf, remedy: &str| {
        let error = gltf.load().unwrap_err().to_string();
        assert!(error.ends_with(remedy), "{error} does not end with {remedy:?}");
    };
    let mut gltf = Gltf::triangle();
    gltf.json["nodes"][0]["translation"] = json!([1e30, 0, 0]);
    ends(&gltf, "; move or scale the scene");
    gltf.json["nodes"][0]["translation"] = json!([1e40, 0, 0]);
    ends(&gltf, "; give it and the nodes above it smaller scales and translations");
    gltf.json["nodes"][0] = json!({"mesh": 3});
    ends(&gltf, "see what the Khronos glTF validator says about it");
    gltf.json["buffers"] = json!([{"uri": "data:;base64,*", "byteLength": 36}]);
    gltf.json["nodes"][0] = json!({"mesh": 0});
    ends(&gltf, "; export the file again");
    let cut = load_bytes(&Gltf::triangle().glb()[..200], &Limits::default()).unwrap_err().to_string();
    assert!(cut.ends_with("; download or export the file again"), "{cut}");
}
