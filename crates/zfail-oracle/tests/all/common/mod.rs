//! Small scenes for the oracle's own tests.

use zfail_plan::glam::{DAffine3, DMat3, DVec3};
use zfail_plan::light::LightKind;
use zfail_plan::view::{Projection, View};
use zfail_scene::{Instance, Light, LightShape, Material, Mesh, Primitive, Scene};
pub use zfail_testing::Random;

pub fn mesh(positions: Vec<[f32; 3]>, triangles: Vec<[u32; 3]>) -> Mesh {
    let count = triangles.len() as u32;
    let primitives = vec![Primitive { triangles: 0..count, material: Some(0) }];
    Mesh { positions, triangles, primitives, ..Mesh::default() }
}

/// A rectangle of the plane y = 0, front up.
pub fn floor(half: f32) -> Mesh {
    let positions = vec![[-half, 0.0, -half], [-half, 0.0, half], [half, 0.0, half], [half, 0.0, -half]];
    mesh(positions, vec![[0, 1, 2], [0, 2, 3]])
}

/// An axis-aligned cube around the origin, fronts outside.
pub fn cube(half: f32) -> Mesh {
    let positions = (0..8).map(|i| [0, 1, 2].map(|k| if i >> k & 1 == 0 { -half } else { half })).collect();
    let quads = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
    mesh(positions, quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect())
}

/// A sphere around the origin with `2 * n * n` quads.
pub fn sphere(radius: f64, n: u32) -> Mesh {
    let (rings, columns) = (n, 2 * n);
    let point = |i: u32, j: u32| {
        let theta = std::f64::consts::PI * f64::from(i) / f64::from(rings);
        let phi = std::f64::consts::TAU * f64::from(j) / f64::from(columns);
        DVec3::new(theta.sin() * phi.cos(), theta.cos(), -theta.sin() * phi.sin()) * radius
    };
    let positions = (0..=rings).flat_map(|i| (0..columns).map(move |j| point(i, j).as_vec3().to_array())).collect();
    let at = |i: u32, j: u32| i * columns + j % columns;
    let triangles = (0..rings).flat_map(|i| {
        (0..columns)
            .flat_map(move |j| [[at(i, j), at(i + 1, j), at(i + 1, j + 1)], [at(i, j), at(i + 1, j + 1), at(i, j + 1)]])
    });
    mesh(positions, triangles.collect())
}

/// `count` triangles at random.
pub fn soup(random: &mut Random, count: u32, radius: f64) -> Mesh {
    let mut positions = Vec::new();
    for _ in 0..count {
        let center = random.vector(radius);
        for _ in 0..3 {
            positions.push((center + random.vector(0.7 * radius)).as_vec3().to_array());
        }
    }
    mesh(positions, (0..count).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect())
}

pub fn scene(parts: Vec<(Mesh, DAffine3)>, light: LightKind) -> Scene {
    let mut scene = Scene { materials: vec![Material::default()], ..Scene::default() };
    for (mesh, world_from_object) in parts {
        let instance = Instance {
            name: String::new(),
            mesh: scene.meshes.len(),
            world_from_object,
            casts_shadow: true,
            receives_shadow: true,
        };
        scene.meshes.push(mesh);
        scene.instances.push(instance);
    }
    let light = Light {
        name: String::new(),
        kind: light,
        color: [1.0; 3],
        intensity: 1.0,
        excluded: Vec::new(),
        shape: LightShape::default(),
    };
    scene.lights.push(light);
    scene
}

pub fn at(x: f64, y: f64, z: f64) -> DAffine3 {
    DAffine3::from_translation(DVec3::new(x, y, z))
}

pub fn point_light(x: f64, y: f64, z: f64) -> LightKind {
    LightKind::Point { position: DVec3::new(x, y, z), range: f64::INFINITY }
}

pub fn look(eye: DVec3, target: DVec3, size: [u32; 2]) -> View {
    let back = (eye - target).normalize();
    let right = DVec3::Y.cross(back).normalize();
    let matrix3 = DMat3::from_cols(right, back.cross(right), back);
    let world_from_view = DAffine3 { matrix3, translation: eye };
    View::new(world_from_view, Projection::Perspective { yfov: 0.8, near: 0.05, far: None }, size)
}
