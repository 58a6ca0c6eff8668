//! Errors that the comparators must catch, and the budget for what they leave out.

use crate::common::{at, cube, floor, look, point_light, scene, sphere};
use std::time::Instant;
use zfail_oracle::{CastTable, Doubt, Oracle, OverBudget, SizeMismatch, Truth};
use zfail_plan::glam::{DAffine3, DVec3};
use zfail_plan::light::LightKind;
use zfail_plan::view::View;
use zfail_scene::Scene;

const SIZE: [u32; 2] = [160, 90];

fn view() -> View {
    look(DVec3::new(2.5, 3.0, 4.0), DVec3::new(0.0, 0.6, 0.0), SIZE)
}

fn room() -> Scene {
    let parts =
        vec![(floor(6.0), DAffine3::IDENTITY), (sphere(0.9, 10), at(0.0, 1.5, 0.0)), (cube(0.5), at(1.4, 0.9, 0.6))];
    scene(parts, point_light(2.0, 4.0, 1.0))
}

fn judge(scene: &Scene) -> Truth {
    Oracle::new(scene).judge(&view(), &scene.lights[0], &CastTable::double(scene))
}

fn wrong(truth: &Truth, other: &Truth) -> (usize, usize) {
    let mask = truth.compare_mask(&other.mask()).unwrap();
    let count = truth.compare_count(&other.counts()).unwrap();
    (mask.wrong.len(), count.wrong.len())
}

#[test]
fn the_truth_is_right_and_within_the_budget() {
    let truth = judge(&room());
    assert_eq!(wrong(&truth, &truth), (0, 0));
    for report in [truth.compare_mask(&truth.mask()).unwrap(), truth.compare_count(&truth.counts()).unwrap()] {
        report.budget().unwrap();
        assert!(report.has_both(0.05), "{} lit, {} shadowed", report.lit, report.shadowed);
        assert!(report.checked > 10_000);
        assert!(report.boundary > 100 && report.max_count >= 2);
    }
}

/// Prints how long a scene of 60 000 triangles takes.
#[test]
#[ignore = "a measurement"]
fn speed() {
    let parts = vec![(floor(6.0), DAffine3::IDENTITY), (sphere(0.9, 122), at(0.0, 1.5, 0.0))];
    let scene = scene(parts, point_light(2.0, 4.0, 1.0));
    let view = View { size: [320, 180], ..view() };
    let start = Instant::now();
    let oracle = Oracle::new(&scene);
    let built = start.elapsed();
    let truth = oracle.judge(&view, &scene.lights[0], &CastTable::double(&scene));
    let report = truth.compare_count(&truth.counts()).unwrap();
    println!("built in {built:?}, all in {:?}; {report:?}", start.elapsed());
    report.budget().unwrap();
}

#[test]
fn changed_scenes_are_caught() {
    let truth = judge(&room());
    // A missing triangle shows wherever its own shadow or what it hid is in view, which holds for most.
    let mut holed = 0;
    for t in 0..room().meshes[1].triangles.len() {
        let mut scene = room();
        scene.meshes[1].triangles[t] = [0; 3];
        let caught = wrong(&truth, &judge(&scene));
        holed += usize::from(caught.0 + caught.1 > 0);
    }
    assert!(holed * 2 > room().meshes[1].triangles.len(), "{holed}");
    let mut scene = room();
    scene.lights[0].kind = point_light(2.02, 4.04, 1.01);
    let caught = wrong(&truth, &judge(&scene)).0;
    assert!(caught > 5, "light moved by 1 %: {caught}");
    let mut scene = room();
    scene.instances[2].casts_shadow = false;
    assert!(wrong(&truth, &judge(&scene)).0 > 100, "caster left out");
    let mut scene = room();
    let LightKind::Point { range, .. } = &mut scene.lights[0].kind else { unreachable!() };
    *range = 5.0;
    assert!(wrong(&truth, &judge(&scene)).0 > 100, "range ignored");
}

#[test]
fn changed_images_are_caught() {
    let truth = judge(&room());
    let mirrored: Vec<u8> = truth.mask().chunks(SIZE[0] as usize).flat_map(|row| row.iter().rev().copied()).collect();
    assert!(truth.compare_mask(&mirrored).unwrap().wrong.len() > 500);
    let upside_down: Vec<u8> = truth.mask().chunks(SIZE[0] as usize).rev().flatten().copied().collect();
    assert!(truth.compare_mask(&upside_down).unwrap().wrong.len() > 500);
    for (i, pixel) in truth.pixels.iter().enumerate().step_by(37) {
        let mut mask = truth.mask();
        mask[i] ^= 255;
        let report = truth.compare_mask(&mask).unwrap();
        assert_eq!(report.wrong.len(), usize::from(pixel.mask_doubt.is_none()));
        if let Some(wrong) = report.wrong.first() {
            assert_eq!((wrong.y * SIZE[0] + wrong.x) as usize, i);
            assert_eq!([wrong.expected, wrong.found], [truth.mask()[i], mask[i]]);
            let picture = truth.diff_image(&mask).unwrap();
            let red_or_green = if mask[i] == 255 { [255, 30, 30] } else { [0, 230, 60] };
            assert_eq!(picture[3 * i..3 * i + 3], red_or_green);
        }
        let mut counts = truth.counts();
        counts[i] = counts[i].wrapping_sub(1);
        let checked = pixel.surface && pixel.count_doubt.is_none();
        assert_eq!(truth.compare_count(&counts).unwrap().wrong.len(), usize::from(checked));
    }
    let mut grey = truth.mask();
    let lit = truth.pixels.iter().position(|p| p.mask() == 255 && p.mask_doubt.is_none()).unwrap();
    grey[lit] = 254;
    assert_eq!(truth.compare_mask(&grey).unwrap().wrong.len(), 1, "neither lit nor dark");
    let mismatch = SizeMismatch { expected: 160 * 90, found: 3 };
    assert_eq!(truth.compare_mask(&[0; 3]), Err(mismatch));
    assert_eq!(truth.compare_count(&[0; 3]), Err(mismatch));
    assert_eq!(truth.diff_image(&[0; 3]), Err(mismatch));
}

#[test]
fn leaving_out_too_much_is_caught() {
    let mut truth = judge(&room());
    // Scattered over the image, away from boundaries.
    for pixel in truth.pixels.iter_mut().filter(|p| p.surface).step_by(23) {
        pixel.mask_doubt = Some(Doubt::Depth);
    }
    let report = truth.compare_mask(&truth.mask()).unwrap();
    assert!(matches!(report.budget(), Err(OverBudget::Share { .. })), "{:?}", report.budget());

    let mut truth = judge(&room());
    for y in 40..43 {
        for x in 60..63 {
            truth.pixels[y * SIZE[0] as usize + x].mask_doubt = Some(Doubt::Boundary);
        }
    }
    assert_eq!(truth.compare_mask(&truth.mask()).unwrap().budget(), Err(OverBudget::Thick { pixels: 1 }));
    let alpha = truth.pixels.iter_mut().filter(|p| p.surface).take(3000);
    alpha.for_each(|p| p.mask_doubt = Some(Doubt::Alpha));
    assert!(
        truth.compare_mask(&truth.mask()).unwrap().excluded_share() < 0.1,
        "alpha-tested surfaces are counted apart"
    );
}

#[test]
fn empty_scenes_and_images() {
    let nothing = scene(Vec::new(), point_light(0.0, 1.0, 0.0));
    let truth = judge(&nothing);
    assert!(truth.pixels.iter().all(|p| !p.surface && p.mask_doubt.is_none()));
    let report = truth.compare_mask(&truth.mask()).unwrap();
    assert_eq!((report.checked, report.background), (0, 160 * 90));
    let truth =
        Oracle::new(&room()).judge(&View { size: [0, 0], ..view() }, &room().lights[0], &CastTable::double(&room()));
    assert!(truth.pixels.is_empty());
}
