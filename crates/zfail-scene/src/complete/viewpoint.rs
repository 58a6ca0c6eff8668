//! From where a scene is looked at.
//!
//! In: a scene in a pose. Out: a direction from outside, or a place within.
//!
//! Three-quarter, from the front, the right and a little above, unless that shows far less of the scene than another view:
//! from higher up if it is walled but open above, from another side if it is open there; and from within if it is a room,
//! which from outside shows no more than its walls. How much is seen is counted over points spread over all triangles.

use super::posed::{Posed, Sample};
use super::sight::{Blocks, Lens, Sight};
use glam::{DVec2, DVec3};
use std::f64::consts::PI;
use zfail_plan::bounds::Bounds;

/// From where.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Viewpoint {
    /// From outside; the direction from the scene to the eye, unit.
    Around(DVec3),
    /// From a place within.
    Inside { eye: DVec3, back: DVec3 },
}

impl Viewpoint {
    /// What is seen of `bounds`.
    pub fn lens(self, bounds: &Bounds) -> Lens {
        match self {
            Self::Around(back) => Lens::parallel(back, bounds),
            Self::Inside { eye, back } => Lens::central(eye, back, [1.6 * INSIDE, INSIDE]),
        }
    }
}

/// Tangent of half the vertical angle of view within rooms.
pub(super) const INSIDE: f64 = 0.6;

/// To the side, and above the horizontal, radians.
const AZIMUTH: f64 = 0.56;
const ELEVATION: f64 = 0.38;
/// Of what lies flat on the ground.
const FLAT_ELEVATION: f64 = 0.7;
/// How many times as much another view must show.
const BETTER: f64 = 1.35;
/// What a view from behind shows counts for less: things have a face.
const BEHIND: f64 = 0.5;
/// More triangles than this are looked at from the usual side without any question.
const MANY: usize = 4_000_000;

/// Chooses.
pub(super) fn choose(posed: Posed<'_>, bounds: &Bounds, samples: &[Sample]) -> Viewpoint {
    let usual = usual(bounds);
    if samples.is_empty() || bounds.is_empty() || posed.triangles() > MANY {
        return Viewpoint::Around(direction(usual));
    }
    let seen = |lens: Lens| {
        let sight = Sight::new(lens, posed, bounds, Blocks::Eyes);
        samples.iter().filter(|sample| sight.sees(sample)).count() as f64
    };
    let around = |angles: DVec2| seen(Lens::parallel(direction(angles), bounds));
    let first = around(usual).max(1.0);
    let mut best = (usual, first);
    for x in [usual.x, -usual.x, usual.x + PI, PI - usual.x] {
        for y in [usual.y, 0.75, 1.0] {
            let angles = DVec2::new(x, y.max(usual.y));
            let count = around(angles) * if x.cos() < 0.0 { BEHIND } else { 1.0 };
            if count > (BETTER * first).max(1.1 * best.1) {
                best = (angles, count);
            }
        }
    }
    within(posed, bounds, samples, BETTER * best.1).unwrap_or(Viewpoint::Around(direction(best.0)))
}

/// Azimuth and elevation of the three-quarter view. What is long is seen from its side, what is flat from higher up.
fn usual(bounds: &Bounds) -> DVec2 {
    let half = if bounds.is_empty() { DVec3::ONE } else { bounds.half() };
    let azimuth = if half.z > 2.0 * half.x { 1.0 } else { AZIMUTH };
    let flatness = 1.0 - (4.0 * half.y / half.x.max(half.z).max(f64::MIN_POSITIVE)).min(1.0);
    DVec2::new(azimuth, ELEVATION + flatness * (FLAT_ELEVATION - ELEVATION))
}

fn direction(angles: DVec2) -> DVec3 {
    let (sine, cosine) = angles.y.sin_cos();
    DVec3::new(angles.x.sin() * cosine, sine, angles.x.cos() * cosine)
}

/// A place at the walls of a closed room from which more than `count` samples are seen.
fn within(posed: Posed<'_>, bounds: &Bounds, samples: &[Sample], count: f64) -> Option<Viewpoint> {
    /// Towards the walls, shares of the way.
    const PLACES: [[f64; 2]; 8] = [
        [0.0, 0.85],
        [0.85, 0.0],
        [0.0, -0.85],
        [-0.85, 0.0],
        [0.78, 0.78],
        [-0.78, 0.78],
        [0.78, -0.78],
        [-0.78, -0.78],
    ];
    let (half, size) = (bounds.half(), bounds.half().length());
    let mut best = (None, count);
    for [x, z] in PLACES {
        let eye = bounds.center() + half * DVec3::new(x, 0.15, z);
        let back = eye - (bounds.center() - DVec3::Y * 0.2 * half.y);
        let place = Viewpoint::Inside { eye, back };
        let sight = Sight::new(place.lens(bounds), posed, bounds, Blocks::Eyes);
        // Neither in the open nor close to a thing, behind one or within one.
        let [free, filled] = sight.openness(0.08 * size);
        let seen = samples.iter().filter(|sample| sight.sees(sample)).count() as f64;
        if filled > 0.9 && free > 0.85 && seen > best.1 {
            best = (Some(place), seen);
        }
    }
    best.0
}
