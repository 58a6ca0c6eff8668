//! What the papers claim of their own and of older methods, each on a scene where it shows.
//!
//! Every "0 wrong" has beside it a method that fails on the same scene, and every failure one that does not. Papers: C,
//! E&K and McG as in the crate's head.

use crate::support::{Case, gpu, light, look, plate, point};
use zfail_methods::{FiniteOptions, Method, Options};
use zfail_plan::glam::DVec3;
use zfail_plan::light::LightKind;
use zfail_scene::Scene;

/// Every method that promises to be exact, on a scene on which `failing` is not.
fn exact_where_others_fail(case: &mut Case<'_>, failing: &[Method]) {
    for &method in failing {
        assert!(case.wrong(method) > 50, "{method} was to fail here");
    }
    for method in Method::ALL.into_iter().filter(|method| method.exact()) {
        assert_eq!(case.wrong(method), 0, "{method}");
    }
}

/// E&K 2.2.2: "Heidmann fails to mention in his article a problem that seriously undermines the robustness of his
/// approach"; with the near rectangle in the light, there is no problem.
#[test]
fn z_pass_is_right_unless_the_near_rectangle_is_in_shadow() {
    let Some(gpu) = gpu() else { return };
    let heidmann = [Method::HeidmannTwoPass, Method::HeidmannTwoSided];
    let mut outside = Case::builtin(&gpu, "container", 0);
    assert_eq!(heidmann.map(|method| outside.wrong(method)), [0, 0]);
    let mut inside = Case::builtin(&gpu, "cathedral", 1);
    assert!(heidmann.map(|method| inside.wrong(method)).into_iter().all(|wrong| wrong > 4000));
    exact_where_others_fail(&mut inside, &heidmann);
    // McG section 3 on Moller & Haines: right while all of the rectangle is as deep in shadow as the eye.
    assert_eq!(inside.wrong(Method::EyeCount), 0);
    // C: "That works all the time."
    assert_eq!(inside.wrong(Method::CarmackPreload), 0);
    assert_eq!(inside.wrong(Method::NearCaps), 0);
    assert_eq!(inside.wrong(Method::FiniteZFail), 0);
    assert_eq!(inside.wrong(Method::EverittKilgard), 0);
}

/// McG section 3: "If a shadow volume crosses partway through the viewport, no uniform adjustment of stencil values will
/// give correct results". C: "a non-zero near clip plane will give situations where the plane is not cleanly on one side".
#[test]
fn the_eyes_own_shadow_is_not_that_of_the_near_rectangle() {
    let Some(gpu) = gpu() else { return };
    let mut case = Case::builtin(&gpu, "nested", 0);
    exact_where_others_fail(&mut case, &[Method::HeidmannTwoPass, Method::HeidmannTwoSided, Method::EyeCount]);
    for method in [Method::CarmackPreload, Method::FiniteZFail, Method::NearCaps, Method::EverittKilgard] {
        assert_eq!(case.wrong(method), 0, "{method}");
    }
}

/// McG section 3: "Reversing the count direction only moved the problem to the far clipping plane". C: "making sure that none
/// of the shadow volumes get clipped off by your far clipping plane (which would unbalance the count)".
#[test]
fn a_far_plane_cuts_volumes_open() {
    let Some(gpu) = gpu() else { return };
    let mut case = Case::builtin(&gpu, "cathedral", 0);
    for method in [Method::CarmackPreload, Method::FiniteZFail] {
        let with = |far, extrusion| Options { finite: FiniteOptions { far, extrusion }, ..Options::default() };
        assert_eq!(case.wrong_of(method, 0, &with(None, None)), 0, "{method} behind everything");
        // All of the hall is nearer than 20 m.
        assert!(case.wrong_of(method, 0, &with(Some(20.0), None)) > 2000, "{method} with a near far plane");
        assert!(case.wrong_of(method, 0, &with(None, Some(1.0))) > 1000, "{method} with short volumes");
    }
    exact_where_others_fail(&mut case, &[Method::ShadowMap]);
    assert_eq!(case.wrong(Method::EverittKilgard), 0);
}

/// E&K 2.2.3: "when a light source is arbitrarily close to a single occluder polygon, any finite distance ... may not extend
/// far enough to ensure that objects beyond the occluder are properly shadowed."
#[test]
fn no_finite_distance_is_enough_for_a_light_close_to_its_occluder() {
    let Some(gpu) = gpu() else { return };
    let mut scene = Scene::default();
    plate(&mut scene, DVec3::ZERO, 4.0);
    plate(&mut scene, DVec3::Y, 0.5);
    scene.lights.push(point(DVec3::Y * 1.01));
    let mut case = Case::new(&gpu, &scene, look(DVec3::new(0.0, 2.0, 5.0), DVec3::ZERO, 0.1));
    exact_where_others_fail(&mut case, &[Method::FiniteZFail]);
    assert_eq!(case.wrong(Method::EverittKilgard), 0);
}

/// E&K 2.2.2: "rasterization cracks or double hitting of pixels can create shadowing artifacts. These artifacts appear as
/// exceedingly narrow regions", for want of "bit-exact CPU and GPU floating-point computations".
#[test]
fn caps_on_the_near_plane_crack() {
    let Some(gpu) = gpu() else { return };
    let (near, half) = (0.01, 1000.0);
    let mut scene = Scene::default();
    plate(&mut scene, DVec3::ZERO, 30.0);
    // The edge of a large shadow passes through the near rectangle, beside the eye.
    let eye = DVec3::new(0.0, 2.0, 5.0);
    let direction = DVec3::new(0.3, -1.0, 0.2).normalize();
    let above = eye - direction * (half / -direction.y);
    plate(&mut scene, above - DVec3::X * (half - 0.1 * near), half as f32);
    scene.lights.push(light(LightKind::Directional { direction }));
    let mut case = Case::new(&gpu, &scene, look(eye, DVec3::X, near));
    let (open, cracked) = (case.wrong(Method::HeidmannTwoSided), case.wrong(Method::NearCaps));
    assert!(open > 4000 && (1..open / 20).contains(&cracked), "{open} wrong without caps, {cracked} with");
    exact_where_others_fail(&mut case, &[Method::HeidmannTwoSided, Method::EyeCount]);
    assert_eq!(case.wrong(Method::EverittKilgard), 0);
}

/// C: "inverting the test when the view is inside a shadow volume ... is not a robust solution".
#[test]
fn an_inverted_test_tells_one_volume_from_none() {
    let Some(gpu) = gpu() else { return };
    let mut scene = Scene::default();
    plate(&mut scene, DVec3::ZERO, 6.0);
    plate(&mut scene, DVec3::Y * 3.0, 2.5);
    scene.lights.push(point(DVec3::Y * 5.0));
    let view = look(DVec3::new(0.0, 1.0, 2.0), DVec3::new(0.0, 0.0, -2.0), 0.1);
    let mut one = Case::new(&gpu, &scene, view);
    assert!(one.wrong(Method::HeidmannTwoSided) > 4000);
    assert_eq!(one.wrong(Method::InvertedTest), 0, "the eye is in one volume, and no other is in sight");
    // A second one in sight: its count lights what both darken.
    plate(&mut scene, DVec3::new(0.0, 0.5, -1.5), 0.5);
    let mut two = Case::new(&gpu, &scene, view);
    exact_where_others_fail(&mut two, &[Method::InvertedTest]);
    assert_eq!(two.wrong(Method::EyeCount), 0, "the number in the bit's place");
    exact_where_others_fail(&mut Case::builtin(&gpu, "nested", 0), &[Method::InvertedTest]);
}

/// C, of the preload: "which I would only apply on surfaces that were likely to intersect the view plane".
#[test]
fn volumes_clear_of_the_view_plane_need_no_preload() {
    let Some(gpu) = gpu() else { return };
    for (name, light) in [("cathedral", 0), ("cathedral", 1), ("nested", 0), ("staircase", 0)] {
        let mut case = Case::builtin(&gpu, name, light);
        let of = |case: &mut Case<'_>, method| case.shadow(method, 0, &Options::default()).expect("a mask");
        let (all, near) = (of(&mut case, Method::CarmackPreload), of(&mut case, Method::CarmackPreloadNear));
        assert_eq!(all.mask, near.mask, "{name}");
        assert!(near.figures.fragments < all.figures.fragments, "{name}");
    }
}

/// E&K 4.1: saturation is worse than wrapping, but "a net 2^N increments ... may alias with the unshadowed zero stencil
/// value"; 3.1: 2^N has to be "greater than the maximum shadow depth count".
#[test]
fn eight_bits_are_not_enough_for_256_layers() {
    let Some(gpu) = gpu() else { return };
    let mut thousand = Case::builtin(&gpu, "stacked", 0);
    let (saturating, wrapping) = (thousand.wrong(Method::HeidmannTwoPass), thousand.wrong(Method::HeidmannTwoSided));
    assert!(saturating > 10 * wrapping && wrapping > 0, "{saturating} and {wrapping}");
    // The same from behind, as section 3.3 prints it.
    let (printed, wrapping) = (thousand.wrong(Method::EverittKilgardTwoPass), thousand.wrong(Method::EverittKilgard));
    assert!(printed > 10 * wrapping && wrapping > 0, "{printed} and {wrapping}");
    let mut layers = Case::builtin(&gpu, "stacked", 1);
    exact_where_others_fail(&mut layers, &[Method::HeidmannTwoSided, Method::FiniteZFail, Method::EverittKilgard]);
}

/// E&K 3.1: "The projection matrix must be perspective, not orthographic." Others are not told so.
#[test]
fn orthographic_views_have_no_eye_and_no_infinity() {
    let Some(gpu) = gpu() else { return };
    let mut case = Case::builtin(&gpu, "ortho", 0);
    for method in [Method::EverittKilgard, Method::EyeCount] {
        let error = case.shadow(method, 0, &Options::default()).expect_err("it cannot run");
        assert!(matches!(&error, zfail_methods::Error::Unavailable(u) if u.method == method), "{error}");
    }
    exact_where_others_fail(&mut case, &[Method::ShadowMap]);
    assert_eq!(case.wrong(Method::FiniteZFail), 0);
}

/// Spot lights whose volumes reach the eye, and bodies that bend.
#[test]
fn exact_methods_are_exact_under_spots_and_on_skins() {
    let Some(gpu) = gpu() else { return };
    for (name, light) in [("stage", 0), ("anemone", 1)] {
        exact_where_others_fail(&mut Case::builtin(&gpu, name, light), &[Method::HeidmannTwoSided]);
    }
}
