//! Skins and morph targets at rest.

use crate::build::{Gltf, TRIANGLE, assert_sound};
use serde_json::json;
use zfail_plan::glam::DVec3;
use zfail_scene::{Scene, world_triangle};

fn world(scene: &Scene, instance: usize) -> [DVec3; 3] {
    let i = &scene.instances[instance];
    world_triangle(&scene.meshes[i.mesh], &i.world_from_object, 0)
}

/// A triangle whose first corner follows joint 0, whose second follows joint 1, and whose third both.
fn skinned() -> Gltf {
    let mut gltf = Gltf::with_primitive(|g| {
        let joints = g.bytes(&[[0, 9, 9, 9], [1, 0, 0, 0], [0, 1, 0, 0]]);
        let weights = g.floats(&[[1.0, 0.0, 0.0, 0.0], [2.0, 0.0, 0.0, 0.0], [0.5, 0.5, 0.0, 0.0]]);
        let normals = g.floats(&[[0.0, 0.0, 1.0]; 3]);
        json!({"attributes": {"POSITION": g.floats(&TRIANGLE), "NORMAL": normals, "JOINTS_0": joints, "WEIGHTS_0": weights}})
    });
    let mut inverse_bind = [0.0; 16];
    [0, 5, 10, 15].iter().for_each(|&i: &usize| inverse_bind[i] = 1.0);
    let mut shifted = inverse_bind;
    shifted[12] = -1.0;
    let matrices = gltf.floats(&[inverse_bind, shifted]);
    gltf.push("skins", json!({"joints": [1, 2], "inverseBindMatrices": matrices}));
    gltf.json["nodes"] = json!([
        {"mesh": 0, "skin": 0, "translation": [100, 100, 100]},
        {"translation": [1000000, 0, 0], "children": [2]},
        {"translation": [1, 0, 0], "rotation": [0, 0, 1, 0]}
    ]);
    gltf
}

#[test]
fn a_skin_follows_its_joints_and_not_its_node() {
    let scene = skinned().scene();
    assert_sound(&scene);
    // Joint 1 turns by half a turn about x = 1; the third corner is the mean of its two images.
    let expected = [[0.0, 0.0], [1.0, 0.0], [1.0, 0.0]].map(|[x, y]| DVec3::new(1e6 + x, y, 0.0));
    for (p, q) in world(&scene, 0).into_iter().zip(expected) {
        assert!(p.distance(q) < 1e-6, "{p} is not {q}");
    }
    let mesh = &scene.meshes[0];
    assert!(mesh.positions.iter().flatten().all(|x| x.abs() < 2.0), "coordinates stay near the origin");
}

#[test]
fn faulty_skins() {
    let mut gltf = skinned();
    let joints = gltf.json["meshes"][0]["primitives"][0]["attributes"]["JOINTS_0"].as_u64().unwrap() as usize;
    let view = gltf.json["accessors"][joints]["bufferView"].as_u64().unwrap() as usize;
    let offset = gltf.json["bufferViews"][view]["byteOffset"].as_u64().unwrap() as usize;
    gltf.bin[offset] = 2;
    let scene = gltf.scene();
    assert_eq!((scene.instances.len(), scene.notices.len()), (0, 2), "{:?}", scene.notices);
    assert!(scene.notices[0].contains("1 triangle with a vertex that is not finite or has no joint: left out"));

    let mut gltf = skinned();
    gltf.json["skins"][0]["joints"] = json!([1, 2, 0]);
    let expected = "skins[0].inverseBindMatrices has 2 matrices for 3 joints: the rest are the identity";
    assert_eq!(gltf.scene().notices, [expected]);
    gltf.json["skins"][0]["joints"] = json!([1, 7]);
    gltf.fails_with("skins[0].joints[1]: refers to nodes[7]");
}

#[test]
fn morph_targets_at_their_default_weights() {
    let mut gltf = Gltf::with_primitive(|g| {
        let up = g.floats(&[[0.0, 0.0, 1.0]; 3]);
        let aside = g.floats(&[[1.0, 0.0, 0.0]; 3]);
        json!({"attributes": {"POSITION": g.floats(&TRIANGLE)}, "targets": [{"POSITION": up}, {"POSITION": aside}]})
    });
    assert_eq!(world(&gltf.scene(), 0)[0], DVec3::ZERO);
    gltf.json["meshes"][0]["weights"] = json!([0.5, 2]);
    gltf.push("nodes", json!({"mesh": 0, "weights": [1, 0]}));
    gltf.push("nodes", json!({"mesh": 0}));
    let scene = gltf.scene();
    assert_sound(&scene);
    assert_eq!(world(&scene, 0)[0], DVec3::new(2.0, 0.0, 0.5), "the mesh's weights");
    assert_eq!(world(&scene, 1)[0], DVec3::Z, "the node's weights");
    assert_eq!(scene.meshes.len(), 2, "equal poses are one mesh");
    assert_eq!(scene.instances[0].mesh, scene.instances[2].mesh);
}
