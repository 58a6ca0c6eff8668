//! Every generated scene is complete and sound, and has what its description promises.

use super::shapes::checks::{unmatched_edges, volume};
use super::{SCENES, scene};
use glam::Vec3;
use zfail_plan::light::LightKind;
use zfail_plan::view::Projection;
use zfail_scene::{AlphaMode, Scene};

fn scenes() -> impl Iterator<Item = Scene> {
    SCENES.iter().map(|entry| scene(entry.name).unwrap_or_else(|| panic!("{} is listed but not made", entry.name)))
}

#[test]
fn scenes_are_sound() {
    for (entry, scene) in SCENES.iter().zip(scenes()) {
        assert_eq!(scene.name, entry.name);
        zfail_scene::check(&scene).unwrap_or_else(|e| panic!("{}: {e}", scene.name));
        for mesh in &scene.meshes {
            let unit = |n: &[f32; 3]| (Vec3::from_array(*n).length() - 1.0).abs() < 1e-5;
            assert!(mesh.normals.iter().all(unit), "{}: normals of {}", scene.name, mesh.name);
            assert!(mesh.primitives.iter().all(|p| p.material.is_some()), "{}: {} is unpainted", scene.name, mesh.name);
        }
    }
}

#[test]
fn bodies_are_closed_outside_the_scenes_for_open_ones() {
    for scene in scenes().filter(|scene| !["open", "stacked", "foliage"].contains(&scene.name.as_str())) {
        for mesh in &scene.meshes {
            assert_eq!(unmatched_edges(mesh), 0, "{}: {} is open", scene.name, mesh.name);
            assert!(volume(mesh) > 0.0, "{}: {} is inside out", scene.name, mesh.name);
        }
    }
    let open = scene("open").expect("a scene");
    assert!(open.meshes.iter().filter(|mesh| unmatched_edges(mesh) > 0).count() >= 5);
}

#[test]
fn scenes_are_complete() {
    for scene in scenes() {
        assert!(!scene.cameras.is_empty() && !scene.lights.is_empty() && !scene.instances.is_empty(), "{}", scene.name);
        assert!(scene.ambient.iter().all(|&x| x > 0.0), "{}", scene.name);
        let bounds = scene.bounds();
        for camera in &scene.cameras {
            let to = bounds.center() - camera.world_from_view.translation;
            assert!(to.dot(-camera.world_from_view.matrix3.z_axis) > 0.0, "{}: {}", scene.name, camera.name);
        }
    }
}

#[test]
fn names_differ() {
    let mut names: Vec<_> = SCENES.iter().map(|entry| entry.name).collect();
    names.sort_unstable();
    names.dedup();
    assert_eq!(names.len(), SCENES.len());
    assert!(scene("").is_none() && scene("Room").is_none());
}

#[test]
fn scenes_are_the_same_on_every_run() {
    for (once, again) in scenes().zip(scenes()) {
        let meshes =
            |scene: &Scene| scene.meshes.iter().map(|m| (m.positions.clone(), m.triangles.clone())).collect::<Vec<_>>();
        let images = |scene: &Scene| scene.images.iter().map(|image| image.rgba.clone()).collect::<Vec<_>>();
        assert!(meshes(&once) == meshes(&again) && images(&once) == images(&again), "{}", once.name);
    }
}

#[test]
fn scenes_hold_the_cases_that_they_are_for() {
    let of = |name: &str| scene(name).unwrap();
    assert_eq!(of("room").lights.len(), 3);
    assert_eq!(of("soft").lights.len(), 12);
    let sun = of("sun");
    let LightKind::Directional { direction } = sun.lights[0].kind else { panic!("no sun") };
    let along = |camera: usize| (-sun.cameras[camera].world_from_view.matrix3.z_axis).dot(direction);
    assert!(along(0) > 0.5 && along(1) < -0.5);
    assert_eq!(of("cathedral").instances.iter().filter(|i| i.name.starts_with("cube ")).count(), 64);
    let triangles: Vec<usize> = of("stacked").meshes.iter().map(|m| m.triangles.len()).collect();
    assert!(triangles.contains(&2000) && triangles.contains(&512));
    assert!(matches!(of("ortho").cameras[0].projection, Projection::Orthographic { .. }));
    assert!(of("stage").lights.iter().all(|l| matches!(l.kind, LightKind::Spot { .. })));
    let lantern = of("lantern").lights;
    assert!(lantern[0].shape.cookie.is_some() && lantern[1].shape.half_extents.is_some());
    assert!(lantern.iter().all(|light| !light.shape.falloff.is_empty()));
    let foliage = of("foliage");
    let masked = foliage.materials.iter().filter(|m| matches!(m.alpha, AlphaMode::Mask(_))).count();
    assert!(masked == 2 && foliage.images.iter().any(|image| image.rgba.chunks(4).any(|texel| texel[3] == 0)));
    let mirrored = of("open").instances.iter().filter(|i| i.world_from_object.matrix3.determinant() < 0.0).count();
    assert_eq!(mirrored, 1);
}
