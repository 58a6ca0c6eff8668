//! Two cubes above a floor, one over the other, and two lights so low that dark caps come into view.

use crate::paper::Paper;
use crate::{Overlay, ThirdPerson};
use zfail_plan::glam::{DAffine3, DMat3, DVec3};
use zfail_plan::light::LightKind;
use zfail_plan::plan::Technique;
use zfail_plan::view::{Projection, View};
use zfail_scene::{Instance, Light, LightShape, Mesh, Scene};

fn block(half: [f32; 3]) -> Mesh {
    let corner = |i: usize| [0, 1, 2].map(|k| if i >> k & 1 == 0 { -half[k] } else { half[k] });
    let quads = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
    Mesh {
        positions: (0..8).map(corner).collect(),
        triangles: quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect(),
        ..Mesh::default()
    }
}

pub fn scene() -> Scene {
    let instance = |mesh, y: f64| Instance {
        name: String::new(),
        mesh,
        world_from_object: DAffine3::from_translation(DVec3::new(1e5, y, 0.0)),
        casts_shadow: true,
        receives_shadow: true,
    };
    let light = |x: f64| Light {
        name: String::new(),
        kind: LightKind::Point { position: DVec3::new(1e5 + x, 3.2, 0.5), range: 30.0 },
        color: [1.0; 3],
        intensity: 1.0,
        excluded: Vec::new(),
        shape: LightShape::default(),
    };
    Scene {
        meshes: vec![block([4.0, 0.1, 4.0]), block([0.5; 3])],
        instances: vec![instance(0, -0.1), instance(1, 1.0), instance(1, 2.4)],
        lights: vec![light(1.0), light(-2.0)],
        ..Scene::default()
    }
}

pub fn view() -> View {
    let eye = DVec3::new(1e5, 3.0, 6.0);
    let back = DVec3::new(0.0, 0.3, 1.0).normalize();
    let right = DVec3::Y.cross(back).normalize();
    View::new(
        DAffine3 { matrix3: DMat3::from_cols(right, back.cross(right), back), translation: eye },
        Projection::Perspective { yfov: 0.8, near: 0.1, far: None },
        [128, 96],
    )
}

pub fn paper<'a>(view: &'a View, overlays: &'a [Overlay]) -> Paper<'a> {
    Paper { overlays, view, lights: &[0], technique: Technique::Auto, from: ThirdPerson::default() }
}
