//! The pixels that a convex set can cover.
//!
//! In: its corner points in world space and the view. Out: a pixel rectangle that holds its projection
//! (Lengyel 2002; McGuire et al. 2003, section 6, `projectBoundsAgainstViewport`, with clipping at the near plane).

use crate::view::View;
use glam::{DMat4, DVec3, DVec4};

/// A pixel rectangle: x, y of the upper left pixel, width, height.
pub type Rectangle = [u32; 4];

/// The rectangle around the convex hull of `points` (world space) in `view`, a pixel larger than needed, or `None`
/// where nothing of it is visible.
#[must_use]
pub fn rectangle(view: &View, points: &[DVec3]) -> Option<Rectangle> {
    // Relative to the eye, so that far-away scenes keep their digits.
    let view_from_world = view.world_from_view.matrix3.transpose();
    let clip_from_view: DMat4 = view.clip_from_view();
    let clip = |p: &DVec3| clip_from_view * (view_from_world * (*p - view.eye())).extend(1.0);
    // Depth beyond the near plane, linear in clip space: z <= w in reversed depth.
    let inside = |c: &DVec4| c.w - c.z;

    let mut min = [f64::INFINITY; 2];
    let mut max = [f64::NEG_INFINITY; 2];
    let mut add = |c: DVec4| {
        for (i, v) in [c.x / c.w, c.y / c.w].into_iter().enumerate() {
            min[i] = min[i].min(v);
            max[i] = max[i].max(v);
        }
    };
    for p in points {
        let c = clip(p);
        if inside(&c) < 0.0 {
            continue;
        }
        add(c);
        for q in points {
            let d = clip(q);
            if inside(&d) < 0.0 {
                // Every pair, not only hull edges: the extra points lie inside the hull.
                let t = inside(&c) / (inside(&c) - inside(&d));
                add(c + (d - c) * t);
            }
        }
    }
    let [width, height] = view.size;
    let across = pixels(0.5 + 0.5 * min[0], 0.5 + 0.5 * max[0], width)?;
    let down = pixels(0.5 - 0.5 * max[1], 0.5 - 0.5 * min[1], height)?;
    Some([across.0, down.0, across.1 - across.0, down.1 - down.0])
}

/// The whole image.
#[must_use]
pub fn full(view: &View) -> Rectangle {
    [0, 0, view.size[0], view.size[1]]
}

/// First pixel and one past the last of the interval `lo..hi` (in units of the image), grown by one and clamped.
fn pixels(lo: f64, hi: f64, size: u32) -> Option<(u32, u32)> {
    let extent = f64::from(size);
    let first = (lo * extent).floor() - 1.0;
    let last = (hi * extent).ceil() + 1.0;
    // `max` and `min` drop NaN in favour of the whole extent, the safe side.
    let first = first.max(0.0).min(extent) as u32;
    let last = last.min(extent).max(0.0) as u32;
    (first < last).then_some((first, last))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::view::Projection;
    use glam::DAffine3;

    fn view() -> View {
        let projection = Projection::Perspective { yfov: std::f64::consts::FRAC_PI_2, near: 0.1, far: None };
        View { world_from_view: DAffine3::IDENTITY, projection, size: [200, 100] }
    }

    #[test]
    fn a_point_ahead_gets_a_small_rectangle_around_its_pixel() {
        // 90 degrees over 100 rows: at distance 1, half a unit up is a quarter of the image: row 24.5.
        let r = rectangle(&view(), &[DVec3::new(0.0, 0.51, -1.0)]).expect("visible");
        assert_eq!(r, [99, 23, 2, 3]);
    }

    #[test]
    fn a_box_around_the_eye_covers_everything() {
        let corners = crate::scene::Bounds { min: DVec3::splat(-1.0), max: DVec3::splat(1.0) }.corners();
        assert_eq!(rectangle(&view(), &corners), Some([0, 0, 200, 100]));
    }

    #[test]
    fn what_lies_behind_or_beside_is_not_visible() {
        assert_eq!(rectangle(&view(), &[DVec3::new(0.0, 0.0, 1.0)]), None);
        assert_eq!(rectangle(&view(), &[DVec3::new(100.0, 0.0, -1.0)]), None);
    }
}
