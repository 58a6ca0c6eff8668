//! Where alpha is a product, triangles are cut where it says, and agree on their edges.

use super::field::AlphaField;
use super::product;
use super::tests::{area, image, noise, on_plane, open_edges, square, texture};
use super::triangle::{Corner, Cut, UNIT, Weights};
use super::{Limits, cut_masked};
use crate::{Filter, Scene, Wrap};
use glam::DVec2;
use zfail_testing::Random;

/// A square with the alpha of its four corners.
fn shaded(mut scene: Scene, alphas: [f32; 4]) -> Scene {
    let mesh = &mut scene.meshes[0];
    let corner = |[x, y, _]: [f32; 3]| [[0, 3], [1, 2]][usize::from(x > 0.5)][usize::from(y > 0.5)];
    mesh.colors = mesh.positions.iter().map(|&p| [1.0, 1.0, 1.0, alphas[corner(p)]]).collect();
    scene
}

fn white(size: [u32; 2]) -> crate::Image {
    image(size, |_, _| 255.0)
}

#[test]
fn the_alpha_of_vertices_cuts_along_straight_lines() {
    let cut_area = |alphas: [f32; 4], textured: bool| {
        let mut scene = shaded(square(white([8, 8]), 1.0, false), alphas);
        if !textured {
            scene.materials[0].base_color_texture = None;
        }
        assert_eq!(cut_masked(&mut scene, 1.0, Limits::default()).len(), 1);
        assert!(scene.notices.is_empty(), "{:?}", scene.notices);
        (area(&scene.meshes[0]), scene.meshes[0].triangles.len())
    };
    for textured in [false, true] {
        let (half, triangles) = cut_area([1.0, 1.0, 0.0, 0.0], textured);
        assert!((half - 0.5).abs() < 1e-6 && triangles <= 4, "{half}, {triangles} triangles");
        let (most, _) = cut_area([1.0, 1.0, 0.25, 0.25], textured);
        assert!((most - 2.0 / 3.0).abs() < 1e-6, "{most}");
        let (corner, triangles) = cut_area([1.0, 0.0, 0.0, 0.0], textured);
        assert!((corner - 0.25).abs() < 1e-6 && triangles <= 2, "{corner}, {triangles} triangles");
        assert_eq!(cut_area([0.25, 0.4, 0.3, 0.2], textured), (0.0, 0));
        assert_eq!(cut_area([0.75, 0.9, 0.6, 1.0], textured), (1.0, 2));
    }
}

/// How many of some points in random triangles a cut keeps or leaves out wrongly if alpha is taken to be `turned` around by
/// so many corners; points near the contour do not count. Also how many were checked.
fn misjudged(field: &AlphaField<'_>, turned: usize, random: &mut Random) -> [usize; 2] {
    const LEVEL: f64 = 90.3;
    let mut counts = [0; 2];
    for _ in 0..40 {
        let corner = |random: &mut Random| DVec2::new(random.unit(), random.unit()) * 12.0 - 4.0;
        let mut texels = [corner(random), corner(random), corner(random)];
        if random.unit() < 0.3 {
            // Through nodes and along the borders of cells.
            texels = texels.map(|p| (2.0 * p).round() / 2.0);
        }
        let alphas = [random.unit(), random.unit(), random.unit()].map(|x| 1.2 * x);
        let positions = [0, 1, 2].map(|k| [random.unit() as f32, k as f32, 0.0]);
        let corners = std::array::from_fn(|k| Corner { position: positions[k], texel: texels[k] });
        let taken = std::array::from_fn(|k| alphas[(k + turned) % 3]);
        let pieces = match product::cut(Some(field), LEVEL, 1.0 / 64.0, corners, taken, 100_000).unwrap() {
            Cut::Whole => vec![[[UNIT, 0, 0], [0, UNIT, 0], [0, 0, UNIT]]],
            Cut::Nothing => Vec::new(),
            Cut::Pieces(pieces) => pieces,
        };
        let turns = |[a, b, c]: [Weights; 3]| {
            let [a, b, c] = [a, b, c].map(|[_, x, y]| [i64::from(x), i64::from(y)]);
            (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
        };
        assert!(pieces.iter().all(|&piece| turns(piece) > 0), "a piece is turned over");
        let pieces = on_plane(&pieces, texels);
        for _ in 0..100 {
            let (mut u, mut v) = (random.unit(), random.unit());
            if u + v > 1.0 {
                (u, v) = (1.0 - u, 1.0 - v);
            }
            let value = |u: f64, v: f64| {
                let alpha = alphas[0] + (alphas[1] - alphas[0]) * u + (alphas[2] - alphas[0]) * v;
                field.at(texels[0] + (texels[1] - texels[0]) * u + (texels[2] - texels[0]) * v) * alpha - LEVEL
            };
            let point = texels[0] + (texels[1] - texels[0]) * u + (texels[2] - texels[0]) * v;
            let there = value(u, v) >= 0.0;
            let [right, up] = [texels[1] - texels[0], texels[2] - texels[0]];
            let twice = right.perp_dot(up);
            let is_near = |k: u32| {
                let away = DVec2::from_angle(f64::from(k) * std::f64::consts::FRAC_PI_8) * 0.05;
                (value(u + away.perp_dot(up) / twice, v + right.perp_dot(away) / twice) >= 0.0) != there
            };
            if twice.abs() < 0.1 || (0..16).any(is_near) {
                continue;
            }
            let inside = |[a, b, c]: &[DVec2; 3]| {
                let side = |p: DVec2, q: DVec2| (q - p).perp_dot(point - p);
                let sides = [side(*a, *b), side(*b, *c), side(*c, *a)];
                sides.iter().all(|&s| s >= 0.0) || sides.iter().all(|&s| s <= 0.0)
            };
            counts[0] += usize::from(pieces.iter().any(inside) != there);
            counts[1] += 1;
        }
    }
    counts
}

#[test]
fn products_are_cut_where_they_say() {
    let mut random = Random(21);
    for wrap in [Wrap::Repeat, Wrap::Mirror, Wrap::Clamp] {
        let image = noise([7, 5], &mut random);
        let field = AlphaField::new(&image, &texture([wrap; 2], Filter::Linear), 0);
        let [wrong, checked] = misjudged(&field, 0, &mut random);
        assert!(wrong == 0 && checked > 1500, "{wrap:?}: {wrong} of {checked}");
        let [wrong, checked] = misjudged(&field, 1, &mut random);
        assert!(wrong * 20 > checked, "{wrap:?}: other corners are caught: {wrong} of {checked}");
    }
}

#[test]
fn triangles_that_were_joined_stay_joined_under_products() {
    let on_diagonal = |p: DVec2| (p.x - p.y).abs() < 1e-6;
    let mut random = Random(22);
    for seam in [false, true] {
        for textured in [false, true] {
            let mut scene = shaded(square(noise([16, 16], &mut random), 1.5, seam), [0.9, 0.3, 1.0, 0.7]);
            if !textured {
                scene.meshes[0].colors.iter_mut().for_each(|color| color[3] = 1.2 * (color[3] - 0.35));
                scene.materials[0].base_color_texture = None;
            }
            cut_masked(&mut scene, 0.5, Limits::default());
            let mesh = &scene.meshes[0];
            assert!(mesh.triangles.len() > if textured { 100 } else { 2 });
            let cracks: Vec<_> =
                open_edges(mesh).into_iter().filter(|ends| ends.iter().all(|&p| on_diagonal(p))).collect();
            assert!(cracks.is_empty(), "seam {seam}, textured {textured}: {cracks:?}");
        }
    }
}

#[test]
fn products_with_detail_without_end_are_thinned_out() {
    let mut random = Random(23);
    let limits = Limits { triangles: 20_000, ..Limits::default() };
    let mut scene = shaded(square(noise([300, 300], &mut random), 1.0, false), [1.0, 0.8, 0.9, 0.7]);
    let cuts = cut_masked(&mut scene, 1.0, limits);
    assert!(cuts[0].tolerance > 2.0 && scene.notices.len() == 1, "{:?}", scene.notices);
    assert!(scene.meshes[0].triangles.len() <= 10_128);
}
