//! The generated scenes that move, seen by a camera that is made for them.

use glam::{DMat4, DVec3};
use zfail_builtin::SCENES;
use zfail_plan::bounds::Bounds;
use zfail_scene::{Camera, Scene, Setting};

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

#[test]
fn all_of_a_motion_is_in_the_picture() {
    let mut tested = 0;
    for entry in SCENES {
        let mut animated = zfail_builtin::animated(entry.name).expect("it is built in");
        if animated.animations.is_empty() {
            continue;
        }
        animated.scene.cameras.clear();
        animated.scene.lights.clear();
        animated.scene.ambient = [0.0; 3];
        let setting = Setting { aspect: 1.6, animation: Some(0), ..Setting::default() };
        setting.complete(&mut animated);
        let Some(framing) = &animated.framing else { continue };
        // From a place within, all pictures are taken by the same camera, and some of the scene is behind it.
        if framing.camera(1.6).projection == framing.camera(4.0).projection {
            continue;
        }
        let mut scene = animated.scene.clone();
        for moment in 0..37 {
            scene.set_pose(&animated.pose(0, animated.animations[0].duration * f64::from(moment) / 36.0));
            let sides = reached(&animated.scene.cameras[0], 1.6, vertices(&scene));
            assert!(sides.into_iter().all(|side| side < 1.0), "{}: {sides:?}", entry.name);
            if let Some(ground) = animated.scene.ground {
                let lowest = Bounds::of(vertices(&scene)).min.y;
                assert!(ground.height < lowest + 1e-2 * scene.bounds().half().length(), "{}", entry.name);
            }
        }
        tested += 1;
    }
    assert!(tested > 0);
}
