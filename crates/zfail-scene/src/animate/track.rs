//! A value over time: glTF 2.0, section 3.11 and appendix C.
//!
//! In: key times and values. Out: the value at any time, in `f64`.

use crate::placement::unit_quaternion;
use glam::{DQuat, DVec3};
use std::array;
use std::sync::Arc;

/// How values between two keys follow from them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Interpolation {
    /// The value of the last key passed.
    Step,
    /// Straight, for rotations along the shortest arc.
    #[default]
    Linear,
    /// Cubic Hermite spline; each key has the derivatives before and after it.
    CubicSpline,
}

impl Interpolation {
    /// Values per key: in-tangent, value and out-tangent for splines.
    pub fn values_per_key(self) -> usize {
        if self == Self::CubicSpline { 3 } else { 1 }
    }
}

/// Values of `N` components at ascending times. The keys of a rotation are quaternions (x, y, z, w) of any length.
#[derive(Clone, Debug)]
pub struct Track<const N: usize> {
    interpolation: Interpolation,
    /// Seconds.
    times: Arc<[f32]>,
    values: Vec<[f32; N]>,
}

impl<const N: usize> Track<N> {
    /// `None` if there is no key, or not as many values as `times` and `interpolation` call for.
    pub fn new(interpolation: Interpolation, times: Arc<[f32]>, values: Vec<[f32; N]>) -> Option<Self> {
        let fits = values.len() == times.len() * interpolation.values_per_key() && !times.is_empty();
        fits.then_some(Self { interpolation, times, values })
    }

    /// How many keys there are; at least one.
    pub fn key_count(&self) -> usize {
        self.times.len()
    }

    /// The value of key `k`, without its tangents.
    pub fn key(&self, k: usize) -> [f64; N] {
        let i = if self.interpolation == Interpolation::CubicSpline { 3 * k + 1 } else { k };
        self.values[i].map(f64::from)
    }

    fn at(&self, seconds: f64, linear: impl Fn([f64; N], [f64; N], f64) -> [f64; N]) -> [f64; N] {
        // In the precision of the keys, so that frame 20 of 60 is the key at a third.
        let passed = self.times.partition_point(|&time| time <= seconds as f32);
        let Some(k) = passed.checked_sub(1) else { return self.key(0) };
        if passed == self.times.len() || self.interpolation == Interpolation::Step {
            return self.key(k);
        }
        let [start, end] = [self.times[k], self.times[passed]].map(f64::from);
        let span = end - start;
        let s = ((seconds - start) / span).clamp(0.0, 1.0);
        if self.interpolation == Interpolation::Linear {
            return linear(self.key(k), self.key(passed), s);
        }
        let (p, q) = (self.key(k), self.key(passed));
        let [out, into] = [3 * k + 2, 3 * passed].map(|tangent| self.values[tangent].map(f64::from));
        let (s2, s3) = (s * s, s * s * s);
        array::from_fn(|i| {
            (2.0 * s3 - 3.0 * s2 + 1.0) * p[i]
                + span * (s3 - 2.0 * s2 + s) * out[i]
                + (3.0 * s2 - 2.0 * s3) * q[i]
                + span * (s3 - s2) * into[i]
        })
    }
}

impl Track<1> {
    /// The morph weight at a time.
    pub fn scalar(&self, seconds: f64) -> f64 {
        self.at(seconds, |[a], [b], s| [a + s * (b - a)])[0]
    }
}

impl Track<3> {
    /// The translation or scale at a time.
    pub fn vector(&self, seconds: f64) -> DVec3 {
        self.at(seconds, |a, b, s| array::from_fn(|i| a[i] + s * (b[i] - a[i]))).into()
    }
}

impl Track<4> {
    /// The rotation at a time, of unit length; `None` where it has no direction.
    pub fn rotation(&self, seconds: f64) -> Option<DQuat> {
        let arc = |a: [f64; 4], b: [f64; 4], s: f64| {
            let unit = |q: [f64; 4]| unit_quaternion(DQuat::from_array(q));
            match (unit(a), unit(b)) {
                (Some(a), Some(b)) => slerp(a, b, s).to_array(),
                (_, None) => a,
                (None, _) => b,
            }
        };
        unit_quaternion(DQuat::from_array(self.at(seconds, arc)))
    }
}

/// Along the shorter of the two arcs between unit quaternions.
///
/// glam's own takes the arc cosine, by an approximation: as good as nothing for small angles, of which motion consists.
fn slerp(a: DQuat, b: DQuat, s: f64) -> DQuat {
    let b = if a.dot(b) < 0.0 { -b } else { b };
    let angle = 2.0 * (a - b).length().atan2((a + b).length());
    let sine = angle.sin();
    // Below this the arc is a line in double precision.
    if sine < 1e-9 { a + (b - a) * s } else { (a * ((1.0 - s) * angle).sin() + b * (s * angle).sin()) * (1.0 / sine) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::{FRAC_1_SQRT_2, PI};

    fn track<const N: usize>(interpolation: Interpolation, times: &[f32], values: &[[f32; N]]) -> Track<N> {
        Track::new(interpolation, times.into(), values.to_vec()).unwrap()
    }

    fn x_at(track: &Track<3>, seconds: f64) -> f64 {
        track.vector(seconds).x
    }

    #[test]
    fn steps_hold_until_the_next_key() {
        let track = track(Interpolation::Step, &[1.0, 2.0, 4.0], &[[1.0, 0.0, 0.0], [5.0, 0.0, 0.0], [7.0, 0.0, 0.0]]);
        for (seconds, x) in [(-9.0, 1.0), (1.0, 1.0), (1.999, 1.0), (2.0, 5.0), (3.9, 5.0), (4.0, 7.0), (1e300, 7.0)] {
            assert_eq!(x_at(&track, seconds), x, "{seconds}");
        }
        assert_eq!((x_at(&track, f64::INFINITY), x_at(&track, f64::NEG_INFINITY)), (7.0, 1.0));
        assert!(x_at(&track, f64::NAN).is_finite());
    }

    #[test]
    fn frames_hit_the_keys_that_were_made_for_them() {
        for fps in [24_u16, 25, 30, 60, 144] {
            let times: Vec<f32> = (0..600_u16).map(|k| f32::from(k) / f32::from(fps)).collect();
            let values: Vec<[f32; 3]> = (0..600_u16).map(|k| [f32::from(k), 0.0, 0.0]).collect();
            let [step, linear] = [Interpolation::Step, Interpolation::Linear].map(|i| track(i, &times, &values));
            for k in 0..600_u16 {
                let seconds = f64::from(k) / f64::from(fps);
                assert_eq!(x_at(&step, seconds), f64::from(k), "frame {k} at {fps} per second");
                assert!((x_at(&linear, seconds) - f64::from(k)).abs() < 1e-4);
            }
        }
    }

    #[test]
    fn lines_between_keys() {
        let track = track(Interpolation::Linear, &[1.0, 3.0], &[[1.0, 2.0, 3.0], [5.0, 0.0, 3.0]]);
        assert_eq!(track.vector(1.5), DVec3::new(2.0, 1.5, 3.0));
        assert_eq!(track.vector(0.0), DVec3::new(1.0, 2.0, 3.0));
        assert_eq!(track.vector(3.0), DVec3::new(5.0, 0.0, 3.0));
    }

    #[test]
    fn splines_reproduce_any_cubic() {
        let f = |t: f64| 2.0 * t * t * t - 3.0 * t * t + 5.0 * t - 7.0;
        let derivative = |t: f64| 6.0 * t * t - 6.0 * t + 5.0;
        let times = [0.5_f32, 1.0, 3.0];
        let value = |x: f64| [x as f32, 0.0, 1.0];
        let keys: Vec<[f32; 3]> =
            times.iter().flat_map(|&t| [derivative(t.into()), f(t.into()), derivative(t.into())].map(value)).collect();
        let mut spline = track(Interpolation::CubicSpline, &times, &keys);
        for seconds in [0.5, 0.6, 0.75, 1.0, 1.5, 2.875, 3.0] {
            assert!((x_at(&spline, seconds) - f(seconds)).abs() < 1e-5, "{seconds}");
        }
        assert!((x_at(&spline, 0.0) - f(0.5)).abs() < 1e-5 && (x_at(&spline, 9.0) - f(3.0)).abs() < 1e-5);
        // In- and out-tangent are told apart: the first key's in-tangent and the last one's out-tangent do nothing,
        // the first one's out-tangent does.
        let before = x_at(&spline, 0.75);
        spline.values[0][0] = 99.0;
        spline.values[8][0] = 99.0;
        assert_eq!(x_at(&spline, 0.75), before);
        spline.values[2][0] += 1.0;
        assert_ne!(x_at(&spline, 0.75), before);
    }

    #[test]
    fn rotations_take_the_shortest_arc_at_constant_speed() {
        let turn = |degrees: f64| DQuat::from_rotation_y(degrees.to_radians());
        let far = turn(170.0).as_quat().to_array();
        for far in [far, far.map(|c| -c), far.map(|c| 3.0 * c)] {
            let track = track(Interpolation::Linear, &[0.0, 1.0], &[[0.0, 0.0, 0.0, 1.0], far]);
            for s in [0.0, 0.1, 0.5, 0.9, 1.0] {
                let q = track.rotation(s).unwrap();
                assert!(q.dot(turn(170.0 * s)).abs() > 1.0 - 1e-12, "{s}: {q}");
            }
        }
    }

    #[test]
    fn small_arcs_keep_their_digits() {
        for angle in [1e-3, 1e-6, 1e-10] {
            let q = slerp(DQuat::IDENTITY, DQuat::from_rotation_x(angle), 0.25);
            assert!((q.x - (0.125 * angle).sin()).abs() < 1e-9 * angle, "{angle}");
        }
        let opposite = slerp(DQuat::IDENTITY, DQuat::from_xyzw(1.0, 0.0, 0.0, 0.0), 0.5);
        assert!((opposite.x - FRAC_1_SQRT_2).abs() < 1e-15, "half a turn has a middle");
        let quarter = slerp(DQuat::from_rotation_z(-0.5 * PI), DQuat::from_rotation_z(0.0), 0.5);
        assert!(quarter.dot(DQuat::from_rotation_z(-0.25 * PI)) > 1.0 - 1e-15);
    }

    #[test]
    fn spline_rotations_have_unit_length_or_none() {
        let zero = [0.0; 4];
        let halves = [[0.0, 0.0, 0.0, 1.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 0.0, -1.0]];
        let keys: Vec<[f32; 4]> = halves.iter().flat_map(|&q| [zero, q, zero]).collect();
        let track = track(Interpolation::CubicSpline, &[0.0, 1.0, 2.0], &keys);
        let middle = track.rotation(0.5).unwrap();
        assert!(middle.dot(DQuat::from_rotation_y(0.5 * PI)) > 1.0 - 1e-12);
        let straight_through = [zero, halves[0], zero, zero, halves[2], zero];
        let track = Track::new(Interpolation::CubicSpline, [0.0, 1.0].into(), straight_through.to_vec()).unwrap();
        assert_eq!(track.rotation(0.5), None, "the spline passes through zero");
    }

    #[test]
    fn a_track_has_a_value_for_every_key() {
        let new = |interpolation, keys: usize, values: usize| {
            Track::new(interpolation, vec![0.0; keys].into(), vec![[0.0; 3]; values]).is_some()
        };
        assert!(new(Interpolation::Step, 2, 2) && new(Interpolation::CubicSpline, 2, 6));
        assert!(!new(Interpolation::Linear, 2, 3) && !new(Interpolation::CubicSpline, 2, 2));
        assert!(!new(Interpolation::Linear, 0, 0));
    }
}
