//! Animations of nodes: what moves, how, and which faults are named.

use crate::build::{Gltf, assert_sound};
use serde_json::{Value, json};
use std::f64::consts::{FRAC_1_SQRT_2, PI};
use zfail_plan::glam::{DAffine3, DVec3};
use zfail_plan::light::LightKind;
use zfail_scene::{Animated, Pose, world_triangle};

/// Key times of most tests, seconds.
const TIMES: [[f32; 1]; 2] = [[1.0], [3.0]];

/// A triangle on node 0, which the animation "move" moves.
fn moving(path: &str, interpolation: &str, output: impl FnOnce(&mut Gltf) -> usize) -> Gltf {
    let mut gltf = Gltf::triangle();
    let (input, output) = (gltf.floats(&TIMES), output(&mut gltf));
    gltf.json["animations"] = json!([{"name": "move",
        "samplers": [{"input": input, "output": output, "interpolation": interpolation}],
        "channels": [{"sampler": 0, "target": {"node": 0, "path": path}}]}]);
    gltf
}

/// A linear translation along x, from 10 to 20.
fn sliding() -> Gltf {
    moving("translation", "LINEAR", |g| g.floats(&[[10.0, 0.0, 0.0], [20.0, 0.0, 0.0]]))
}

/// The first instance's transform after `seconds`.
fn instance(animated: &Animated, seconds: f64) -> DAffine3 {
    animated.pose(0, seconds).instances[0]
}

#[track_caller]
fn assert_near(a: DVec3, b: impl Into<DVec3>) {
    let b = b.into();
    assert!(a.distance(b) < 1e-6, "{a} is not {b}");
}

#[test]
fn translations_by_every_interpolation() {
    let x = |animated: &Animated, seconds: f64| instance(animated, seconds).translation.x;
    let linear = sliding().animated();
    assert_eq!((linear.animations[0].name.as_str(), linear.animations[0].duration), ("move", 3.0));
    assert!(linear.animations[0].moves_anything());
    for (seconds, expected) in [(-1.0, 10.0), (1.0, 10.0), (1.5, 12.5), (3.0, 20.0), (99.0, 20.0)] {
        assert_eq!(x(&linear, seconds), expected, "{seconds}");
    }
    let mut gltf = sliding();
    gltf.json["animations"][0]["samplers"][0].as_object_mut().unwrap().remove("interpolation");
    assert_eq!(x(&gltf.animated(), 1.5), 12.5, "linear is the default");
    gltf.json["animations"][0]["samplers"][0]["interpolation"] = json!("STEP");
    assert_eq!((x(&gltf.animated(), 2.9), x(&gltf.animated(), 3.0)), (10.0, 20.0));

    // x = t^2 between t = 1 and 3.
    let keys = [2.0, 1.0, 2.0, 6.0, 9.0, 6.0].map(|x| [x, 0.0, 0.0]);
    let spline = moving("translation", "CUBICSPLINE", |g| g.floats(&keys)).animated();
    for seconds in [1.0, 1.25, 2.0, 2.5, 3.0] {
        assert!((x(&spline, seconds) - seconds * seconds).abs() < 1e-12, "{seconds}");
    }
    assert_eq!((x(&spline, 0.0), x(&spline, 4.0)), (1.0, 9.0));
}

#[test]
fn the_file_at_rest_is_not_moved() {
    let mut gltf = sliding();
    gltf.json["nodes"][0]["translation"] = json!([7, 8, 9]);
    let animated = gltf.animated();
    assert_eq!(animated.scene.instances[0].world_from_object.translation, DVec3::new(7.0, 8.0, 9.0));
    assert_eq!(gltf.scene().instances[0].world_from_object.translation, DVec3::new(7.0, 8.0, 9.0));
    assert_eq!(animated.pose(1, 2.0), Pose::of(&animated.scene), "there is no second animation");
    assert_ne!(animated.pose(0, 2.0), Pose::of(&animated.scene));
}

#[test]
fn rotations_from_floats_and_normalised_integers() {
    let half = [0.0, 1.0, 0.0, 0.0];
    let quarter_turned = |animated: &Animated| instance(animated, 2.0).transform_vector3(DVec3::X);
    let floats = moving("rotation", "LINEAR", |g| g.floats(&[[0.0, 0.0, 0.0, 1.0], half]));
    assert_near(quarter_turned(&floats.animated()), [0.0, 0.0, -1.0]);

    let normalised = |output: &dyn Fn(&mut Gltf) -> usize| {
        moving("rotation", "LINEAR", |g| {
            let accessor = output(g);
            g.json["accessors"][accessor]["normalized"] = json!(true);
            accessor
        })
    };
    let bytes = normalised(&|g| g.bytes(&[[0, 0, 0, 255], [0, 255, 0, 0]]));
    let shorts = normalised(&|g| g.shorts(&[[0, 0, 0, 65535], [0, 65535, 0, 0]]));
    let signed = normalised(&|g| g.accessor(&[0, 0, 0, 127, 0, 129, 0, 0], 5120, "VEC4", 2));
    for (gltf, z) in [(bytes, -1.0), (shorts, -1.0), (signed, 1.0)] {
        assert_near(quarter_turned(&gltf.animated()), [0.0, 0.0, z]);
    }
}

#[test]
fn spline_rotations_are_normalised() {
    let zero = [0.0; 4];
    let keys = [zero, [0.0, 0.0, 0.0, 1.0], zero, zero, [0.0, 1.0, 0.0, 0.0], zero];
    let animated = moving("rotation", "CUBICSPLINE", |g| g.floats(&keys)).animated();
    assert_near(instance(&animated, 2.0).transform_vector3(DVec3::X), [0.0, 0.0, -1.0]);
}

#[test]
fn scales_and_what_they_shrink_to_nothing() {
    let animated = moving("scale", "LINEAR", |g| g.floats(&[[2.0, 2.0, 0.0], [-2.0, 2.0, 0.0]])).animated();
    let mut scene = animated.scene.clone();
    for seconds in [0.0, 1.0, 2.0, 2.0 + 1e-12, 3.0] {
        scene.set_pose(&animated.pose(0, seconds));
        assert_sound(&scene);
        let matrix = scene.instances[0].world_from_object.matrix3;
        assert!(matrix.inverse().is_finite(), "{seconds}");
        assert!((matrix.x_axis.x - (2.0 - 2.0 * (seconds - 1.0).clamp(0.0, 2.0))).abs() < 1e-5, "{seconds}");
        assert!(matrix.z_axis.length() < 1e-5);
    }
    let vanishing = moving("scale", "STEP", |g| g.floats(&[[0.0; 3], [1.0; 3]])).animated();
    assert!(instance(&vanishing, 0.0).transform_vector3(DVec3::ONE).length() < 1e-8);
    assert!(instance(&vanishing, 0.0).inverse().is_finite());
    assert_eq!(instance(&vanishing, 3.0), DAffine3::IDENTITY);
}

#[test]
fn what_is_flat_at_rest_keeps_its_shape_for_later() {
    for scale in [json!([0, 0, 0]), json!([1, 0, 1])] {
        let mut gltf = moving("scale", "STEP", |g| g.floats(&[[0.0; 3], [1.0; 3]]));
        gltf.json["nodes"][0]["scale"] = scale;
        let animated = gltf.animated();
        assert_sound(&animated.scene);
        let mesh = &animated.scene.meshes[animated.scene.instances[0].mesh];
        let corners = world_triangle(mesh, &instance(&animated, 3.0), 0);
        assert_eq!(corners, [DVec3::ZERO, DVec3::X, DVec3::Y]);
        assert!(animated.scene.notices.is_empty(), "{:?}", animated.scene.notices);
    }
}

#[test]
fn hierarchies_compose_in_double_precision() {
    let mut gltf = sliding();
    gltf.json["nodes"] = json!([
        {"translation": [0, 0, 0], "children": [1]},
        {"rotation": [0, 0, FRAC_1_SQRT_2, FRAC_1_SQRT_2], "children": [2]},
        {"translation": [0.1, 0, 0], "mesh": 0, "name": "leaf"},
        {"mesh": 0, "name": "still"},
        {"translation": [1000000.1, 0, 0], "children": [0]}
    ]);
    let turn = gltf.floats(&[[0.0, 0.0, 0.0, 1.0], [0.0, 0.0, 1.0, 0.0]]);
    let animation = &mut gltf.json["animations"][0];
    let input = animation["samplers"][0]["input"].clone();
    animation["samplers"].as_array_mut().unwrap().push(json!({"input": input, "output": turn}));
    animation["channels"]
        .as_array_mut()
        .unwrap()
        .push(json!({"sampler": 1, "target": {"node": 1, "path": "rotation"}}));
    let animated = gltf.animated();
    let names: Vec<_> = animated.scene.instances.iter().map(|i| i.name.as_str()).collect();
    assert_eq!(names, ["still", "leaf"]);
    let rest = Pose::of(&animated.scene);
    for seconds in [1.0, 1.5, 2.0, 3.0] {
        let pose = animated.pose(0, seconds);
        let angle = PI * (seconds - 1.0) / 2.0;
        let slide = 10.0 + 5.0 * (seconds - 1.0);
        let expected = DVec3::new(1_000_000.1 + slide + 0.1 * angle.cos(), 0.1 * angle.sin(), 0.0);
        assert!(pose.instances[1].translation.distance(expected) < 1e-9, "{seconds}");
        assert_eq!(pose.instances[0], rest.instances[0]);
    }
}

#[test]
fn lights_and_cameras_move_with_their_nodes() {
    let mut gltf = sliding();
    let light = |i: usize| json!({"KHR_lights_punctual": {"light": i}});
    gltf.json["extensions"] = json!({"KHR_lights_punctual": {"lights": [
        {"type": "point", "range": 5}, {"type": "spot", "spot": {"outerConeAngle": 0.5}}, {"type": "directional"}]}});
    gltf.json["cameras"] = json!([{"type": "perspective", "perspective": {"yfov": 1, "znear": 0.1}}]);
    gltf.json["nodes"] = json!([
        {"children": [1, 2, 3, 4]}, {"extensions": light(0)},
        {"extensions": light(1), "rotation": [0, FRAC_1_SQRT_2, 0, FRAC_1_SQRT_2]}, {"extensions": light(2)},
        {"camera": 0, "translation": [0, 1, 0], "scale": [2, 2, 2]}, {"extensions": light(0)}
    ]);
    let animated = gltf.animated();
    let pose = animated.pose(0, 2.0);
    let position = DVec3::X * 15.0;
    assert_eq!(pose.lights[0], LightKind::Point { position, range: 5.0 });
    let LightKind::Spot { position: at, direction, outer, .. } = pose.lights[1] else { panic!() };
    assert_eq!((at, outer), (position, 0.5));
    assert_near(direction, DVec3::NEG_X);
    assert_near(pose.light_axes[1].x_axis, DVec3::NEG_Z);
    assert_near(pose.light_axes[1].y_axis, DVec3::Y);
    assert_eq!(pose.lights[2], LightKind::Directional { direction: DVec3::NEG_Z });
    assert_eq!(pose.lights[3], animated.scene.lights[3].kind, "the same light on a node that stands still");
    assert_eq!(pose.cameras[0], DAffine3::from_translation(DVec3::new(15.0, 1.0, 0.0)), "rigid");
}

#[test]
fn a_pose_depends_on_nothing_but_animation_and_time() {
    let mut gltf = sliding();
    let mut second = gltf.json["animations"][0].clone();
    second["name"] = Value::Null;
    second["channels"] = json!([]);
    gltf.json["animations"].as_array_mut().unwrap().push(second);
    let mut animated = gltf.animated();
    assert_eq!((animated.animations[1].name.as_str(), animated.animations[1].duration), ("animation 1", 0.0));
    assert!(!animated.animations[1].moves_anything());
    let expected = [animated.pose(0, 2.0), animated.pose(1, 2.0)];
    assert_ne!(expected[0], expected[1]);
    let mut pose = animated.pose(0, 3.0);
    animated.scene.set_pose(&pose);
    for (i, expected) in expected.iter().enumerate() {
        animated.pose_into(i, 2.0, &mut pose);
        assert_eq!(pose, *expected, "animation {i}");
    }
}

#[test]
fn a_completed_scene_has_poses_of_its_size() {
    let mut animated = sliding().animated();
    zfail_scene::complete(&mut animated.scene);
    let pose = animated.pose(0, 2.0);
    assert_eq!((pose.instances.len(), pose.lights.len(), pose.cameras.len()), (1, 1, 1));
    assert_eq!(pose.cameras[0], animated.scene.cameras[0].world_from_view);
}

#[test]
fn time_wraps_over_the_duration() {
    let animation = &sliding().animated().animations[0];
    for (seconds, wrapped) in [(0.0, 0.0), (2.5, 2.5), (3.0, 3.0), (4.0, 1.0), (9.5, 0.5)] {
        assert_eq!(animation.wrapped(seconds), wrapped);
    }
    assert!(zfail_scene::Animation::default().wrapped(7.0) < 1e-9);
}

#[test]
fn what_cannot_be_animated_is_left_out_with_a_notice() {
    let notices = |change: &dyn Fn(&mut Gltf)| {
        let mut gltf = sliding();
        change(&mut gltf);
        let animated = gltf.animated();
        assert!(!animated.animations[0].moves_anything());
        assert_eq!(animated.animations[0].duration, 3.0);
        animated.scene.notices
    };
    let target = |g: &mut Gltf, target: Value| g.json["animations"][0]["channels"][0]["target"] = target;
    assert_eq!(
        notices(&|g| target(g, json!({"node": 0, "path": "weights"}))),
        ["animations[0].channels[0] would change the morph weights of nodes[0], which has none: left out"]
    );
    assert_eq!(
        notices(&|g| target(g, json!({"path": "pointer"}))),
        ["animations[0].channels[0].target.path is \"pointer\": left out"]
    );
    assert!(notices(&|g| target(g, json!({"path": "translation"}))).is_empty(), "for an extension to say");
    let matrix = json!([1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 7, 8, 9, 1]);
    assert_eq!(
        notices(&|g| g.json["nodes"][0]["matrix"] = matrix.clone()),
        ["animations[0].channels[0] would move nodes[0], which has a matrix: left out"]
    );
    // A node outside of the default scene is nobody's fault.
    let elsewhere = notices(&|g| {
        g.push("nodes", json!({"mesh": 0}));
        g.json["scenes"] = json!([{"nodes": [1]}]);
    });
    assert!(elsewhere.is_empty(), "{elsewhere:?}");
}

#[test]
fn rotations_without_length_are_replaced() {
    let keys = [[0.0; 4], [0.0, 1.0, 0.0, 0.0]];
    let animated = moving("rotation", "LINEAR", |g| g.floats(&keys)).animated();
    assert_eq!(animated.scene.notices.len(), 1);
    assert!(animated.scene.notices[0].starts_with("animations[0].samplers[0].output has rotations without length"));
    for seconds in [1.0, 2.0, 3.0] {
        assert_near(instance(&animated, seconds).transform_vector3(DVec3::X), DVec3::NEG_X);
    }
    assert_eq!(instance(&animated, 0.0), DAffine3::IDENTITY, "before it, the node's own");
}

/// Asserts that the animation of `gltf` moves nothing, and that the notice about it ends so.
#[track_caller]
fn assert_still(gltf: &Gltf, expected: &str) {
    let animated = gltf.animated();
    assert_sound(&animated.scene);
    assert!(animated.animations.iter().all(|animation| !animation.moves_anything()), "{expected}");
    assert_eq!(animated.scene.instances.len(), 1);
    let notices = &animated.scene.notices;
    assert!(notices.iter().any(|notice| notice.contains(expected)), "{notices:?} lack {expected:?}");
}

#[test]
fn broken_channels_are_left_out() {
    assert!(sliding().animated().animations[0].moves_anything(), "without a fault it moves");
    let still = |pointer: &str, value: Value, expected: &str| {
        let mut gltf = sliding();
        *gltf.json.pointer_mut(&format!("/animations/0/{pointer}")).unwrap() = value;
        assert_still(&gltf, expected);
    };
    still("samplers/0/input", json!(9), "animations[0].samplers[0].input refers to accessors[9]");
    still("samplers/0/output", json!(9), "animations[0].samplers[0].output refers to accessors[9]");
    still("channels/0/sampler", json!(1), "animations[0].channels[0].sampler refers to samplers[1]");
    still("channels/0/target/node", json!(1), "animations[0].channels[0].target.node refers to nodes[1]");
    still("channels/0/target", json!({}), "animations[0].channels[0].target.path is \"\": left out");
    still("samplers/0/interpolation", json!("BEZIER"), "animations[0].samplers[0].interpolation is left out: unknown");
    still("samplers/0/interpolation", json!("CUBICSPLINE"), "has 2 elements, but 2 keys need 6");
    still("channels/0/target/path", json!("rotation"), "accessors[2].type: is Vec3, but 4 components are needed");
    still("samplers/0/input", json!(0), "accessors[0].type: is Vec3, but 1 components are needed");

    let with_times = |times: &[[f32; 1]], expected: &str| {
        let mut gltf = sliding();
        gltf.json["animations"][0]["samplers"][0]["input"] = json!(gltf.floats(times));
        assert_still(&gltf, expected);
    };
    with_times(&[[0.0], [1.0], [2.0]], "accessors[2] has 2 elements, but 3 keys need 3");
    with_times(&[], "animations[0].samplers[0].input: accessors[3] has no keys");
    with_times(&[[0.0], [f32::NAN]], "the time of key 1 (accessors[3]) is not finite");
    let mut gltf = sliding();
    gltf.json["animations"][0]["samplers"][0]["input"] = json!(gltf.shorts(&[[0], [1]]));
    assert_still(&gltf, "animations[0].samplers[0].input: accessors[3] must hold single-precision floats");

    let infinite = moving("scale", "LINEAR", |g| g.floats(&[[1.0; 3], [1.0, f32::INFINITY, 1.0]]));
    assert_still(&infinite, "animations[0].samplers[0].output: element 1 (accessors[2]) is not finite");
    let plain = moving("rotation", "LINEAR", |g| g.bytes(&[[0, 0, 0, 255], [0, 255, 0, 0]]));
    assert_still(&plain, "animations[0].samplers[0].output: accessors[2] must hold floats or normalized integers");
}

#[test]
fn a_second_channel_of_the_same_property_is_left_out() {
    let mut gltf = sliding();
    let other = gltf.floats(&[[0.0; 3], [0.0; 3]]);
    let animation = &mut gltf.json["animations"][0];
    let input = animation["samplers"][0]["input"].clone();
    animation["samplers"].as_array_mut().unwrap().push(json!({"input": input, "output": other}));
    let mut again = animation["channels"][0].clone();
    again["sampler"] = json!(1);
    animation["channels"].as_array_mut().unwrap().push(again);
    let animated = gltf.animated();
    assert_eq!(instance(&animated, 2.0).translation.x, 15.0);
    let expected = "animations[0].channels[1] is left out: it moves the translation of nodes[0] a second time";
    assert_eq!(animated.scene.notices, [expected]);
}

#[test]
fn keys_out_of_order_are_sorted() {
    let sorted = |interpolation: &str, times: &[[f32; 1]], values: &[[f32; 3]]| {
        let mut gltf = moving("translation", interpolation, |g| g.floats(values));
        gltf.json["animations"][0]["samplers"][0]["input"] = json!(gltf.floats(times));
        let animated = gltf.animated();
        assert_eq!(animated.scene.notices.len(), usize::from(!times.is_sorted()), "{:?}", animated.scene.notices);
        animated
    };
    let x = |x: f32| [x, 0.0, 0.0];
    let linear = sorted("LINEAR", &[[3.0], [1.0], [2.0]], &[x(30.0), x(10.0), x(0.0)]);
    assert_eq!(linear.animations[0].duration, 3.0);
    for (seconds, expected) in [(0.0, 10.0), (1.5, 5.0), (2.0, 0.0), (2.5, 15.0), (9.0, 30.0)] {
        assert_eq!(instance(&linear, seconds).translation.x, expected, "{seconds}");
    }
    // Tangents go with their key.
    let key = |t: f32| [x(2.0 * t), x(t * t), x(2.0 * t)];
    let spline = sorted("CUBICSPLINE", &[[3.0], [1.0]], [key(3.0), key(1.0)].as_flattened());
    let same = sorted("CUBICSPLINE", &[[1.0], [3.0]], [key(1.0), key(3.0)].as_flattened());
    for seconds in [1.0, 1.5, 2.5] {
        assert_eq!(instance(&spline, seconds).translation.x, seconds * seconds);
        assert_eq!(instance(&spline, seconds), instance(&same, seconds));
    }
}

#[test]
fn what_pointers_would_change_is_named() {
    let mut gltf = sliding();
    let pointer =
        |pointer: &str| json!({"path": "pointer", "extensions": {"KHR_animation_pointer": {"pointer": pointer}}});
    let channel = &mut gltf.json["animations"][0]["channels"][0]["target"];
    *channel = pointer("/nodes/0/extensions/KHR_node_visibility/visible");
    assert_still(&gltf, "show and hide by \"/nodes/0/extensions/KHR_node_visibility/visible\": left out");
    gltf.json["animations"][0]["channels"][0]["target"] = pointer("/materials/0/alphaCutoff");
    assert_still(&gltf, "animations[0].channels[0] would change \"/materials/0/alphaCutoff\": left out");
}

#[test]
fn a_node_below_two_others_moves_below_both() {
    let mut gltf = sliding();
    gltf.json["nodes"] =
        json!([{"children": [3]}, {"children": [2]}, {"children": [3], "translation": [0, 7, 0]}, {"mesh": 0}]);
    let animated = gltf.animated();
    let places = |pose: &Pose| pose.instances.iter().map(|i| i.translation.to_array()).collect::<Vec<_>>();
    assert_eq!(places(&Pose::of(&animated.scene)), [[0.0; 3], [0.0, 7.0, 0.0]]);
    assert_eq!(places(&animated.pose(0, 2.0)), [[15.0, 0.0, 0.0], [0.0, 7.0, 0.0]]);
    gltf.json["animations"][0]["channels"][0]["target"]["node"] = json!(3);
    assert_eq!(places(&gltf.animated().pose(0, 2.0)), [[15.0, 0.0, 0.0], [15.0, 7.0, 0.0]], "itself, in both places");
}

#[test]
fn two_keys_at_one_time_are_a_jump() {
    let mut gltf = sliding();
    gltf.json["animations"][0]["samplers"][0] = json!({
        "input": gltf.floats(&[[0.0], [1.0], [1.0], [2.0]]),
        "output": gltf.floats(&[[0.0; 3], [1.0, 0.0, 0.0], [5.0, 0.0, 0.0], [6.0, 0.0, 0.0]])
    });
    let animated = gltf.animated();
    let x = |seconds| instance(&animated, seconds).translation.x;
    assert_eq!((x(0.5), x(1.0), x(1.5)), (0.5, 5.0, 5.5));
}

#[test]
fn beyond_all_measure_means_at_rest() {
    let mut gltf = moving("scale", "LINEAR", |g| g.floats(&[[1.0; 3], [1e38; 3]]));
    gltf.json["nodes"] = json!([{"children": [1]}, {"mesh": 0, "translation": [1, 2, 3]}]);
    let animated = gltf.animated();
    let mut scene = animated.scene.clone();
    for seconds in [2.0, 3.0] {
        scene.set_pose(&animated.pose(0, seconds));
        assert_sound(&scene);
        assert_eq!(scene.instances[0].world_from_object.translation, DVec3::new(1.0, 2.0, 3.0));
    }
}
