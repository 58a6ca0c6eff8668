//! Textures: which texel a surface shows, and what normal maps do to it.

use crate::support::{add, gpu, look, matt, picture, plain, square};
use zfail_plan::glam::{DAffine3, DVec3};
use zfail_render::{AovKind, Renderer};
use zfail_scene::{Filter, Image, Material, Mesh, Scene, Texture, TextureRef, Wrap};

/// A scene with one texture of `rgba` texels in one row, read without interpolation.
fn with_texture(rgba: &[[u8; 4]]) -> Scene {
    let image = Image { name: "row".into(), width: rgba.len() as u32, height: 1, rgba: rgba.concat() };
    let texture = Texture {
        image: 0,
        wrap_u: Wrap::Repeat,
        wrap_v: Wrap::Repeat,
        mag: Filter::Nearest,
        min: Filter::Nearest,
        mipmaps: false,
    };
    Scene { images: vec![image], textures: vec![texture], ..Scene::default() }
}

#[test]
fn a_texture_is_read_through_its_uv_set_and_transform() {
    let Some(gpu) = gpu() else { return };
    const RED: [u8; 4] = [255, 0, 0, 255];
    const GREEN: [u8; 4] = [0, 255, 0, 255];
    let plain_slot = TextureRef::new(0);
    let shifted = TextureRef { uv_from_mesh: [[1.0, 0.0, 0.5], [0.0, 1.0, 0.0]], ..plain_slot };
    let turned = TextureRef { uv_from_mesh: [[0.0, 1.0, 0.0], [-1.0, 0.0, 1.0]], ..plain_slot };
    let second = TextureRef { uv_set: 1, ..plain_slot };
    // The left, right and upper middle of the square; `uv1` mirrors `uv0`.
    for (slot, expected) in [
        (plain_slot, [RED, GREEN]),
        (shifted, [GREEN, RED]),
        (second, [GREEN, RED]),
        // The quarter points lie in the upper half, where v < 1/2.
        (turned, [RED, RED]),
    ] {
        let mut scene = with_texture(&[RED, GREEN]);
        let mut mesh = square(1.0);
        mesh.uv1 = mesh.uv0.iter().map(|[u, v]| [1.0 - u, *v]).collect();
        let material = Material { unlit: true, base_color_texture: Some(slot), ..matt([1.0; 3]) };
        add(&mut scene, mesh, material, DAffine3::IDENTITY);
        let found = picture(&gpu, &scene, &look(DVec3::Z * 2.5, DVec3::ZERO, [64, 64]), &plain());
        let texel = |x: usize, y: usize| found.rgba8[(y * 64 + x) * 4..][..4].to_vec();
        assert_eq!([texel(20, 24), texel(43, 24)], expected, "{slot:?}");
    }
}

/// The shading normal in the middle of a normal-mapped square.
fn bent(gpu: &zfail_render::Gpu, mesh: Mesh, texel: [u8; 3], placement: DAffine3) -> DVec3 {
    let [r, g, b] = texel;
    let mut scene = with_texture(&[[r, g, b, 255]]);
    let material = Material { normal_texture: Some(TextureRef::new(0)), double_sided: true, ..matt([1.0; 3]) };
    add(&mut scene, mesh, material, placement);
    let view = look(DVec3::Z * 2.0, DVec3::ZERO, [33, 33]);
    let out = Renderer::new(gpu, &scene).and_then(|mut r| r.aovs(&view, &plain(), &[AovKind::Normal]));
    DVec3::from_array(out.expect("outputs").normal[16 * 33 + 16].map(f64::from))
}

#[test]
fn normal_maps_bend_normals_with_and_without_tangents() {
    let Some(gpu) = gpu() else { return };
    // Red leads along u, which is +x here, and green against v, which is +y.
    let texel = [218, 191, 218];
    let expected = (DVec3::new(218.0, 191.0, 218.0) / 127.5 - 1.0).normalize();
    let without = square(1.0);
    let mut with = square(1.0);
    with.tangents = vec![[1.0, 0.0, 0.0, 1.0]; 4];
    // Half as wide and mirrored: tangents follow the surface.
    let mirror = DAffine3::from_scale(DVec3::new(-0.5, 1.0, 1.0));
    let mirrored = expected * DVec3::new(-1.0, 1.0, 1.0);
    // The back of a double-sided surface shows the reversed normal.
    let turn = DAffine3::from_rotation_y(std::f64::consts::PI);
    let turned = expected * DVec3::new(1.0, -1.0, 1.0);
    for (placement, expected) in [(DAffine3::IDENTITY, expected), (mirror, mirrored), (turn, turned)] {
        for mesh in [&with, &without] {
            let found = bent(&gpu, mesh.clone(), texel, placement);
            assert!(found.distance(expected) < 2e-3, "{found} is not {expected}");
        }
    }
}
