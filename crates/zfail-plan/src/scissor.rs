//! The pixels that a convex set can cover.
//!
//! In: its corner points, or a ball, relative to the eye, and the view. Out: a pixel rectangle that holds its projection
//! (Lengyel 2002; McGuire et al. 2003, section 6, `projectBoundsAgainstViewport`, with clipping at the near plane).

use crate::view::{Projection, View};
use glam::{DVec2, DVec3, DVec4};

/// A pixel rectangle: x, y of the upper left pixel, width, height.
pub type Rectangle = [u32; 4];

/// The whole image.
#[must_use]
pub fn full(view: &View) -> Rectangle {
    [0, 0, view.size[0], view.size[1]]
}

/// What both rectangles cover, if anything.
#[must_use]
pub fn intersection(a: Rectangle, b: Rectangle) -> Option<Rectangle> {
    let axis = |i: usize| {
        let (first, last) = (a[i].max(b[i]), (a[i] + a[i + 2]).min(b[i] + b[i + 2]));
        (first < last).then(|| (first, last - first))
    };
    let ((x, width), (y, height)) = (axis(0)?, axis(1)?);
    Some([x, y, width, height])
}

/// The least rectangle around both.
#[must_use]
pub fn union(a: Rectangle, b: Rectangle) -> Rectangle {
    let axis = |i: usize| (a[i].min(b[i]), (a[i] + a[i + 2]).max(b[i] + b[i + 2]));
    let ((x0, x1), (y0, y1)) = (axis(0), axis(1));
    [x0, y0, x1 - x0, y1 - y0]
}

/// The rectangle around the convex hull of homogeneous `points` (world directions, relative to the eye; w = 0 at infinity,
/// w = 1 elsewhere) in `view`, a pixel larger than needed, or `None` where nothing of it is visible.
#[must_use]
pub fn of_points(view: &View, points: &[DVec4]) -> Option<Rectangle> {
    let clip_from_relative = view.clip_from_relative();
    let clip = |p: &DVec4| clip_from_relative * *p;
    // Depth beyond the near plane, linear in clip space: z <= w in reversed depth.
    let inside = |c: &DVec4| c.w - c.z;

    let mut extent = Extent::EMPTY;
    for p in points {
        let c = clip(p);
        if inside(&c) < 0.0 {
            continue;
        }
        extent.add(c);
        for q in points {
            let d = clip(q);
            if inside(&d) < 0.0 {
                // Every pair, not only hull edges: the extra points lie inside the hull.
                let t = inside(&c) / (inside(&c) - inside(&d));
                extent.add(c + (d - c) * t);
            }
        }
    }
    extent.rectangle(view)
}

/// The same for points that all lie in front of the near plane, relative to the eye.
#[must_use]
pub fn of_visible(view: &View, points: &[DVec3]) -> Option<Rectangle> {
    let clip_from_relative = view.clip_from_relative();
    let mut extent = Extent::EMPTY;
    for p in points {
        extent.add(clip_from_relative * p.extend(1.0));
    }
    extent.rectangle(view)
}

/// The rectangle around the ball of `radius` about `center` (relative to the eye), exact up to a pixel, or `None` where
/// nothing of it is visible. Per axis the tangents from the eye, or where the near plane cuts them off the ball's section
/// with it (Lengyel 2002; Mara & McGuire 2013, "2D Polyhedral Bounds of a Clipped, Perspective-Projected 3D Sphere").
#[must_use]
pub fn of_ball(view: &View, center: DVec3, radius: f64) -> Option<Rectangle> {
    let at = view.world_from_view.matrix3.transpose() * center;
    let depth = -at.z;
    let near = view.near();
    // Also false for a radius that is not a number.
    if !(radius.is_finite() && center.is_finite()) {
        return Some(full(view));
    }
    if depth + radius <= near {
        return None;
    }
    let windowed = |[x, y]: [f64; 2]| (view.window.scale * DVec2::new(x, y) + view.window.offset).to_array();
    let mut extent = Extent::EMPTY;
    match view.projection {
        Projection::Orthographic { ymag, .. } => {
            let xmag = ymag * view.aspect();
            for sign in [-1.0, 1.0] {
                extent.add_ndc(windowed([(at.x + sign * radius) / xmag, (at.y + sign * radius) / ymag]));
            }
        }
        Projection::Perspective { yfov, .. } => {
            let scale_y = 1.0 / (0.5 * yfov).tan();
            let scale = [scale_y / view.aspect(), scale_y];
            let [across, up] = [at.x, at.y].map(|offset| tangents(offset, depth, radius, near));
            for (x, y) in across.into_iter().zip(up) {
                extent.add_ndc(windowed([x * scale[0], y * scale[1]]));
            }
        }
    }
    extent.rectangle(view)
}

/// Least and greatest slope (across over depth) of the visible part of a disc.
fn tangents(across: f64, depth: f64, radius: f64, near: f64) -> [f64; 2] {
    let distance_squared = across * across + depth * depth;
    let tangent_squared = distance_squared - radius * radius;
    [-1.0, 1.0].map(|side| {
        if tangent_squared > 0.0 {
            let tangent = tangent_squared.sqrt();
            // Where the tangent touches the disc.
            let z = tangent_squared * depth - side * tangent * radius * across;
            let x = tangent_squared * across + side * tangent * radius * depth;
            if z / distance_squared >= near {
                return x / z;
            }
        }
        (across + side * (radius * radius - (depth - near) * (depth - near)).max(0.0).sqrt()) / near
    })
}

/// The extent of projected points, in normalised device coordinates.
#[derive(Clone, Copy, Debug)]
struct Extent {
    min: [f64; 2],
    max: [f64; 2],
}

impl Extent {
    const EMPTY: Self = Self { min: [f64::INFINITY; 2], max: [f64::NEG_INFINITY; 2] };

    fn add(&mut self, c: DVec4) {
        // A direction across the view: its vanishing point lies at infinity, to one side.
        let tiny = 1e-12 * c.truncate().abs().max_element();
        if c.w <= tiny {
            for (i, v) in [c.x, c.y].into_iter().enumerate().filter(|(_, v)| v.abs() > tiny) {
                let end = if v > 0.0 { &mut self.max[i] } else { &mut self.min[i] };
                *end = f64::INFINITY.copysign(v);
            }
            return;
        }
        self.add_ndc([c.x / c.w, c.y / c.w]);
    }

    fn add_ndc(&mut self, point: [f64; 2]) {
        for (i, v) in point.into_iter().enumerate() {
            self.min[i] = self.min[i].min(v);
            self.max[i] = self.max[i].max(v);
        }
    }

    fn rectangle(&self, view: &View) -> Option<Rectangle> {
        let [width, height] = view.size;
        let across = pixels(0.5 + 0.5 * self.min[0], 0.5 + 0.5 * self.max[0], width)?;
        let down = pixels(0.5 - 0.5 * self.max[1], 0.5 - 0.5 * self.min[1], height)?;
        Some([across.0, down.0, across.1 - across.0, down.1 - down.0])
    }
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
    use crate::bounds::Bounds;
    use glam::DAffine3;

    fn view() -> View {
        let projection = Projection::Perspective { yfov: std::f64::consts::FRAC_PI_2, near: 0.1, far: None };
        View::new(DAffine3::IDENTITY, projection, [200, 100])
    }

    fn of(points: &[DVec3]) -> Option<Rectangle> {
        of_points(&view(), &points.iter().map(|p| p.extend(1.0)).collect::<Vec<_>>())
    }

    #[test]
    fn a_point_ahead_gets_a_small_rectangle_around_its_pixel() {
        // 90 degrees over 100 rows: at distance 1, half a unit up is a quarter of the image: row 24.5.
        assert_eq!(of(&[DVec3::new(0.0, 0.51, -1.0)]), Some([99, 23, 2, 3]));
    }

    #[test]
    fn a_box_around_the_eye_covers_everything() {
        let corners = Bounds { min: DVec3::splat(-1.0), max: DVec3::splat(1.0) }.corners();
        assert_eq!(of(&corners), Some([0, 0, 200, 100]));
    }

    #[test]
    fn what_lies_behind_or_beside_is_not_visible() {
        assert_eq!(of(&[DVec3::new(0.0, 0.0, 1.0)]), None);
        assert_eq!(of(&[DVec3::new(100.0, 0.0, -1.0)]), None);
        assert_eq!(of_ball(&view(), DVec3::new(0.0, 0.0, 2.0), 1.0), None);
        assert_eq!(of_ball(&view(), DVec3::new(9.0, 0.0, -1.0), 1.0), None);
    }

    #[test]
    fn points_at_infinity_cover_up_to_their_vanishing_points() {
        let ray = [DVec4::new(0.0, 0.0, -1.0, 1.0), DVec4::new(1.0, 0.0, -1.0, 0.0)];
        // From the middle to 45 degrees, half the image's width being 63 degrees.
        assert_eq!(of_points(&view(), &ray), Some([99, 49, 52, 2]));
    }

    #[test]
    fn the_rectangle_of_a_ball_is_that_of_many_points_on_it() {
        let mut numbers = zfail_testing::Random(1);
        let mut random = || numbers.signed();
        let mut seen = 0;
        for _ in 0..300 {
            let center = DVec3::new(random(), random(), random() - 0.7) * 3.0;
            let radius = 0.2 + random().abs();
            let dense: Vec<DVec3> = (0..20_000)
                .map(|i| {
                    // Fibonacci lattice.
                    let y = 1.0 - 2.0 * (f64::from(i) + 0.5) / 20_000.0;
                    let turn = f64::from(i) * 2.399_963_229_728_653;
                    let r = (1.0 - y * y).sqrt();
                    center + radius * DVec3::new(r * turn.cos(), y, r * turn.sin())
                })
                .filter(|p| -p.z >= 0.1)
                .collect();
            let exact = of_ball(&view(), center, radius);
            // Without the eye inside, the visible rim is sampled to within a few pixels.
            let sampled = dense.iter().fold(Extent::EMPTY, |mut e, p| {
                e.add(view().clip_from_relative() * p.extend(1.0));
                e
            });
            let Some(sampled) = (!dense.is_empty()).then(|| sampled.rectangle(&view())).flatten() else { continue };
            let exact = exact.expect("points of it are visible");
            assert_eq!(intersection(exact, sampled), Some(sampled), "ball {center} {radius}: {exact:?}");
            let slack = (0..4).map(|i| exact[i].abs_diff(sampled[i])).max();
            // A section with the near plane is covered sparsely.
            if center.length() > radius + 0.5 && -center.z > radius + 0.2 {
                assert!(slack <= Some(3), "ball {center} {radius}: {exact:?} for {sampled:?}");
                seen += 1;
            }
        }
        assert!(seen > 20, "only {seen} balls in full view");
    }
}
