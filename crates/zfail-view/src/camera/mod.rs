//! The eye and how it is moved: around a point of the scene, or freely.
//!
//! In: drags, wheel notches and seconds of keys held. Out: a [`Camera`], whose rotation stays a rotation. A camera of the
//! file is left bit for bit as it is until somebody moves it.

mod fly;
mod orbit;

use zfail_plan::bounds::Bounds;
use zfail_plan::glam::{DAffine3, DMat3, DVec3};
use zfail_plan::view::Projection;
use zfail_scene::Camera;

/// What a drag does.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Mode {
    /// Turns the eye around the pivot.
    #[default]
    Orbit,
    /// Turns the eye where it is.
    Fly,
}

/// A camera that can be moved.
#[derive(Clone, Debug)]
pub struct Rig {
    /// As it is now.
    pub camera: Camera,
    /// The point around which it orbits, world space.
    pub pivot: DVec3,
    /// What a drag does.
    pub mode: Mode,
    /// The scene's camera that this still is.
    pub preset: Option<usize>,
    /// Half the diagonal of the scene, world units, positive.
    radius: f64,
}

impl Rig {
    /// The scene's camera number `preset`, which looks at a scene with these bounds.
    #[must_use]
    pub fn new(camera: &Camera, preset: usize, bounds: &Bounds) -> Self {
        let mut rig = Self {
            camera: camera.clone(),
            pivot: DVec3::ZERO,
            mode: Mode::Orbit,
            preset: Some(preset),
            radius: radius(bounds),
        };
        rig.aim(bounds);
        rig
    }

    /// Becomes the scene's camera number `preset`.
    pub fn take(&mut self, camera: &Camera, preset: usize, bounds: &Bounds) {
        *self = Self { mode: self.mode, ..Self::new(camera, preset, bounds) };
    }

    /// Puts the pivot onto the view axis, as far away as the middle of the scene.
    fn aim(&mut self, bounds: &Bounds) {
        let eye = self.camera.world_from_view.translation;
        let forward = -self.camera.world_from_view.matrix3.z_axis;
        let middle = if bounds.is_empty() { DVec3::ZERO } else { bounds.center() };
        self.pivot = eye + forward * forward.dot(middle - eye).max(0.1 * self.radius);
    }

    /// Follows a drag by so many heights of the picture, to the right and down.
    pub fn turn(&mut self, [x, y]: [f64; 2]) {
        /// Radians per height of the picture.
        const SPEED: f64 = 3.0;
        let center = match self.mode {
            Mode::Orbit => self.pivot,
            Mode::Fly => self.camera.world_from_view.translation,
        };
        self.place(orbit::turned(&self.camera.world_from_view, center, -SPEED * x, -SPEED * y));
        if self.mode == Mode::Fly {
            let distance = self.distance();
            let pose = &self.camera.world_from_view;
            self.pivot = pose.translation - distance * pose.matrix3.z_axis;
        }
    }

    /// Moves the eye in the plane of the picture, so that what is at the pivot's depth follows the pointer.
    pub fn pan(&mut self, [x, y]: [f64; 2]) {
        let height = match self.camera.projection {
            Projection::Perspective { yfov, .. } => 2.0 * self.distance() * (0.5 * yfov).tan(),
            Projection::Orthographic { ymag, .. } => 2.0 * ymag,
        };
        let axes = self.camera.world_from_view.matrix3;
        self.shift((axes.y_axis * y - axes.x_axis * x) * height);
    }

    /// Goes nearer by so many notches of the wheel; an orthographic camera shows less.
    pub fn dolly(&mut self, notches: f64) {
        let factor = 0.88_f64.powf(notches.clamp(-20.0, 20.0));
        let far = 1e4 * self.radius;
        if let Projection::Orthographic { ymag, .. } = &mut self.camera.projection {
            *ymag = (*ymag * factor).clamp(1e-6 * self.radius, far);
            self.preset = None;
            return;
        }
        let mut pose = self.camera.world_from_view;
        if self.mode == Mode::Fly {
            let step = -pose.matrix3.z_axis * (1.0 - factor) * self.distance();
            return self.shift(step);
        }
        let distance = (self.distance() * factor).clamp(1e-5 * self.radius, far);
        pose.translation = self.pivot + pose.matrix3.z_axis * distance;
        self.place(pose);
        // Reversed depth keeps its precision however near the near plane is.
        if let Projection::Perspective { near, .. } = &mut self.camera.projection {
            *near = near.min(0.02 * distance);
        }
    }

    /// Walks for `seconds` along right, up (the world's) and back, each -1 to 1; pivot and eye alike.
    pub fn walk(&mut self, way: DVec3, seconds: f64, fast: bool) {
        let step = fly::step(&self.camera.world_from_view.matrix3, way, 0.5 * self.radius * seconds);
        self.shift(if fast { 4.0 * step } else { step });
    }

    /// Steps back until all of `bounds` is seen in a picture of this aspect ratio.
    pub fn frame(&mut self, bounds: &Bounds, aspect: f64) {
        self.radius = radius(bounds);
        let unit = Bounds { min: DVec3::splat(-1.0), max: DVec3::ONE };
        let bounds = if bounds.is_empty() { &unit } else { bounds };
        let mut pose = self.camera.world_from_view;
        let half = match &mut self.camera.projection {
            Projection::Perspective { yfov, near, .. } => {
                let distance = 1.05 * orbit::distance(&pose.matrix3, bounds, (0.5 * *yfov).tan(), aspect);
                *near = near.min(0.005 * distance);
                distance
            }
            Projection::Orthographic { ymag, .. } => {
                *ymag = 1.05 * orbit::half_height(&pose.matrix3, bounds, aspect).max(1e-6 * self.radius);
                2.0 * self.radius
            }
        };
        self.pivot = bounds.center();
        pose.translation = self.pivot + half * pose.matrix3.z_axis;
        self.place(pose);
    }

    /// From the eye to the pivot.
    fn distance(&self) -> f64 {
        self.pivot.distance(self.camera.world_from_view.translation).max(1e-6 * self.radius)
    }

    fn shift(&mut self, by: DVec3) {
        let mut pose = self.camera.world_from_view;
        pose.translation += by;
        self.pivot += by;
        self.place(pose);
    }

    /// Takes a new place; one that is not finite is refused.
    fn place(&mut self, world_from_view: DAffine3) {
        if world_from_view.is_finite() && world_from_view != self.camera.world_from_view {
            self.camera.world_from_view = world_from_view;
            self.preset = None;
        }
    }
}

/// Half the diagonal; 1 for nothing.
#[must_use]
pub fn radius(bounds: &Bounds) -> f64 {
    let radius = if bounds.is_empty() { 1.0 } else { bounds.half().length() };
    if radius.is_finite() && radius > 0.0 { radius } else { 1.0 }
}

/// The rotation nearest to `axes`, up to rounding.
fn orthonormal(axes: DMat3) -> DMat3 {
    let back = axes.z_axis.normalize();
    let right = axes.y_axis.cross(back).normalize();
    DMat3::from_cols(right, back.cross(right), back)
}

#[cfg(test)]
mod tests {
    use super::*;

    const BOUNDS: Bounds = Bounds { min: DVec3::new(-2.0, 0.0, -1.0), max: DVec3::new(2.0, 3.0, 1.0) };

    fn rig() -> Rig {
        let projection = Projection::Perspective { yfov: 0.8, near: 0.1, far: None };
        let world_from_view = DAffine3::from_translation(DVec3::new(0.3, 1.5, 9.0));
        Rig::new(&Camera { name: "front".into(), world_from_view, projection }, 0, &BOUNDS)
    }

    #[test]
    fn a_camera_of_the_file_stays_what_it_is_until_it_is_moved() {
        let mut rig = rig();
        let before = rig.camera.world_from_view;
        rig.turn([0.0, 0.0]);
        rig.walk(DVec3::ZERO, 1.0, false);
        assert_eq!((rig.preset, rig.camera.world_from_view), (Some(0), before));
        rig.turn([0.01, 0.0]);
        assert_eq!(rig.preset, None);
        assert_ne!(rig.camera.world_from_view, before);
    }

    #[test]
    fn an_orbit_keeps_distance_and_axes() {
        let mut rig = rig();
        let distance = rig.distance();
        for _ in 0..500 {
            rig.turn([0.037, 0.011]);
        }
        let axes = rig.camera.world_from_view.matrix3;
        assert!((axes.transpose() * axes - DMat3::IDENTITY).to_cols_array().iter().all(|x| x.abs() < 1e-12));
        assert!((rig.distance() - distance).abs() < 1e-9 * distance);
        assert!(axes.y_axis.y > 0.0, "the world is not upside down");
        let ahead = (rig.pivot - rig.camera.world_from_view.translation).normalize();
        assert!(ahead.dot(-axes.z_axis) > 1.0 - 1e-9, "the pivot stays in the middle");
    }

    #[test]
    fn in_flight_the_eye_stays_when_it_turns_and_the_wheel_moves_it() {
        let mut rig = rig();
        rig.mode = Mode::Fly;
        let eye = rig.camera.world_from_view.translation;
        rig.turn([0.2, -0.1]);
        assert_eq!(rig.camera.world_from_view.translation, eye);
        let forward = -rig.camera.world_from_view.matrix3.z_axis;
        rig.dolly(1.0);
        assert!((rig.camera.world_from_view.translation - eye).normalize().dot(forward) > 1.0 - 1e-12);
        assert!(rig.camera.world_from_view.matrix3.y_axis.y > 0.9, "a drag up looks up, not over");
    }

    #[test]
    fn framing_shows_everything_and_no_more_than_needed() {
        for aspect in [0.5, 1.0, 2.5] {
            let mut rig = rig();
            rig.turn([0.3, 0.2]);
            rig.frame(&BOUNDS, aspect);
            let view = rig.camera.view([(1000.0 * aspect) as u32, 1000], &BOUNDS);
            let to_clip = view.clip_from_view() * zfail_plan::glam::DMat4::from(rig.camera.world_from_view.inverse());
            let reach = BOUNDS.corners().map(|c| {
                let p = to_clip * c.extend(1.0);
                p.x.abs().max(p.y.abs()) / p.w
            });
            let reach = reach.into_iter().fold(0.0, f64::max);
            assert!((0.8..1.0).contains(&reach), "{aspect}: {reach}");
        }
    }

    #[test]
    fn the_wheel_comes_close_without_being_clipped() {
        let mut rig = rig();
        (0..400).for_each(|_| rig.dolly(1.0));
        let Projection::Perspective { near, .. } = rig.camera.projection else { panic!("it stays perspective") };
        assert!(near > 0.0 && near < rig.distance() && rig.distance() > 0.0);
        (0..400).for_each(|_| rig.dolly(-5.0));
        assert!(rig.camera.world_from_view.is_finite());
    }
}
