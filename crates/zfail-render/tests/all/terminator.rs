//! Where smooth surfaces turn away from the light.

use crate::support::{add, gpu, light, look, matt, plain, sun};
use zfail_plan::glam::{DAffine3, DVec3};
use zfail_plan::light::LightKind;
use zfail_render::{AovKind, Aovs, Gpu, Picture, Renderer, Settings, Terminator};
use zfail_scene::{Light, Mesh, Primitive, Scene};

const SIZE: [u32; 2] = [320, 240];

/// A unit sphere of `2 n` meridians and `n` bands, its normals the sphere's or each facet's own.
fn sphere(n: u32, smooth: bool) -> Mesh {
    let point = |i: u32, j: u32| {
        let (u, v) =
            (std::f32::consts::PI * (i % (2 * n)) as f32 / n as f32, std::f32::consts::PI * j as f32 / n as f32);
        [v.sin() * u.cos(), v.cos(), -v.sin() * u.sin()]
    };
    let mut positions = Vec::new();
    for i in 0..2 * n {
        for j in 0..n {
            let [a, b, c, d] = [point(i, j), point(i, j + 1), point(i + 1, j + 1), point(i + 1, j)];
            positions.extend([a, b, c, a, c, d]);
        }
    }
    let normals = if smooth { positions.clone() } else { Vec::new() };
    let count = positions.len() as u32 / 3;
    Mesh {
        positions,
        normals,
        triangles: (0..count).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect(),
        primitives: vec![Primitive { triangles: 0..count, material: None }],
        ..Mesh::default()
    }
}

fn rendered(gpu: &Gpu, mesh: Mesh, light: Light, terminator: Terminator) -> (Picture, Aovs) {
    let mut scene = Scene::default();
    add(&mut scene, mesh, matt([1.0; 3]), DAffine3::IDENTITY);
    scene.lights.push(light);
    let view = look(DVec3::new(0.0, 0.0, 2.4), DVec3::ZERO, SIZE);
    let settings = Settings { terminator, ..plain() };
    let mut renderer = Renderer::new(gpu, &scene).expect("a renderer");
    let picture = renderer.picture(&view, &settings).expect("a picture").0;
    (picture, renderer.aovs(&view, &settings, &[AovKind::Shadow, AovKind::Depth]).expect("outputs"))
}

fn brightest(picture: &Picture) -> f32 {
    picture.hdr.iter().map(|p| p[0]).fold(0.0, f32::max)
}

/// The greatest radiance of a lit pixel beside one in shadow, as a share of the picture's, and the number of such pixels.
fn border((picture, out): &(Picture, Aovs)) -> (f32, usize) {
    let width = SIZE[0] as usize;
    let (mut greatest, mut count) = (0.0_f32, 0);
    for pixel in width..out.depth.len() - width {
        let shadowed = |p: usize| out.depth[p] > 0.0 && out.shadow[0][p] == 0;
        let beside = [pixel - 1, pixel + 1, pixel - width, pixel + width];
        if out.shadow[0][pixel] == 255 && beside.into_iter().any(shadowed) {
            greatest = greatest.max(picture.hdr[pixel][0] / brightest(picture));
            count += 1;
        }
    }
    (greatest, count)
}

#[test]
fn no_lit_pixel_borders_on_its_own_shadow() {
    let Some(gpu) = gpu() else { return };
    let lamp = light(LightKind::Point { position: DVec3::new(1.2, 1.1, 0.4), range: f64::INFINITY }, 10.0);
    for light in [sun(DVec3::new(-1.0, -0.4, 0.1), 3.0), sun(DVec3::new(0.3, -1.0, 0.2), 3.0), lamp] {
        let [soft, exact] =
            [Terminator::Soft, Terminator::Exact].map(|t| rendered(&gpu, sphere(6, true), light.clone(), t));
        let (step, pixels) = border(&soft);
        assert!(pixels > 50 && step < 0.03, "{:?}: {step} at one of {pixels} pixels", light.kind);
        assert!(border(&exact).0 > 0.06, "the comparison can fail: {}", border(&exact).0);
        for (soft, exact) in soft.1.shadow.iter().zip(&exact.1.shadow) {
            zfail_testing::assert_alike("shadows of both", SIZE, soft, exact, 0);
        }
        assert!(brightest(&soft.0) > 0.98 * brightest(&exact.0));
    }
}

#[test]
fn flat_and_fine_meshes_stay_as_they_are() {
    let Some(gpu) = gpu() else { return };
    let light = sun(DVec3::new(-1.0, -0.4, 0.1), 3.0);
    for (mesh, same) in [(sphere(8, false), true), (sphere(160, true), true), (sphere(8, true), false)] {
        let [soft, exact] =
            [Terminator::Soft, Terminator::Exact].map(|t| rendered(&gpu, mesh.clone(), light.clone(), t).0);
        assert_eq!(soft == exact, same, "{} triangles", mesh.triangles.len());
    }
    let [soft, exact] =
        [Terminator::Soft, Terminator::Exact].map(|t| rendered(&gpu, sphere(32, true), light.clone(), t).0);
    let darker = soft.hdr.iter().zip(&exact.hdr).map(|(s, e)| e[0] - s[0]).fold(0.0, f32::max);
    assert!(darker > 0.0 && darker < 0.1 * brightest(&exact), "{darker} of {}", brightest(&exact));
}
