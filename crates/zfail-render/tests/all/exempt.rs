//! Things on which no shadow falls: labels and other annotations (McGuire et al. 2003, section 8).

use crate::support::{add, gpu, light, look, matt, picture, square, wall};
use zfail_plan::glam::{DAffine3, DVec3};
use zfail_plan::light::LightKind;
use zfail_render::{AovKind, Renderer, Settings};
use zfail_scene::{AlphaMode, Material, Scene};

const SIZE: [u32; 2] = [48, 32];

/// A wall under some lights, a card in their way that the eye does not see, and a pane of glass before the wall.
fn scene(lights: usize) -> Scene {
    let mut scene = wall(matt([0.8; 3]));
    add(&mut scene, square(0.4), matt([0.5; 3]), DAffine3::from_translation(DVec3::new(0.3, 0.2, 4.0)));
    let glass = Material { alpha: AlphaMode::Blend, base_color: [0.9, 0.2, 0.1, 0.5], ..matt([1.0; 3]) };
    add(&mut scene, square(0.7), glass, DAffine3::from_translation(DVec3::new(-0.4, 0.0, 0.5)));
    for l in 0..lights {
        let position = DVec3::new(0.1 * l as f64 - 0.2, 0.1, 5.0);
        scene.lights.push(light(LightKind::Point { position, range: f64::INFINITY }, 20.0 / lights as f32));
    }
    scene
}

#[test]
fn no_shadow_falls_on_what_receives_none() {
    let Some(gpu) = gpu() else { return };
    let view = look(DVec3::new(0.0, 0.0, 3.0), DVec3::ZERO, SIZE);
    // One light in the stencil or in bits, a few, and more than shaders unroll.
    for (lights, samples) in [(1, 1), (1, 4), (3, 1), (6, 1)] {
        let received = scene(lights);
        let mut exempt = received.clone();
        exempt.instances.iter_mut().for_each(|instance| instance.receives_shadow = false);
        let settings = Settings { samples, ..Settings::default() };
        let bright = picture(&gpu, &exempt, &view, &Settings { shadows: false, ..settings.clone() });
        assert_eq!(picture(&gpu, &exempt, &view, &settings).hdr, bright.hdr, "{lights} lights");
        assert_ne!(
            picture(&gpu, &received, &view, &settings).hdr,
            bright.hdr,
            "{lights} lights: the card has a shadow"
        );
        // The glass alone: the wall keeps its shadow where the glass is not before it.
        let mut label = received.clone();
        label.instances[2].receives_shadow = false;
        let seen = picture(&gpu, &label, &view, &settings).hdr;
        assert_ne!(seen, bright.hdr, "{lights} lights");
        assert_ne!(seen, picture(&gpu, &received, &view, &settings).hdr, "{lights} lights");

        let masks = |scene: &Scene| {
            let mut renderer = Renderer::new(&gpu, scene).expect("a renderer");
            renderer.aovs(&view, &Settings::default(), &[AovKind::Shadow, AovKind::Stencil]).expect("masks")
        };
        let (free, shadowed) = (masks(&exempt), masks(&received));
        assert!(free.shadow.iter().flatten().all(|&m| m == 255), "{lights} lights");
        assert!(shadowed.shadow.iter().all(|mask| mask.contains(&0)), "{lights} lights");
        assert_eq!(free.stencil, shadowed.stencil, "counts are of volumes");
    }
}
