//! A scene of a floor and cubes, rays through it that know nothing of shadow volumes, and figures of it as pixels.

use zfail_figures::{Figures, Options, Overlay};
use zfail_plan::glam::{DAffine3, DMat3, DVec2, DVec3};
use zfail_plan::light::LightKind;
use zfail_plan::view::{Projection, View};
use zfail_render::{Gpu, GpuOptions, wgpu};
use zfail_scene::{Instance, Light, LightShape, Mesh, Scene};

/// Legends and labels have no room here.
pub const SIZE: [u32; 2] = [128, 96];
/// What the figures are drawn over.
pub const GREY: u8 = 90;

/// A device, or `None` if the test is to be skipped.
pub fn gpu() -> Option<Gpu> {
    zfail_testing::gpu(Gpu::new(&GpuOptions::default()))
}

fn block(half: [f32; 3]) -> Mesh {
    let corner = |i: usize| [0, 1, 2].map(|k| if i >> k & 1 == 0 { -half[k] } else { half[k] });
    let quads = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
    Mesh {
        positions: (0..8).map(corner).collect(),
        triangles: quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect(),
        ..Mesh::default()
    }
}

/// A thick floor, cubes of 1 m at `cubes`, and point lights.
pub fn scene(cubes: &[DVec3], lights: &[DVec3]) -> Scene {
    let instance = |mesh: usize, at: DVec3| Instance {
        name: String::new(),
        mesh,
        world_from_object: DAffine3::from_translation(at),
        casts_shadow: true,
        receives_shadow: true,
    };
    let light = |&position: &DVec3| Light {
        name: String::new(),
        kind: LightKind::Point { position, range: f64::INFINITY },
        color: [1.0; 3],
        intensity: 1.0,
        excluded: Vec::new(),
        shape: LightShape::default(),
    };
    let floor = instance(0, DVec3::NEG_Y * 0.1);
    Scene {
        meshes: vec![block([6.0, 0.1, 6.0]), block([0.5; 3])],
        instances: [floor].into_iter().chain(cubes.iter().map(|&at| instance(1, at))).collect(),
        lights: lights.iter().map(light).collect(),
        ..Scene::default()
    }
}

/// A view of [`SIZE`] from `eye` towards `target`.
pub fn look(eye: DVec3, target: DVec3) -> View {
    let back = (eye - target).normalize();
    let right = DVec3::Y.cross(back).normalize();
    View::new(
        DAffine3 { matrix3: DMat3::from_cols(right, back.cross(right), back), translation: eye },
        Projection::Perspective { yfov: 0.9, near: 0.1, far: None },
        SIZE,
    )
}

/// The direction of the ray through the centre of a pixel, one unit deep.
pub fn ray(view: &View, [x, y]: [u32; 2]) -> DVec3 {
    let Projection::Perspective { yfov, .. } = view.projection else { panic!("a perspective view") };
    let slope = (0.5 * yfov).tan();
    let ndc = [(f64::from(x) + 0.5) / 64.0 - 1.0, 1.0 - (f64::from(y) + 0.5) / 48.0];
    view.world_from_view.matrix3 * DVec3::new(ndc[0] * slope * view.aspect(), ndc[1] * slope, -1.0)
}

/// The pixel that shows `p`, with fractions.
pub fn pixel(view: &View, p: DVec3) -> DVec2 {
    let clip = view.clip_from_relative() * (p - view.eye()).extend(1.0);
    DVec2::new((0.5 + 0.5 * clip.x / clip.w) * 128.0, (0.5 - 0.5 * clip.y / clip.w) * 96.0)
}

/// Where a ray enters and leaves a box, in lengths of `direction`.
pub fn through_box(center: DVec3, half: DVec3, from: DVec3, direction: DVec3) -> Option<[f64; 2]> {
    let (a, b) = ((center - half - from) / direction, (center + half - from) / direction);
    let (enter, leave) = (a.min(b).max_element(), a.max(b).min_element());
    (enter < leave).then_some([enter, leave])
}

/// Every box of [`scene`]: centre and half extents.
pub fn boxes(cubes: &[DVec3]) -> Vec<(DVec3, DVec3)> {
    let floor = (DVec3::NEG_Y * 0.1, DVec3::new(6.0, 0.1, 6.0));
    [floor].into_iter().chain(cubes.iter().map(|&at| (at, DVec3::splat(0.5)))).collect()
}

/// The nearest surface that a ray meets.
pub fn seen(cubes: &[DVec3], from: DVec3, direction: DVec3) -> Option<DVec3> {
    let hits = boxes(cubes).into_iter().filter_map(|(center, half)| through_box(center, half, from, direction));
    let nearest = hits.map(|[enter, _]| enter).filter(|enter| *enter > 0.0).fold(f64::INFINITY, f64::min);
    nearest.is_finite().then(|| from + direction * nearest)
}

/// `overlays` over an even `ground`, as RGB by rows.
pub fn figure(
    gpu: &Gpu,
    scene: &Scene,
    view: &View,
    overlays: &[Overlay],
    options: &Options,
    ground: u8,
) -> Vec<[u8; 3]> {
    let [width, height] = view.size;
    let extent = wgpu::Extent3d { width, height, depth_or_array_layers: 1 };
    let target = gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size: extent,
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: wgpu::TextureFormat::Rgba8Unorm,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC | wgpu::TextureUsages::COPY_DST,
        view_formats: &[],
    });
    let texels = [ground, ground, ground, 255].repeat((width * height) as usize);
    let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(4 * width), rows_per_image: None };
    gpu.queue.write_texture(target.as_image_copy(), &texels, layout, extent);
    let mut figures = Figures::new(gpu, scene).expect("figures");
    figures.draw(overlays, view, options, &target).expect("a figure");
    let rgba = gpu.read_texture(&target).expect("texels");
    rgba.chunks_exact(4).map(|t| [t[0], t[1], t[2]]).collect()
}

/// A channel-wise distance.
pub fn distance(a: [u8; 3], b: [u8; 3]) -> i32 {
    (0..3).map(|k| i32::from(a[k].abs_diff(b[k]))).max().unwrap_or(0)
}

/// All pixels of [`SIZE`], by rows.
pub fn pixels() -> impl Iterator<Item = [u32; 2]> {
    (0..SIZE[1]).flat_map(|y| (0..SIZE[0]).map(move |x| [x, y]))
}

/// A figure as a picture.
pub fn rgba(figure: &[[u8; 3]]) -> Vec<u8> {
    figure.iter().flat_map(|&[r, g, b]| [r, g, b, 255]).collect()
}
