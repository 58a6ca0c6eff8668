//! Light from the sky, against integrals of the same sky in f64.

use crate::support::{add, at, gpu, look, matt, picture, plain, square};
use zfail_plan::glam::{DAffine3, DMat3, DVec3, Vec3};
use zfail_plan::view::Projection;
use zfail_render::{Gpu, Settings};
use zfail_scene::{Clearcoat, Material, Scene, Sheen, Sky, Specular, Transmission};

const SIZE: [u32; 2] = [33, 33];
const PI: f64 = std::f64::consts::PI;

/// Each colour in a channel of its own.
const SKY: Sky = Sky { zenith: [1.0, 0.0, 0.0], horizon: [0.0, 1.0, 0.0], nadir: [0.0, 0.0, 1.0] };
const WHITE: Sky = Sky { zenith: [1.0; 3], horizon: [1.0; 3], nadir: [1.0; 3] };

/// Radiance from a direction of height `y`, its horizon as sharp as can be.
fn radiance(y: f64) -> DVec3 {
    if y < 0.0 { DVec3::Z } else { DVec3::new(y, 1.0 - y, 0.0) }
}

/// Directions over a hemisphere about z, by the cosine.
fn hemisphere() -> impl Iterator<Item = DVec3> {
    const N: u32 = 96;
    (0..N * N).map(|i| {
        let [u, v] = [i / N, i % N].map(|k| (f64::from(k) + 0.5) / f64::from(N));
        let (sin, cos) = (2.0 * PI * v).sin_cos();
        DVec3::new(u.sqrt() * cos, u.sqrt() * sin, (1.0 - u).sqrt())
    })
}

/// A square that faces `normal`, seen from `eye` before a black background, under `sky` alone.
fn shown(gpu: &Gpu, sky: Sky, material: Material, normal: DVec3, eye: DVec3) -> DVec3 {
    let mut scene = Scene { sky: Some(sky), ..Scene::default() };
    let right = normal.any_orthonormal_vector();
    let turn = DMat3::from_cols(right, normal.cross(right), normal);
    add(&mut scene, square(9.0), material, DAffine3::from_mat3(turn));
    let found = at(&picture(gpu, &scene, &look(eye * 3.0, DVec3::ZERO, SIZE), &plain()), 16, 16);
    Vec3::from(found).as_dvec3()
}

/// Scatters, and mirrors nothing.
fn dull(color: [f32; 3]) -> Material {
    Material { specular: Specular { strength: 0.0, ..Specular::default() }, ..matt(color) }
}

fn metal(roughness: f32) -> Material {
    Material { metallic: 1.0, roughness, ..matt([1.0; 3]) }
}

#[test]
fn dull_surfaces_scatter_the_irradiance_of_their_side() {
    let Some(gpu) = gpu() else { return };
    for pitch in [-1.5, -0.9, -0.3, 0.0, 0.4, 1.0, 1.57] {
        let normal = DMat3::from_rotation_y(0.3) * DVec3::new(0.0, f64::sin(pitch), f64::cos(pitch));
        let right = normal.any_orthonormal_vector();
        let world = DMat3::from_cols(right, normal.cross(right), normal);
        let count = hemisphere().count() as f64;
        let expected = hemisphere().map(|l| radiance((world * l).y)).sum::<DVec3>() / count;
        let found = shown(&gpu, SKY, dull([1.0; 3]), normal, normal);
        assert!(found.abs_diff_eq(expected, 0.01), "{pitch}: {found} is not {expected}");
        assert!(!found.abs_diff_eq(expected + DVec3::X * 0.02, 0.01), "the comparison can fail");
    }
    let half = shown(&gpu, SKY, dull([0.5; 3]), DVec3::Y, DVec3::Y);
    assert!(half.abs_diff_eq(DVec3::new(1.0 / 3.0, 1.0 / 6.0, 0.0), 0.01), "{half}");
}

#[test]
fn nothing_is_lost_or_won_under_a_white_sky() {
    let Some(gpu) = gpu() else { return };
    let eyes = [DVec3::Z, DVec3::new(0.9, 0.0, 0.5).normalize(), DVec3::new(0.0, 1.0, 0.2).normalize()];
    for eye in eyes {
        for roughness in [0.0, 0.1, 0.3, 0.5, 0.8, 1.0] {
            for metallic in [0.0, 1.0] {
                let found = shown(&gpu, WHITE, Material { metallic, ..metal(roughness) }, DVec3::Z, eye);
                assert!(found.abs_diff_eq(DVec3::ONE, 4e-3), "{metallic}, {roughness}, {eye}: {found}");
            }
        }
    }
    let dark = shown(&gpu, WHITE, Material { metallic: 0.0, ..metal(0.3) }, DVec3::Z, eyes[0]);
    let black = shown(&gpu, WHITE, Material { base_color: [0.0, 0.0, 0.0, 1.0], ..matt([0.0; 3]) }, DVec3::Z, eyes[0]);
    assert!(dark.x > 20.0 * black.x, "the comparison can fail: {dark} {black}");
}

#[test]
fn metals_mirror_the_sky_as_microfacets_blur_it() {
    let Some(gpu) = gpu() else { return };
    let mut worst = 0.0_f64;
    for roughness in [0.0, 0.2, 0.4, 0.6, 0.8, 1.0] {
        for (pitch, turn) in [(-0.8, 0.3), (-0.2, 0.6), (0.1, 0.2), (0.3, 0.7), (0.7, 0.5), (1.3, 0.4)] {
            let normal = DVec3::new(0.0, f64::sin(pitch), f64::cos(pitch));
            let eye = DMat3::from_rotation_x(-turn) * normal;
            let found = shown(&gpu, SKY, metal(roughness as f32), normal, eye);
            let expected = if roughness == 0.0 {
                let mirrored = normal * (2.0 * normal.dot(eye)) - eye;
                radiance(mirrored.y)
            } else {
                let right = normal.any_orthonormal_vector();
                let world = DMat3::from_cols(right, normal.cross(right), normal);
                let (mut sum, mut weights) = (DVec3::ZERO, 0.0);
                for l in hemisphere().map(|l| world * l) {
                    let h = (l + eye).normalize();
                    let (n_l, n_v, n_h) = (normal.dot(l), normal.dot(eye), normal.dot(h));
                    let a2 = f64::powi(roughness, 4);
                    let root = |c: f64| (a2 + (1.0 - a2) * c * c).sqrt();
                    let d = a2 / (n_h * n_h * (a2 - 1.0) + 1.0).powi(2);
                    let weight = d / (n_l * root(n_v) + n_v * root(n_l));
                    sum += radiance(l.y) * weight;
                    weights += weight;
                }
                sum / weights
            };
            let difference = (found - expected).abs().max_element();
            worst = worst.max(difference);
            assert!(difference < 0.17, "roughness {roughness}, {pitch}, {turn}: {found} is not {expected}");
        }
    }
    println!("at most {worst:.3} off");
    let [smooth, rough] =
        [0.0, 0.6].map(|r| shown(&gpu, SKY, metal(r), DVec3::Z, DVec3::new(0.0, 0.3, 1.0).normalize()));
    assert!((smooth - rough).abs().max_element() > 0.3, "the comparison can fail: {smooth} {rough}");
}

#[test]
fn layers_occlusion_and_unlit_surfaces_see_the_sky_as_they_see_ambient_light() {
    let Some(gpu) = gpu() else { return };
    let under = |material| shown(&gpu, WHITE, material, DVec3::Z, DVec3::Z);
    let black = Material { specular: Specular { strength: 0.0, ..Specular::default() }, ..matt([0.0; 3]) };
    let coat = |strength| Some(Clearcoat { strength, texture: None, roughness: 0.0 });
    let coated = under(Material { clearcoat: coat(1.0), ..black.clone() });
    assert!(coated.abs_diff_eq(DVec3::splat(0.04), 2e-3), "{coated}");
    let half = under(Material { clearcoat: coat(0.5), ..dull([1.0; 3]) });
    assert!(half.abs_diff_eq(DVec3::ONE, 4e-3), "{half}");
    let sheen = Some(Sheen { color: [1.0; 3], texture: None, roughness: 0.5 });
    let fibres = hemisphere().map(|l| {
        let h = (l + DVec3::Z).normalize();
        let distribution = 6.0 * (1.0 - h.z * h.z).powi(2) / (2.0 * PI);
        PI * distribution / (4.0 * (l.z + 1.0 - l.z))
    });
    let expected = fibres.sum::<f64>() / hemisphere().count() as f64;
    let cloth = under(Material { sheen, ..black.clone() });
    assert!(cloth.abs_diff_eq(DVec3::splat(expected), 0.03), "{cloth} is not {expected}");
    // What passes does not scatter, and nothing is behind but the sky.
    let clear = Some(Transmission { share: 1.0, texture: None, tint: [1.0; 3] });
    let glass = under(Material { transmission: clear, roughness: 0.0, ..matt([1.0; 3]) });
    assert!(glass.abs_diff_eq(DVec3::ONE, 4e-3), "{glass}");
    let unlit = under(Material { unlit: true, ..matt([0.25; 3]) });
    assert!(unlit.abs_diff_eq(DVec3::splat(0.25), 2e-3), "{unlit}");
}

#[test]
fn the_sky_is_seen_where_nothing_else_is_and_stays_with_the_world() {
    let Some(gpu) = gpu() else { return };
    let scene = Scene { sky: Some(SKY), background: [9.0; 3], ..Scene::default() };
    for samples in [1, 4] {
        let settings = Settings { samples, ..plain() };
        let view = look(DVec3::ZERO, DVec3::new(0.0, 0.2, 1.0), SIZE);
        let upright = picture(&gpu, &scene, &view, &settings);
        let column: Vec<[f32; 3]> = (0..33).map(|y| at(&upright, 16, y)).collect();
        assert!(column.is_sorted_by(|a, b| a[0] > b[0] && a[2] < b[2]), "{column:?}");
        // The background has no say.
        assert!(column.iter().flatten().all(|&c| (0.0..=1.0).contains(&c)));
        let mut rolled = view;
        rolled.world_from_view.matrix3 *= DMat3::from_rotation_z(PI);
        let rolled = picture(&gpu, &scene, &rolled, &settings);
        for (y, color) in column.iter().enumerate() {
            let turned = at(&rolled, 16, 32 - y as u32);
            assert!(color.iter().zip(turned).all(|(a, b)| (a - b).abs() < 2e-3), "{color:?} {turned:?}");
        }
    }
    let mut parallel = look(DVec3::ZERO, DVec3::new(0.0, -0.5, 1.0), SIZE);
    parallel.projection = Projection::Orthographic { ymag: 1.0, near: 0.1, far: 9.0 };
    let flat = picture(&gpu, &scene, &parallel, &plain());
    assert!(flat.hdr.iter().all(|&p| p == flat.hdr[0]) && flat.hdr[0][2] > 0.5, "{:?}", flat.hdr[0]);
}
