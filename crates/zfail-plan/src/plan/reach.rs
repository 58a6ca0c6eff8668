//! How far a light reaches: the scissor rectangle and the casters that its range, cone and box leave.
//!
//! In: a light and a view. Out: convex bounds of the lit region, relative to the eye. A box bounds what artists make of a
//! light's attenuation better than a sphere (McGuire et al. 2003, section 4), the sphere of its half diagonal in particular.

use super::ShadowLight;
use crate::bounds::{Bounds, OrientedBox};
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
    bounds: Option<OrientedBox>,
    /// What is lit is within `dot(xyz, p) + w >= 0` for all of these.
    pub planes: Vec<DVec4>,
    /// For so many of them, the first, the light is within too, and with it all that can stand between it and what is lit.
    around_light: usize,
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
        (self.ball, self.cone, self.bounds) = (None, None, None);
        self.planes.clear();
        self.around_light = 0;
    }

    /// The reach of `light`.
    pub fn set(&mut self, light: &ShadowLight<'_>, eye: DVec3) {
        self.clear();
        let kind = &light.kind;
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
        self.around_light = self.planes.len();
        self.bounds = light.bounds.map(|bounds| {
            let bounds = bounds.relative_to(eye);
            // Whoever shades compares with less precision.
            let extent = bounds.corners().iter().map(|corner| corner.length()).fold(0.0, f64::max);
            bounds.grown(1e-6 * extent)
        });
        if let Some(bounds) = self.bounds {
            let homogeneous = kind.homogeneous();
            let relative = (homogeneous.truncate() - eye * homogeneous.w).extend(homogeneous.w);
            for plane in bounds.planes() {
                self.planes.push(plane);
                if plane.dot(relative) >= 0.0 {
                    let last = self.planes.len() - 1;
                    self.planes.swap(self.around_light, last);
                    self.around_light += 1;
                }
            }
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
        if let Some(bounds) = self.bounds {
            let corners = bounds.corners().map(|corner| corner.extend(1.0));
            within = scissor::intersection(within, scissor::of_points(view, &corners)?)?;
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
        self.planes[..self.around_light].iter().any(|plane| {
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

    fn set(reach: &mut Reach, kind: LightKind, bounds: Option<OrientedBox>) {
        reach.set(&ShadowLight::new(kind).within(bounds), DVec3::ZERO);
    }

    fn excludes(reach: &Reach, center: DVec3, half: f64) -> bool {
        let world = Bounds { min: center - half, max: center + half };
        reach.excludes(&world, center, [DVec3::X * half, DVec3::Y * half, DVec3::Z * half])
    }

    #[test]
    fn a_cone_bounds_scissor_and_casters() {
        let mut reach = Reach::default();
        set(&mut reach, spot(0.3, f64::INFINITY), None);
        let [x, y, width, height] = reach.scissor(&view()).expect("in view");
        assert!(x.abs_diff(49) <= 1 && x + width == 100, "{x} {width}");
        // tan(0.3) = 0.31 either way at first, and more towards the eye: the image's whole height at its end.
        assert!(y < 40 && height > 20);
        assert!(!excludes(&reach, DVec3::new(3.0, 0.5, -5.0), 0.1), "within the cone");
        assert!(excludes(&reach, DVec3::new(3.0, 2.0, -5.0), 0.1), "beside the cone");
        assert!(excludes(&reach, DVec3::new(-1.0, 0.0, -5.0), 0.1), "behind the light");
        set(&mut reach, spot(0.3, 2.0), None);
        assert!(excludes(&reach, DVec3::new(3.0, 0.5, -5.0), 0.1), "out of range");
        set(&mut reach, spot(1.5, f64::INFINITY), None);
        assert!(!excludes(&reach, DVec3::new(0.1, 4.0, -5.0), 0.1), "a wide cone");
    }

    #[test]
    fn a_box_bounds_scissor_and_casters() {
        let half_axes = [DVec3::X * 0.5, DVec3::Y * 2.0, DVec3::Z * 0.5];
        let lamp = LightKind::Point { position: DVec3::new(0.0, 0.0, -5.0), range: f64::INFINITY };
        let at = |center| Some(OrientedBox { center, half_axes });
        let mut reach = Reach::default();
        set(&mut reach, lamp, at(DVec3::new(0.0, 0.0, -5.0)));
        // 50 pixels for a tangent of 1; the near faces are at depth 4.5.
        assert_eq!(reach.scissor(&view()), Some([43, 26, 14, 48]));
        assert!(!excludes(&reach, DVec3::new(0.0, 1.9, -5.0), 0.05), "within the box");
        assert!(excludes(&reach, DVec3::new(0.7, 0.0, -5.0), 0.1), "within the sphere around it");
        // A light beside its box: what lies between casts into it.
        set(&mut reach, lamp, at(DVec3::new(3.0, 0.0, -5.0)));
        assert!(!excludes(&reach, DVec3::new(1.5, 0.0, -5.0), 0.1), "between them");
        assert!(excludes(&reach, DVec3::new(4.0, 0.0, -5.0), 0.1), "beyond the box");
        assert!(excludes(&reach, DVec3::new(1.5, 0.0, -4.0), 0.1), "beside the way");
        let sun = LightKind::Directional { direction: DVec3::NEG_Y };
        set(&mut reach, sun, at(DVec3::new(0.0, 0.0, -5.0)));
        assert!(!excludes(&reach, DVec3::new(0.0, 90.0, -5.0), 0.1), "above the box");
        assert!(excludes(&reach, DVec3::new(0.0, -3.0, -5.0), 0.1), "below it");
        set(&mut reach, lamp, at(DVec3::new(0.0, 0.0, 5.0)));
        assert_eq!(reach.scissor(&view()), None, "behind the eye");
    }

    #[test]
    fn every_point_that_a_light_reaches_is_within() {
        let mut numbers = zfail_testing::Random(9);
        let mut random = || numbers.signed();
        let mut reached = 0;
        for _ in 0..600 {
            let position = DVec3::new(random(), random(), random() - 1.0) * 4.0;
            let direction = DVec3::new(random(), random(), random()).normalize();
            let (range, outer) = (1.0 + random().abs() * 4.0, 0.1 + 1.4 * random().abs());
            let kind = LightKind::Spot { position, direction, range, inner: 0.0, outer };
            let (u, v) = direction.any_orthonormal_pair();
            let half_axes = [direction * (0.5 + random().abs() * 3.0), u * (0.2 + random().abs() * 2.0), v * 1.5];
            let bounds = Some(OrientedBox { center: position, half_axes }).filter(|_| range > 3.0);
            let inside = |p: DVec3| {
                bounds.is_none_or(|b| b.planes().iter().all(|plane| plane.truncate().dot(p) + plane.w >= 0.0))
            };
            let mut reach = Reach::default();
            set(&mut reach, kind, bounds);
            let within = reach.scissor(&view());
            for _ in 0..50 {
                let p = DVec3::new(random(), random(), random() - 1.0) * 6.0;
                if !(kind.reaches(p) && inside(p)) {
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
