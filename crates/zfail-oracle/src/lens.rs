//! Rays through pixels, computed from the camera's parameters alone.
//!
//! In: a view. Out: rays relative to the soup's origin, with their change per pixel; depths along a ray are distances
//! along the view axis.

use crate::cone::Apex;
use glam::DVec3;
use zfail_plan::view::{Projection, View};

/// A camera as the oracle sees it.
#[derive(Clone, Debug)]
pub(crate) struct Lens {
    eye: DVec3,
    /// The view axes.
    right: DVec3,
    up: DVec3,
    forward: DVec3,
    /// Pixels to the view plane at depth 1, or to the world if orthographic: across and down.
    pixel: [f64; 2],
    /// Where the view axis meets the image, in pixels from its upper left corner.
    middle: [f64; 2],
    orthographic: bool,
    /// Visible depths.
    pub depths: [f64; 2],
}

/// A ray through a point of the image.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Ray {
    pub origin: DVec3,
    /// Advances by depth 1.
    pub direction: DVec3,
}

impl Lens {
    pub fn new(view: &View, origin: DVec3) -> Self {
        let axes = view.world_from_view.matrix3;
        let (half_height, orthographic) = match view.projection {
            Projection::Perspective { yfov, .. } => ((0.5 * yfov).tan(), false),
            Projection::Orthographic { ymag, .. } => (ymag, true),
        };
        let far = match view.projection {
            Projection::Perspective { far, .. } => far.unwrap_or(f64::INFINITY),
            Projection::Orthographic { far, .. } => far,
        };
        let [width, height] = view.size.map(f64::from);
        let pixel = 2.0 * half_height / height;
        Self {
            eye: view.world_from_view.translation - origin,
            right: axes.x_axis,
            up: axes.y_axis,
            forward: -axes.z_axis,
            pixel: [pixel / view.window.scale.x, pixel / view.window.scale.y],
            middle: [0.5 * width * (1.0 + view.window.offset.x), 0.5 * height * (1.0 - view.window.offset.y)],
            orthographic,
            depths: [view.near(), far],
        }
    }

    /// The ray through `(x, y)`, in pixels from the upper left corner of the image.
    pub fn ray(&self, x: f64, y: f64) -> Ray {
        let [right, down] = self.per_pixel();
        let aside = right * (x - self.middle[0]) + down * (y - self.middle[1]);
        match self.orthographic {
            false => Ray { origin: self.eye, direction: self.forward + aside },
            true => Ray { origin: self.eye + aside, direction: self.forward },
        }
    }

    /// Change of a ray's [`Lens::aim`] per pixel to the right and down.
    pub fn per_pixel(&self) -> [DVec3; 2] {
        [self.right * self.pixel[0], -self.up * self.pixel[1]]
    }

    /// Tip of the cone of all rays.
    pub fn apex(&self) -> Apex {
        if self.orthographic { Apex::Direction(self.forward) } else { Apex::Point(self.eye) }
    }

    /// Distance of `point` along the view axis.
    pub fn depth_of(&self, point: DVec3) -> f64 {
        self.forward.dot(point - self.eye)
    }

    /// A point on `ray` at which [`Lens::per_pixel`] holds.
    pub fn aim(&self, ray: &Ray) -> DVec3 {
        if self.orthographic { ray.origin } else { ray.origin + ray.direction }
    }

    /// How many times farther apart rays are at `depth` than at their aim.
    pub fn spread(&self, depth: f64) -> f64 {
        if self.orthographic { 1.0 } else { depth }
    }

    /// Change of [`Lens::spread`] with depth.
    pub fn divergence(&self) -> f64 {
        if self.orthographic { 0.0 } else { 1.0 }
    }

    /// The greater length that one pixel covers at `depth`.
    pub fn pixel_at(&self, depth: f64) -> f64 {
        self.pixel[0].max(self.pixel[1]) * self.spread(depth)
    }

    /// `kappa` units in the last place of a 24-bit depth buffer, as a difference of depth.
    pub fn depth_error(&self, depth: f64, kappa: f64) -> f64 {
        let [near, far] = self.depths;
        let range = if self.orthographic { far - near } else { depth * depth / near };
        kappa * range / f64::from(1 << 24)
    }

    /// Depth at which `ray` meets the plane through `a` with `normal`; not finite if they are parallel.
    pub fn meet(ray: &Ray, a: DVec3, normal: DVec3) -> f64 {
        normal.dot(a - ray.origin) / normal.dot(ray.direction)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{DAffine3, DVec4};

    /// The lens and the projection matrix are written independently; they must agree.
    #[test]
    fn rays_hit_what_the_projection_puts_there() {
        let world_from_view = DAffine3::from_rotation_y(0.7) * DAffine3::from_translation(DVec3::new(3.0, -1.0, 2.0));
        let perspective = Projection::Perspective { yfov: 0.9, near: 0.1, far: None };
        let orthographic = Projection::Orthographic { ymag: 2.5, near: -1.0, far: 9.0 };
        for projection in [perspective, orthographic] {
            let view = View::new(world_from_view, projection, [320, 180]);
            let lens = Lens::new(&view, DVec3::new(1.0, 2.0, 3.0));
            for (x, y) in [(0.5, 0.5), (319.5, 0.5), (100.25, 150.0)] {
                let ray = lens.ray(x, y);
                let world = ray.origin + ray.direction * 4.0 + DVec3::new(1.0, 2.0, 3.0);
                let clip = view.clip_from_view() * world_from_view.inverse().transform_point3(world).extend(1.0);
                let DVec4 { x: cx, y: cy, w, .. } = clip;
                assert!((cx / w - (2.0 * x / 320.0 - 1.0)).abs() < 1e-12);
                assert!((cy / w - (1.0 - 2.0 * y / 180.0)).abs() < 1e-12);
                let step = lens.aim(&lens.ray(x + 1.0, y)) - lens.aim(&ray);
                assert!((step - lens.per_pixel()[0]).length() < 1e-12);
            }
        }
    }
}
