//! Editing lights: where they are, what they shine on, how many there are.

use super::Session;
use crate::action::Place;
use crate::camera::radius;
use std::mem;
use zfail_plan::glam::DVec3;
use zfail_plan::light::LightKind;
use zfail_scene::{Light, LightShape};

/// Where a light comes from.
#[derive(Clone, Debug, Default)]
pub(super) struct Origin {
    /// The light of the file whose animation it follows, until it is moved by hand.
    pub(super) follows: Option<usize>,
    /// The casters that it excluded before its shadows were switched off.
    pub(super) excluded: Vec<usize>,
}

impl Origin {
    pub(super) fn of_file((index, light): (usize, &Light)) -> Self {
        Self { follows: Some(index), excluded: light.excluded.clone() }
    }
}

impl Session {
    /// Says that colour, intensity or excluded casters of a light have changed.
    pub fn relit(&mut self) {
        self.changes.lights = true;
        self.touch();
    }

    /// Puts a light somewhere else; it no longer follows an animation.
    pub fn move_light(&mut self, light: usize, kind: LightKind) {
        let Some(moved) = self.scene.lights.get_mut(light).filter(|light| light.kind != kind) else { return };
        if kind.homogeneous().is_finite() {
            moved.kind = kind;
            self.origins[light].follows = None;
            self.relit();
        }
    }

    /// Whether anything casts a shadow from this light.
    #[must_use]
    pub fn light_casts(&self, light: usize) -> bool {
        self.scene
            .lights
            .get(light)
            .is_some_and(|light| (0..self.scene.instances.len()).any(|i| !light.excluded.contains(&i)))
    }

    /// Switches all shadows of a light off, or on as they were.
    pub fn set_light_casts(&mut self, light: usize, casts: bool) {
        if casts == self.light_casts(light) || light >= self.scene.lights.len() {
            return;
        }
        let excluded = &mut self.scene.lights[light].excluded;
        if casts {
            *excluded = mem::take(&mut self.origins[light].excluded);
        } else {
            self.origins[light].excluded = mem::replace(excluded, (0..self.scene.instances.len()).collect());
        }
        self.relit();
    }

    /// A white point light that gives surfaces in the middle of the scene about as much light as the others together.
    pub(super) fn add_light(&mut self, place: Place) {
        let radius = radius(&self.bounds);
        let middle = if self.bounds.is_empty() { DVec3::ZERO } else { self.bounds.center() };
        let position = match place {
            Place::Eye => self.rig.camera.world_from_view.translation,
            Place::Above => middle + DVec3::Y * 1.2 * radius,
        };
        let irradiance = |light: &Light| match light.kind {
            LightKind::Directional { .. } => f64::from(light.intensity),
            LightKind::Point { position, .. } | LightKind::Spot { position, .. } => {
                f64::from(light.intensity) / position.distance_squared(middle).max(0.01 * radius * radius)
            }
        };
        let present: f64 = self.scene.lights.iter().map(irradiance).fold(0.0, f64::max);
        let present = if present.is_finite() && present > 0.0 { present } else { std::f64::consts::PI };
        let distance_squared = position.distance_squared(middle).max(0.01 * radius * radius);
        let number = self.scene.lights.len();
        self.scene.lights.push(Light {
            name: format!("added {number}"),
            kind: LightKind::Point { position, range: f64::INFINITY },
            color: [1.0; 3],
            intensity: (present * distance_squared).min(1e30) as f32,
            excluded: Vec::new(),
            shape: LightShape::default(),
        });
        self.origins.push(Origin::default());
        self.selected = Some(number);
        self.relit();
    }

    /// Removes the selected light.
    pub(super) fn remove_light(&mut self) {
        if let Some(light) = self.selected.filter(|&light| light < self.scene.lights.len()) {
            self.scene.lights.remove(light);
            self.origins.remove(light);
            self.selected = None;
            self.relit();
        }
    }
}
