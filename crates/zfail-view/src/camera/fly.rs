//! Walking through the scene.

use zfail_plan::glam::{DMat3, DVec3};

/// The way of `length` along right, the world's up, and back; zero if there is no way.
pub fn step(axes: &DMat3, way: DVec3, length: f64) -> DVec3 {
    let along = axes.x_axis * way.x + DVec3::Y * way.y + axes.z_axis * way.z;
    along.try_normalize().map_or(DVec3::ZERO, |along| along * length)
}
