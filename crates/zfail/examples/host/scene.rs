//! What the example shows: a ring of boxes, an open bowl and a leaning sheet on a floor, under a lamp and a sun. The boxes turn,
//! the lamp rises, and the camera goes round them.

use zfail::glam::{DAffine3, DMat3, DQuat, DVec3};
use zfail::{LightKind, Projection, View};

/// A mesh.
pub struct Mesh {
    /// Object space.
    pub positions: Vec<[f32; 3]>,
    /// Counter-clockwise from the front.
    pub triangles: Vec<[u32; 3]>,
}

/// A mesh in the world.
pub struct Object {
    /// Index into the meshes.
    pub mesh: usize,
    /// Placement.
    pub world_from_object: DAffine3,
    /// Diffuse reflectance.
    pub color: [f32; 3],
}

/// A light as the host shades it.
pub struct Light {
    /// Placement.
    pub kind: LightKind,
    /// Colour times intensity.
    pub color: [f32; 3],
}

/// Everything in it.
pub struct Scene {
    /// Meshes.
    pub meshes: Vec<Mesh>,
    /// Placed meshes; all of them cast.
    pub objects: Vec<Object>,
    /// Lights.
    pub lights: Vec<Light>,
}

/// The scene of the example at a time, seconds. Its meshes are the same at any.
#[must_use]
pub fn scene(time: f64) -> Scene {
    let floor = quads(&[[[-30., 0., -30.], [-30., 0., 30.], [30., 0., 30.], [30., 0., -30.]]]);
    let sheet = quads(&[[[-0.8, 0., 0.], [0.8, 0., 0.], [0.8, 1.6, 0.], [-0.8, 1.6, 0.]]]);
    let place = |translation: DVec3, rotation: DQuat| DAffine3 { matrix3: DMat3::from_quat(rotation), translation };
    let object = |mesh, world_from_object, color| Object { mesh, world_from_object, color };
    let mut objects = vec![
        object(0, DAffine3::IDENTITY, [0.8, 0.78, 0.75]),
        object(2, place(DVec3::new(0., 0.02, 0.), DQuat::IDENTITY), [0.9, 0.55, 0.25]),
        object(
            3,
            place(DVec3::new(-2.3, 0., 1.2), DQuat::from_rotation_y(0.6) * DQuat::from_rotation_x(-0.4)),
            [0.5, 0.8, 0.5],
        ),
    ];
    for i in 0..7 {
        let angle = f64::from(i) / 7.0 * std::f64::consts::TAU + 0.2 * time;
        let at = DVec3::new(2.2 * angle.cos(), 0.4, 2.2 * angle.sin());
        // Every second box is mirrored.
        let mirror = DMat3::from_diagonal(DVec3::new(if i % 2 == 0 { 0.3 } else { -0.3 }, 0.4, 0.2));
        let turn = DMat3::from_quat(DQuat::from_rotation_y(-angle * 1.7));
        objects.push(object(1, DAffine3 { matrix3: turn * mirror, translation: at }, [0.45, 0.6, 0.85]));
    }
    Scene {
        meshes: vec![floor, cube(), bowl(), sheet],
        objects,
        lights: vec![
            Light {
                kind: LightKind::Point { position: DVec3::new(0.15, 0.85 + 0.3 * time, 0.1), range: f64::INFINITY },
                color: [3.4, 2.3, 1.3],
            },
            Light {
                kind: LightKind::Directional { direction: DVec3::new(-0.5, -0.8, -0.35).normalize() },
                color: [0.22, 0.3, 0.46],
            },
        ],
    }
}

/// The camera of the example at a time.
#[must_use]
pub fn view(time: f64, size: [u32; 2]) -> View {
    let eye = DQuat::from_rotation_y(0.15 * time) * DVec3::new(2.6, 3.1, 3.9);
    let projection = Projection::Perspective { yfov: 0.8, near: 0.1, far: None };
    View::looking_at(eye, DVec3::new(0.0, 0.35, 0.0), DVec3::Y, projection, size)
}

fn quads(corners: &[[[f32; 3]; 4]]) -> Mesh {
    let positions = corners.iter().flatten().copied().collect();
    let quads = (0..corners.len() as u32).map(|i| 4 * i);
    Mesh { positions, triangles: quads.flat_map(|v| [[v, v + 1, v + 2], [v, v + 2, v + 3]]).collect() }
}

fn cube() -> Mesh {
    let corner = |i: u32| [0, 1, 2].map(|bit| if i >> bit & 1 == 0 { -1.0 } else { 1.0 });
    let sides = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
    quads(&sides.map(|side| side.map(corner)))
}

/// An open shell without thickness, seen and lit from both sides.
fn bowl() -> Mesh {
    let ring = |height: f32, radius: f32, i: u32| {
        let angle = (i % 16) as f32 / 16.0 * std::f32::consts::TAU;
        [radius * angle.cos(), height, radius * angle.sin()]
    };
    let profile = [(0.0, 0.2), (0.08, 0.55), (0.3, 0.8), (0.6, 0.95)];
    let mut sides = Vec::new();
    for pair in profile.windows(2) {
        for i in 0..16 {
            let [(h0, r0), (h1, r1)] = [pair[0], pair[1]];
            sides.push([ring(h0, r0, i), ring(h1, r1, i), ring(h1, r1, i + 1), ring(h0, r0, i + 1)]);
        }
    }
    quads(&sides)
}
