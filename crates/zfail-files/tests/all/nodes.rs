//! Node hierarchy, instances, lights, cameras.

use crate::build::{Gltf, TRIANGLE, assert_sound};
use serde_json::{Value, json};
use std::f64::consts::FRAC_1_SQRT_2;
use zfail_plan::glam::DVec3;
use zfail_plan::light::LightKind;
use zfail_plan::view::Projection;
use zfail_scene::{Scene, world_triangle};

/// A PNG image of one pixel.
const PIXEL: &str = "data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mNk+M9QDwADhgGAWjR9awAAAABJRU5ErkJggg==";

fn with_nodes(nodes: Value) -> Gltf {
    let mut gltf = Gltf::triangle();
    gltf.json["nodes"] = nodes;
    gltf
}

fn names(scene: &Scene) -> Vec<&str> {
    scene.instances.iter().map(|i| i.name.as_str()).collect()
}

fn world(scene: &Scene, instance: usize) -> [DVec3; 3] {
    let i = &scene.instances[instance];
    world_triangle(&scene.meshes[i.mesh], &i.world_from_object, 0)
}

#[test]
fn nodes_are_visited_depth_first() {
    let mut gltf = with_nodes(json!([
        {"name": "c", "mesh": 0}, {"name": "a", "mesh": 0, "children": [3, 2]}, {"name": "a2", "mesh": 0},
        {"name": "a1", "children": [4]}, {"mesh": 0}
    ]));
    assert_eq!(names(&gltf.scene()), ["c", "a", "node 4", "a2"], "no scene: all roots");
    gltf.json["scenes"] = json!([{"nodes": [1, 0]}, {"nodes": [0]}]);
    assert_eq!(names(&gltf.scene()), ["a", "node 4", "a2", "c"], "the first scene");
    gltf.json["scene"] = json!(1);
    let scene = gltf.scene();
    assert_eq!(names(&scene), ["c"]);
    assert_eq!(scene.meshes.len(), 1, "one mesh however many instances");
}

#[test]
fn broken_hierarchies_are_refused() {
    with_nodes(json!([{"children": [1]}, {"children": [0]}])).fails_with("nodes[0]: is or hangs below");
    with_nodes(json!([{"children": [0]}])).fails_with("nodes[0]");
    with_nodes(json!([{"children": [1]}, {"children": [2]}, {"children": [1]}])).fails_with("nodes[1]: is or hangs");
    with_nodes(json!([{"children": [2]}])).fails_with("nodes[0].children[0]: refers to nodes[2], but the file has 1");
    with_nodes(json!([{"mesh": 1}])).fails_with("nodes[0].mesh: refers to meshes[1]");
    let mut gltf = with_nodes(json!([{"mesh": 0}]));
    gltf.json["scenes"] = json!([{"nodes": [0, 4]}]);
    gltf.fails_with("scenes[0].nodes[1]: refers to nodes[4], but the file has 1");
}

#[test]
fn all_nodes_are_drawn_where_no_scene_says_which() {
    let mut gltf = with_nodes(json!([{"name": "a", "mesh": 0}, {"children": [2]}, {"name": "b", "mesh": 0}]));
    assert_eq!((names(&gltf.scene()), gltf.scene().notices.len()), (vec!["a", "b"], 0));
    gltf.json["scenes"] = json!([]);
    assert_eq!((names(&gltf.scene()), gltf.scene().notices.len()), (vec!["a", "b"], 0));
    gltf.json["scenes"] = json!([{"nodes": [0]}]);
    gltf.json["scene"] = json!(3);
    assert_eq!(names(&gltf.scene()), ["a", "b"]);
    assert_eq!(gltf.scene().notices, ["scene is 3, but the file has 1 scenes: all its nodes are drawn"]);
    gltf.json["scene"] = json!(-1);
    assert_eq!(names(&gltf.scene()), ["a"], "the first scene");
    gltf.json["scenes"] = json!([{}]);
    gltf.json["scene"] = json!(0);
    assert_eq!(names(&gltf.scene()), ["a", "b"]);
    assert_eq!(gltf.scene().notices, ["scenes[0] names no nodes: all nodes of the file are drawn"]);
}

#[test]
fn what_the_scene_lists_twice_is_drawn_once() {
    let mut gltf = with_nodes(json!([
        {"name": "child", "mesh": 0, "translation": [1, 0, 0]}, {"translation": [10, 0, 0], "children": [0]}
    ]));
    let x = |gltf: &Gltf| gltf.scene().instances.iter().map(|i| i.world_from_object.translation.x).collect::<Vec<_>>();
    for (nodes, places, count) in [
        (json!([1]), vec![11.0], 0),
        (json!([0, 1]), vec![11.0], 1),
        (json!([1, 0]), vec![11.0], 1),
        (json!([1, 1]), vec![11.0], 1),
        // Without its parent, it is where the scene has it.
        (json!([0]), vec![1.0], 0),
    ] {
        gltf.json["scenes"] = json!([{"nodes": nodes}]);
        assert_eq!((x(&gltf), gltf.scene().notices.len()), (places, count), "{nodes}: {:?}", gltf.scene().notices);
    }
    gltf.json["nodes"][1]["children"] = json!([0, 0]);
    gltf.json["scenes"] = json!([{"nodes": [1]}]);
    assert_eq!(x(&gltf), [11.0]);
    assert_eq!(gltf.scene().notices, ["nodes[1].children[1] names nodes[0] twice: drawn once"]);
}

#[test]
fn a_node_with_two_parents_is_drawn_below_both() {
    let gltf = with_lights(json!([
        {"translation": [1, 0, 0], "children": [2]}, {"translation": [0, 5, 0], "children": [2], "name": "second"},
        {"translation": [0, 0, 1], "children": [3], "mesh": 0}, {"mesh": 0, "name": "leaf", "extensions": light(0)},
        {"extensions": light(0), "extras": {"shadowExclude": ["second"]}}
    ]));
    let scene = gltf.scene();
    let places: Vec<_> = scene.instances.iter().map(|i| i.world_from_object.translation.to_array()).collect();
    assert_eq!(places, [[1.0, 0.0, 1.0], [1.0, 0.0, 1.0], [0.0, 5.0, 1.0], [0.0, 5.0, 1.0]]);
    assert_eq!((scene.meshes.len(), scene.lights.len()), (1, 3));
    assert_eq!(scene.lights[2].excluded, [2, 3], "below one of the parents");
    assert_eq!(scene.notices, ["2 nodes are drawn again below a second parent"]);
}

#[test]
fn more_ways_to_a_node_than_memory_are_refused() {
    // Two ways on each of 40 levels.
    let mut nodes: Vec<Value> = (0..40)
        .flat_map(|i| {
            let next = json!({"children": [2 * i + 2, 2 * i + 3]});
            [next.clone(), next]
        })
        .collect();
    nodes.extend([json!({"mesh": 0}), json!({"mesh": 0})]);
    let start = std::time::Instant::now();
    with_nodes(json!(nodes)).fails_with("reached by many ways: needs more than the limit of 8192 MiB");
    assert!(start.elapsed() < std::time::Duration::from_secs(10), "{:?}", start.elapsed());
    let few = with_nodes(json!([{"children": [1, 2]}, {"children": [3]}, {"children": [3]}, {"mesh": 0}]));
    assert_eq!(few.scene().instances.len(), 2);
}

#[test]
fn hidden_nodes_are_not_drawn() {
    let hidden = json!({"KHR_node_visibility": {"visible": false}});
    let shown = json!({"KHR_node_visibility": {"visible": true}});
    let mut gltf = with_lights(json!([
        {"name": "a", "mesh": 0, "extensions": shown}, {"name": "b", "mesh": 0, "extensions": hidden, "children": [2, 3, 4]},
        {"name": "c", "mesh": 0, "extensions": shown}, {"extensions": light(0)}, {"camera": 0},
        {"name": "d", "mesh": 0, "extensions": {"KHR_node_visibility": {}}}, {"extensions": light(2)}
    ]));
    gltf.json["cameras"] = json!([{"type": "perspective", "perspective": {"yfov": 1, "znear": 0.5}}]);
    gltf.json["extensionsUsed"] = json!(["KHR_node_visibility", "KHR_lights_punctual"]);
    let scene = gltf.scene();
    assert_eq!((names(&scene), scene.lights.len(), scene.cameras.len()), (vec!["a", "d"], 1, 1));
    let notice = "1 node is hidden (KHR_node_visibility): neither drawn nor casting, with all that hangs below";
    assert_eq!(scene.notices, [notice]);
    // What is hidden may be broken.
    gltf.json["nodes"][2]["mesh"] = json!(7);
    assert_eq!(names(&gltf.scene()), ["a", "d"]);
    gltf.json["nodes"][1]["extensions"] = json!({});
    gltf.fails_with("nodes[2].mesh: refers to meshes[7]");
}

#[test]
fn transforms_compose_in_double_precision() {
    let scene = with_nodes(json!([
        {"translation": [1000000.1, 0, 0], "rotation": [0, 0, FRAC_1_SQRT_2, FRAC_1_SQRT_2], "children": [1]},
        {"scale": [2, 2, -2], "mesh": 0}
    ]))
    .scene();
    let expected = [[0.0, 0.0], [0.0, 2.0], [-2.0, 0.0]].map(|[x, y]| DVec3::new(1_000_000.1 + x, y, 0.0));
    for (p, q) in world(&scene, 0).into_iter().zip(expected) {
        assert!(p.distance(q) < 1e-9, "{p} is not {q}");
    }
    assert!(scene.instances[0].world_from_object.matrix3.determinant() < 0.0, "mirrored");

    let matrix = json!([1, 0, 0, 0, 0.5, 1, 0, 0, 0, 0, 1, 0, 7, 8, 9, 1]);
    let sheared = with_nodes(json!([{"mesh": 0, "matrix": matrix}])).scene();
    assert_eq!(world(&sheared, 0)[2], DVec3::new(7.5, 9.0, 9.0));

    let twice = with_nodes(json!([{"mesh": 0, "rotation": [0, 0, 2, 2]}])).scene();
    assert!(world(&twice, 0)[1].distance(DVec3::Y) < 1e-15, "quaternions are normalised");
    let none = with_nodes(json!([{"mesh": 0, "rotation": [0, 0, 0, 0]}])).scene();
    assert_eq!((world(&none, 0)[1], none.notices.len()), (DVec3::X, 1));
    with_nodes(json!([{"mesh": 0, "scale": [1e200, 1, 1], "children": [1]}, {"scale": [1e200, 1, 1]}]))
        .fails_with("nodes[0]: its world transform is beyond all measure");
    with_nodes(json!([{"mesh": 0, "translation": [1e30, 0, 0]}])).fails_with("nodes[0]: places its mesh more than");
}

#[test]
fn far_meshes_are_brought_to_their_own_origin() {
    let offset = [1e6, -2e6, 0.25];
    let positions = TRIANGLE.map(|p| std::array::from_fn(|i| p[i] + offset[i]));
    let mut gltf = Gltf::with_primitive(|g| json!({"attributes": {"POSITION": g.floats(&positions)}}));
    gltf.json["nodes"][0]["translation"] = json!([0.125, 0, 0]);
    let scene = gltf.scene();
    assert!(scene.meshes[0].positions.iter().flatten().all(|x| x.abs() <= 1.0), "{:?}", scene.meshes[0].positions);
    let expected = positions.map(|p| DVec3::from(p.map(f64::from)) + DVec3::X * 0.125);
    assert_eq!(world(&scene, 0), expected, "not a bit is lost");
}

#[test]
fn flattened_nodes_are_baked() {
    let scene = with_nodes(json!([
        {"name": "flat", "mesh": 0, "scale": [2, 3, 0], "translation": [1000000, 0, 5]},
        {"name": "line", "mesh": 0, "scale": [2, 0, 0]},
        {"name": "point", "mesh": 0, "scale": [0, 0, 0]},
        {"name": "full", "mesh": 0}
    ]))
    .scene();
    assert_sound(&scene);
    assert_eq!(names(&scene), ["flat", "full"]);
    assert_eq!(scene.meshes.len(), 2);
    let expected = [[0.0, 0.0], [2.0, 0.0], [0.0, 3.0]].map(|[x, y]| DVec3::new(1e6 + x, y, 5.0));
    assert_eq!(world(&scene, 0), expected);
    assert_eq!(scene.notices.len(), 3);
}

#[test]
fn cast_shadow_is_inherited() {
    let scene = with_nodes(json!([
        {"name": "a", "mesh": 0, "children": [1, 2]}, {"name": "b", "mesh": 0, "extras": {"castShadow": false, "receiveShadow": false}, "children": [3]},
        {"name": "c", "mesh": 0, "extras": {"castShadow": true, "receiveShadow": true}}, {"name": "d", "mesh": 0, "extras": {"castShadow": true, "receiveShadow": true}},
        {"name": "e", "mesh": 0, "extras": "text"}
    ]))
    .scene();
    assert!(scene.instances.iter().all(|i| i.receives_shadow == i.casts_shadow), "one is inherited as the other");
    let casts: Vec<_> = scene.instances.iter().map(|i| (i.name.as_str(), i.casts_shadow)).collect();
    assert_eq!(casts, [("a", true), ("b", false), ("d", false), ("c", true), ("e", true)]);
}

fn with_lights(nodes: Value) -> Gltf {
    let mut gltf = with_nodes(nodes);
    gltf.json["extensionsUsed"] = json!(["KHR_lights_punctual"]);
    gltf.json["extensions"] = json!({"KHR_lights_punctual": {"lights": [
        {"type": "point", "intensity": 20, "color": [1, 0.5, 0]},
        {"type": "spot", "range": 7, "spot": {"innerConeAngle": 0.1, "outerConeAngle": 0.5}, "name": "spot"},
        {"type": "directional"}
    ]}});
    gltf
}

fn light(index: usize) -> Value {
    json!({"KHR_lights_punctual": {"light": index}})
}

#[test]
fn lights() {
    let down = json!([-FRAC_1_SQRT_2, 0, 0, FRAC_1_SQRT_2]);
    let scene = with_lights(json!([
        {"name": "bulb", "translation": [1, 2, 3], "extensions": light(0)},
        {"translation": [0, 1, 0], "rotation": down, "scale": [3, 3, 3], "extensions": light(1)},
        {"rotation": down, "extensions": light(2)}
    ]))
    .scene();
    assert_sound(&scene);
    assert_eq!(scene.lights.iter().map(|l| l.name.as_str()).collect::<Vec<_>>(), ["bulb", "spot", "light 2"]);
    let position = DVec3::new(1.0, 2.0, 3.0);
    assert_eq!(scene.lights[0].kind, LightKind::Point { position, range: f64::INFINITY });
    assert_eq!((scene.lights[0].intensity, scene.lights[0].color), (20.0, [1.0, 0.5, 0.0]));
    let LightKind::Spot { direction, range, inner, outer, .. } = scene.lights[1].kind else { panic!() };
    assert!(direction.distance(DVec3::NEG_Y) < 1e-12, "{direction}");
    assert_eq!((range, inner, outer), (7.0, 0.1, 0.5), "a node's scale does not change a light");
    let LightKind::Directional { direction } = scene.lights[2].kind else { panic!() };
    assert!(direction.distance(DVec3::NEG_Y) < 1e-12);
    let dangling = with_lights(json!([{"extensions": light(3)}, {"extensions": light(0)}])).scene();
    assert!(dangling.notices[0].starts_with("nodes[0].extensions.KHR_lights_punctual.light refers to"));
    let mut unknown = with_lights(json!([{"extensions": light(0)}, {"extensions": light(1)}]));
    unknown.json["extensions"]["KHR_lights_punctual"]["lights"][0]["type"] = json!("area");
    let unknown = unknown.scene();
    assert_eq!((dangling.lights.len(), unknown.lights.len()), (1, 1));
    assert!(unknown.notices[1].ends_with("lights[0] is of no known type: left out"), "{:?}", unknown.notices);
}

#[test]
fn shapes_of_lights() {
    let mut gltf = with_lights(json!([
        {"extensions": light(1), "rotation": [0, 0, FRAC_1_SQRT_2, FRAC_1_SQRT_2], "scale": [3, 3, 3],
            "extras": {"falloff": [1, 0.5, 0], "cookie": 1, "box": [1, 2, 3]}},
        {"extensions": light(0), "extras": {"box": [4, 5, 6]}},
        {"extensions": light(1), "extras": {"falloff": [1], "cookie": 2, "box": [1, 2]}},
        {"extensions": light(1), "extras": {"falloff": [1, -1], "cookie": -1, "box": [1, 2, 0]}},
        {"extensions": light(0), "extras": {"falloff": [1, 0], "cookie": 1}},
        {"extensions": light(2), "extras": {"falloff": "smooth", "cookie": "gobo.png", "box": true}},
        {"extensions": light(2), "extras": {"falloff": [], "cookie": 1, "box": [1, 1, 1]}},
        {"extensions": light(1), "extras": {"cookie": 0}}
    ]));
    gltf.json["images"] = json!([{"uri": "data:image/png;base64,AAAA"}, {"uri": PIXEL}]);
    gltf.json["textures"] = json!([{"source": 0}, {"source": 1}]);
    let scene = gltf.scene();
    assert_sound(&scene);
    let shape = &scene.lights[0].shape;
    // Texture 0 has no image and is not in the scene.
    assert_eq!((&shape.falloff[..], shape.cookie), (&[1.0, 0.5, 0.0][..], Some(0)));
    assert_eq!(shape.half_extents, Some(DVec3::new(1.0, 2.0, 3.0)), "a node's scale does not change a light");
    assert!(shape.axes.y_axis.distance(DVec3::NEG_X) < 1e-12 && shape.axes.z_axis.distance(DVec3::Z) < 1e-12);
    assert_eq!(scene.lights[1].shape.half_extents, Some(DVec3::new(4.0, 5.0, 6.0)));
    assert!(scene.lights[2..].iter().all(|light| light.shape.is_plain()));
    let notices: Vec<&str> = scene.notices.iter().filter_map(|n| n.strip_prefix("nodes[")).collect();
    assert_eq!(
        notices,
        [
            "2].extras.falloff is left out: it needs at least 2 samples",
            "2].extras.cookie is left out: it refers to a texture that is not there",
            "2].extras.box is left out: it is no array of three numbers",
            "3].extras.falloff is left out: it needs samples that are finite and not negative",
            "3].extras.cookie is left out: it is no index of a texture",
            "3].extras.box is left out: it needs half extents that are finite and greater than 0",
            "4].extras.falloff is left out: it needs a point or spot light with a finite range",
            "4].extras.cookie is left out: it needs a spot light",
            "5].extras.falloff is left out: it is no array of numbers",
            "5].extras.cookie is left out: it is no index of a texture",
            "5].extras.box is left out: it is no array of three numbers",
            "6].extras.falloff is left out: it is empty",
            "6].extras.cookie is left out: it needs a spot light",
            "6].extras.box is left out: it needs a point or spot light",
            "7].extras.cookie is left out: it refers to a texture without a readable image",
        ]
    );
}

#[test]
fn shadow_exclusions_reach_descendants() {
    let scene = with_lights(json!([
        {"extensions": light(0), "extras": {"shadowExclude": ["group", "single", "nobody", 7]}},
        {"name": "group", "children": [2, 3]}, {"mesh": 0}, {"name": "inner", "mesh": 0},
        {"name": "other", "mesh": 0}, {"name": "single", "mesh": 0}, {"extensions": light(1)}
    ]))
    .scene();
    assert_eq!(names(&scene), ["node 2", "inner", "other", "single"]);
    assert_eq!(scene.lights[0].excluded, [0, 1, 3]);
    assert!(scene.lights[1].excluded.is_empty());
    assert_eq!(
        scene.notices,
        ["light \"node 0\": shadowExclude names no node \"nobody\""].map(|s| s.replace("node 0", "light 0"))
    );
}

#[test]
fn cameras() {
    let mut gltf = with_nodes(json!([
        {"camera": 0, "name": "eye", "translation": [0, 0, 5], "scale": [-2, 2, 2]}, {"camera": 1}
    ]));
    gltf.json["cameras"] = json!([
        {"type": "perspective", "perspective": {"yfov": 1, "znear": 0.5}},
        {"type": "orthographic", "name": "plan", "orthographic": {"xmag": 9, "ymag": -2, "znear": 0, "zfar": 10}}
    ]);
    let scene = gltf.scene();
    assert_sound(&scene);
    assert_eq!(scene.cameras[0].name, "eye");
    assert_eq!(scene.cameras[0].projection, Projection::Perspective { yfov: 1.0, near: 0.5, far: None });
    assert_eq!(scene.cameras[0].world_from_view.translation, DVec3::Z * 5.0);
    assert!(scene.cameras[0].world_from_view.matrix3.determinant() > 0.999, "right-handed");
    assert_eq!(scene.cameras[1].name, "plan");
    assert_eq!(scene.cameras[1].projection, Projection::Orthographic { ymag: 2.0, near: 0.0, far: 10.0 });
    for (path, value, expected) in [
        ("0/perspective/yfov", json!(4), "cameras[0] is left out: perspective.yfov must"),
        ("0/perspective/znear", json!(0), "cameras[0] is left out: perspective.znear must"),
        ("0/perspective/yfov", json!("wide"), "cameras[0].perspective.yfov is left out: invalid type"),
        ("1/orthographic/ymag", json!(0), "cameras[1] is left out: orthographic.ymag must"),
        ("1/orthographic/zfar", json!(0), "cameras[1] is left out: orthographic.zfar must"),
        ("1/orthographic", Value::Null, "cameras[1] is left out: it needs exactly one of"),
    ] {
        let mut gltf = gltf.clone();
        *gltf.json.pointer_mut(&format!("/cameras/{path}")).unwrap() = value;
        let scene = gltf.scene();
        assert!(scene.cameras.len() == 1 && scene.notices[0].starts_with(expected), "{:?}", scene.notices);
    }
    gltf.json["nodes"][0]["camera"] = json!(9);
    assert_eq!(gltf.scene().cameras.len(), 1);
    assert!(gltf.scene().notices[0].starts_with("nodes[0].camera refers to cameras[9]"), "{:?}", gltf.scene().notices);
}

#[test]
fn gpu_instancing() {
    let mut gltf = Gltf::triangle();
    let translations = gltf.floats(&[[1.0, 0.0, 0.0], [2.0, 0.0, 0.0]]);
    let scales = gltf.floats(&[[1.0, 1.0, 1.0], [3.0, 3.0, 3.0]]);
    gltf.json["nodes"][0] = json!({"mesh": 0, "name": "tree", "translation": [0, 0, 9], "extensions":
        {"EXT_mesh_gpu_instancing": {"attributes": {"TRANSLATION": translations, "SCALE": scales}}}});
    let scene = gltf.scene();
    assert_eq!(names(&scene), ["tree #0", "tree #1"]);
    assert_eq!(world(&scene, 1)[1], DVec3::new(5.0, 0.0, 9.0));
    let three = gltf.floats(&[[0.0, 0.0, 0.0, 1.0]; 3]);
    gltf.json["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["ROTATION"] = json!(three);
    gltf.fails_with("EXT_mesh_gpu_instancing.attributes");
}

#[test]
fn a_long_chain_of_nodes() {
    const LENGTH: usize = 200_000;
    let mut nodes: Vec<Value> = (1..LENGTH).map(|i| json!({"children": [i]})).collect();
    nodes.push(json!({"mesh": 0}));
    assert_eq!(names(&with_nodes(json!(nodes)).scene()), [format!("node {}", LENGTH - 1)]);
}
