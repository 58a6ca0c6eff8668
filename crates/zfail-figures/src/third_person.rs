//! The camera of figures that show the eye itself.
//!
//! In: what is to be seen, the eye's directions, orbit angles. Out: a camera from which everything fits the image.

use crate::ThirdPerson;
use zfail_plan::glam::{DAffine3, DMat3, DMat4, DQuat, DVec2, DVec3, DVec4};
use zfail_plan::view::{Projection, View};

/// Vertical field of view, radians: long enough a lens that distances compare.
const FOV: f64 = 0.5;

/// A camera in the space of a drawing.
#[derive(Clone, Copy, Debug)]
pub struct Camera {
    pub clip_from_origin: DMat4,
    pub position: DVec3,
    /// Of the image, pixels.
    pub size: [u32; 2],
}

impl Camera {
    /// Looks at `points`, turned by `from` against an eye that looks along `forward`; y is up.
    pub fn around(points: &[DVec3], forward: DVec3, up: DVec3, from: ThirdPerson, size: [u32; 2]) -> Self {
        // Who looks straight down has the top of the image in front.
        let level = |d: DVec3| d.reject_from_normalized(DVec3::Y).try_normalize();
        let ahead = if forward.y.abs() < 0.98 { level(forward) } else { level(up * -forward.y.signum()) };
        let heading = DQuat::from_rotation_y(from.yaw) * ahead.unwrap_or(DVec3::NEG_Z);
        let axis = heading * from.pitch.cos() - DVec3::Y * from.pitch.sin();
        let right = axis.cross(DVec3::Y).normalize();
        let basis = DMat3::from_cols(right, right.cross(axis), -axis);

        let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        for p in points {
            let p = basis.transpose() * *p;
            (low, high) = (low.min(p), high.max(p));
        }
        if !(low.is_finite() && high.is_finite()) {
            (low, high) = (DVec3::NEG_ONE, DVec3::ONE);
        }
        let center = (low + high) * 0.5;
        let slope_y = (0.5 * FOV).tan() / (1.08 / from.zoom);
        let slope = DVec2::new(slope_y * f64::from(size[0]) / f64::from(size[1]), slope_y);
        let needed = |p: &DVec3| {
            let q = basis.transpose() * *p - center;
            (q.truncate().abs() / slope).max_element() + q.z
        };
        let extent = (high - low).length().max(1e-6);
        let distance = points.iter().map(needed).fold(0.05 * extent, f64::max);
        let position = basis * (center + DVec3::Z * distance);
        let projection = Projection::Perspective { yfov: FOV, near: 0.01 * distance, far: None };
        let view = View::new(DAffine3 { matrix3: basis, translation: position }, projection, size);
        let clip_from_origin = view.clip_from_relative() * DMat4::from_translation(-position);
        Self { clip_from_origin, position, size }
    }

    /// The pixel at which a homogeneous point appears, from the upper left corner; `None` behind the camera.
    pub fn pixel(&self, p: DVec4) -> Option<[f32; 2]> {
        let clip = self.clip_from_origin * p;
        (clip.w - clip.z > 0.0).then(|| {
            let [width, height] = self.size.map(f64::from);
            [(0.5 + 0.5 * clip.x / clip.w) * width, (0.5 - 0.5 * clip.y / clip.w) * height].map(|x| x as f32)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use zfail_plan::bounds::Bounds;

    #[test]
    fn everything_fits_the_image_and_fills_it() {
        let points = Bounds { min: DVec3::new(-1.0, 3.0, 2.0), max: DVec3::new(9.0, 5.0, 4.0) }.corners();
        for (forward, size) in [(DVec3::NEG_Z, [300, 200]), (DVec3::NEG_Y, [100, 400]), (DVec3::X, [64, 64])] {
            let camera = Camera::around(&points, forward, DVec3::Z, ThirdPerson::default(), size);
            let pixels: Vec<[f32; 2]> = points.iter().filter_map(|p| camera.pixel(p.extend(1.0))).collect();
            assert_eq!(pixels.len(), 8);
            let share = |axis: usize| {
                let all = pixels.iter().map(|p| p[axis] / size[axis] as f32);
                let (low, high) = all.fold((1.0_f32, 0.0_f32), |(low, high), x| (low.min(x), high.max(x)));
                assert!(low > 0.0 && high < 1.0, "{low} {high}");
                high - low
            };
            let (x, y) = (share(0), share(1));
            assert!(x.max(y) > 0.6, "{x} {y}");
        }
        let nothing = Camera::around(&[], DVec3::NAN, DVec3::Y, ThirdPerson::default(), [8, 8]);
        assert!(nothing.pixel(DVec4::W).is_some());
    }
}
