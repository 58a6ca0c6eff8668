//! Lights and casters that change while the scene stays on the device.

use crate::support::{add, gpu, light, look, matt, square, sun, wall};
use zfail_plan::glam::{DAffine3, DVec3};
use zfail_plan::light::LightKind;
use zfail_plan::view::View;
use zfail_render::{Gpu, Renderer, Settings};
use zfail_scene::{Filter, Image, Light, LightShape, Scene, Texture, Wrap};
use zfail_testing::assert_alike;

/// Squares before a wall; the last one casts nothing at first, and no other instance has its mesh.
fn scene() -> Scene {
    let mut scene = wall(matt([0.7, 0.7, 0.7]));
    for x in [-1.5, 0.0, 1.5] {
        add(&mut scene, square(0.5), matt([0.9, 0.4, 0.2]), DAffine3::from_translation(DVec3::new(x, 0.0, 1.0)));
    }
    scene.instances[3].casts_shadow = false;
    scene.images.push(Image { name: String::new(), width: 2, height: 1, rgba: vec![255, 0, 0, 255, 0, 255, 255, 255] });
    let (wrap, filter) = (Wrap::Clamp, Filter::Linear);
    scene.textures.push(Texture { image: 0, wrap_u: wrap, wrap_v: wrap, mag: filter, min: filter, mipmaps: true });
    scene.ambient = [0.05; 3];
    scene.lights = vec![sun(DVec3::new(0.4, -0.3, -1.0), 2.0), lamp(DVec3::new(0.5, 1.0, 3.0))];
    scene
}

fn lamp(position: DVec3) -> Light {
    light(LightKind::Point { position, range: f64::INFINITY }, 12.0)
}

fn view() -> View {
    look(DVec3::new(0.3, 0.5, 6.0), DVec3::ZERO, [96, 64])
}

fn fresh(gpu: &Gpu, scene: &Scene, settings: &Settings) -> Vec<u8> {
    let mut renderer = Renderer::new(gpu, scene).expect("a renderer");
    renderer.picture(&view(), settings).expect("a picture").0.rgba8
}

/// Changes a scene.
type Edit = fn(&mut Scene);

#[test]
fn every_edit_gives_the_picture_of_a_scene_that_was_always_so() {
    let Some(gpu) = gpu() else { return };
    let edits: [(&str, Edit); 8] = [
        ("recoloured", |s| s.lights[0].color = [0.2, 0.9, 0.4]),
        ("moved", |s| s.lights[1].kind = lamp(DVec3::new(-1.0, 0.4, 2.0)).kind),
        ("added", |s| s.lights.push(lamp(DVec3::new(2.0, -1.0, 4.0)))),
        ("excluded", |s| s.lights[0].excluded = vec![1]),
        ("shaped", |s| {
            let position = DVec3::new(0.0, 0.2, 4.0);
            let direction = DVec3::NEG_Z;
            s.lights[1].kind = LightKind::Spot { position, direction, range: 9.0, inner: 0.3, outer: 0.5 };
            s.lights[1].shape = LightShape { cookie: Some(0), falloff: vec![0.3, 0.1], ..LightShape::default() };
        }),
        ("removed", |s| drop(s.lights.remove(0))),
        ("cast by one that did not", |s| s.instances[3].casts_shadow = true),
        ("cast by one no longer", |s| s.instances[1].casts_shadow = false),
    ];
    for settings in [Settings::default(), Settings { samples: 4, ..Settings::default() }] {
        let mut scene = scene();
        let mut renderer = Renderer::new(&gpu, &scene).expect("a renderer");
        let mut before = renderer.picture(&view(), &settings).expect("a picture").0.rgba8;
        for (name, edit) in edits {
            edit(&mut scene);
            renderer.set_casting(&scene).expect("it fits");
            renderer.set_lights(&scene).expect("it fits");
            let edited = renderer.picture(&view(), &settings).expect("a picture").0.rgba8;
            assert_alike(name, view().size, &edited, &fresh(&gpu, &scene, &settings), 0);
            assert!(edited != before, "{name}: the comparison can fail");
            before = edited;
        }
    }
}

#[test]
fn what_does_not_fit_is_refused_and_the_old_lights_stay() {
    let Some(gpu) = gpu() else { return };
    let scene = scene();
    let mut renderer = Renderer::new(&gpu, &scene).expect("a renderer");
    let mut other = scene.clone();
    other.instances.pop();
    assert!(renderer.set_lights(&other).is_err() && renderer.set_casting(&other).is_err());
    let mut astray = scene.clone();
    astray.lights[0].excluded = vec![99];
    assert!(renderer.set_lights(&astray).is_err());
    let picture = renderer.picture(&view(), &Settings::default()).expect("a picture").0.rgba8;
    assert_alike("refused", view().size, &picture, &fresh(&gpu, &scene, &Settings::default()), 0);
}
