//! Methods that sample: shadow maps, and rays where the device has them; and what every method reports.

use crate::support::{Case, gpu};
use zfail_methods::{Error, Figures, FiniteOptions, Method, Methods, Options, ShadowMapOptions};
use zfail_render::{Renderer, Settings, Technique};

/// Pixels that are wrongly dark and wrongly lit with a map of `resolution` and biases.
fn map(case: &mut Case<'_>, resolution: u32, bias: f32, slope_bias: f32) -> [usize; 2] {
    let shadow_map = ShadowMapOptions { resolution, bias, slope_bias, ..ShadowMapOptions::default() };
    let options = Options { shadow_map, ..Options::default() };
    let shadow = case.shadow(Method::ShadowMap, 0, &options).expect("a shadow");
    let wrong = case.truths[0].compare_mask(&shadow.mask).expect("a mask of the same size").wrong;
    let dark = wrong.iter().filter(|pixel| pixel.expected == 255).count();
    [dark, wrong.len() - dark]
}

/// C: "the quality just isn't good enough unless you use extremely high resolution shadow maps ..., and you need to tweak
/// the biases and ranges in many scenes."
#[test]
fn shadow_maps_trade_one_fault_for_another() {
    let Some(gpu) = gpu() else { return };
    let mut case = Case::builtin(&gpu, "room", 0);
    let [acne, _] = map(&mut case, 512, 0.0, 0.0);
    let tuned = map(&mut case, 512, 1e-3, 1.0);
    let [dark, detached] = map(&mut case, 512, 0.05, 1.0);
    assert!(acne > 2000, "without a bias surfaces shadow themselves: {acne}");
    assert!(10 * tuned[0] < acne, "a bias hides that: {tuned:?}");
    assert!(
        detached > 2 * tuned[1] && detached > 20 * dark,
        "a large one lifts shadows off casters: {detached}, {dark}"
    );
    let errors = [64, 256, 1024].map(|resolution| map(&mut case, resolution, 1e-3, 1.0).iter().sum::<usize>());
    assert!(errors.is_sorted_by(|a, b| a > b) && errors[2] > 0, "errors fall, and stay: {errors:?}");
    assert_eq!(case.wrong(Method::Zfail), 0);
}

#[test]
fn four_texels_vote() {
    let Some(gpu) = gpu() else { return };
    let mut case = Case::builtin(&gpu, "room", 0);
    let with = |pcf| {
        let shadow_map = ShadowMapOptions { resolution: 256, pcf, ..ShadowMapOptions::default() };
        Options { shadow_map, ..Options::default() }
    };
    let [nearest, voted] = [false, true].map(|pcf| case.shadow(Method::ShadowMap, 0, &with(pcf)).expect("a shadow"));
    assert_ne!(nearest.mask, voted.mask);
}

/// A ray starts a little off a position that is rounded: few pixels show it, and where a device has no ray queries it says so.
#[test]
fn rays_are_nearly_right_where_there_are_any() {
    let Some(gpu) = gpu() else { return };
    let mut case = Case::builtin(&gpu, "nested", 0);
    match case.shadow(Method::RayQuery, 0, &Options::default()) {
        Ok(_) => {
            assert!(case.wrong(Method::RayQuery) < 20);
            assert!(case.wrong(Method::HeidmannTwoSided) > 1000);
            let mut spots = Case::builtin(&gpu, "stage", 0);
            assert!(spots.wrong(Method::RayQuery) < 20);
        }
        Err(Error::Unavailable(reason)) => {
            assert_eq!(case.methods.availability(Method::RayQuery), Err(reason.clone()));
            assert!(reason.to_string().contains("no ray queries"), "{reason}");
        }
        Err(error) => panic!("{error}"),
    }
}

#[test]
fn figures_follow_from_the_methods() {
    let Some(gpu) = gpu() else { return };
    let mut case = Case::builtin(&gpu, "cathedral", 1);
    let mut figures = |method| -> Figures {
        let shadow = case.shadow(method, 0, &Options::default()).expect("a shadow");
        assert_eq!(shadow.mask.len(), 160 * 100);
        assert!(shadow.figures.fragments > 0 && shadow.figures.render_ms > 0.0, "{method}");
        assert_eq!(shadow.figures.vertices, 3 * shadow.figures.triangles, "{method}");
        shadow.figures
    };
    let [one, two] = [Method::HeidmannTwoSided, Method::HeidmannTwoPass].map(&mut figures);
    assert_eq!((two.triangles, two.fragments, two.passes), (2 * one.triangles, one.fragments, one.passes + 1));
    let [everitt, preload, mcguire, ours] =
        [Method::EverittKilgard, Method::CarmackPreload, Method::Mcguire, Method::Zfail].map(&mut figures);
    assert!(one.triangles < everitt.triangles, "z-pass needs no caps");
    assert_eq!(preload.passes, everitt.passes + 1);
    assert!(mcguire.triangles < everitt.triangles && mcguire.fragments <= everitt.fragments);
    assert!(ours.triangles <= mcguire.triangles && ours.fragments <= mcguire.fragments);
}

/// The renderer counts what its pipelines rasterise, the stage here what it draws itself: two programs, one number.
#[test]
fn the_renderer_counts_the_same_fragments() {
    let Some(gpu) = gpu() else { return };
    let scene = zfail_builtin::scene("container").expect("a built-in scene");
    let view = scene.cameras[0].view([160, 100], &scene.bounds());
    let mut methods = Methods::new(&gpu, &scene).expect("methods");
    let mut renderer = Renderer::new(&gpu, &scene).expect("a renderer");
    let mut counted = |settings: &Settings| {
        let mut stats = renderer.render(&view, settings).expect("a frame");
        renderer.count_fragments(&mut stats).expect("counts");
        stats.lights.iter().map(|light| light.fragments.expect("a count")).collect::<Vec<_>>()
    };
    let by = |technique| Settings { technique, ..Settings::default() }.repeatable();
    for (method, technique) in [
        (Method::EverittKilgard, Technique::EverittKilgard),
        (Method::Mcguire, Technique::Mcguire),
        (Method::Zfail, Technique::Auto),
    ] {
        let expected: Vec<u64> = (0..scene.lights.len())
            .map(|light| methods.shadow(method, &view, light, &Options::default()).expect("a mask").figures.fragments)
            .collect();
        assert_eq!(counted(&by(technique)), expected, "{method}");
    }
    assert_ne!(counted(&by(Technique::Auto)), counted(&by(Technique::EverittKilgard)), "the comparison can fail");
    let dark = Settings { shadows: false, ..by(Technique::Auto) };
    assert_eq!(counted(&dark), vec![0; scene.lights.len()]);
}

#[test]
fn what_makes_no_sense_is_refused() {
    let Some(gpu) = gpu() else { return };
    let mut case = Case::builtin(&gpu, "container", 0);
    let shadow_map = |resolution, bias| Options {
        shadow_map: ShadowMapOptions { resolution, bias, ..ShadowMapOptions::default() },
        ..Options::default()
    };
    let finite = |far, extrusion| Options { finite: FiniteOptions { far, extrusion }, ..Options::default() };
    for (method, options) in [
        (Method::ShadowMap, shadow_map(0, 0.0)),
        (Method::ShadowMap, shadow_map(1 << 30, 0.0)),
        (Method::ShadowMap, shadow_map(16, f32::NAN)),
        (Method::FiniteZFail, finite(Some(0.0), None)),
        (Method::FiniteZFail, finite(Some(f64::INFINITY), None)),
        (Method::CarmackPreload, finite(None, Some(-1.0))),
    ] {
        assert!(matches!(case.shadow(method, 0, &options), Err(Error::BadOption { .. })), "{method} {options:?}");
    }
    let none = case.shadow(Method::Zfail, 9, &Options::default()).expect_err("there is one light");
    assert!(none.to_string().contains("no light 9"), "{none}");
}
