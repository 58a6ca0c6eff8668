//! A view from the matrices that other renderers have.
//!
//! In: view-to-world and a projection matrix. Out: a [`View`] that shows the same, or why there is none: its own matrices are
//! composed in f64 from parameters, and of a matrix that hides them in shear, or in depths the wrong way round, there are none.

use super::{Projection, View, Window};
use glam::{DAffine3, DMat3, DMat4, DVec2};

/// Why matrices make no [`View`].
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum ViewError {
    /// A number that is none.
    #[error("the matrices of the view hold numbers that are not finite")]
    NotFinite,
    /// The camera is scaled or sheared.
    #[error(
        "view-to-world is not a rotation and a translation alone (its axes are off by {deviation}): take scale out of the \
         camera's transform and its parents'"
    )]
    NotRigid {
        /// Greatest difference between the products of axes and those of a rotation.
        deviation: f64,
    },
    /// The bottom row belongs to no camera that looks along -z.
    #[error(
        "the projection's bottom row is neither (0, 0, -1, 0), a perspective that looks along -z, nor (0, 0, 0, 1), a parallel \
         projection: use a right-handed one such as `glam::camera::rh::proj::directx::perspective_infinite_reverse`"
    )]
    NoProjection,
    /// x depends on y, or y on x, or the image is mirrored.
    #[error(
        "the projection shears or mirrors the image: x and y of clip space have to grow with those of view space alone"
    )]
    Sheared,
    /// Depth does not fall from 1 to 0.
    #[error(
        "depth is not reversed: it has to be 1 at the near plane and to fall to 0 at infinity or at the far plane, as in \
         `glam::camera::rh::proj::directx::perspective_infinite_reverse` with the near plane at a positive distance; clear depth to 0 and compare with \
         `Greater`"
    )]
    NotReversed,
    /// An image without pixels.
    #[error("the image has no pixels: {0:?}")]
    NoPixels([u32; 2]),
}

/// Axes of a camera that f32 arithmetic has turned are off by less.
const RIGID: f64 = 1e-4;

impl View {
    /// A view from a camera's placement (looking along -z, +y up) and its projection matrix, off-centre ones included, with
    /// reversed depth from 1 at the near plane to 0 at infinity (perspective) or at the far plane.
    ///
    /// What it shows is what the matrices show, up to rounding. Its own [`View::clip_from_object`] rounds once, so a renderer
    /// that goes on multiplying its own matrices gets other bits: see `zfail::Caster::clip_from_object` for what such a
    /// renderer has to respect.
    ///
    /// ```
    /// use zfail_plan::glam::{DAffine3, dcamera::rh::proj::directx};
    /// use zfail_plan::view::{View, ViewError};
    ///
    /// let projection = directx::perspective_infinite_reverse(1.0, 16.0 / 9.0, 0.1);
    /// let view = View::from_matrices(DAffine3::IDENTITY, projection, [1280, 720])?;
    /// assert!((view.near() - 0.1).abs() < 1e-12 && !view.has_far_plane());
    ///
    /// let other_way_round = directx::perspective(1.0, 16.0 / 9.0, 0.1, 100.0);
    /// assert_eq!(View::from_matrices(DAffine3::IDENTITY, other_way_round, [1280, 720]), Err(ViewError::NotReversed));
    /// # Ok::<(), ViewError>(())
    /// ```
    ///
    /// # Errors
    /// Matrices of which no view can be made; the message says what to change.
    pub fn from_matrices(world_from_view: DAffine3, clip_from_view: DMat4, size: [u32; 2]) -> Result<Self, ViewError> {
        if size.contains(&0) {
            return Err(ViewError::NoPixels(size));
        }
        if !world_from_view.is_finite() || !clip_from_view.is_finite() {
            return Err(ViewError::NotFinite);
        }
        let axes = world_from_view.matrix3;
        let products = axes.transpose() * axes - DMat3::IDENTITY;
        let off = products.to_cols_array().into_iter().fold(0.0, |most: f64, entry| most.max(entry.abs()));
        let deviation = if axes.determinant() > 0.0 { off } else { off.max(2.0) };
        if deviation > RIGID {
            return Err(ViewError::NotRigid { deviation });
        }
        let rows = clip_from_view.transpose();
        let [x, y, z, w] = [rows.x_axis, rows.y_axis, rows.z_axis, rows.w_axis];
        let perspective = match w.to_array() {
            [0.0, 0.0, -1.0, 0.0] => true,
            [0.0, 0.0, 0.0, 1.0] => false,
            _ => return Err(ViewError::NoProjection),
        };
        let (offset, unused) = if perspective { ([-x.z, -y.z], [x.w, y.w]) } else { ([x.w, y.w], [x.z, y.z]) };
        if x.x <= 0.0 || y.y <= 0.0 || [x.y, y.x].into_iter().chain(unused).any(|entry| entry != 0.0) {
            return Err(ViewError::Sheared);
        }
        let (slope, depth) = (z.z, z.w);
        let projection = match perspective {
            true => Projection::Perspective {
                yfov: 2.0 * y.y.recip().atan(),
                near: depth / (1.0 + slope),
                far: (slope != 0.0).then_some(depth / slope),
            },
            false => Projection::Orthographic { ymag: y.y.recip(), near: (depth - 1.0) / slope, far: depth / slope },
        };
        let in_order = if perspective { slope >= 0.0 && depth > 0.0 } else { slope > 0.0 };
        if z.x != 0.0 || z.y != 0.0 || !in_order {
            return Err(ViewError::NotReversed);
        }
        let mut view = Self::new(world_from_view, projection, size);
        let centred = view.clip_from_view();
        let scale = DVec2::new(x.x / centred.x_axis.x, y.y / centred.y_axis.y);
        view.window = Window { scale, offset: offset.into() };
        Ok(view)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::dcamera::{lh, rh::proj::directx};
    use glam::{DVec3, DVec4};

    fn differ(a: DMat4, b: DMat4) -> f64 {
        (a - b).to_cols_array().into_iter().fold(0.0, |most: f64, entry| most.max(entry.abs()))
    }

    #[test]
    fn a_view_has_the_matrices_it_was_made_of() {
        let reversed = |near: f64, far: f64| DVec4::new(0.0, 0.0, near / (far - near), near * far / (far - near));
        let frustum = |offset: [f64; 2], z: DVec4| {
            DMat4::from_cols(
                DVec4::new(1.3, 0.0, -offset[0], 0.0),
                DVec4::new(0.0, 2.1, -offset[1], 0.0),
                z,
                DVec4::new(0.0, 0.0, -1.0, 0.0),
            )
            .transpose()
        };
        let parallel = DMat4::from_cols(
            DVec4::new(0.4, 0.0, 0.0, 0.3),
            DVec4::new(0.0, 0.9, 0.0, -0.6),
            DVec4::new(0.0, 0.0, 1.0 / 19.0, 20.0 / 19.0),
            DVec4::W,
        )
        .transpose();
        let turned = DAffine3::from_axis_angle(DVec3::new(0.6, 0.0, 0.8), 1.1) * DAffine3::from_translation(DVec3::ONE);
        for matrix in [
            directx::perspective_infinite_reverse(0.9, 2.0, 0.05),
            frustum([0.0; 2], DVec4::new(0.0, 0.0, 0.0, 0.2)),
            frustum([0.7, -1.9], DVec4::new(0.0, 0.0, 0.0, 0.2)),
            frustum([0.1, 0.2], reversed(0.5, 90.0)),
            parallel,
        ] {
            let view = View::from_matrices(turned, matrix, [300, 170]).expect("a view");
            let off = differ(view.clip_from_view(), matrix);
            assert!(off < 1e-12, "{matrix} became {}: {off}", view.clip_from_view());
            assert_eq!(view.world_from_view, turned);
        }
    }

    #[test]
    fn what_makes_no_view_says_why() {
        let good = directx::perspective_infinite_reverse(0.9, 2.0, 0.05);
        let make =
            |world_from_view, matrix| View::from_matrices(world_from_view, matrix, [10, 10]).expect_err("no view");
        let rigid = DAffine3::IDENTITY;
        assert_eq!(make(rigid, directx::perspective(0.9, 2.0, 0.1, 9.0)), ViewError::NotReversed);
        assert_eq!(make(rigid, directx::perspective_infinite(0.9, 2.0, 0.1)), ViewError::NotReversed);
        assert_eq!(
            make(rigid, lh::proj::directx::perspective_infinite_reverse(0.9, 2.0, 0.1)),
            ViewError::NoProjection
        );
        assert_eq!(make(rigid, good * DMat4::from_rotation_z(0.1)), ViewError::Sheared);
        assert_eq!(make(rigid, DMat4::from_scale(DVec3::new(1.0, -1.0, 1.0)) * good), ViewError::Sheared);
        assert_eq!(make(rigid, DMat4::NAN), ViewError::NotFinite);
        let scaled = make(DAffine3::from_scale(DVec3::splat(2.0)), good);
        assert!(matches!(scaled, ViewError::NotRigid { deviation } if (deviation - 3.0).abs() < 1e-12));
        let mirrored = make(DAffine3::from_scale(DVec3::new(-1.0, 1.0, 1.0)), good);
        assert!(matches!(mirrored, ViewError::NotRigid { .. }));
        assert_eq!(View::from_matrices(rigid, good, [0, 9]), Err(ViewError::NoPixels([0, 9])));
    }
}
