//! Many casters, and what of them moves from frame to frame.
//!
//! In: how many casters and lights, and what moves. Out: a frame's view, casters, lights and receivers, the same for every
//! technique.

use clap::ValueEnum;
use serde::Serialize;
use zfail_builtin::shapes;
use zfail_plan::bounds::{Bounds, OrientedBox};
use zfail_plan::glam::{DAffine3, DMat3, DVec3};
use zfail_plan::light::LightKind;
use zfail_plan::view::{Projection, View};
use zfail_render::zfail::{Caster, MeshId, ShadowLight};
use zfail_scene::Mesh;

/// What is another in every frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, ValueEnum)]
#[serde(rename_all = "kebab-case")]
pub enum Moves {
    /// Nothing.
    Nothing,
    /// The eye.
    Camera,
    /// The first light.
    Light,
    /// Every tenth caster.
    Tenth,
    /// The eye, all lights and all casters.
    All,
}

/// How many boxes there are around what can be seen.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, ValueEnum)]
#[serde(rename_all = "kebab-case")]
pub enum Boxes {
    /// One.
    Scene,
    /// One for each caster, and one for the floor.
    Each,
}

/// Radius of a caster.
const RADIUS: f64 = 0.4;

/// A floor with spheres above it, a metre apart, and the lights over them.
#[derive(Debug)]
pub struct Crowd {
    pub view: View,
    pub casters: Vec<Caster>,
    pub lights: Vec<ShadowLight<'static>>,
    pub receivers: Vec<Bounds>,
    moves: Moves,
    boxes: Boxes,
}

/// What every caster looks like: 256 triangles.
pub fn body() -> Mesh {
    shapes::uv_sphere(RADIUS, 16, 9)
}

impl Crowd {
    pub fn new(mesh: MeshId, casters: usize, lights: usize, moves: Moves, boxes: Boxes) -> Self {
        let row = (casters as f64).sqrt().ceil();
        let at = |i: usize| {
            DVec3::new(i as f64 % row - 0.5 * row, 1.0 + 0.1 * (i % 7) as f64, (i as f64 / row).floor() - 0.5 * row)
        };
        let casters = (0..casters).map(|i| Caster::new(mesh, DAffine3::from_translation(at(i)))).collect();
        let light = |l: usize| {
            let turn = l as f64 * 2.4;
            let position = DVec3::new(0.3 * row * turn.sin(), 6.0 + l as f64, 0.3 * row * turn.cos());
            ShadowLight::new(LightKind::Point { position, range: f64::INFINITY }).within(None::<OrientedBox>)
        };
        let back = DVec3::new(0.3, 0.5, 1.0).normalize();
        let right = DVec3::Y.cross(back).normalize();
        let world_from_view = DAffine3 {
            matrix3: DMat3::from_cols(right, back.cross(right), back),
            translation: DVec3::Y * 2.0 + back * (0.5 * row + 3.0),
        };
        let view =
            View::new(world_from_view, Projection::Perspective { yfov: 1.0, near: 0.1, far: None }, [1920, 1080]);
        let mut crowd =
            Self { view, casters, lights: (0..lights).map(light).collect(), receivers: Vec::new(), moves, boxes };
        crowd.bound();
        crowd
    }

    /// Goes on to frame number `frame`; every one is a little further.
    pub fn step(&mut self, frame: usize) {
        let on = DVec3::new(0.002, 0.0, 0.001) * if frame.is_multiple_of(2) { 1.0 } else { 1.01 };
        let lift = |caster: &mut Caster| caster.world_from_object.translation += on;
        let shift = |light: &mut ShadowLight<'_>| {
            if let LightKind::Point { position, .. } = &mut light.kind {
                *position -= on;
            }
        };
        let all = self.moves == Moves::All;
        if all || self.moves == Moves::Camera {
            self.view.world_from_view.translation += on;
        }
        if all {
            self.lights.iter_mut().for_each(shift);
            self.casters.iter_mut().for_each(lift);
        } else if self.moves == Moves::Light {
            self.lights.iter_mut().take(1).for_each(shift);
        } else if self.moves == Moves::Tenth {
            self.casters.iter_mut().step_by(10).for_each(lift);
        }
        self.bound();
    }

    /// Puts boxes around floor and casters.
    fn bound(&mut self) {
        let half = 0.5 * (self.casters.len() as f64).sqrt() + 2.0;
        let floor = Bounds { min: DVec3::new(-half, 0.0, -half), max: DVec3::new(half, 0.0, half) };
        let around = |caster: &Caster| {
            let middle = caster.world_from_object.translation;
            Bounds { min: middle - RADIUS, max: middle + RADIUS }
        };
        self.receivers.clear();
        match self.boxes {
            Boxes::Each => self.receivers.extend(self.casters.iter().map(around)),
            Boxes::Scene => {
                let corners = self.casters.iter().map(around).flat_map(|bounds| [bounds.min, bounds.max]);
                self.receivers.push(Bounds::of(corners.chain([floor.min, floor.max])));
            }
        }
        if self.boxes == Boxes::Each {
            self.receivers.push(floor);
        }
    }
}
