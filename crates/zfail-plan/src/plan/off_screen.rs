//! Which parts of a shadow volume come into view.
//!
//! In: a caster's box, its light and the scissored view. Out: whether sides, dark cap and light cap may cover a pixel
//! (McGuire et al. 2003, section 6, with points at infinity). Everything is homogeneous, so a point behind the eye or at
//! infinity is no special case: the volume of a box is the cone of its 8 corners and their 8 extrusions, and lies
//! outside a plane through the eye exactly if all 16 do.

use crate::bounds::Bounds;
use crate::casting::ObjectLight;
use crate::scissor::Rectangle;
use crate::view::{Projection, View};
use glam::{DAffine3, DMat4, DVec4};

/// Which parts of a volume to draw.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Parts {
    pub sides: bool,
    pub dark_cap: bool,
    pub light_cap: bool,
}

impl Parts {
    pub const ALL: Self = Self { sides: true, dark_cap: true, light_cap: true };

    /// The parts that either has.
    pub fn union(self, other: Self) -> Self {
        Self {
            sides: self.sides || other.sides,
            dark_cap: self.dark_cap || other.dark_cap,
            light_cap: self.light_cap || other.light_cap,
        }
    }
}

/// The parts of the volume of `bounds` (object space) that may be seen in the pixels `within`.
pub(super) fn visible_parts(
    view: &View,
    within: Rectangle,
    world_from_object: &DAffine3,
    bounds: &Bounds,
    light: ObjectLight,
) -> Parts {
    let clip_from_object = view.clip_from_view() * DMat4::from(view.view_from_object(world_from_object));
    let light = light.as_dvec4();
    let planes = planes(view, within);
    let heights = |points: [DVec4; 8]| {
        planes.map(|plane| {
            // Rounding relative to the terms of the product.
            let height = |p: DVec4| plane.dot(p) + 1e-9 * plane.abs().dot(p.abs());
            points.map(height).into_iter().fold(f64::NEG_INFINITY, f64::max)
        })
    };
    let corners = bounds.corners();
    let near = heights(corners.map(|c| clip_from_object * c.extend(1.0)));
    let far = heights(corners.map(|c| clip_from_object * (c * light.w - light.truncate()).extend(0.0)));
    let out = |heights: [f64; 5]| heights.iter().any(|&h| h < 0.0);
    // A plane that both leave outside; at infinity the border itself is outside.
    let sides_out = (0..5).any(|i| near[i] < 0.0 && far[i] <= 0.0);
    // Planes close the volumes of orthographic views, before infinity.
    let at_infinity = matches!(view.projection, Projection::Perspective { .. });
    let dark_cap_out = at_infinity && (light.w == 0.0 || out(far));
    Parts { sides: !sides_out, dark_cap: !dark_cap_out && !sides_out, light_cap: !out(near) }
}

/// The borders of a pixel rectangle, grown by a pixel, and the near plane, as inward planes in clip space.
fn planes(view: &View, [x, y, width, height]: Rectangle) -> [DVec4; 5] {
    let [columns, rows] = view.size.map(f64::from);
    let left = 2.0 * (f64::from(x) - 1.0) / columns - 1.0;
    let right = 2.0 * (f64::from(x + width) + 1.0) / columns - 1.0;
    let top = 1.0 - 2.0 * (f64::from(y) - 1.0) / rows;
    let bottom = 1.0 - 2.0 * (f64::from(y + height) + 1.0) / rows;
    [
        DVec4::new(1.0, 0.0, 0.0, -left),
        DVec4::new(-1.0, 0.0, 0.0, right),
        DVec4::new(0.0, 1.0, 0.0, -bottom),
        DVec4::new(0.0, -1.0, 0.0, top),
        // Reversed depth: z <= w from the near plane on.
        DVec4::new(0.0, 0.0, -1.0, 1.0),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{DVec3, Vec4};

    fn parts(center: DVec3, light: Vec4) -> Parts {
        let projection = Projection::Perspective { yfov: std::f64::consts::FRAC_PI_2, near: 0.1, far: None };
        let view = View::new(DAffine3::IDENTITY, projection, [100, 100]);
        let bounds = Bounds { min: center - 0.5, max: center + 0.5 };
        visible_parts(&view, [0, 0, 100, 100], &DAffine3::IDENTITY, &bounds, light)
    }

    #[test]
    fn parts_out_of_view_are_told_apart() {
        let light = Vec4::new(0.0, 0.0, 5.0, 1.0);
        // Behind the eye, with a volume that comes into view from there.
        assert_eq!(parts(DVec3::new(0.0, 0.0, 2.0), light), Parts { light_cap: false, ..Parts::ALL });
        // In front.
        assert_eq!(parts(DVec3::new(0.0, 0.0, -2.0), light), Parts::ALL);
        // To the left, away from a light at the right: never in view.
        let right = Vec4::new(5.0, 0.0, -3.0, 1.0);
        assert_eq!(parts(DVec3::new(-9.0, 0.0, -3.0), right), Parts::default());
        // To the left of a light further left: sides and dark cap cross the view.
        let left = Vec4::new(-20.0, 0.0, -3.0, 1.0);
        assert!(!parts(DVec3::new(-9.0, 0.0, -3.0), left).light_cap);
        assert!(parts(DVec3::new(-9.0, 0.0, -3.0), left).sides);
        // Parallel rays have no dark cap.
        assert!(!parts(DVec3::new(0.0, 0.0, -2.0), Vec4::new(0.0, 1.0, 0.0, 0.0)).dark_cap);
    }

    /// Every point of a volume that projects into the rectangle keeps its part.
    #[test]
    fn what_can_be_seen_is_kept() {
        let projection = Projection::Perspective { yfov: 1.0, near: 0.1, far: None };
        let view = View::new(DAffine3::IDENTITY, projection, [64, 48]);
        let within = [10, 5, 20, 30];
        let mut numbers = zfail_testing::Random(5);
        let mut random = || numbers.signed();
        let (mut seen, mut culled) = (0, 0);
        for round in 0..3000 {
            let center = DVec3::new(random(), random(), random()) * 6.0;
            let bounds = Bounds { min: center - 0.3, max: center + 0.3 };
            let at = DVec3::new(random(), random(), random()) * 6.0;
            let light = if round % 2 == 0 { at.extend(1.0) } else { at.extend(0.0) };
            let parts = visible_parts(&view, within, &DAffine3::IDENTITY, &bounds, light.as_vec4());
            culled += usize::from(!parts.sides);
            for _ in 0..40 {
                let p = center + 0.3 * DVec3::new(random(), random(), random());
                let away = p * light.w - light.truncate();
                let t = 20.0 * random().abs();
                for (point, kept) in [(p + away * t, parts.sides), (p, parts.light_cap)] {
                    let c = view.clip_from_view() * point.extend(1.0);
                    let [px, py] = [32.0 + 32.0 * c.x / c.w, 24.0 - 24.0 * c.y / c.w];
                    if c.w > 0.1 && (10.0..30.0).contains(&px) && (5.0..35.0).contains(&py) {
                        seen += 1;
                        assert!(kept, "{point} of {bounds:?} from {light}");
                    }
                }
            }
        }
        assert!(seen > 1000 && culled > 500, "{seen} seen, {culled} culled");
    }
}
