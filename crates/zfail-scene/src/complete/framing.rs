//! A camera that frames what it is to show, tightly.
//!
//! In: points, of all poses that are to be in the picture. Out: a camera for a picture of any aspect ratio.
//!
//! With the axes of the eye fixed, a plane of the view volume holds all points on its inner side if and only if it holds the
//! one that lies farthest out along its normal. So of all points only that is kept, for normals at equal steps of the angle
//! of view ([`Reach`]); how far out points lie is a convex function of the slope, and between two steps the chord is a bound
//! that crops nothing.

use super::sight::upright;
use crate::Camera;
use glam::{DAffine3, DMat3, DVec3};
use std::f64::consts::PI;
use zfail_plan::view::Projection;

/// Half the vertical angle of view, and the most that half the horizontal one may be.
const HALF_ANGLE: f64 = PI / 10.5;
const WIDEST_HALF_ANGLE: f64 = PI / 6.0;
/// How far from the middle towards the picture's edge the outermost points lie.
const FILLED: f64 = 0.92;
/// Steps of a slope up to that of the picture that was asked for, and beyond for other pictures.
const STEPS: usize = 8;
const KNOTS: usize = 2 * STEPS + 1;

/// How to see a scene in a picture of any aspect ratio.
#[derive(Clone, Debug)]
pub struct Framing(pub(super) Kind);

#[derive(Clone, Debug)]
pub(super) enum Kind {
    /// From outside.
    Around { origin: DVec3, axes: DMat3, reach: Box<Reach> },
    /// From a place within.
    Inside(Camera),
}

/// How far out points lie, in view space relative to some origin.
#[derive(Clone, Debug)]
pub(super) struct Reach {
    /// Slope between two knots, horizontal and vertical.
    step: [f64; 2],
    /// To the right, left, up and down: the greatest of distance plus slope times z.
    out: [[f64; KNOTS]; 4],
    /// Greatest and least z.
    depth: [f64; 2],
}

/// Tangents of half the angles of view.
fn slopes(aspect: f64) -> [f64; 2] {
    let y = HALF_ANGLE.tan().min(WIDEST_HALF_ANGLE.tan() / aspect);
    [y * aspect, y]
}

impl Reach {
    /// Of no points; exact for pictures of this aspect ratio.
    pub fn new(aspect: f64) -> Self {
        let step = slopes(aspect).map(|slope| FILLED * slope / STEPS as f64);
        Self { step, out: [[f64::NEG_INFINITY; KNOTS]; 4], depth: [f64::NEG_INFINITY, f64::INFINITY] }
    }

    /// Holds a point too.
    pub fn add(&mut self, p: DVec3) {
        for (side, out) in self.out.iter_mut().enumerate() {
            let (distance, step) = ([p.x, -p.x, p.y, -p.y][side], p.z * self.step[side / 2]);
            for (k, out) in out.iter_mut().enumerate() {
                *out = out.max(distance + k as f64 * step);
            }
        }
        self.depth = [self.depth[0].max(p.z), self.depth[1].min(p.z)];
    }

    /// Holds what `other` holds, moved by `by`.
    pub fn join(&mut self, other: &Self, by: DVec3) {
        for (side, (out, others)) in self.out.iter_mut().zip(&other.out).enumerate() {
            let (distance, step) = ([by.x, -by.x, by.y, -by.y][side], by.z * self.step[side / 2]);
            for (k, (out, other)) in out.iter_mut().zip(others).enumerate() {
                *out = out.max(other + distance + k as f64 * step);
            }
        }
        self.depth = [self.depth[0].max(other.depth[0] + by.z), self.depth[1].min(other.depth[1] + by.z)];
    }

    fn is_empty(&self) -> bool {
        !(self.depth[0].is_finite() && self.depth[1].is_finite())
    }

    /// The greatest of distance plus `slope` times z on a side, or a bound of it.
    fn out(&self, side: usize, slope: f64) -> f64 {
        let (out, at) = (&self.out[side], slope / self.step[side / 2]);
        let k = at.floor().clamp(0.0, (KNOTS - 1) as f64) as usize;
        match out.get(k + 1) {
            Some(next) => out[k] + (at - k as f64) * (next - out[k]),
            // Beyond the last knot it grows by no more than the greatest z.
            None => out[k] + (slope - k as f64 * self.step[side / 2]) * self.depth[0],
        }
    }

    /// Where the eye is that has everything within these slopes, as near as can be, and in the middle.
    fn eye(&self, slopes: [f64; 2]) -> DVec3 {
        let sum = |axis: usize, slope: f64| self.out(2 * axis, slope) + self.out(2 * axis + 1, slope);
        let z =
            [0, 1].map(|axis| sum(axis, slopes[axis]) / (2.0 * slopes[axis])).into_iter().fold(self.depth[0], f64::max);
        let middle = |axis: usize| {
            // The slope that is reached on both sides alike; what is asked for falls from the width to below 0.
            let (mut low, mut high) = (0.0, slopes[axis]);
            for _ in 0..60 {
                let slope = 0.5 * (low + high);
                if sum(axis, slope) > 2.0 * slope * z { low = slope } else { high = slope }
            }
            0.5 * (self.out(2 * axis, high) - self.out(2 * axis + 1, high))
        };
        DVec3::new(middle(0), middle(1), z)
    }
}

impl Framing {
    /// Of what `reach` holds, relative to `origin` in the directions of `axes`.
    pub(super) fn around(origin: DVec3, axes: DMat3, reach: Reach) -> Self {
        Self(Kind::Around { origin, axes, reach: Box::new(reach) })
    }

    /// From `eye` along `-back`, in a room of this size.
    pub(super) fn inside(eye: DVec3, back: DVec3, size: f64) -> Self {
        let projection =
            Projection::Perspective { yfov: 2.0 * super::viewpoint::INSIDE.atan(), near: 0.002 * size, far: None };
        let world_from_view = DAffine3 { matrix3: upright(back), translation: eye };
        Self(Kind::Inside(Camera { name: NAME.to_owned(), world_from_view, projection }))
    }

    /// The camera for a picture of this aspect ratio.
    #[must_use]
    pub fn camera(&self, aspect: f64) -> Camera {
        let (origin, axes, reach) = match &self.0 {
            Kind::Inside(camera) => return camera.clone(),
            Kind::Around { origin, axes, reach } => (origin, axes, reach),
        };
        let slopes = slopes(aspect);
        let mut eye = if reach.is_empty() { DVec3::ZERO } else { reach.eye(slopes.map(|slope| FILLED * slope)) };
        let depth = if reach.is_empty() { [0.0; 2] } else { reach.depth };
        if eye.z <= depth[0] {
            // A single point.
            eye.z = depth[0] + 1.0;
        }
        let distance = eye.z - 0.5 * (depth[0] + depth[1]);
        let near = (0.005 * distance).min(0.5 * (eye.z - depth[0])).max(1e-5 * distance);
        Camera {
            name: NAME.to_owned(),
            world_from_view: DAffine3 { matrix3: *axes, translation: *origin + *axes * eye },
            projection: Projection::Perspective { yfov: 2.0 * slopes[1].atan(), near, far: None },
        }
    }
}

const NAME: &str = "framing";

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DMat4;
    use zfail_plan::bounds::Bounds;

    /// Least and greatest of x and y on the screen, -1 to 1.
    fn extent(points: &[DVec3], camera: &Camera, aspect: f64) -> [[f64; 2]; 2] {
        let view = camera.view([(1000.0 * aspect) as u32, 1000], &Bounds::EMPTY);
        let clip_from_world = view.clip_from_view() * DMat4::from(camera.world_from_view.inverse());
        let mut extent = [[f64::INFINITY, f64::NEG_INFINITY]; 2];
        for p in points {
            let p = clip_from_world * p.extend(1.0);
            assert!(p.w > view.near());
            for (axis, [low, high]) in extent.iter_mut().enumerate() {
                (*low, *high) = (low.min(p[axis] / p.w), high.max(p[axis] / p.w));
            }
        }
        extent
    }

    fn points(scale: DVec3) -> Vec<DVec3> {
        // An L, which no box fits.
        let l = [[0.0, 0.0, 0.0], [3.0, 0.0, 0.0], [3.0, 1.0, 0.5], [1.0, 1.0, 0.0], [1.0, 4.0, 1.0], [0.0, 4.0, 0.0]];
        l.into_iter().map(|p| DVec3::from(p) * scale + DVec3::new(100.0, -7.0, 3.0)).collect()
    }

    fn framing(points: &[DVec3], aspect: f64) -> Framing {
        let (origin, axes) = (points[0], upright(DVec3::new(0.5, 0.4, 0.8)));
        let mut reach = Reach::new(aspect);
        points.iter().for_each(|&p| reach.add(axes.transpose() * (p - origin)));
        Framing::around(origin, axes, reach)
    }

    #[test]
    fn everything_is_in_the_picture_centred_and_up_to_its_margin() {
        for scale in [DVec3::ONE, DVec3::new(9.0, 0.01, 1.0), DVec3::new(0.01, 5.0, 0.01), DVec3::splat(1e-3)] {
            let points = points(scale);
            for aspect in [0.4, 1.0, 1.6, 16.0 / 9.0, 4.0] {
                let [x, y] = extent(&points, &framing(&points, aspect).camera(aspect), aspect);
                let reached = x[1].max(y[1]);
                assert!((reached - FILLED).abs() < 1e-3, "{scale} {aspect}: {x:?} {y:?}");
                // Across the axis that is not full the middle is found between knots.
                assert!((x[0] + x[1]).abs() < 0.03 && (y[0] + y[1]).abs() < 0.03, "{scale} {aspect}: {x:?} {y:?}");
            }
        }
    }

    #[test]
    fn another_aspect_ratio_crops_nothing_and_wastes_little() {
        let points = points(DVec3::ONE);
        for (made_for, aspect) in [(1.6, 1.0), (1.6, 2.3), (1.0, 3.0), (2.0, 0.5)] {
            let [x, y] = extent(&points, &framing(&points, made_for).camera(aspect), aspect);
            let reached = x[1].max(y[1]).max(-x[0]).max(-y[0]);
            assert!((0.85..FILLED + 1e-9).contains(&reached), "{made_for} {aspect}: {x:?} {y:?}");
        }
    }

    #[test]
    fn points_elsewhere_are_the_same_points_moved() {
        let all = points(DVec3::ONE);
        let (axes, by) = (upright(DVec3::new(0.5, 0.4, 0.8)), DVec3::new(0.3, -2.0, 0.7));
        let [mut whole, mut first, mut second] = [(); 3].map(|()| Reach::new(1.5));
        for p in &all {
            let p = axes.transpose() * (*p - all[0]);
            whole.add(p);
            whole.add(p + by);
            first.add(p);
            second.add(p);
        }
        first.join(&second, by);
        let (a, b) = (whole.eye([0.4, 0.3]), first.eye([0.4, 0.3]));
        assert!((a - b).length() < 1e-9, "{a} {b}");
        second.join(&first, DVec3::ZERO);
        assert!((second.eye([0.4, 0.3]) - first.eye([0.4, 0.3])).length() < 1e-9);
    }

    #[test]
    fn nothing_and_a_point_can_be_looked_at() {
        for points in [vec![], vec![DVec3::ONE]] {
            let mut reach = Reach::new(1.0);
            points.iter().for_each(|&p| reach.add(p));
            let camera = Framing::around(DVec3::ZERO, DMat3::IDENTITY, reach).camera(1.0);
            let Projection::Perspective { near, .. } = camera.projection else { panic!("it is perspective") };
            assert!(camera.world_from_view.is_finite() && near > 0.0);
        }
    }
}
