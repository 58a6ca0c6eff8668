//! Figures that replace the picture, and what all figures refuse.

use crate::support::{GREY, SIZE, distance, figure, gpu, look, rgba, scene};
use zfail_figures::{Error, Figures, Options, Overlay, ThirdPerson, palette};
use zfail_plan::glam::DVec3;
use zfail_render::wgpu;
use zfail_scene::Pose;
use zfail_testing::assert_alike;

const CUBES: [DVec3; 1] = [DVec3::new(0.0, 1.0, 0.0)];
const LIGHT: DVec3 = DVec3::new(0.7, 4.0, 0.9);

/// The share of pixels that are not paper.
fn covered(figure: &[[u8; 3]]) -> f64 {
    figure.iter().filter(|c| distance(**c, palette::PAPER) > 6).count() as f64 / figure.len() as f64
}

#[test]
fn only_what_the_eye_sees_is_in_the_alternate_view() {
    let Some(gpu) = gpu() else { return };
    let scene = scene(&CUBES, &[LIGHT]);
    let eye = DVec3::new(1.0, 3.5, 6.5);
    for overlay in [Overlay::Alternate, Overlay::ClipSpace, Overlay::Pyramid] {
        let drawn = |target| figure(&gpu, &scene, &look(eye, target), &[overlay], &Options::default(), GREY);
        let (towards, away) = (drawn(DVec3::Y), drawn(DVec3::new(1.0, 9.0, 12.0)));
        assert!(covered(&towards) > 0.12, "{overlay}: {}", covered(&towards));
        assert!(covered(&towards) < 0.95, "{overlay} is on paper: {}", covered(&towards));
        if overlay != Overlay::Pyramid {
            assert!(covered(&away) < 0.5 * covered(&towards), "{overlay}: {}", covered(&away));
        }
    }
}

#[test]
fn another_place_to_look_from_gives_another_figure() {
    let Some(gpu) = gpu() else { return };
    let scene = scene(&CUBES, &[LIGHT]);
    let view = look(DVec3::new(1.0, 3.5, 6.5), DVec3::Y);
    let drawn =
        |from| figure(&gpu, &scene, &view, &[Overlay::Alternate], &Options { from, ..Options::default() }, GREY);
    let differing = |a: &[[u8; 3]], b: &[[u8; 3]]| a.iter().zip(b).filter(|(a, b)| distance(**a, **b) > 8).count();
    let usual = drawn(None);
    let named = drawn(Some(ThirdPerson::default()));
    assert_alike("the usual place", view.size, &rgba(&named), &rgba(&usual), 8);
    let turned = ThirdPerson { yaw: -1.2, ..ThirdPerson::default() };
    assert!(differing(&usual, &drawn(Some(turned))) > usual.len() / 10);
    let odd = ThirdPerson { yaw: f64::NAN, pitch: 90.0, zoom: -1.0 };
    assert_eq!(drawn(Some(odd)).len(), usual.len());
}

#[test]
fn figures_follow_what_moves_and_refuse_what_does_not_fit() {
    let Some(gpu) = gpu() else { return };
    let mut scene = scene(&CUBES, &[LIGHT]);
    let view = look(DVec3::new(1.0, 3.5, 6.5), DVec3::Y);
    let texture = |format, size: [u32; 2]| {
        gpu.device.create_texture(&wgpu::TextureDescriptor {
            label: None,
            size: wgpu::Extent3d { width: size[0], height: size[1], depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format,
            usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
            view_formats: &[],
        })
    };
    let target = texture(wgpu::TextureFormat::Rgba8Unorm, SIZE);
    let mut figures = Figures::new(&gpu, &scene).expect("figures");
    let mut pose = Pose::of(&scene);
    pose.instances[1].translation.x += 0.5;
    figures.set_pose(&pose).expect("a pose");
    let all = Options::default();
    figures.draw(&[Overlay::Alternate], &view, &all, &target).expect("a figure");
    let posed = gpu.read_texture(&target).expect("texels");
    let rest = figure(&gpu, &scene, &view, &[Overlay::Alternate], &all, 0);
    scene.set_pose(&pose);
    let moved = figure(&gpu, &scene, &view, &[Overlay::Alternate], &all, 0);
    let posed: Vec<[u8; 3]> = posed.chunks_exact(4).map(|t| [t[0], t[1], t[2]]).collect();
    assert!(moved == posed && rest != posed);

    let fails = |result: Result<(), Error>, word: &str| {
        let message = result.expect_err("a refusal").to_string();
        assert!(message.contains(word), "{message}");
    };
    let chosen = Options { lights: Some(vec![1]), ..Options::default() };
    fails(figures.draw(&[Overlay::Cases], &view, &chosen, &target), "no light 1");
    let other = texture(wgpu::TextureFormat::Rgba8UnormSrgb, SIZE);
    fails(figures.draw(&[Overlay::Cases], &view, &all, &other), "Rgba8UnormSrgb");
    let other = texture(wgpu::TextureFormat::Rgba8Unorm, [9, 9]);
    fails(figures.draw(&[Overlay::Cases], &view, &all, &other), "size");
    scene.instances[0].mesh = 7;
    fails(figures.set_scene(&scene), "mesh");
    figures.set_lights(&[]);
    for overlay in Overlay::ALL {
        figures.draw(&[overlay], &view, &all, &target).expect("a figure without lights");
    }
}
