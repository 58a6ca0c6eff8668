//! Turning around a point.

use super::orthonormal;
use zfail_plan::bounds::Bounds;
use zfail_plan::glam::{DAffine3, DMat3, DQuat, DVec3};

/// How near to the vertical the view axis comes, radians.
const POLE: f64 = 0.01;

/// A view turned about `center`: by `yaw` about the world's vertical and by `pitch` about its own right axis, radians. It
/// does not go over the poles.
pub fn turned(world_from_view: &DAffine3, center: DVec3, yaw: f64, pitch: f64) -> DAffine3 {
    if yaw == 0.0 && pitch == 0.0 {
        return *world_from_view;
    }
    let axes = world_from_view.matrix3;
    // Positive pitch lowers the eye.
    let elevation = axes.z_axis.y.clamp(-1.0, 1.0).asin();
    let room = std::f64::consts::FRAC_PI_2 - POLE;
    let raised = (elevation - pitch).clamp(elevation.min(-room), elevation.max(room));
    let turn = DQuat::from_rotation_y(yaw) * DQuat::from_axis_angle(axes.x_axis.normalize(), elevation - raised);
    let matrix3 = orthonormal(DMat3::from_quat(turn) * axes);
    DAffine3 { matrix3, translation: center + turn * (world_from_view.translation - center) }
}

/// The least distance of the eye from the middle of `bounds` at which it sees all of them; `slope` is the tangent of half
/// the vertical field of view.
pub fn distance(axes: &DMat3, bounds: &Bounds, slope: f64, aspect: f64) -> f64 {
    let needed = |corner: DVec3| {
        let from_center = axes.transpose() * (corner - bounds.center());
        from_center.z + from_center.y.abs().max(from_center.x.abs() / aspect) / slope
    };
    let distance = bounds.corners().map(needed).into_iter().fold(0.0, f64::max);
    if distance > 0.0 { distance } else { 1.0 }
}

/// Half the height of a box that holds all of `bounds`.
pub fn half_height(axes: &DMat3, bounds: &Bounds, aspect: f64) -> f64 {
    let needed = |corner: DVec3| {
        let from_center = axes.transpose() * (corner - bounds.center());
        from_center.y.abs().max(from_center.x.abs() / aspect)
    };
    bounds.corners().map(needed).into_iter().fold(0.0, f64::max)
}
