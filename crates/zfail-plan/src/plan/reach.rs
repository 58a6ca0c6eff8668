//! How far a light reaches: the scissor rectangle and the casters that its range and cone leave.
//!
//! In: a light and a view. Out: convex bounds of the lit region, relative to the eye.

use crate::bounds::Bounds;
use crate::light::LightKind;
use crate::scissor::{self, Rectangle};
use crate::view::View;
use glam::{DVec3, DVec4};

/// Sides of the pyramid around a spot light's cone.
const SIDES: usize = 8;
/// Wider cones are bounded by their half space alone.
const WIDEST: f64 = 1.4;

/// The region outside of which a light has no effect; everything is relative to the eye.
#[derive(Clone, Debug, Default)]
pub(super) struct Reach {
    ball: Option<(DVec3, f64)>,
    cone: Option<Cone>,
    /// The region is within `dot(xyz, p) + w >= 0` for all of these.
    pub planes: Vec<DVec4>,
}

#[derive(Clone, Copy, Debug)]
struct Cone {
    apex: DVec3,
    /// Unit directions of the edges of the pyramid around it, in a cycle; none for wide cones.
    edges: Option<[DVec3; SIDES]>,
}

impl Reach {
    /// No limits.
    pub fn clear(&mut self) {
        (self.ball, self.cone) = (None, None);
        self.planes.clear();
    }

    /// The reach of `kind`.
    pub fn set(&mut self, kind: &LightKind, eye: DVec3) {
        self.clear();
        if let LightKind::Point { position, range } | LightKind::Spot { position, range, .. } = *kind
            && range.is_finite()
        {
            let center = position - eye;
            self.ball = Some((center, range));
            for axis in [DVec3::X, DVec3::Y, DVec3::Z] {
                self.planes.push(axis.extend(range - axis.dot(center)));
                self.planes.push((-axis).extend(range + axis.dot(center)));
            }
        }
        if let LightKind::Spot { position, direction, outer, .. } = *kind {
            let apex = position - eye;
            // The edges of the pyramid that touches the cone along the middle of its sides.
            let edges = (outer < WIDEST).then(|| {
                let (u, v) = direction.any_orthonormal_pair();
                let radius = outer.tan() * (1.0 + 1e-6) / (std::f64::consts::PI / SIDES as f64).cos();
                std::array::from_fn(|i| {
                    let turn = std::f64::consts::TAU * i as f64 / SIDES as f64;
                    (direction + (u * turn.cos() + v * turn.sin()) * radius).normalize()
                })
            });
            self.planes.push(direction.extend(-direction.dot(apex)));
            if let Some(edges) = edges {
                for i in 0..SIDES {
                    let normal = edges[i].cross(edges[(i + 1) % SIDES]).normalize_or_zero();
                    let inward = normal * normal.dot(direction).signum();
                    self.planes.push(inward.extend(-inward.dot(apex)));
                }
            }
            self.cone = Some(Cone { apex, edges });
        }
    }

    /// Pixels whose surfaces the light may reach; `None` if there are none.
    pub fn scissor(&self, view: &View) -> Option<Rectangle> {
        let mut within = scissor::full(view);
        if let Some((center, radius)) = self.ball {
            within = scissor::intersection(within, scissor::of_ball(view, center, radius)?)?;
        }
        if let Some(Cone { apex, edges: Some(edges) }) = self.cone {
            let mut points = [apex.extend(1.0); SIDES + 1];
            for (point, edge) in points.iter_mut().zip(edges) {
                *point = edge.extend(0.0);
            }
            within = scissor::intersection(within, scissor::of_points(view, &points)?)?;
        }
        Some(within)
    }

    /// Whether nothing within a box (its world bounds, and the box itself as centre and half axes, all relative to the
    /// eye) can be lit, or can stand between the light and something lit.
    pub fn excludes(&self, world: &Bounds, center: DVec3, axes: [DVec3; 3]) -> bool {
        if let Some((middle, range)) = self.ball
            && world.distance_squared(middle) > range * range * (1.0 + 1e-9)
        {
            return true;
        }
        self.planes.iter().any(|plane| {
            let n = plane.truncate();
            let extent: f64 = axes.iter().map(|axis| n.dot(*axis).abs()).sum();
            let height = n.dot(center) + plane.w;
            height + extent < -1e-9 * (height.abs() + extent)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::view::Projection;
    use glam::DAffine3;

    fn spot(outer: f64, range: f64) -> LightKind {
        LightKind::Spot { position: DVec3::new(0.0, 0.0, -5.0), direction: DVec3::X, range, inner: 0.0, outer }
    }

    fn view() -> View {
        let projection = Projection::Perspective { yfov: std::f64::consts::FRAC_PI_2, near: 0.1, far: None };
        View::new(DAffine3::IDENTITY, projection, [100, 100])
    }

    fn excludes(reach: &Reach, center: DVec3, half: f64) -> bool {
        let world = Bounds { min: center - half, max: center + half };
        reach.excludes(&world, center, [DVec3::X * half, DVec3::Y * half, DVec3::Z * half])
    }

    #[test]
    fn a_cone_bounds_scissor_and_casters() {
        let mut reach = Reach::default();
        reach.set(&spot(0.3, f64::INFINITY), DVec3::ZERO);
        let [x, y, width, height] = reach.scissor(&view()).expect("in view");
        assert!(x.abs_diff(49) <= 1 && x + width == 100, "{x} {width}");
        // tan(0.3) = 0.31 either way at first, and more towards the eye: the image's whole height at its end.
        assert!(y < 40 && height > 20);
        assert!(!excludes(&reach, DVec3::new(3.0, 0.5, -5.0), 0.1), "within the cone");
        assert!(excludes(&reach, DVec3::new(3.0, 2.0, -5.0), 0.1), "beside the cone");
        assert!(excludes(&reach, DVec3::new(-1.0, 0.0, -5.0), 0.1), "behind the light");
        reach.set(&spot(0.3, 2.0), DVec3::ZERO);
        assert!(excludes(&reach, DVec3::new(3.0, 0.5, -5.0), 0.1), "out of range");
        reach.set(&spot(1.5, f64::INFINITY), DVec3::ZERO);
        assert!(!excludes(&reach, DVec3::new(0.1, 4.0, -5.0), 0.1), "a wide cone");
    }

    #[test]
    fn every_point_that_a_light_reaches_is_within() {
        let mut numbers = zfail_testing::Random(9);
        let mut random = || numbers.signed();
        let mut reached = 0;
        for _ in 0..400 {
            let position = DVec3::new(random(), random(), random() - 1.0) * 4.0;
            let direction = DVec3::new(random(), random(), random()).normalize();
            let (range, outer) = (1.0 + random().abs() * 4.0, 0.1 + 1.4 * random().abs());
            let kind = LightKind::Spot { position, direction, range, inner: 0.0, outer };
            let mut reach = Reach::default();
            reach.set(&kind, DVec3::ZERO);
            let within = reach.scissor(&view());
            for _ in 0..50 {
                let p = DVec3::new(random(), random(), random() - 1.0) * 6.0;
                if !kind.reaches(p) {
                    continue;
                }
                reached += 1;
                assert!(!excludes(&reach, p, 1e-6), "{p} of {kind:?}");
                let c = view().clip_from_relative() * p.extend(1.0);
                if c.w > 0.1 && c.x.abs() < c.w && c.y.abs() < c.w {
                    let [x, y, width, height] = within.expect("something is in view");
                    let pixel = [(50.0 + 50.0 * c.x / c.w) as u32, (50.0 - 50.0 * c.y / c.w) as u32];
                    assert!((x..x + width).contains(&pixel[0]) && (y..y + height).contains(&pixel[1]));
                }
            }
        }
        assert!(reached > 100, "{reached}");
    }
}
