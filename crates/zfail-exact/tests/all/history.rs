//! What a renderer has drawn before does not change what it draws now.

use zfail_exact::kinds::Kind;
use zfail_plan::glam::{DAffine3, DVec3};
use zfail_plan::light::LightKind;
use zfail_plan::view::View;
use zfail_render::{AovKind, Renderer, Settings};
use zfail_scene::{Pose, Scene};

/// Views along a path that ends where the recipe's camera is.
fn path(last: &View, extent: f64) -> Vec<View> {
    let at = |t: f64| {
        let offset = DVec3::new((3.0 * t).sin(), 0.5 * t, (2.0 * t).cos() - 1.0) * extent * 0.2;
        View { world_from_view: DAffine3::from_translation(offset) * last.world_from_view, ..*last }
    };
    [0.6, 0.0].map(at).to_vec()
}

/// The scene's pose with its placed lights elsewhere.
fn moved(scene: &Scene, offset: DVec3) -> Pose {
    let mut pose = Pose::of(scene);
    for light in &mut pose.lights {
        if let LightKind::Point { position, .. } | LightKind::Spot { position, .. } = light {
            *position += offset;
        }
    }
    pose
}

#[test]
fn pictures_and_verdicts_do_not_depend_on_earlier_frames() {
    let Some(gpu) = crate::gpu() else { return };
    let settings = Settings { samples: 4, ..Settings::default() }.repeatable();
    let (mut images, mut changes, mut differing) = (0, 0, Vec::new());
    for kind in Kind::ALL {
        let recipe = kind.recipe(1, [160, 100]);
        let scene = recipe.scene();
        let extent = scene.bounds().half().length();
        let mut last = Vec::new();
        let mut used = Renderer::new(&gpu, &scene).expect("a renderer");
        for (step, view) in path(&recipe.view, extent).iter().enumerate() {
            // Lights go elsewhere and come back.
            for offset in [DVec3::splat(0.1 * extent), DVec3::ZERO] {
                used.set_pose(&moved(&scene, offset)).expect("a pose");
                used.render(view, &settings).expect("a frame");
            }
            let mut fresh = Renderer::new(&gpu, &scene).expect("a renderer");
            let [a, b] = [&mut used, &mut fresh].map(|renderer| {
                let picture = renderer.picture(view, &settings).expect("a picture").0.rgba8;
                (picture, renderer.aovs(view, &settings, &[AovKind::Shadow]).expect("masks").shadow)
            });
            images += 1;
            changes += usize::from(a.0 != last);
            last.clone_from(&a.0);
            let same = zfail_testing::compare(&format!("{kind:?} frame {step}"), view.size, &a.0, &b.0, 0);
            differing.extend(same.err());
            if a.1 != b.1 {
                differing.push(format!("{kind:?}, frame {step}: masks differ"));
            }
        }
    }
    assert!(
        images > 30 && changes > images / 2,
        "the comparison can fail: {changes} of {images} pictures are new ones"
    );
    assert!(differing.is_empty(), "{differing:#?}");
}
