//! What is seen from somewhere, coarsely: a small depth buffer, to choose viewpoints and lights by. No picture is made of
//! it.

use super::posed::{Posed, Sample};
use crate::Camera;
use glam::{DAffine3, DMat3, DVec3, Vec3};
use zfail_plan::bounds::Bounds;
use zfail_plan::topology::Blocking;
use zfail_plan::view::Projection;

/// Pixels along a side.
const SIDE: usize = 160;

/// A square view.
#[derive(Clone, Copy, Debug)]
pub(super) struct Lens {
    /// Right, up and back.
    axes: DMat3,
    eye: DVec3,
    shape: Shape,
}

#[derive(Clone, Copy, Debug)]
enum Shape {
    /// Half the extents to the right and up.
    Parallel([f64; 2]),
    /// Tangents of half the angles of view.
    Central([f64; 2]),
}

/// Which triangles block.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Blocks {
    /// Those that are drawn: not the backs of single-sided ones.
    Eyes,
    /// Those that cast shadows.
    Light,
}

/// The nearest triangle by pixel.
pub(super) struct Sight {
    lens: Lens,
    /// Greater is nearer: view-space z, or the reciprocal of the distance along the axis.
    nearness: Vec<f32>,
    /// By how much a point may lie behind what is nearest in its pixel: metres, or a share of the distance.
    tolerance: f32,
}

/// Right, up and back of an eye that looks along `-back`, upright.
pub(super) fn upright(back: DVec3) -> DMat3 {
    let back = back.normalize_or(DVec3::Z);
    let right = DVec3::Y.cross(back).try_normalize().unwrap_or(DVec3::X);
    DMat3::from_cols(right, back.cross(right), back)
}

impl Lens {
    /// All of `bounds` from far away in direction `back`.
    pub fn parallel(back: DVec3, bounds: &Bounds) -> Self {
        let axes = upright(back);
        let half = |axis: DVec3| (axis.abs().dot(bounds.half())).max(f64::MIN_POSITIVE);
        let shape = Shape::Parallel([half(axes.x_axis), half(axes.y_axis)]);
        Self { axes, eye: bounds.center(), shape }
    }

    /// From `eye` along `-back`; `slope` has the tangents of half the angles of view.
    pub fn central(eye: DVec3, back: DVec3, slope: [f64; 2]) -> Self {
        Self { axes: upright(back), eye, shape: Shape::Central(slope) }
    }

    /// What `camera` sees in a picture of this aspect ratio.
    pub fn of(camera: &Camera, aspect: f64) -> Self {
        let shape = match camera.projection {
            Projection::Perspective { yfov, .. } => Shape::Central([aspect, 1.0].map(|x| x * (0.5 * yfov).tan())),
            Projection::Orthographic { ymag, .. } => Shape::Parallel([aspect * ymag, ymag]),
        };
        Self { axes: camera.world_from_view.matrix3, eye: camera.world_from_view.translation, shape }
    }

    /// Where the eye is; the middle of what a parallel view shows.
    pub fn eye(&self) -> DVec3 {
        self.eye
    }

    /// Unit, from what is seen to the eye along the axis.
    pub fn back(&self) -> DVec3 {
        self.axes.z_axis
    }

    /// View space, divided so that the square is -1..1 (at the distance 1 along the axis if central).
    fn scaled_from_world(&self) -> DAffine3 {
        let [x, y] = match self.shape {
            Shape::Parallel(half) => half,
            Shape::Central(slope) => slope,
        };
        let view_from_world = self.axes.transpose();
        let scale = DMat3::from_diagonal(DVec3::new(x.recip(), y.recip(), 1.0));
        DAffine3 { matrix3: scale * view_from_world, translation: -(scale * (view_from_world * self.eye)) }
    }

    /// Whether `sample` shows its drawn side.
    fn faces(&self, sample: &Sample) -> bool {
        sample.both_sides || self.share(sample) > 0.0
    }

    /// Of the picture, up to a factor, what the triangle of `sample` takes; negative if its back is seen.
    pub fn share(&self, sample: &Sample) -> f64 {
        let (towards, distance) = match self.shape {
            Shape::Parallel(_) => (self.axes.z_axis, 1.0),
            Shape::Central(_) => (self.eye - sample.point, self.eye.distance(sample.point).max(f64::MIN_POSITIVE)),
        };
        sample.area * sample.normal.dot(towards) / distance.powi(3)
    }

    /// Pixel coordinates and nearness of a point in scaled view space that is in front of the eye.
    fn project(&self, p: Vec3) -> Vec3 {
        let (x, y, nearness) = match self.shape {
            Shape::Parallel(_) => (p.x, p.y, p.z),
            Shape::Central(_) => (p.x / -p.z, p.y / -p.z, -1.0 / p.z),
        };
        let pixel = |ndc: f32| (0.5 * ndc + 0.5) * SIDE as f32;
        Vec3::new(pixel(x), pixel(y), nearness)
    }
}

impl Sight {
    /// Draws the scene.
    pub fn new(lens: Lens, posed: Posed<'_>, bounds: &Bounds, blocks: Blocks) -> Self {
        let size = bounds.half().length() as f32;
        let (empty, tolerance) = match lens.shape {
            Shape::Parallel(_) => (f32::NEG_INFINITY, 0.03 * size),
            Shape::Central(_) => (0.0, 0.03),
        };
        let mut sight = Self { lens, nearness: vec![empty; SIDE * SIDE], tolerance };
        let scaled_from_world = lens.scaled_from_world();
        let near = 1e-3 * size;
        for placed in posed.placed().filter(|placed| blocks == Blocks::Eyes || placed.casts) {
            let scaled_from_object = scaled_from_world * placed.world_from_object;
            // A mirrored instance turns its triangles over.
            let mirrored = placed.world_from_object.matrix3.determinant() < 0.0;
            for t in 0..placed.mesh.triangles.len() {
                let surface = posed.scene.triangle_blocking(placed.index, t);
                if surface == Blocking::Nothing {
                    continue;
                }
                let fronts_only = blocks == Blocks::Eyes && surface == Blocking::Front;
                let corners =
                    placed.mesh.triangles[t].map(|v| scaled_from_object.transform_point3(placed.position(v)).as_vec3());
                sight.triangle(corners, fronts_only, mirrored, near);
            }
        }
        sight
    }

    /// Which has no patience with points behind what is nearest: for level points, seen from straight above.
    pub fn strict(mut self) -> Self {
        self.tolerance *= 0.01;
        self
    }

    /// Draws a triangle, or what lies beyond `near` of it.
    fn triangle(&mut self, corners: [Vec3; 3], fronts_only: bool, mirrored: bool, near: f32) {
        let mut clipped = [Vec3::ZERO; 4];
        let mut count = 0;
        let mut push = |p: Vec3| {
            clipped[count] = p;
            count += 1;
        };
        if matches!(self.lens.shape, Shape::Parallel(_)) {
            corners.into_iter().for_each(&mut push);
        } else {
            for i in 0..3 {
                let (p, q) = (corners[i], corners[(i + 1) % 3]);
                let (inside, next) = (p.z <= -near, q.z <= -near);
                if inside {
                    push(p);
                }
                if inside != next {
                    push(p.lerp(q, (p.z + near) / (p.z - q.z)));
                }
            }
        }
        let pixels = clipped.map(|p| self.lens.project(p));
        for i in 2..count {
            self.fill([pixels[0], pixels[i - 1], pixels[i]], fronts_only, mirrored);
        }
    }

    fn fill(&mut self, [a, b, c]: [Vec3; 3], fronts_only: bool, mirrored: bool) {
        let area = (b - a).truncate().perp_dot((c - a).truncate());
        if !area.is_finite() || area == 0.0 || fronts_only && (area < 0.0) != mirrored {
            return;
        }
        let (low, high) = (a.min(b).min(c), a.max(b).max(c));
        let range = |low: f32, high: f32| {
            let side = SIDE as f32;
            (low - 0.5).ceil().clamp(0.0, side) as usize..(high + 0.5).floor().clamp(0.0, side) as usize
        };
        for y in range(low.y, high.y) {
            for x in range(low.x, high.x) {
                let p = Vec3::new(x as f32 + 0.5, y as f32 + 0.5, 0.0);
                let share = |q: Vec3, r: Vec3| (q - p).truncate().perp_dot((r - p).truncate()) / area;
                let [u, v, w] = [share(b, c), share(c, a), share(a, b)];
                if u >= 0.0 && v >= 0.0 && w >= 0.0 {
                    let nearest = &mut self.nearness[y * SIDE + x];
                    *nearest = nearest.max(u * a.z + v * b.z + w * c.z);
                }
            }
        }
    }

    /// Whether nothing is in front of a point within the square.
    pub fn reaches(&self, point: DVec3) -> bool {
        let p = self.lens.scaled_from_world().transform_point3(point).as_vec3();
        if matches!(self.lens.shape, Shape::Central(_)) && p.z >= 0.0 {
            return false;
        }
        let spot = self.lens.project(p);
        let inside = |x: f32| (0.0..SIDE as f32).contains(&x);
        if !inside(spot.x) || !inside(spot.y) {
            return false;
        }
        let nearest = self.nearness[spot.y as usize * SIDE + spot.x as usize];
        match self.lens.shape {
            Shape::Parallel(_) => spot.z + self.tolerance >= nearest,
            Shape::Central(_) => spot.z * (1.0 + self.tolerance) >= nearest,
        }
    }

    /// Whether `sample` is seen.
    pub fn sees(&self, sample: &Sample) -> bool {
        self.lens.faces(sample) && self.reaches(sample.point)
    }

    /// The share of pixels in which nothing is nearer than `distance`, and of those that hold anything at all.
    pub fn openness(&self, distance: f64) -> [f64; 2] {
        let share = |count: usize| count as f64 / self.nearness.len() as f64;
        let limit = distance.recip() as f32;
        let free = self.nearness.iter().filter(|&&n| n <= limit).count();
        let filled = self.nearness.iter().filter(|&&n| n > 0.0).count();
        [share(free), share(filled)]
    }
}
