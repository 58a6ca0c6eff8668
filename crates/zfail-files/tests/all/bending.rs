//! Skins and morph targets in motion.

use crate::build::{Gltf, TRIANGLE, assert_sound};
use serde_json::json;
use zfail_plan::glam::DVec3;
use zfail_scene::{Animated, Pose, Scene, world_triangle};

const TIMES: [[f32; 1]; 2] = [[0.0], [2.0]];

/// The first instance's triangle after `seconds`, in a scene that has been posed once before.
fn world(animated: &Animated, seconds: f64) -> [DVec3; 3] {
    let mut scene = animated.scene.clone();
    scene.set_pose(&animated.pose(0, 77.0));
    scene.set_pose(&animated.pose(0, seconds));
    assert_sound(&scene);
    corners(&scene)
}

fn corners(scene: &Scene) -> [DVec3; 3] {
    let instance = &scene.instances[0];
    world_triangle(&scene.meshes[instance.mesh], &instance.world_from_object, 0)
}

#[track_caller]
fn assert_near(found: [DVec3; 3], expected: [[f64; 3]; 3]) {
    for (a, b) in found.into_iter().zip(expected) {
        assert!(a.distance(b.into()) < 1e-6, "{a} is not {b:?}");
    }
}

/// Adds an animation of one channel.
fn animate(gltf: &mut Gltf, node: usize, path: &str, interpolation: &str, output: usize) {
    let input = gltf.floats(&TIMES);
    gltf.json["animations"] = json!([{
        "samplers": [{"input": input, "output": output, "interpolation": interpolation}],
        "channels": [{"sampler": 0, "target": {"node": node, "path": path}}]}]);
}

/// A triangle whose first two corners follow joint 0 and whose third follows joint 1, which an animation takes up by 4 m and
/// away by `far`.
fn waving(far: f32) -> Gltf {
    let mut gltf = Gltf::with_primitive(|g| {
        let joints = g.bytes(&[[0, 0, 0, 0], [0, 0, 0, 0], [1, 0, 0, 0]]);
        let weights = g.floats(&[[1.0, 0.0, 0.0, 0.0]; 3]);
        json!({"attributes": {"POSITION": g.floats(&TRIANGLE), "JOINTS_0": joints, "WEIGHTS_0": weights}})
    });
    gltf.json["skins"] = json!([{"joints": [1, 2]}]);
    gltf.json["nodes"] = json!([{"mesh": 0, "skin": 0, "translation": [9, 9, 9]}, {}, {}]);
    let output = gltf.floats(&[[0.0, 0.0, 0.0], [far, 4.0, 0.0]]);
    animate(&mut gltf, 2, "translation", "LINEAR", output);
    gltf
}

#[test]
fn a_skin_follows_moving_joints() {
    let animated = waving(0.0).animated();
    assert!(animated.animations[0].moves_anything());
    assert!(animated.scene.notices.is_empty(), "{:?}", animated.scene.notices);
    assert_near(corners(&animated.scene), TRIANGLE.map(|p| p.map(f64::from)));
    let [a, b, c] = TRIANGLE.map(|p| p.map(f64::from));
    assert_near(world(&animated, 1.0), [a, b, [c[0], c[1] + 2.0, c[2]]]);
    assert_near(world(&animated, 2.0), [a, b, [c[0], c[1] + 4.0, c[2]]]);
    assert_eq!(animated.pose(1, 2.0), Pose::of(&animated.scene), "at rest in other animations");
    assert_eq!(animated.pose(0, 0.0).bent[0].positions, animated.scene.meshes[0].positions, "the same arithmetic");
}

#[test]
fn normals_follow_the_bent_triangle() {
    // Without normals in the file they are the triangle's own; here it is bent out of its plane.
    let mut gltf = waving(0.0);
    let output = gltf.floats(&[[0.0, 0.0, 0.0], [0.0, 0.0, 1.0]]);
    animate(&mut gltf, 2, "translation", "LINEAR", output);
    let pose = gltf.animated().pose(0, 2.0);
    let [a, b, c] = world(&gltf.animated(), 2.0);
    let expected = (b - a).cross(c - a).normalize();
    for n in &pose.bent[0].normals {
        assert!(DVec3::from(n.map(f64::from)).distance(expected) < 1e-6, "{n:?} is not {expected}");
    }
}

#[test]
fn coordinates_stay_near_the_origin_of_a_skin_that_walks_away() {
    let mut gltf = waving(0.0);
    gltf.json["nodes"] = json!([{"mesh": 0, "skin": 0}, {}, {}, {"children": [1, 2]}]);
    let output = gltf.floats(&[[0.0; 3], [2.0e6, 0.0, 0.0]]);
    animate(&mut gltf, 3, "translation", "LINEAR", output);
    let animated = gltf.animated();
    let pose = animated.pose(0, 2.0);
    assert!(pose.bent[0].positions.iter().flatten().all(|x| x.abs() < 2.0), "{:?}", pose.bent[0].positions);
    assert_near(world(&animated, 2.0), TRIANGLE.map(|[x, y, z]| [2e6 + f64::from(x), y.into(), z.into()]));
}

#[test]
fn what_goes_beyond_all_measure_stays_at_rest() {
    let animated = waving(3e30).animated();
    assert_near(world(&animated, 0.0), TRIANGLE.map(|p| p.map(f64::from)));
    assert_near(world(&animated, 2.0), TRIANGLE.map(|p| p.map(f64::from)));
}

#[test]
fn vertices_that_move_as_one_are_alike() {
    let corners = [TRIANGLE[0], TRIANGLE[1], TRIANGLE[2], TRIANGLE[0], TRIANGLE[1], TRIANGLE[2]];
    let mut gltf = Gltf::with_primitive(|g| {
        // The second triangle's last corner lies where the first one's does, but follows the other joint.
        let joints = g.bytes(&[[0; 4], [0; 4], [1, 0, 0, 0], [0; 4], [0; 4], [0; 4]]);
        let weights = g.floats(&[[1.0, 0.0, 0.0, 0.0]; 6]);
        json!({"attributes": {"POSITION": g.floats(&corners), "JOINTS_0": joints, "WEIGHTS_0": weights}})
    });
    gltf.json["skins"] = json!([{"joints": [1, 2]}]);
    gltf.json["nodes"] = json!([{"mesh": 0, "skin": 0}, {}, {}]);
    assert!(gltf.scene().meshes[0].alike.is_empty(), "nothing moves, so it is rigid");
    let output = gltf.floats(&[[0.0; 3], [1.0; 3]]);
    animate(&mut gltf, 2, "translation", "LINEAR", output);
    let alike = &gltf.scene().meshes[0].alike;
    assert_eq!((alike[0], alike[1]), (alike[3], alike[4]));
    assert_ne!(alike[2], alike[5]);
}

/// A triangle with two morph targets, up and aside, on two nodes; the weights of node 0 are animated.
fn morphing(interpolation: &str, weights: &[[f32; 1]]) -> Gltf {
    let mut gltf = Gltf::with_primitive(|g| {
        let up = g.floats(&[[0.0, 0.0, 1.0]; 3]);
        let aside = g.floats(&[[1.0, 0.0, 0.0]; 3]);
        json!({"attributes": {"POSITION": g.floats(&TRIANGLE)}, "targets": [{"POSITION": up}, {"POSITION": aside}]})
    });
    gltf.json["meshes"][0]["weights"] = json!([0.5, 0]);
    gltf.push("nodes", json!({"mesh": 0}));
    let output = gltf.floats(weights);
    animate(&mut gltf, 0, "weights", interpolation, output);
    gltf
}

fn first_corner(animated: &Animated, seconds: f64) -> [f64; 3] {
    world(animated, seconds)[0].into()
}

#[test]
fn morph_weights_by_every_interpolation() {
    let keys = [[0.0], [1.0], [2.0], [3.0]];
    let linear = morphing("LINEAR", &keys).animated();
    assert_eq!(linear.scene.meshes.len(), 2, "the node whose weights are animated has its own");
    assert_eq!(corners(&linear.scene)[0], DVec3::Z * 0.5, "the mesh's weights");
    assert_eq!(first_corner(&linear, 0.0), [1.0, 0.0, 0.0]);
    assert_eq!(first_corner(&linear, 1.0), [2.0, 0.0, 1.0]);
    assert_eq!(first_corner(&linear, 2.0), [3.0, 0.0, 2.0]);
    assert_eq!(linear.pose(0, 2.0).bent.len(), 1, "the other node is rigid");
    let step = morphing("STEP", &keys).animated();
    assert_eq!(first_corner(&step, 1.9), [1.0, 0.0, 0.0]);

    // In-tangents of both targets, values, out-tangents: up = t^2, aside = 0 between t = 0 and 2.
    let keys = [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 4.0, 0.0, 4.0, 0.0, 4.0, 0.0].map(|x| [x]);
    let spline = morphing("CUBICSPLINE", &keys).animated();
    for seconds in [0.0, 0.5, 1.0, 1.75, 2.0] {
        let [x, _, z] = first_corner(&spline, seconds);
        assert!((z - seconds * seconds).abs() < 1e-6 && x == 0.0, "{seconds}: {x} {z}");
    }
}

#[test]
fn faulty_morph_animations_are_left_out() {
    let short = morphing("LINEAR", &[[0.0], [1.0], [2.0]]).animated();
    assert!(!short.animations[0].moves_anything());
    assert!(short.scene.notices[0].contains("has 3 elements, but 2 keys of 2 morph targets need 4"));
    let mut twice = morphing("LINEAR", &[[0.0], [1.0], [2.0], [3.0]]);
    let channel = twice.json["animations"][0]["channels"][0].clone();
    twice.json["animations"][0]["channels"].as_array_mut().unwrap().push(channel);
    let twice = twice.animated();
    assert_eq!(first_corner(&twice, 1.0), [2.0, 0.0, 1.0], "as the first says");
    let expected = "animations[0].channels[1] is left out: it changes the morph weights of nodes[0] a second time";
    assert_eq!(twice.scene.notices, [expected]);
}
