//! The camera: one function from object space to clip space for every pass, and its inverse for tests.
//!
//! In: a camera's placement and projection, the size of the image. Out: matrices for the GPU, in f32, composed in f64
//! relative to the eye, so that a scene 10^6 m from the origin is as exact as one around it.
//!
//! Depth is reversed: 1 at the near plane, 0 at infinity (perspective) or at `far`. With the far plane at infinity the
//! z row is `(0, 0, 0, near)`, so a vertex with w = 0 gets depth 0 exactly, without rounding
//! (Everitt & Kilgard 2002, section 3.2.1, re-derived for a depth range of 0..1).

mod matrices;

pub use matrices::ViewError;

use glam::{DAffine3, DMat3, DMat4, DVec2, DVec3, DVec4, Mat4};

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
///
/// ```
/// use zfail_plan::glam::DVec3;
/// use zfail_plan::view::{Projection, View};
///
/// let projection = Projection::Perspective { yfov: 1.0, near: 0.1, far: None };
/// let view = View::looking_at(DVec3::new(0.0, 2.0, 5.0), DVec3::ZERO, DVec3::Y, projection, [1280, 720]);
/// // The right half of the picture, as another machine or another pass would render it.
/// let half = view.part([640, 0, 640, 720]);
/// // What is in the middle of the whole lies on the left border of the half.
/// let clip = half.clip_from_view() * view.view_from_world().transform_point3(DVec3::ZERO).extend(1.0);
/// assert!((clip.x / clip.w + 1.0).abs() < 1e-12 && clip.y.abs() < 1e-12);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// View to world: rotation and translation only; looks along -z, +y up.
    pub world_from_view: DAffine3,
    /// Shape of the view volume.
    pub projection: Projection,
    /// Width and height in pixels, both positive.
    pub size: [u32; 2],
    /// Which part of the projection's image plane the image shows.
    pub window: Window,
}

/// A stretch of the image plane, for frusta that are off centre: `ndc = scale * centred + offset`, where `centred` are the
/// normalised device coordinates of the projection with the image's own aspect ratio, x to the right, y up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Window {
    /// Magnification.
    pub scale: DVec2,
    /// Where the middle of the projection lies in the image.
    pub offset: DVec2,
}

impl Window {
    /// All of it: an image whose middle is the projection's.
    pub const WHOLE: Self = Self { scale: DVec2::ONE, offset: DVec2::ZERO };
}

impl Default for Window {
    fn default() -> Self {
        Self::WHOLE
    }
}

impl View {
    /// A view whose middle is the projection's.
    #[must_use]
    pub const fn new(world_from_view: DAffine3, projection: Projection, size: [u32; 2]) -> Self {
        Self { world_from_view, projection, size, window: Window::WHOLE }
    }

    /// A view from `eye` towards `target`, both in world space, with `up` upwards in the image. Where these leave a direction
    /// open, because they coincide or are parallel, any is taken.
    #[must_use]
    pub fn looking_at(eye: DVec3, target: DVec3, up: DVec3, projection: Projection, size: [u32; 2]) -> Self {
        let back = (eye - target).try_normalize().unwrap_or(DVec3::Z);
        let right = up.cross(back).try_normalize().unwrap_or_else(|| back.any_orthonormal_vector());
        let matrix3 = DMat3::from_cols(right, back.cross(right), back);
        Self::new(DAffine3 { matrix3, translation: eye }, projection, size)
    }

    /// The part of this view's image within a rectangle of its pixels (x and y of the upper left one, width, height), which
    /// may reach beyond it: a tile of a large picture.
    #[must_use]
    pub fn part(&self, [x, y, width, height]: [u32; 4]) -> Self {
        let [columns, rows] = self.size.map(f64::from);
        let [x, y, width, height] = [x, y, width, height].map(f64::from);
        let middle = DVec2::new((2.0 * x + width) / columns - 1.0, 1.0 - (2.0 * y + height) / rows);
        let half = DVec2::new(width / columns, height / rows);
        let size = [width as u32, height as u32];
        let mut part = Self { size, ..*self };
        let stretch = DVec2::new(part.aspect() / self.aspect(), 1.0);
        part.window =
            Window { scale: self.window.scale * stretch / half, offset: (self.window.offset - middle) / half };
        part
    }

    /// This view with everything moved by so many pixels to the right and down, as for temporal anti-aliasing.
    #[must_use]
    pub fn jittered(&self, [right, down]: [f64; 2]) -> Self {
        let [columns, rows] = self.size.map(f64::from);
        let offset = self.window.offset + DVec2::new(2.0 * right / columns, -2.0 * down / rows);
        Self { window: Window { offset, ..self.window }, ..*self }
    }

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

    /// Whether points at infinity lie beyond a far plane, so that the depth of volumes has to be clamped.
    #[must_use]
    pub fn has_far_plane(&self) -> bool {
        !matches!(self.projection, Projection::Perspective { far: None, .. })
    }

    /// Where a point of the image, in normalised device coordinates, lies in view space: x and y at a distance of 1 along the
    /// view axis (perspective), or at any (orthographic).
    #[must_use]
    pub fn on_image_plane(&self, ndc: DVec2) -> DVec2 {
        let half = match self.projection {
            Projection::Perspective { yfov, .. } => (0.5 * yfov).tan(),
            Projection::Orthographic { ymag, .. } => ymag,
        };
        (ndc - self.window.offset) / self.window.scale * DVec2::new(half * self.aspect(), half)
    }

    /// View to clip space: x and y in -w..w (y up), reversed z in 0..w.
    #[must_use]
    pub fn clip_from_view(&self) -> DMat4 {
        let Window { scale, offset } = self.window;
        let rows = match self.projection {
            Projection::Perspective { yfov, near, far } => {
                let y = 1.0 / (0.5 * yfov).tan();
                let z = match far {
                    None => DVec4::new(0.0, 0.0, 0.0, near),
                    Some(far) => DVec4::new(0.0, 0.0, near / (far - near), near * far / (far - near)),
                };
                [
                    DVec4::new(scale.x * (y / self.aspect()), 0.0, 0.0 - offset.x, 0.0),
                    DVec4::new(0.0, scale.y * y, 0.0 - offset.y, 0.0),
                    z,
                    DVec4::new(0.0, 0.0, -1.0, 0.0),
                ]
            }
            Projection::Orthographic { ymag, near, far } => [
                DVec4::new(scale.x * (1.0 / (ymag * self.aspect())), 0.0, 0.0, offset.x),
                DVec4::new(0.0, scale.y * (1.0 / ymag), 0.0, offset.y),
                DVec4::new(0.0, 0.0, 1.0 / (far - near), far / (far - near)),
                DVec4::W,
            ],
        };
        DMat4::from_cols(rows[0], rows[1], rows[2], rows[3]).transpose()
    }

    /// World to view space; far from the origin, [`Self::view_from_object`] keeps more digits.
    #[must_use]
    pub fn view_from_world(&self) -> DAffine3 {
        self.view_from_object(&DAffine3::IDENTITY)
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

#[cfg(test)]
mod tests {
    use super::*;

    fn views() -> [View; 2] {
        let perspective = Projection::Perspective { yfov: 0.8, near: 0.2, far: None };
        let orthographic = Projection::Orthographic { ymag: 3.0, near: -1.0, far: 20.0 };
        [perspective, orthographic].map(|projection| {
            View::looking_at(DVec3::new(3.0, 4.0, 5.0), DVec3::new(0.0, 1.0, 0.0), DVec3::Y, projection, [300, 170])
        })
    }

    /// Where `point`, world space, is in the image, in pixels from the upper left corner.
    fn pixel(view: &View, point: DVec3) -> DVec2 {
        let clip = view.clip_from_view() * view.view_from_world().transform_point3(point).extend(1.0);
        let [width, height] = view.size.map(f64::from);
        DVec2::new(0.5 * width * (1.0 + clip.x / clip.w), 0.5 * height * (1.0 - clip.y / clip.w))
    }

    #[test]
    fn a_part_shows_the_same_pixels() {
        for view in views() {
            for point in [DVec3::ZERO, DVec3::new(-0.4, 1.2, 0.3), DVec3::new(0.9, 0.0, 1.1)] {
                let whole = pixel(&view, point);
                let part = view.part([31, 17, 200, 40]);
                assert!((pixel(&part, point) - (whole - DVec2::new(31.0, 17.0))).length() < 1e-9);
                let nested = part.part([9, 3, 64, 64]);
                assert!((pixel(&nested, point) - (whole - DVec2::new(40.0, 20.0))).length() < 1e-9);
                let moved = view.jittered([0.25, -0.375]);
                assert!((pixel(&moved, point) - (whole + DVec2::new(0.25, -0.375))).length() < 1e-9);
            }
        }
    }

    #[test]
    fn the_image_plane_is_what_clip_space_shows() {
        for view in views().into_iter().flat_map(|view| [view, view.part([10, 90, 33, 47])]) {
            for ndc in [DVec2::ZERO, DVec2::new(-1.0, 0.5), DVec2::new(0.3, 1.0)] {
                let at = view.on_image_plane(ndc).extend(-1.0);
                let clip = view.clip_from_view() * at.extend(1.0);
                assert!((clip.truncate().truncate() / clip.w - ndc).length() < 1e-9, "{ndc} is {at}, {clip}");
            }
        }
    }

    #[test]
    fn where_directions_are_open_any_will_do() {
        let projection = Projection::Perspective { yfov: 1.0, near: 0.1, far: None };
        for (target, up) in [(DVec3::ZERO, DVec3::Y), (DVec3::Y, DVec3::Y), (DVec3::X, DVec3::ZERO)] {
            let axes = View::looking_at(DVec3::ZERO, target, up, projection, [1, 1]).world_from_view.matrix3;
            assert!((axes.determinant() - 1.0).abs() < 1e-12 && axes.is_finite(), "{axes}");
        }
    }
}
