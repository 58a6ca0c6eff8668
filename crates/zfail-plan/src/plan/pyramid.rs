//! The occlusion pyramid: everything between the light and the near rectangle (McGuire et al. 2003, section 6).
//!
//! In: the near rectangle, grown to a slab that covers rounding, and the light, both in a caster's object space. Out:
//! whether a box or an edge keeps clear of their convex hull. Where a whole caster does, no point of the near rectangle
//! is in its shadow, and counting in front of the visible surface equals counting behind it.
//!
//! A plane through an edge of the rectangle and the light bounds the hull whatever its orientation, once its offset is
//! the least over all the hull's points. So there is no degenerate case: a light on the near plane, behind it or inside
//! the view only makes planes that exclude little.

use crate::bounds::Bounds;
use crate::casting::ObjectLight;
use crate::scissor::Rectangle;
use crate::view::{Projection, View};
use glam::{DAffine3, DVec2, DVec3};

/// The part of the near rectangle behind pixels `within`, grown by 2 % and by `pad` (world units) to either side and to
/// both depths: eight corners relative to the eye, the nearer four first, each four in a cycle.
pub(super) fn near_slab(view: &View, within: Rectangle, pad: f64) -> [DVec3; 8] {
    let near = view.near();
    let spread = if matches!(view.projection, Projection::Perspective { .. }) { near } else { 1.0 };
    let [x, y, width, height] = within.map(f64::from);
    let [columns, rows] = view.size.map(f64::from);
    let lower = DVec2::new(2.0 * x / columns - 1.0, 1.0 - 2.0 * (y + height) / rows);
    let upper = DVec2::new(2.0 * (x + width) / columns - 1.0, 1.0 - 2.0 * y / rows);
    let corners = [lower, upper].map(|ndc| view.on_image_plane(ndc) * spread);
    let span: [[f64; 2]; 2] = std::array::from_fn(|i| {
        let [lo, hi] = corners.map(|corner| corner[i]);
        let grown = 0.02 * (hi - lo) + pad;
        [lo - grown, hi + grown]
    });
    let corner =
        |x: usize, y: usize, depth: f64| view.world_from_view.matrix3 * DVec3::new(span[0][x], span[1][y], -depth);
    let layer = |depth| [corner(0, 0, depth), corner(1, 0, depth), corner(1, 1, depth), corner(0, 1, depth)];
    let ([a, b, c, d], [e, f, g, h]) = (layer(near - pad), layer(near + pad));
    [a, b, c, d, e, f, g, h]
}

/// How far rounding may move a vertex at most `reach` from the eye, near the near plane.
pub(super) fn pad(view: &View, reach: f64) -> f64 {
    (0.01 * view.near().abs()).max(1e-5 * reach)
}

/// The convex hull of a light and a near slab, or a region somewhat larger.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Pyramid {
    /// The region is `dot(normal, x) >= offset` for all of these.
    planes: [(DVec3, f64); 18],
    pub slab: [DVec3; 8],
    pub light: ObjectLight,
}

impl Pyramid {
    /// The pyramid over a slab (relative to the eye) and a light, in the object space that `object_from_relative` leads to.
    pub fn new(slab: [DVec3; 8], object_from_relative: &DAffine3, light: ObjectLight) -> Self {
        let slab = slab.map(|p| object_from_relative.transform_point3(p));
        let (at, w) = (light.truncate().as_dvec3(), f64::from(light.w));
        let mut planes = [(DVec3::ZERO, f64::NEG_INFINITY); 18];
        let mut normals = [DVec3::ZERO; 9];
        for i in 0..8 {
            let next = (i & 4) | ((i + 1) & 3);
            normals[i] = (slab[next] - slab[i]).cross(at - slab[i] * w);
        }
        normals[8] = (slab[1] - slab[0]).cross(slab[3] - slab[0]);
        for (pair, normal) in planes.chunks_exact_mut(2).zip(normals) {
            let [mut least, mut greatest] = [f64::INFINITY, f64::NEG_INFINITY];
            for p in slab {
                let d = normal.dot(p);
                least = least.min(d);
                greatest = greatest.max(d);
            }
            let d = normal.dot(at);
            if w != 0.0 {
                least = least.min(d);
                greatest = greatest.max(d);
            } else if d < 0.0 {
                least = f64::NEG_INFINITY;
            } else if d > 0.0 {
                greatest = f64::INFINITY;
            }
            pair[0] = (normal, least);
            pair[1] = (-normal, -greatest);
        }
        Self { planes, slab, light }
    }

    /// Whether nothing of a box lies in the pyramid.
    pub fn excludes(&self, bounds: &Bounds) -> bool {
        let (center, half) = (bounds.center(), bounds.half());
        if self.planes.iter().any(|(n, offset)| n.dot(center) + n.abs().dot(half) < *offset) {
            return true;
        }
        // The other way round: a face of the box that has the whole pyramid in front of it.
        let (at, w) = (self.light.truncate().as_dvec3(), f64::from(self.light.w));
        (0..3).any(|axis| {
            let beyond = |sign: f64, face: f64| {
                let light = if w == 0.0 { sign * at[axis] >= 0.0 } else { sign * at[axis] > face };
                light && self.slab.iter().all(|p| sign * p[axis] > face)
            };
            beyond(1.0, bounds.max[axis]) || beyond(-1.0, -bounds.min[axis])
        })
    }

    /// Whether nothing of a segment lies in the pyramid.
    pub fn excludes_segment(&self, a: DVec3, b: DVec3) -> bool {
        let (mut from, mut to) = (0.0_f64, 1.0_f64);
        for (n, offset) in &self.planes {
            if *offset == f64::NEG_INFINITY {
                continue;
            }
            let (da, db) = (n.dot(a) - offset, n.dot(b) - offset);
            if da < 0.0 && db < 0.0 {
                return true;
            }
            if da < 0.0 {
                from = from.max(da / (da - db));
            } else if db < 0.0 {
                to = to.min(da / (da - db));
            }
            if from > to {
                return true;
            }
        }
        false
    }

    /// Whether a triangle may come into the near slab.
    pub fn slab_meets(&self, [a, b, c]: [DVec3; 3]) -> bool {
        let s = &self.slab;
        let (right, up, deep) = (s[1] - s[0], s[3] - s[0], s[4] - s[0]);
        let normals = [up.cross(deep), deep.cross(right), right.cross(up), (b - a).cross(c - a)];
        normals.into_iter().all(|n| {
            let extent = |points: &[DVec3]| {
                points
                    .iter()
                    .fold((f64::INFINITY, f64::NEG_INFINITY), |(lo, hi), p| (lo.min(n.dot(*p)), hi.max(n.dot(*p))))
            };
            let ((lo, hi), (from, to)) = (extent(s), extent(&[a, b, c]));
            lo <= to && from <= hi
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec4;

    fn view() -> View {
        let projection = Projection::Perspective { yfov: std::f64::consts::FRAC_PI_2, near: 0.1, far: None };
        View::new(DAffine3::IDENTITY, projection, [100, 100])
    }

    fn cube(center: DVec3, half: f64) -> Bounds {
        Bounds { min: center - half, max: center + half }
    }

    fn pyramid(light: Vec4) -> Pyramid {
        Pyramid::new(near_slab(&view(), [0, 0, 100, 100], 0.001), &DAffine3::IDENTITY, light)
    }

    /// Points of the exact hull are never excluded, whatever holds them.
    #[test]
    fn nothing_that_meets_the_hull_is_excluded() {
        let mut numbers = zfail_testing::Random(3);
        let mut random = || numbers.signed();
        let (mut clear, mut met) = (0, 0);
        for round in 0..4000 {
            let at = DVec3::new(random(), random(), random()) * if round % 3 == 0 { 0.2 } else { 5.0 };
            let light = if round % 2 == 0 { at.extend(1.0) } else { at.normalize().extend(0.0) };
            let pyramid = pyramid(light.as_vec4());
            let light = pyramid.light.as_dvec4();
            let caster = cube(DVec3::new(random(), random(), random()) * 3.0, 0.02 + 0.5 * random().abs());
            let excluded = pyramid.excludes(&caster);
            clear += usize::from(excluded);
            for _ in 0..20 {
                let on_near = DVec3::new(0.1 * random(), 0.1 * random(), -0.1);
                // Each segment is divided finely, and each dividing point is of the hull.
                for i in 0..=40 {
                    let t = f64::from(i) / 40.0;
                    let p = if light.w == 0.0 {
                        on_near + light.truncate() * (8.0 * t)
                    } else {
                        on_near.lerp(light.truncate(), t)
                    };
                    assert!(!pyramid.excludes_segment(p, p + DVec3::new(random(), random(), random())));
                    if caster.distance_squared(p) == 0.0 {
                        met += 1;
                        assert!(!excluded, "{caster:?} holds {p} between the near rectangle and {light}");
                    }
                }
            }
        }
        assert!(clear > 1500 && met > 500, "{clear} casters keep clear, {met} points are met");
    }

    #[test]
    fn a_caster_beside_the_pyramid_is_excluded_and_one_inside_is_not() {
        let above = pyramid(Vec4::new(0.0, 5.0, -0.1, 1.0));
        assert!(above.excludes(&cube(DVec3::new(2.0, 2.0, -0.1), 0.5)));
        assert!(!above.excludes(&cube(DVec3::new(0.0, 2.0, -0.1), 0.1)));
        assert!(above.excludes(&cube(DVec3::new(0.0, 6.0, -0.1), 0.5)), "behind the light");
        let sun = pyramid(Vec4::new(0.0, 1.0, 0.0, 0.0));
        assert!(!sun.excludes(&cube(DVec3::new(0.0, 100.0, -0.1), 0.05)));
        assert!(sun.excludes(&cube(DVec3::new(0.0, -1.0, -0.1), 0.5)), "behind the near rectangle");
    }
}
