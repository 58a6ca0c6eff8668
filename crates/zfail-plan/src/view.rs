//! The camera: one function from object space to clip space for every pass, and its inverse for tests.
//!
//! In: a camera's placement and projection, the size of the image. Out: matrices for the GPU, in f32, composed in f64
//! relative to the eye, so that a scene 10^6 m from the origin is as exact as one around it.
//!
//! Depth is reversed: 1 at the near plane, 0 at infinity (perspective) or at `far`. With the far plane at infinity the
//! z row is `(0, 0, 0, near)`, so a vertex with w = 0 gets depth 0 exactly, without rounding
//! (Everitt & Kilgard 2002, section 3.2.1, re-derived for a depth range of 0..1).

use glam::{DAffine3, DMat4, DVec3, DVec4, Mat4};

/// Shape of the view volume.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Projection {
    /// A pyramid.
    Perspective {
        /// Vertical field of view, radians, in (0, pi).
        yfov: f64,
        /// Distance to the near plane, positive.
        near: f64,
        /// Distance to the far plane; `None` puts it at infinity, which is what shadow volumes want.
        far: Option<f64>,
    },
    /// A box.
    Orthographic {
        /// Half the height of the view volume, positive.
        ymag: f64,
        /// Distance to the near plane; may be negative.
        near: f64,
        /// Distance to the far plane, greater than `near`.
        far: f64,
    },
}

/// A camera with an image: what one frame sees.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// View to world: rotation and translation only; looks along -z, +y up.
    pub world_from_view: DAffine3,
    /// Shape of the view volume.
    pub projection: Projection,
    /// Width and height in pixels, both positive.
    pub size: [u32; 2],
}

impl View {
    /// Width over height.
    #[must_use]
    pub fn aspect(&self) -> f64 {
        f64::from(self.size[0]) / f64::from(self.size[1])
    }

    /// The eye in world space (for an orthographic camera the origin of its view space).
    #[must_use]
    pub fn eye(&self) -> DVec3 {
        self.world_from_view.translation
    }

    /// Distance to the near plane.
    #[must_use]
    pub fn near(&self) -> f64 {
        match self.projection {
            Projection::Perspective { near, .. } | Projection::Orthographic { near, .. } => near,
        }
    }

    /// Whether points at infinity lie beyond the far plane, so that the depth of volumes has to be clamped.
    #[must_use]
    pub fn is_finite(&self) -> bool {
        !matches!(self.projection, Projection::Perspective { far: None, .. })
    }

    /// View to clip space: x and y in -w..w (y up), reversed z in 0..w.
    #[must_use]
    pub fn clip_from_view(&self) -> DMat4 {
        let rows = match self.projection {
            Projection::Perspective { yfov, near, far } => {
                let y = 1.0 / (0.5 * yfov).tan();
                let z = match far {
                    None => DVec4::new(0.0, 0.0, 0.0, near),
                    Some(far) => DVec4::new(0.0, 0.0, near / (far - near), near * far / (far - near)),
                };
                [
                    DVec4::new(y / self.aspect(), 0.0, 0.0, 0.0),
                    DVec4::new(0.0, y, 0.0, 0.0),
                    z,
                    DVec4::new(0.0, 0.0, -1.0, 0.0),
                ]
            }
            Projection::Orthographic { ymag, near, far } => [
                DVec4::new(1.0 / (ymag * self.aspect()), 0.0, 0.0, 0.0),
                DVec4::new(0.0, 1.0 / ymag, 0.0, 0.0),
                DVec4::new(0.0, 0.0, 1.0 / (far - near), far / (far - near)),
                DVec4::W,
            ],
        };
        DMat4::from_cols(rows[0], rows[1], rows[2], rows[3]).transpose()
    }

    /// World directions relative to the eye, homogeneous, to clip space.
    #[must_use]
    pub fn clip_from_relative(&self) -> DMat4 {
        self.clip_from_view() * DMat4::from_mat3(self.world_from_view.matrix3.transpose())
    }

    /// Object to view space, composed in f64.
    #[must_use]
    pub fn view_from_object(&self, world_from_object: &DAffine3) -> DAffine3 {
        // A rotation's inverse is its transpose; exactness matters more than generality here.
        let view_from_world = self.world_from_view.matrix3.transpose();
        DAffine3 {
            matrix3: view_from_world * world_from_object.matrix3,
            translation: view_from_world * (world_from_object.translation - self.world_from_view.translation),
        }
    }

    /// Object to clip space, rounded once to f32: the one matrix with which every pass places this object's vertices.
    #[must_use]
    pub fn clip_from_object(&self, world_from_object: &DAffine3) -> Mat4 {
        let view_from_object = self.view_from_object(world_from_object);
        (self.clip_from_view() * DMat4::from(view_from_object)).as_mat4()
    }
}
