//! Handles of lights in the picture, and what dragging them does.
//!
//! In: lights, a view, places in the picture. Out: handles in pixels, and where a dragged light goes. A light is moved in
//! the plane of the screen; a direction is turned as if its handle lay on a ball.

use crate::camera::radius;
use zfail_plan::bounds::Bounds;
use zfail_plan::glam::{DVec2, DVec3};
use zfail_plan::light::LightKind;
use zfail_plan::view::{Projection, View};
use zfail_scene::Light;

/// A place that can be dragged.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Handle {
    /// Index of the light.
    pub light: usize,
    /// What of it.
    pub grip: Grip,
    /// Pixels from the picture's top left corner.
    pub at: DVec2,
    /// The other end of the handle's stem, if it has one that is seen.
    pub stem: Option<DVec2>,
}

/// What of a light is held.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Grip {
    /// Where it is.
    Position,
    /// Where it shines.
    Direction,
}

/// Handles of all lights that are in front of the eye.
#[must_use]
pub fn handles(lights: &[Light], bounds: &Bounds, view: &View) -> Vec<Handle> {
    let mut handles = Vec::new();
    for (light, kind) in lights.iter().map(|light| light.kind).enumerate() {
        let position = match kind {
            LightKind::Point { position, .. } | LightKind::Spot { position, .. } => project(view, position),
            LightKind::Directional { .. } => None,
        };
        handles.extend(position.map(|at| Handle { light, grip: Grip::Position, at, stem: None }));
        let ball = ball(&kind, bounds);
        handles.extend(ball.and_then(|ball| {
            let at = project(view, ball.center + ball.radius * ball.towards)?;
            Some(Handle { light, grip: Grip::Direction, at, stem: project(view, ball.center) })
        }));
    }
    handles
}

/// The light after its handle was dragged to `to`, pixels.
#[must_use]
pub fn dragged(kind: &LightKind, grip: Grip, bounds: &Bounds, view: &View, to: DVec2) -> LightKind {
    let mut kind = *kind;
    match (grip, &mut kind) {
        (Grip::Position, LightKind::Point { position, .. } | LightKind::Spot { position, .. }) => {
            let eye = &view.world_from_view;
            let depth = eye.matrix3.z_axis.dot(eye.translation - *position);
            let (origin, along) = ray(view, to);
            *position = origin + along * depth;
        }
        (Grip::Direction, LightKind::Spot { .. } | LightKind::Directional { .. }) => {
            if let Some(ball) = ball(&kind, bounds)
                && let Some(towards) = ball.under(ray(view, to), view)
            {
                match &mut kind {
                    LightKind::Spot { direction, .. } => *direction = towards,
                    LightKind::Directional { direction } => *direction = -towards,
                    LightKind::Point { .. } => {}
                }
            }
        }
        _ => {}
    }
    kind
}

/// The ball on which the handle of a direction lies.
struct Ball {
    center: DVec3,
    radius: f64,
    /// Unit, from the centre to the handle.
    towards: DVec3,
}

fn ball(kind: &LightKind, bounds: &Bounds) -> Option<Ball> {
    let size = radius(bounds);
    match *kind {
        LightKind::Point { .. } => None,
        LightKind::Spot { position, direction, range, .. } => {
            Some(Ball { center: position, radius: (0.25 * size).min(range), towards: direction })
        }
        LightKind::Directional { direction } => {
            let center = if bounds.is_empty() { DVec3::ZERO } else { bounds.center() };
            Some(Ball { center, radius: 0.6 * size, towards: -direction })
        }
    }
}

impl Ball {
    /// The unit vector to the point of the ball under a ray, on the side on which the handle is; beside the ball that of
    /// its outline.
    fn under(&self, (origin, along): (DVec3, DVec3), view: &View) -> Option<DVec3> {
        let along = along.try_normalize()?;
        let nearest = origin + along * along.dot(self.center - origin) - self.center;
        let half = (self.radius * self.radius - nearest.length_squared()).max(0.0).sqrt();
        let to_eye = match view.projection {
            Projection::Perspective { .. } => {
                view.world_from_view.translation - self.center - self.radius * self.towards
            }
            Projection::Orthographic { .. } => view.world_from_view.matrix3.z_axis,
        };
        let front = self.towards.dot(to_eye) >= 0.0;
        (nearest + along * if front { -half } else { half }).try_normalize()
    }
}

/// Where a point is seen, in pixels; `None` behind the eye.
fn project(view: &View, point: DVec3) -> Option<DVec2> {
    let clip = view.clip_from_relative() * (point - view.world_from_view.translation).extend(1.0);
    let at = DVec2::new(0.5 + 0.5 * clip.x / clip.w, 0.5 - 0.5 * clip.y / clip.w) * size(view);
    (clip.w > 0.0 && at.is_finite()).then_some(at)
}

/// Origin and direction, of length 1 along the view axis, of what is seen at a pixel.
fn ray(view: &View, at: DVec2) -> (DVec3, DVec3) {
    let clip_from_view = view.clip_from_view();
    let ndc = (at / size(view) - 0.5) * DVec2::new(2.0, -2.0);
    let aside = DVec3::new(ndc.x / clip_from_view.x_axis.x, ndc.y / clip_from_view.y_axis.y, 0.0);
    let eye = &view.world_from_view;
    match view.projection {
        Projection::Perspective { .. } => (eye.translation, eye.matrix3 * (aside - DVec3::Z)),
        Projection::Orthographic { .. } => (eye.translation + eye.matrix3 * aside, -eye.matrix3.z_axis),
    }
}

fn size(view: &View) -> DVec2 {
    DVec2::new(view.size[0].into(), view.size[1].into())
}

#[cfg(test)]
mod tests {
    use super::*;
    use zfail_plan::glam::{DAffine3, DMat3, DQuat};
    use zfail_scene::LightShape;

    const BOUNDS: Bounds = Bounds { min: DVec3::NEG_ONE, max: DVec3::ONE };

    fn views() -> [View; 2] {
        let turn = DMat3::from_quat(DQuat::from_euler(zfail_plan::glam::EulerRot::YXZ, 0.4, -0.3, 0.1));
        let world_from_view = DAffine3 { matrix3: turn, translation: turn * DVec3::new(0.1, -0.2, 8.0) };
        let size = [320, 200];
        let perspective = Projection::Perspective { yfov: 0.7, near: 0.1, far: None };
        let orthographic = Projection::Orthographic { ymag: 3.0, near: 0.1, far: 30.0 };
        [perspective, orthographic].map(|projection| View::new(world_from_view, projection, size))
    }

    fn light(kind: LightKind) -> Light {
        let shape = LightShape::default();
        Light { name: String::new(), kind, color: [1.0; 3], intensity: 1.0, excluded: Vec::new(), shape }
    }

    #[test]
    fn a_dragged_handle_is_where_the_pointer_is() {
        let position = DVec3::new(0.5, 0.7, -0.2);
        let direction = DVec3::new(0.3, -0.4, -0.8).normalize();
        for view in views() {
            let depth = |p: DVec3| view.world_from_view.matrix3.z_axis.dot(p);
            for (kind, grip) in [
                (LightKind::Point { position, range: 5.0 }, Grip::Position),
                (LightKind::Directional { direction }, Grip::Direction),
                (LightKind::Spot { position, direction, range: 5.0, inner: 0.1, outer: 0.5 }, Grip::Direction),
            ] {
                let at = |kind| {
                    let found = handles(&[light(kind)], &BOUNDS, &view);
                    found.into_iter().find(|handle| handle.grip == grip).expect("a handle").at
                };
                let to = at(kind) + DVec2::new(4.0, -3.0);
                let moved = dragged(&kind, grip, &BOUNDS, &view, to);
                assert!(at(moved).distance(to) < 1e-6, "{kind:?}: {} instead of {to}", at(moved));
                assert!(at(kind).distance(to) > 1.0, "the comparison can fail");
                if let LightKind::Point { position: new, .. } = moved {
                    assert!((depth(new) - depth(position)).abs() < 1e-9, "it stays in the plane of the screen");
                }
            }
        }
    }

    #[test]
    fn directions_stay_unit_vectors_even_beside_the_ball() {
        for view in views() {
            let kind = LightKind::Directional { direction: DVec3::NEG_Y };
            let LightKind::Directional { direction } =
                dragged(&kind, Grip::Direction, &BOUNDS, &view, DVec2::new(-900.0, 5.0))
            else {
                panic!("it stays directional")
            };
            assert!((direction.length() - 1.0).abs() < 1e-12);
        }
    }

    #[test]
    fn what_is_behind_the_eye_has_no_handle() {
        let [view, _] = views();
        let behind = view.world_from_view.translation + view.world_from_view.matrix3.z_axis;
        assert!(handles(&[light(LightKind::Point { position: behind, range: 1.0 })], &BOUNDS, &view).is_empty());
    }
}
