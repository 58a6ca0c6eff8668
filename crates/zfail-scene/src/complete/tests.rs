use super::*;
use crate::{Camera, Instance, Light, LightShape, Material, Primitive};
use glam::{DAffine3, DMat4};

/// Adds a box with its faces outwards, or inwards.
fn add_box(scene: &mut Scene, min: [f32; 3], max: [f32; 3], inwards: bool) {
    let corner = |i: usize| std::array::from_fn(|axis| if i >> axis & 1 == 0 { min[axis] } else { max[axis] });
    let faces: [[u32; 4]; 6] = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
    let triangles = faces.into_iter().flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]]);
    let mesh = Mesh {
        positions: (0..8).map(corner).collect(),
        triangles: triangles.map(|[a, b, c]| if inwards { [a, c, b] } else { [a, b, c] }).collect(),
        primitives: vec![Primitive { triangles: 0..12, material: None }],
        ..Mesh::default()
    };
    let instance = Instance {
        name: "box".into(),
        mesh: scene.meshes.len(),
        world_from_object: DAffine3::IDENTITY,
        casts_shadow: true,
        receives_shadow: true,
    };
    scene.meshes.push(mesh);
    scene.instances.push(instance);
}

/// One box with its faces outwards.
fn one_box(min: [f32; 3], max: [f32; 3]) -> Scene {
    let mut scene = Scene::default();
    add_box(&mut scene, min, max, false);
    scene
}

/// A room with walls that are thick, or seen from within alone, and things in its corners.
fn room(thick: bool, lid: bool) -> Scene {
    let mut scene = Scene::default();
    let (low, high) = ([-5.0, 0.0, -5.0], [5.0, 4.0, 5.0]);
    add_box(&mut scene, low, high, true);
    if thick {
        add_box(&mut scene, [-5.2, -0.2, -5.2], [5.2, if lid { 4.2 } else { 4.0 }, 5.2], false);
    }
    if !lid {
        for mesh in &mut scene.meshes {
            // Both triangles of the face at the top.
            mesh.triangles.drain(6..8);
            mesh.primitives[0].triangles = 0..10;
        }
    }
    for (x, z) in [(-3.0, -3.0), (3.0, -3.0), (-3.0, 3.0), (3.0, 3.0)] {
        for y in [0.0, 1.0, 2.0] {
            for dx in [0.0, 0.5] {
                add_box(&mut scene, [x + dx, y, z], [x + dx + 0.4, y + 0.8, z + 0.6], false);
            }
        }
    }
    scene
}

fn completed(scene: Scene, setting: &Setting) -> Animated {
    let mut animated = Animated::from(scene);
    setting.complete(&mut animated);
    animated
}

fn point_light(intensity: f32) -> Light {
    Light {
        name: String::new(),
        kind: LightKind::Point { position: DVec3::Y, range: f64::INFINITY },
        color: [1.0; 3],
        intensity,
        excluded: Vec::new(),
        shape: LightShape::default(),
    }
}

/// How far from the middle of the picture towards its edges points lie: left, right, below, above.
fn reached(camera: &Camera, aspect: f64, points: impl Iterator<Item = DVec3>) -> [f64; 4] {
    let view = camera.view([(1000.0 * aspect) as u32, 1000], &Bounds::EMPTY);
    let clip_from_world = view.clip_from_view() * DMat4::from(camera.world_from_view.inverse());
    points.fold([f64::NEG_INFINITY; 4], |reached, p| {
        let p = clip_from_world * p.extend(1.0);
        assert!(p.w > view.near(), "in front of the eye");
        let here = [-p.x, p.x, -p.y, p.y];
        std::array::from_fn(|side| reached[side].max(here[side] / p.w))
    })
}

fn vertices(scene: &Scene) -> impl Iterator<Item = DVec3> {
    scene.instances.iter().flat_map(|instance| {
        let mesh = &scene.meshes[instance.mesh];
        (0..mesh.positions.len() as u32).map(|v| instance.world_from_object.transform_point3(mesh.position(v)))
    })
}

fn sunlight(scene: &Scene) -> DVec3 {
    let LightKind::Directional { direction } = scene.lights[0].kind else { panic!("it is a sun") };
    direction
}

#[test]
fn everything_and_its_shadow_fill_the_picture() {
    for size in [1e-3, 1.0, 1e6] {
        for aspect in [0.5, 1.0, 1.6, 3.0] {
            let bare = one_box([0.0; 3], [size, 2.0 * size, size]);
            let scene = completed(bare, &Setting { aspect, ..Setting::default() }).scene;
            let (ground, way) = (scene.ground.expect("nothing lies below"), sunlight(&scene));
            let shadow = |p: DVec3| p + (ground.height - p.y) / way.y * way;
            let points: Vec<DVec3> = vertices(&scene).flat_map(|p| [p, shadow(p)]).collect();
            let sides = reached(&scene.cameras[0], aspect, points.into_iter());
            let widest = sides.into_iter().fold(0.0, f64::max);
            assert!((0.9..0.93).contains(&widest), "{size} {aspect}: {sides:?}");
            let centred = (sides[0] - sides[1]).abs().max((sides[2] - sides[3]).abs());
            assert!(centred < 0.03, "{size} {aspect}: {sides:?}");
        }
    }
}

#[test]
fn shadows_fall_to_the_side_and_are_not_long() {
    let scene = completed(one_box([0.0; 3], [1.0, 2.0, 1.0]), &Setting::default()).scene;
    let axes = scene.cameras[0].world_from_view.matrix3;
    let along = sunlight(&scene).with_y(0.0);
    let forward = (-axes.z_axis).with_y(0.0).normalize();
    assert!(along.dot(axes.x_axis) > along.dot(forward).abs(), "to the right of the eye rather than away from it");
    assert!(along.dot(forward) > 0.0, "the side that is seen is lit");
    assert!(along.length() / -sunlight(&scene).y < 1.2, "no longer than the thing is high");
    // Where most of what is seen would face away from it, the sun stands on the other side.
    let mut wall = one_box([0.0; 3], [0.1, 2.0, 5.0]);
    wall.instances[0].world_from_object = DAffine3::from_rotation_y(0.3);
    let scene = completed(wall, &Setting::default()).scene;
    assert!(sunlight(&scene).dot(scene.cameras[0].world_from_view.matrix3.x_axis) < 0.0);
    let sun = Sun { azimuth: 90.0, elevation: 30.0 };
    let moved = completed(one_box([0.0; 3], [1.0, 2.0, 1.0]), &Setting { sun: Some(sun), ..Setting::default() }).scene;
    assert!((sunlight(&moved) - sun.direction()).length() < 1e-12);
}

#[test]
fn a_ground_lies_where_nothing_else_does() {
    let ground = |scene: Scene, choice| {
        completed(scene, &Setting { ground: choice, ..Setting::default() }).scene.ground.map(|ground| ground.height)
    };
    let alone = || one_box([0.0, -0.25, 0.0], [1.0, 2.0, 1.0]);
    assert_eq!(ground(alone(), GroundChoice::Auto), Some(-0.25));
    assert_eq!(ground(alone(), GroundChoice::None), None);
    let mut floored = alone();
    add_box(&mut floored, [-3.0, -0.25, -3.0], [3.0, -0.25, 3.0], false);
    assert_eq!(ground(floored, GroundChoice::Auto), None);
    let mut rug = alone();
    add_box(&mut rug, [0.4, -0.25, 0.4], [0.6, -0.25, 0.6], false);
    assert_eq!(ground(rug, GroundChoice::Auto), Some(-0.25), "a rug is no floor");
    let mut lit = alone();
    lit.lights.push(point_light(1.0));
    assert_eq!(ground(lit, GroundChoice::Auto), None, "what a file has lit is left as it is");
    let bare = Setting { surroundings: false, ..Setting::default() };
    assert_eq!(completed(alone(), &bare).scene.ground, None);
    let shown = completed(alone(), &Setting::default()).scene;
    assert_eq!(completed(alone(), &bare).scene.cameras[0].world_from_view, shown.cameras[0].world_from_view);
}

#[test]
fn a_ground_with_a_height_is_a_surface() {
    let mut lit = one_box([0.0; 3], [1.0; 3]);
    lit.lights.push(point_light(1.0));
    let scene = completed(lit, &Setting { ground: GroundChoice::Height(-2.0), ..Setting::default() }).scene;
    assert!(scene.ground.is_none() && scene.instances.len() == 2 && !scene.instances[1].casts_shadow);
    let heights = Bounds::of(vertices(&scene).skip(8));
    assert_eq!((heights.min.y, heights.max.y), (-2.0, -2.0));
    assert!(scene.meshes[1].primitives[0].material == Some(0) && scene.materials.len() == 1);
}

#[test]
fn what_leaves_its_place_would_leave_a_picture_of_its_rest() {
    // What `Motion` adds; the control of what the built-in scenes show of motions that stay in the picture.
    let scene = one_box([0.0; 3], [1.0; 3]);
    let used = [scene.meshes[0].used_vertices()];
    let mut pose = Pose::of(&scene);
    let framed = |poses: &[Pose]| {
        let mut motion = Motion::new(1.0, DVec3::ZERO, upright(DVec3::Z), None);
        poses.iter().for_each(|pose| motion.add(Posed { scene: &scene, pose, used: &used }));
        (motion.framing(None).camera(1.0), motion.bounds)
    };
    let rest = pose.clone();
    pose.instances[0] = DAffine3::from_translation(DVec3::new(7.0, -3.0, 0.0));
    let moved = || vertices(&scene).map(|p| p + DVec3::new(7.0, -3.0, 0.0));
    let outside = |camera: &Camera| reached(camera, 1.0, moved()).into_iter().any(|side| side > 1.0);
    assert!(outside(&framed(std::slice::from_ref(&rest)).0));
    let (camera, bounds) = framed(&[rest, pose]);
    assert!(!outside(&camera));
    assert_eq!(bounds, Bounds { min: DVec3::new(0.0, -3.0, 0.0), max: DVec3::new(8.0, 1.0, 1.0) });
}

#[test]
fn rooms_are_seen_open_and_lit() {
    // A closed room is seen from within, under a lamp.
    let closed = completed(room(true, true), &Setting::default());
    assert!(matches!(closed.framing, Some(Framing(framing::Kind::Inside(_)))));
    let eye = closed.scene.cameras[0].world_from_view.translation;
    assert!(eye.abs().max_element() < 5.0 && closed.scene.ground.is_none());
    let LightKind::Point { position, .. } = closed.scene.lights[0].kind else { panic!("no sun comes in") };
    assert!(position.abs().max_element() < 5.0 && position.y > 1.0);
    assert!(closed.scene.notices[0].contains("lamp"));
    // One whose walls are seen from within alone is seen through them; no sun comes in all the same.
    let shell = completed(room(false, true), &Setting::default());
    assert!(matches!(shell.framing, Some(Framing(framing::Kind::Around { .. }))));
    assert!(matches!(shell.scene.lights[0].kind, LightKind::Point { .. }));
    // One without a ceiling is seen from higher up than a thing without walls, in the sun.
    let open = completed(room(true, false), &Setting::default());
    let height = |animated: &Animated| animated.scene.cameras[0].world_from_view.matrix3.z_axis.y;
    let solid = completed(one_box([-5.2, -0.2, -5.2], [5.2, 4.0, 5.2]), &Setting::default());
    assert!(height(&open) > height(&solid) + 0.1, "{} {}", height(&open), height(&solid));
    assert!(sunlight(&open.scene).y < 0.0);
    // And what is hollow but has nothing in it is a thing.
    let mut hollow = one_box([-1.0; 3], [1.0; 3]);
    add_box(&mut hollow, [-0.9; 3], [0.9; 3], true);
    let hollow = completed(hollow, &Setting::default());
    assert!(matches!(hollow.framing, Some(Framing(framing::Kind::Around { .. }))));
}

#[test]
fn things_are_seen_from_the_front_even_if_there_is_more_behind() {
    // Boxes behind a wall: two thirds more than before it.
    let shelf = |front: usize, behind: usize| {
        let mut scene = one_box([-5.0, 0.0, -0.1], [5.0, 9.0, 0.1]);
        for (count, z) in [(front, 1.0), (behind, -1.4)] {
            for i in 0..count {
                let (x, y) = ((i % 10) as f32 - 4.9, 0.9 * (i / 10) as f32);
                add_box(&mut scene, [x, y, z], [x + 0.4, y + 0.4, z + 0.4], false);
            }
        }
        completed(scene, &Setting::default()).scene.cameras[0].world_from_view.matrix3.z_axis.z
    };
    assert!(shelf(30, 50) > 0.0);
    assert!(shelf(0, 50) < 0.0, "where there is nothing before it, it is seen from behind");
}

#[test]
fn a_floor_that_goes_on_and_on_is_not_framed() {
    let mut scene = Scene::default();
    for i in 0..20 {
        let x = i as f32;
        add_box(&mut scene, [x, 0.0, 0.0], [x + 0.5, 2.0, 10.0], false);
    }
    let near = Setting::default();
    let distance = |scene: Scene| {
        let scene = completed(scene, &near).scene;
        scene.cameras[0].world_from_view.translation.length()
    };
    let alone = distance(scene.clone());
    add_box(&mut scene, [-500.0, -0.1, -500.0], [500.0, 0.0, 500.0], false);
    assert!(distance(scene.clone()) < 2.0 * alone);
    add_box(&mut scene, [-500.0, 0.0, -500.0], [-499.0, 300.0, -499.0], false);
    assert!(distance(scene) > 10.0 * alone, "a tower is no floor");
}

#[test]
fn what_is_there_stays() {
    let mut scene = one_box([0.0; 3], [1.0; 3]);
    complete(&mut scene);
    assert_eq!((scene.cameras.len(), scene.lights.len(), scene.notices.len()), (1, 1, 1));
    assert!(scene.sky.is_none() && scene.ambient[0] > 0.0, "what is judged has no sky");
    let before = format!("{scene:?}");
    complete(&mut scene);
    assert_eq!(format!("{scene:?}"), before);
    let mut shown = completed(one_box([0.0; 3], [1.0; 3]), &Setting::default());
    assert!(shown.scene.sky.is_some() && shown.scene.ambient == [0.0; 3] && shown.scene.exposure == Some(0.0));
    let before = format!("{:?}", shown.scene);
    Setting::default().complete(&mut shown);
    assert_eq!(format!("{:?}", shown.scene), before);
    let plain = completed(one_box([0.0; 3], [1.0; 3]), &Setting { sky: false, ..Setting::default() }).scene;
    assert!(plain.sky.is_none() && plain.ambient[0] > 0.0);
}

#[test]
fn a_sun_for_a_scene_with_lights_is_a_notice() {
    let mut lit = one_box([0.0; 3], [1.0; 3]);
    lit.lights.push(point_light(1.0));
    let sun = Some(Sun { azimuth: 0.0, elevation: 45.0 });
    let scene = completed(lit, &Setting { sun, ..Setting::default() }).scene;
    assert!(scene.lights.len() == 1 && scene.notices[0].contains("--sun changes nothing"));
}

#[test]
fn ambient_light_follows_the_lights() {
    let ambient = |intensity: f32| {
        let mut scene = one_box([0.0; 3], [1.0; 3]);
        scene.lights = vec![point_light(intensity)];
        complete(&mut scene);
        scene.ambient[0]
    };
    assert!((ambient(1000.0) / ambient(1.0) - 1000.0).abs() < 1e-2);
    assert!(ambient(1.0) > 0.0);
}

#[test]
fn an_empty_scene_gets_a_camera_too() {
    for setting in [Setting::default(), Setting { ground: GroundChoice::Height(0.5), ..Setting::default() }] {
        let scene = completed(Scene::default(), &setting).scene;
        assert!(scene.cameras[0].world_from_view.is_finite() && scene.lights.len() == 1);
    }
    let mut glass = one_box([0.0; 3], [1.0; 3]);
    let alpha = crate::AlphaMode::Blend;
    glass.materials.push(Material { alpha, ..Material::default() });
    glass.meshes[0].primitives[0].material = Some(0);
    assert!(completed(glass, &Setting::default()).scene.cameras[0].world_from_view.is_finite());
}
