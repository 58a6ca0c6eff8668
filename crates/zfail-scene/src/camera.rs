//! Cameras, and what one frame sees through them.

use glam::DAffine3;
use zfail_plan::bounds::Bounds;
use zfail_plan::view::{Projection, View};

/// A camera placed in the world.
#[derive(Clone, Debug)]
pub struct Camera {
    /// The camera's or the node's name.
    pub name: String,
    /// View to world: rotation and translation only; the camera looks along its -z axis, +y is up.
    pub world_from_view: DAffine3,
    /// Shape of the view volume.
    pub projection: Projection,
}

impl Camera {
    /// This camera with an image of `size`: the image's aspect ratio wins, the vertical extent is kept, and a finite
    /// far plane is moved so that nothing within `bounds` (world space) is clipped by it.
    #[must_use]
    pub fn view(&self, size: [u32; 2], bounds: &Bounds) -> View {
        let projection = match self.projection {
            Projection::Perspective { yfov, near, .. } => Projection::Perspective { yfov, near, far: None },
            Projection::Orthographic { ymag, near, far } => {
                let mut far = far.min(near + 1.0);
                if !bounds.is_empty() {
                    let forward = -self.world_from_view.matrix3.z_axis;
                    for corner in bounds.corners() {
                        let depth = forward.dot(corner - self.world_from_view.translation);
                        far = far.max(depth + 1e-3 * (depth - near).abs());
                    }
                }
                Projection::Orthographic { ymag, near, far }
            }
        };
        View::new(self.world_from_view, projection, size)
    }
}
