//! Overlays against geometry computed here, by other means: each comparison would notice another light's figure.

use crate::support::{GREY, SIZE, boxes, distance, figure, gpu, look, pixel, pixels, ray, scene, seen, through_box};
use zfail_figures::{Options, Overlay, palette};
use zfail_plan::glam::DVec3;
use zfail_plan::light::LightKind;
use zfail_plan::view::View;
use zfail_render::{Gpu, Technique};

const CUBES: [DVec3; 2] = [DVec3::new(0.0, 1.0, 0.0), DVec3::new(-0.2, 2.6, 0.3)];
const LIGHTS: [DVec3; 2] = [DVec3::new(0.7, 5.0, 0.9), DVec3::new(-3.0, 4.0, 1.0)];

fn view() -> View {
    look(DVec3::new(1.0, 3.5, 6.5), DVec3::new(0.0, 1.0, 0.0))
}

fn of_light(light: usize) -> Options {
    Options { lights: Some(vec![light]), technique: Technique::EverittKilgard, ..Options::default() }
}

fn draw(gpu: &Gpu, overlay: Overlay, options: &Options) -> Vec<[u8; 3]> {
    figure(gpu, &scene(&CUBES, &LIGHTS), &view(), &[overlay], options, GREY)
}

/// Boxes between what a pixel shows and a light; the one that it belongs to counts where it faces away.
fn layers(at: [u32; 2], light: DVec3) -> usize {
    let view = view();
    let Some(p) = seen(&CUBES, view.eye(), ray(&view, at)) else { return 0 };
    // From the light, so that a solid counts where its front is crossed before the point.
    let direction = p - light;
    let before =
        |(center, half)| through_box(center, half, light, direction).is_some_and(|[enter, _]| enter < 1.0 - 1e-6);
    boxes(&CUBES).into_iter().filter(|&(center, half)| before((center, half))).count()
}

#[test]
fn the_heat_map_shows_the_layers_between_surface_and_light() {
    let Some(gpu) = gpu() else { return };
    let map = draw(&gpu, Overlay::Stencil, &of_light(0));
    let level = |color: [u8; 3]| {
        let shown =
            |i: usize| palette::COUNTS[i].0.map(|c| (0.82 * f32::from(c) + 0.18 * f32::from(GREY)).round() as u8);
        (0..palette::COUNTS.len()).min_by_key(|&i| distance(shown(i), color)).unwrap_or(0)
    };
    let wrong = |light: usize| {
        let expected = pixels().map(|at| layers(at, LIGHTS[light]));
        expected.zip(&map).filter(|(count, color)| palette::level(*count as i32) != level(**color)).count()
    };
    let all = (SIZE[0] * SIZE[1]) as usize;
    let twice = pixels().filter(|&at| layers(at, LIGHTS[0]) > 1).count();
    assert!(twice > 60, "{twice} pixels lie in two shadows");
    assert!(wrong(0) * 200 < all, "{} of {all} pixels", wrong(0));
    assert!(wrong(1) * 20 > all, "the comparison can fail: {}", wrong(1));
}

/// Faces of the shadow volume of a cube that a ray crosses before `limit`, by marching: the number of changes between
/// inside and outside.
fn crossings(cube: DVec3, light: DVec3, from: DVec3, direction: DVec3, limit: f64) -> usize {
    const STEPS: usize = 4000;
    let inside = |t: f64| {
        let p = from + direction * t;
        through_box(cube, DVec3::splat(0.5), light, p - light).is_some_and(|[enter, _]| (0.0..1.0).contains(&enter))
    };
    let states: Vec<bool> = (0..=STEPS).map(|i| inside(limit * i as f64 / STEPS as f64)).collect();
    states.windows(2).filter(|w| w[0] != w[1]).count() + usize::from(states[STEPS])
}

#[test]
fn volumes_are_as_dense_as_the_layers_in_front_of_the_surface() {
    let Some(gpu) = gpu() else { return };
    let (view, cube) = (view(), [CUBES[0]]);
    let scene = scene(&cube, &LIGHTS);
    let shown = |ground| figure(&gpu, &scene, &view, &[Overlay::Volumes], &of_light(0), ground);
    let (black, white) = (shown(0), shown(255));
    // What is left of the ground says how much lies over it, whatever its colours.
    let left: Vec<f32> = black.iter().zip(&white).map(|(b, w)| (f32::from(w[1]) - f32::from(b[1])) / 255.0).collect();
    let one = 1.0 - palette::PART_OPACITY[0];
    let mean_error = |light: DVec3| {
        let errors = pixels().zip(&left).filter_map(|(at, left)| {
            let direction = ray(&view, at);
            // Floor that the light sees: no cap of the floor's own but one in front, and the cube's sides.
            let p = seen(&cube, view.eye(), direction).filter(|p| p.y.abs() < 1e-9)?;
            let sides =
                crossings(cube[0], light, view.eye(), direction, (p - view.eye()).length() / direction.length());
            let lit = crossings(cube[0], light, p, DVec3::Y * 1e-9, 1.0) == 0;
            let sides = if lit { sides } else { sides - 1 };
            let expected = one.powi(sides as i32) * (1.0 - palette::PART_OPACITY[2]);
            Some((left - expected).abs())
        });
        let errors: Vec<f32> = errors.collect();
        assert!(errors.len() > 3000);
        errors.iter().sum::<f32>() / errors.len() as f32
    };
    let (own, other) = (mean_error(LIGHTS[0]), mean_error(DVec3::new(-5.0, 3.0, 2.0)));
    assert!(own < 0.006, "{own}");
    assert!(other > 0.012, "the comparison can fail: {other}, {own}");
}

#[test]
fn volumes_by_light_have_the_hues_of_their_lights() {
    let Some(gpu) = gpu() else { return };
    let shown = |light| {
        let colors = draw(&gpu, Overlay::VolumesByLight, &of_light(light));
        let changed: Vec<_> = colors.into_iter().filter(|c| distance(*c, [GREY; 3]) > 12).collect();
        assert!(changed.len() > 2000);
        // Towards which of the two hues the change points.
        let towards = |hue: [u8; 3]| {
            let way = |c: &[u8; 3]| {
                (0..3).map(|k| (i32::from(c[k]) - i32::from(GREY)) * (i32::from(hue[k]) - i32::from(GREY))).sum::<i32>()
            };
            changed.iter().filter(|c| way(c) > 0).count() as f64 / changed.len() as f64
        };
        palette::lights(&[[1.0; 3]; 2]).into_iter().map(towards).collect::<Vec<f64>>()
    };
    let (first, second) = (shown(0), shown(1));
    assert!(first[0] > 0.95 && second[1] > 0.95, "{first:?} {second:?}");
    assert!(first[1] < 0.5 && second[0] < 0.5, "hues differ: {first:?} {second:?}");
}

/// The share of points along `edges` beside which the figure differs from its ground.
fn inked(figure: &[[u8; 3]], edges: &[[DVec3; 2]]) -> f64 {
    let (mut hits, mut all) = (0, 0);
    for [a, b] in edges {
        for i in 1..40 {
            let at = pixel(&view(), a.lerp(*b, f64::from(i) / 40.0));
            if at.x >= 1.0 && at.y >= 1.0 && at.x < f64::from(SIZE[0]) - 1.0 && at.y < f64::from(SIZE[1]) - 1.0 {
                all += 1;
                let color = figure[at.y as usize * SIZE[0] as usize + at.x as usize];
                hits += usize::from(distance(color, [GREY; 3]) > 10);
            }
        }
    }
    f64::from(u32::try_from(hits).unwrap_or(0)) / f64::from(all.max(1))
}

/// The edges of a cube between a face that sees the light and one that does not.
fn outline(cube: DVec3, light: DVec3) -> Vec<[DVec3; 2]> {
    let lit = |axis: usize, side: f64| side * (light[axis] - cube[axis]) > 0.5;
    let mut edges = Vec::new();
    for axis in 0..3 {
        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
        for (su, sv) in [(-1.0, -1.0), (-1.0, 1.0), (1.0, -1.0), (1.0, 1.0)] {
            if lit(u, su) != lit(v, sv) {
                let end = |side: f64| {
                    let mut p = cube;
                    (p[axis], p[u], p[v]) = (p[axis] + 0.5 * side, p[u] + 0.5 * su, p[v] + 0.5 * sv);
                    p
                };
                edges.push([end(-1.0), end(1.0)]);
            }
        }
    }
    edges
}

#[test]
fn silhouettes_lie_between_lit_and_dark_faces() {
    let Some(gpu) = gpu() else { return };
    let drawn = draw(&gpu, Overlay::Silhouettes, &of_light(0));
    let edges = |light: DVec3| CUBES.iter().flat_map(|&cube| outline(cube, light)).collect::<Vec<_>>();
    let (own, other) = (edges(LIGHTS[0]), edges(LIGHTS[1]));
    let missing: Vec<_> = other.into_iter().filter(|edge| !own.contains(edge)).collect();
    assert!(own.len() >= 8 && missing.len() >= 3, "{} {}", own.len(), missing.len());
    assert!(inked(&drawn, &own) > 0.97, "{}", inked(&drawn, &own));
    assert!(inked(&drawn, &missing) < 0.55, "the comparison can fail: {}", inked(&drawn, &missing));
    // Nothing but lines.
    let changed = drawn.iter().filter(|c| distance(**c, [GREY; 3]) > 10).count();
    assert!(changed < drawn.len() / 6, "{changed}");
}

#[test]
fn the_wireframe_has_visible_edges_and_leaves_faces_open() {
    let Some(gpu) = gpu() else { return };
    let drawn = draw(&gpu, Overlay::Wireframe, &of_light(0));
    // The upper cube's front and top.
    let corner = |x: f64, y: f64, z: f64| CUBES[1] + DVec3::new(x, y, z) * 0.5;
    let front = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].map(|(x, y)| corner(x, y, 1.0));
    let edges: Vec<_> = (0..4).map(|i| [front[i], front[(i + 1) % 4]]).collect();
    assert!(inked(&drawn, &edges) > 0.97, "{}", inked(&drawn, &edges));
    let inside = [[corner(-0.2, 0.7, 1.0), corner(-0.7, 0.2, 1.0)], [corner(0.2, -0.7, 1.0), corner(0.7, -0.2, 1.0)]];
    let hidden = [[corner(-0.8, -1.0, -1.0), corner(0.8, -1.0, -1.0)]];
    let beside = f64::min(inked(&drawn, &inside), inked(&drawn, &hidden));
    assert!(beside < 0.4, "the comparison can fail: {beside}");
}

#[test]
fn casters_between_eye_and_light_are_in_another_case() {
    let Some(gpu) = gpu() else { return };
    // One cube between the eye and the first light, and one far from every pyramid.
    let cubes = [DVec3::new(0.0, 1.5, 0.0), DVec3::new(2.6, 0.6, -1.0)];
    let view = look(DVec3::new(0.0, 1.6, 5.0), DVec3::new(0.6, 1.2, 0.0));
    let scene = scene(&cubes, &[DVec3::new(-0.1, 1.5, -4.0), DVec3::new(0.0, 6.0, 1.0)]);
    let case_at = |light: usize, cube: DVec3| {
        let options = Options { lights: Some(vec![light]), technique: Technique::Mcguire, from: None };
        let drawn = figure(&gpu, &scene, &view, &[Overlay::Cases], &options, GREY);
        let at = pixel(&view, cube + DVec3::Z * 0.5);
        let color = drawn[at.y as usize * SIZE[0] as usize + at.x as usize];
        let shown = |hue: [u8; 3]| hue.map(|c| (0.62 * f32::from(c) + 0.38 * f32::from(GREY)) as u8);
        (1..=3).find(|case| distance(shown(palette::CASES[case - 1]), color) < 12)
    };
    assert_eq!([case_at(0, cubes[0]), case_at(0, cubes[1])], [Some(3), Some(1)]);
    assert_eq!(case_at(1, cubes[0]), Some(1), "the comparison can fail");
}

/// The first and the last column of the image that a ball covers, by brute force.
fn ball_columns(view: &View, center: DVec3, radius: f64) -> [f64; 2] {
    let around = (0..400).flat_map(|i| (0..200).map(move |j| (f64::from(i) * 0.0157, f64::from(j) * 0.0157)));
    let points = around.map(|(a, b)| center + DVec3::new(a.cos() * b.sin(), b.cos(), a.sin() * b.sin()) * radius);
    points
        .map(|p| pixel(view, p))
        .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], p| [low.min(p.x), high.max(p.x)])
}

#[test]
fn volumes_are_drawn_within_their_scissors() {
    let Some(gpu) = gpu() else { return };
    let (view, center, range) = (view(), DVec3::new(-0.4, 1.4, 0.0), 1.1);
    let mut scene = scene(&CUBES, &LIGHTS[..1]);
    scene.lights[0].kind = LightKind::Point { position: center, range };
    let [left, right] = ball_columns(&view, center, range);
    // Pixels with volumes over them, within the light's reach and outside.
    let covered = |technique| {
        let options = Options { technique, ..of_light(0) };
        let drawn = figure(&gpu, &scene, &view, &[Overlay::Volumes], &options, GREY);
        let changed = pixels().zip(drawn).filter(|(_, color)| distance(*color, [GREY; 3]) > 3);
        let (within, outside): (Vec<_>, Vec<_>) = changed.partition(|([x, _], _)| {
            let x = f64::from(*x) + 0.5;
            left - 2.0 < x && x < right + 2.0
        });
        [within.len(), outside.len()]
    };
    let [within, outside] = covered(Technique::Mcguire);
    assert!(within > 200 && outside == 0, "{within} {outside}");
    let [_, outside] = covered(Technique::EverittKilgard);
    assert!(outside > 100, "the comparison can fail: {outside}");
}

#[test]
fn scissors_enclose_what_a_light_can_reach() {
    let Some(gpu) = gpu() else { return };
    let view = view();
    let (center, range) = (DVec3::new(-0.4, 1.4, 0.0), 1.1);
    let mut scene = scene(&CUBES, &LIGHTS[..1]);
    scene.lights[0].kind = LightKind::Point { position: center, range };
    let options = Options { technique: Technique::Mcguire, ..of_light(0) };
    let drawn = figure(&gpu, &scene, &view, &[Overlay::Scissors], &options, GREY);
    let extent = |radius: f64| ball_columns(&view, center, radius);
    let column = |x: f64| {
        let inked = |x: i32, y: u32| {
            let x = x.clamp(0, SIZE[0] as i32 - 1) as usize;
            distance(drawn[y as usize * SIZE[0] as usize + x], [GREY; 3]) > 20
        };
        (40..60).filter(|&y| (-2..=2).any(|d| inked(x.round() as i32 + d, y))).count()
    };
    let [left, right] = extent(range);
    assert!(column(left) == 20 && column(right) == 20, "{} {}", column(left), column(right));
    let [left, right] = extent(1.5 * range);
    assert!(column(left) < 10 && column(right) < 10, "the comparison can fail: {} {}", column(left), column(right));
}
