//! Lights: where they are ([`LightKind`]), their colour, and what they do beyond physics.

use glam::{DMat3, DVec3};
use zfail_plan::bounds::OrientedBox;
use zfail_plan::light::LightKind;

/// A light in world space.
#[derive(Clone, Debug)]
pub struct Light {
    /// The light's or the node's name.
    pub name: String,
    /// Point, spot or directional, with its placement.
    pub kind: LightKind,
    /// Linear RGB, each component usually at most 1.
    pub color: [f32; 3],
    /// Candela for point and spot lights, lux for directional ones (KHR_lights_punctual).
    pub intensity: f32,
    /// Indices of instances that cast no shadow from this light (light extras `shadowExclude`).
    pub excluded: Vec<usize>,
    /// What the light does beyond physics; nothing by default.
    pub shape: LightShape,
}

/// Attenuation and projection to an artist's taste, for point and spot lights (McGuire et al. section 4). Directional
/// lights have none of it. The stencil's plan is not concerned: it goes by range and cone.
#[derive(Clone, Debug, PartialEq)]
pub struct LightShape {
    /// Irradiance per intensity, at equal steps from the light (first) to its range (last), linear between; none beyond.
    /// At least two samples, finite and not negative, and a finite range. It replaces the inverse-square law and the
    /// window of the range. None if empty (node extras `falloff`).
    pub falloff: Vec<f32>,
    /// Index into [`crate::Scene::textures`] of a picture, sRGB-encoded, that multiplies a spot light's colour. It fills
    /// the square around the outer cone: seen from the light, its top is at +y and its right at +x of
    /// [`Self::axes`]. The cone still ends the light (node extras `cookie`).
    pub cookie: Option<usize>,
    /// Half extents, metres, along [`Self::axes`] of a box around the light, beyond which it reaches nothing (node extras
    /// `box`).
    pub half_extents: Option<DVec3>,
    /// World from the light's own space: a rotation. The light shines along its -z axis; +y is up.
    pub axes: DMat3,
}

impl Default for LightShape {
    fn default() -> Self {
        Self { falloff: Vec::new(), cookie: None, half_extents: None, axes: DMat3::IDENTITY }
    }
}

impl LightShape {
    /// Whether the light is as physics has it.
    #[must_use]
    pub fn is_plain(&self) -> bool {
        self.falloff.is_empty() && self.cookie.is_none() && self.half_extents.is_none()
    }

    /// The value of [`Self::falloff`] at `share` of the range, 0 beyond; `None` if there is no such curve.
    #[must_use]
    pub fn falloff_at(&self, share: f64) -> Option<f64> {
        let &last = self.falloff.last()?;
        if share.is_nan() || share > 1.0 {
            return Some(0.0);
        }
        let x = share.max(0.0) * (self.falloff.len() - 1) as f64;
        let &from = self.falloff.get(x as usize)?;
        let to = f64::from(*self.falloff.get(x as usize + 1).unwrap_or(&last));
        Some(f64::from(from) + (to - f64::from(from)) * x.fract())
    }

    /// What is wrong with [`Self::falloff`] for a light of `kind`.
    #[must_use]
    pub fn falloff_problem(&self, kind: &LightKind) -> Option<&'static str> {
        if self.falloff.is_empty() {
            None
        } else if self.falloff.len() < 2 {
            Some("needs at least 2 samples")
        } else if !self.falloff.iter().all(|x| x.is_finite() && *x >= 0.0) {
            Some("needs samples that are finite and not negative")
        } else if !kind.range().is_some_and(f64::is_finite) {
            Some("needs a point or spot light with a finite range")
        } else {
            None
        }
    }

    /// What is wrong with [`Self::cookie`] for a light of `kind` in a scene of so many textures.
    #[must_use]
    pub fn cookie_problem(&self, kind: &LightKind, textures: usize) -> Option<&'static str> {
        let cookie = self.cookie?;
        if !matches!(kind, LightKind::Spot { .. }) {
            Some("needs a spot light")
        } else if cookie >= textures {
            Some("refers to a texture that is not there")
        } else {
            None
        }
    }

    /// What is wrong with [`Self::half_extents`] for a light of `kind`.
    #[must_use]
    pub fn box_problem(&self, kind: &LightKind) -> Option<&'static str> {
        let half = self.half_extents?;
        if kind.range().is_none() {
            Some("needs a point or spot light")
        } else if !(half.is_finite() && half.cmpgt(DVec3::ZERO).all()) {
            Some("needs half extents that are finite and greater than 0")
        } else {
            None
        }
    }
}

impl Light {
    /// [`LightShape::axes`], turned so that -z is a spot light's direction exactly; right-handed and of unit length.
    #[must_use]
    pub fn axes(&self) -> DMat3 {
        let axes = self.shape.axes;
        let back = match self.kind {
            LightKind::Spot { direction, .. } => -direction,
            _ => axes.z_axis.try_normalize().unwrap_or(DVec3::Z),
        };
        let up = axes.y_axis.reject_from_normalized(back);
        let up = up.try_normalize().unwrap_or_else(|| back.any_orthonormal_vector());
        DMat3::from_cols(up.cross(back), up, back)
    }

    /// Whether `point` lies within the light's range, cone and box (facing and shadows aside).
    #[must_use]
    pub fn reaches(&self, point: DVec3) -> bool {
        self.kind.reaches(point) && self.box_excess(point) <= 0.0
    }

    /// The box that ends what the light reaches, if it has one.
    #[must_use]
    pub fn bounds(&self) -> Option<OrientedBox> {
        let (LightKind::Point { position, .. } | LightKind::Spot { position, .. }) = self.kind else { return None };
        let half = self.shape.half_extents?;
        let axes = self.axes();
        let half_axes = [axes.x_axis * half.x, axes.y_axis * half.y, axes.z_axis * half.z];
        Some(OrientedBox { center: position, half_axes })
    }

    /// How far `point` is outside the light's box along the axis where it is farthest, metres; negative inside, and
    /// negative infinity if there is no box.
    #[must_use]
    pub fn box_excess(&self, point: DVec3) -> f64 {
        match (self.shape.half_extents, self.kind) {
            (Some(half), LightKind::Point { position, .. } | LightKind::Spot { position, .. }) => {
                let local = self.axes().transpose() * (point - position);
                (local.abs() - half).max_element()
            }
            _ => f64::NEG_INFINITY,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn light(kind: LightKind, shape: LightShape) -> Light {
        Light { name: String::new(), kind, color: [1.0; 3], intensity: 1.0, excluded: Vec::new(), shape }
    }

    const POINT: LightKind = LightKind::Point { position: DVec3::ZERO, range: 4.0 };

    #[test]
    fn a_curve_is_linear_between_its_samples_and_ends_with_the_range() {
        let shape = LightShape { falloff: vec![2.0, 1.0, 4.0], ..LightShape::default() };
        for (share, value) in [(0.0, 2.0), (0.25, 1.5), (0.5, 1.0), (0.75, 2.5), (1.0, 4.0), (1.001, 0.0)] {
            assert_eq!(shape.falloff_at(share), Some(value), "at {share}");
        }
        assert_eq!(shape.falloff_at(f64::NAN), Some(0.0));
        assert_eq!(LightShape::default().falloff_at(0.5), None);
    }

    #[test]
    fn bad_shapes_have_a_reason() {
        let sun = LightKind::Directional { direction: DVec3::NEG_Y };
        let spot = LightKind::Spot { position: DVec3::ZERO, direction: DVec3::X, range: 4.0, inner: 0.1, outer: 0.5 };
        let endless = LightKind::Point { position: DVec3::ZERO, range: f64::INFINITY };
        let curve = |falloff: &[f32], kind| {
            LightShape { falloff: falloff.to_vec(), ..LightShape::default() }.falloff_problem(kind).is_none()
        };
        assert!(curve(&[1.0, 0.0], &POINT) && curve(&[], &sun) && curve(&[0.0, 0.0, 3.0], &spot));
        assert!(!curve(&[1.0], &POINT) && !curve(&[1.0, -0.1], &POINT) && !curve(&[1.0, f32::NAN], &POINT));
        assert!(!curve(&[1.0, 0.0], &endless) && !curve(&[1.0, 0.0], &sun));
        let cookie =
            |index, kind| LightShape { cookie: Some(index), ..LightShape::default() }.cookie_problem(kind, 2).is_none();
        assert!(cookie(1, &spot) && !cookie(2, &spot) && !cookie(1, &POINT));
        let bounded =
            |half, kind| LightShape { half_extents: Some(half), ..LightShape::default() }.box_problem(kind).is_none();
        assert!(bounded(DVec3::ONE, &POINT) && !bounded(DVec3::ONE, &sun) && !bounded(DVec3::X, &POINT));
        assert!(!bounded(DVec3::new(1.0, f64::INFINITY, 1.0), &spot));
    }

    #[test]
    fn axes_follow_the_direction_of_a_spot_light() {
        let turned = DMat3::from_rotation_z(0.3);
        let shape = LightShape { axes: turned, ..LightShape::default() };
        assert!(light(POINT, shape.clone()).axes().abs_diff_eq(turned, 1e-15));
        for direction in [DVec3::NEG_Z, DVec3::X, DVec3::Y, DVec3::new(0.3, -0.2, 0.7).normalize()] {
            let kind = LightKind::Spot { position: DVec3::ZERO, direction, range: 1.0, inner: 0.1, outer: 0.5 };
            let axes = light(kind, shape.clone()).axes();
            assert!((axes.transpose() * axes).abs_diff_eq(DMat3::IDENTITY, 1e-12) && axes.determinant() > 0.0);
            assert_eq!(axes.z_axis, -direction);
        }
    }

    #[test]
    fn a_box_ends_the_reach_along_its_own_axes() {
        let half_extents = Some(DVec3::new(1.0, 2.0, 3.0));
        let shape = LightShape { half_extents, axes: DMat3::from_rotation_z(1.0), ..LightShape::default() };
        let lamp = light(POINT, shape);
        let at = |x: f64, y: f64| lamp.axes() * DVec3::new(x, y, -2.9);
        assert!(lamp.reaches(at(0.99, 0.0)) && !lamp.reaches(at(1.01, 0.0)) && !lamp.reaches(at(0.0, -2.1)));
        assert!(lamp.reaches(at(0.0, -1.99)) && !lamp.reaches(lamp.axes() * DVec3::new(0.0, 0.0, 3.1)));
        assert!((lamp.box_excess(at(1.25, 0.0)) - 0.25).abs() < 1e-12);
        assert!(!lamp.reaches(at(0.9, 1.9) * 2.0), "the range ends it too");
        assert_eq!(light(POINT, LightShape::default()).box_excess(DVec3::ONE), f64::NEG_INFINITY);
    }
}
