//! Small scenes with known answers, and a device to render them on.

use zfail_plan::glam::{DAffine3, DMat3, DVec3};
use zfail_plan::light::LightKind;
use zfail_plan::view::{Projection, View};
use zfail_render::{Exposure, Gpu, GpuOptions, Picture, Renderer, Settings};
use zfail_scene::{AlphaMode, Instance, Light, LightShape, Material, Mesh, Primitive, Scene};

/// A device, or `None` if the test is to be skipped.
pub fn gpu() -> Option<Gpu> {
    zfail_testing::gpu(Gpu::new(&GpuOptions::default()))
}

/// Radiance as it is.
pub fn plain() -> Settings {
    Settings { exposure: Exposure::Ev(0.0), ..Settings::default() }
}

/// A view from `eye` towards `target` with a vertical field of view of 1 radian.
pub fn look(eye: DVec3, target: DVec3, size: [u32; 2]) -> View {
    let back = (eye - target).normalize();
    let right = DVec3::Y.cross(back).try_normalize().unwrap_or(DVec3::X);
    View::new(
        DAffine3 { matrix3: DMat3::from_cols(right, back.cross(right), back), translation: eye },
        Projection::Perspective { yfov: 1.0, near: 0.01, far: None },
        size,
    )
}

/// A rough dielectric of one colour.
pub fn matt(color: [f32; 3]) -> Material {
    let [r, g, b] = color;
    Material { base_color: [r, g, b, 1.0], metallic: 0.0, roughness: 1.0, ..Material::default() }
}

/// A rectangle around the origin, perpendicular to z and facing it.
pub fn square(half: f32) -> Mesh {
    Mesh {
        name: "square".into(),
        positions: vec![[-half, -half, 0.0], [half, -half, 0.0], [half, half, 0.0], [-half, half, 0.0]],
        normals: vec![[0.0, 0.0, 1.0]; 4],
        tangents: vec![[0.0; 4]; 4],
        uv0: vec![[0.0, 1.0], [1.0, 1.0], [1.0, 0.0], [0.0, 0.0]],
        uv1: vec![[0.0; 2]; 4],
        colors: vec![[1.0; 4]; 4],
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        primitives: vec![Primitive { triangles: 0..2, material: Some(0) }],
        ..Mesh::default()
    }
}

/// `mesh` with `material`, placed by `world_from_object`.
pub fn add(scene: &mut Scene, mut mesh: Mesh, material: Material, world_from_object: DAffine3) {
    mesh.primitives[0].material = Some(scene.materials.len());
    let casts_shadow = material.alpha != AlphaMode::Blend;
    scene.materials.push(material);
    scene.meshes.push(mesh);
    let mesh = scene.meshes.len() - 1;
    scene.instances.push(Instance {
        name: format!("instance {mesh}"),
        mesh,
        world_from_object,
        casts_shadow,
        receives_shadow: true,
    });
}

/// One large square in the plane z = 0.
pub fn wall(material: Material) -> Scene {
    let mut scene = Scene::default();
    add(&mut scene, square(50.0), material, DAffine3::IDENTITY);
    scene
}

pub fn light(kind: LightKind, intensity: f32) -> Light {
    Light { name: String::new(), kind, color: [1.0; 3], intensity, excluded: Vec::new(), shape: LightShape::default() }
}

pub fn sun(direction: DVec3, lux: f32) -> Light {
    light(LightKind::Directional { direction: direction.normalize() }, lux)
}

pub fn picture(gpu: &Gpu, scene: &Scene, view: &View, settings: &Settings) -> Picture {
    let mut renderer = Renderer::new(gpu, scene).expect("a renderer");
    renderer.picture(view, settings).expect("a picture").0
}

/// Linear RGB at a pixel.
pub fn at(picture: &Picture, x: u32, y: u32) -> [f32; 3] {
    picture.hdr[(y * picture.size[0] + x) as usize]
}

/// The metallic-roughness model of glTF 2.0, appendix B, in f64 and as the text writes it: reflected radiance per
/// irradiance, cosine included.
pub fn reflectance(albedo: f64, metallic: f64, roughness: f64, n: DVec3, v: DVec3, l: DVec3) -> f64 {
    let pi = std::f64::consts::PI;
    let h = (v + l).normalize();
    let (n_l, n_v, n_h, v_h) = (n.dot(l), n.dot(v), n.dot(h), v.dot(h));
    let a2 = roughness.powi(4);
    let f0 = 0.04 * (1.0 - metallic) + albedo * metallic;
    let f = f0 + (1.0 - f0) * (1.0 - v_h).powi(5);
    let d = a2 / (pi * (n_h * n_h * (a2 - 1.0) + 1.0).powi(2));
    let root = |c: f64| (a2 + (1.0 - a2) * c * c).sqrt();
    let visibility = 0.5 / (n_l * root(n_v) + n_v * root(n_l));
    ((1.0 - f) * albedo * (1.0 - metallic) / pi + f * d * visibility) * n_l
}

/// Whether `a` is within `relative` of `b`.
pub fn close(a: f32, b: f64, relative: f64) -> bool {
    (f64::from(a) - b).abs() <= relative * b.abs() + 1e-6
}

/// Asserts that two pictures agree in every value.
#[track_caller]
pub fn assert_same(name: &str, actual: &Picture, expected: &Picture) {
    assert_eq!(actual.size, expected.size, "{name}");
    zfail_testing::assert_alike(name, actual.size, &actual.rgba8, &expected.rgba8, 0);
    assert!(actual == expected, "{name}: what is shown agrees, radiance does not");
}
