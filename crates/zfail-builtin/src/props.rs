//! Things that stand in several scenes: columns, arcades, vases, trees, jointed figures.
//!
//! In: sizes in metres. Out: meshes that stand on y = 0 around the origin, without material.

use glam::{DAffine3, DQuat, DVec2, DVec3};
use std::f64::consts::{PI, TAU};
use zfail_scene::Mesh;

use super::shapes::{self, CREASE, Slab, capsule, cuboid, curve, ico_sphere, lathe, merged, moved, uv_sphere};

/// A box of `size` that stands on the ground.
pub(super) fn block(size: DVec3) -> Mesh {
    cuboid(DVec3::new(-0.5 * size.x, 0.0, -0.5 * size.z), DVec3::new(0.5 * size.x, size.y, 0.5 * size.z))
}

/// A round column with a square plinth and abacus.
pub(super) fn column(radius: f64, height: f64) -> Mesh {
    let (r, slab) = (radius, 0.35 * radius);
    let mut shaft = vec![DVec2::new(0.0, slab)];
    shaft.extend(molding(1.32 * r, slab, 0.3 * r));
    shaft.push(DVec2::new(1.04 * r, slab + 0.45 * r));
    shaft.push(DVec2::new(r, slab + 0.7 * r));
    shaft.push(DVec2::new(0.88 * r, height - slab - 0.9 * r));
    shaft.extend(molding(1.0 * r, height - slab - 0.85 * r, 0.12 * r));
    shaft.push(DVec2::new(0.9 * r, height - slab - 0.66 * r));
    shaft.extend(curve(
        &[(0.95 * r, height - slab - 0.5 * r), (1.1 * r, height - slab - 0.2 * r), (1.4 * r, height - slab)],
        3,
    ));
    shaft.push(DVec2::new(0.0, height - slab));
    let plate = block(DVec3::new(3.0 * r, slab, 3.0 * r));
    let top = moved(plate.clone(), &DAffine3::from_translation(DVec3::Y * (height - slab)));
    merged("column", [plate, lathe(&shaft, 24, CREASE), top])
}

/// Half a round bulging to `radius`, from `bottom` up by `height`.
fn molding(radius: f64, bottom: f64, height: f64) -> Vec<DVec2> {
    let half = 0.5 * height;
    (0..=6)
        .map(|k| DVec2::from_angle(PI * (f64::from(k) / 6.0 - 0.5)) * half + DVec2::new(radius - half, bottom + half))
        .collect()
}

/// Openings of an [`arcade`], metres.
#[derive(Clone, Copy)]
pub(super) struct Arch {
    /// Width of the opening.
    pub span: f64,
    /// Height at which it begins; 0 for a passage.
    pub sill: f64,
    /// Height at which the arch springs.
    pub spring: f64,
    /// Height of the arch above that.
    pub rise: f64,
    /// Whether it ends in a point, as Gothic ones do.
    pub pointed: bool,
}

impl Arch {
    /// Height of the opening's edge at `t` in -1..1 across it.
    pub fn edge(&self, t: f64) -> f64 {
        // A point is where two circles meet, each around the other's springing.
        let squared = if self.pointed { (4.0 - (t.abs() + 1.0).powi(2)) / 3.0 } else { 1.0 - t * t };
        self.spring + self.rise * squared.max(0.0).sqrt()
    }
}

/// A wall along x, centred, with `bays` arched openings between piers of width `pier`.
pub(super) fn arcade(bays: usize, arch: Arch, pier: f64, height: f64, thickness: f64) -> Mesh {
    const STEPS: usize = 16;
    let mut edge = Vec::new();
    let mut open = Vec::new();
    let mut x = -0.5 * (bays as f64 * (arch.span + pier) + pier);
    for _ in 0..bays {
        edge.push((x, arch.spring));
        open.push(false);
        x += pier;
        for k in 0..STEPS {
            let t = 2.0 * k as f64 / STEPS as f64 - 1.0;
            edge.push((x + 0.5 * (t + 1.0) * arch.span, arch.edge(t)));
            open.push(true);
        }
        x += arch.span;
    }
    edge.extend([(x, arch.spring), (x + pier, arch.spring)]);
    open.push(false);

    let sill = usize::from(arch.sill > 0.0);
    Slab::new(open.len(), 2 + sill).mesh(
        |i, j| j != sill || !open[i],
        |i, j| {
            let (x, top) = edge[i];
            let y = match (j + 1 - sill, j) {
                (_, 0) => 0.0,
                (1, _) => arch.sill,
                (2, _) => top,
                _ => height,
            };
            [0.5, -0.5].map(|side| DVec3::new(x, y, side * thickness))
        },
    )
}

/// A vase with thickness, open at the top, `height` tall.
pub(super) fn vase(height: f64) -> Mesh {
    let outside =
        [(0.0, 0.0), (0.16, 0.0), (0.2, 0.06), (0.33, 0.35), (0.3, 0.6), (0.13, 0.82), (0.14, 0.93), (0.2, 1.0)];
    let inside = [(0.18, 1.0), (0.115, 0.92), (0.105, 0.82), (0.27, 0.6), (0.3, 0.35), (0.15, 0.05), (0.0, 0.03)];
    let mut profile = vec![DVec2::ZERO];
    profile.extend(curve(&outside[1..], 5));
    profile.extend(curve(&inside, 5));
    profile.iter_mut().for_each(|p| *p *= height);
    lathe(&profile, 40, CREASE)
}

/// A bowl with thickness, open at the top.
pub(super) fn bowl(radius: f64) -> Mesh {
    let mut profile = vec![DVec2::ZERO, DVec2::new(0.4, 0.0)];
    profile.extend(curve(&[(0.42, 0.06), (0.75, 0.2), (1.0, 0.55)], 6));
    profile.extend(curve(&[(0.94, 0.55), (0.7, 0.27), (0.38, 0.14), (0.0, 0.1)], 6));
    profile.iter_mut().for_each(|p| *p *= radius);
    lathe(&profile, 48, CREASE)
}

/// A slender conifer as a trunk and a crown.
pub(super) fn cypress(height: f64) -> [Mesh; 2] {
    let trunk = shapes::cylinder(0.035 * height, 0.2 * height, 12);
    let crown = [(0.0, 0.1), (0.09, 0.12), (0.14, 0.25), (0.135, 0.4), (0.1, 0.65), (0.05, 0.88), (0.0, 1.0)];
    let profile: Vec<DVec2> = curve(&crown, 4).iter().map(|p| *p * height).collect();
    [trunk, lathe(&profile, 14, CREASE)]
}

/// A broad-leaved tree as a trunk and a faceted crown.
pub(super) fn tree(height: f64) -> [Mesh; 2] {
    let trunk = capsule(DVec3::Y * -0.1, 0.05 * height, DVec3::Y * 0.55 * height, 0.03 * height, 12);
    let balls = [(0.0, 0.72, 0.0, 0.27), (0.2, 0.58, 0.08, 0.19), (-0.17, 0.6, 0.12, 0.18), (-0.02, 0.56, -0.2, 0.2)];
    let crown = balls.map(|(x, y, z, r)| {
        let place = DAffine3::from_rotation_y(9.0 * x) * DAffine3::from_scale(DVec3::new(1.0, 0.9, 1.0));
        let place = DAffine3::from_translation(DVec3::new(x, y, z) * height) * place;
        moved(ico_sphere(r * height, 2, false), &place)
    });
    [trunk, merged("crown", crown)]
}

/// How a [`figure`] holds its limbs: degrees forward of hanging down, left then right.
#[derive(Clone, Copy, Default)]
pub(super) struct Pose {
    /// Upper arms.
    pub arms: [f64; 2],
    /// Upper arms, away from the body.
    pub spread: [f64; 2],
    /// Elbows.
    pub elbows: [f64; 2],
    /// Thighs.
    pub legs: [f64; 2],
    /// Knees, backward.
    pub knees: [f64; 2],
}

impl Pose {
    /// At ease.
    pub const STAND: Self =
        Self { arms: [6.0, -2.0], spread: [10.0, 10.0], elbows: [14.0, 10.0], legs: [3.0, -3.0], knees: [2.0, 0.0] };
    /// In stride.
    pub const WALK: Self =
        Self { arms: [-32.0, 34.0], spread: [8.0, 8.0], elbows: [24.0, 38.0], legs: [27.0, -22.0], knees: [8.0, 24.0] };
    /// One arm up.
    pub const WAVE: Self =
        Self { arms: [4.0, 8.0], spread: [14.0, 150.0], elbows: [20.0, 26.0], legs: [4.0, -4.0], knees: [2.0, 2.0] };
    /// Both arms up, on one toe.
    pub const DANCE: Self = Self {
        arms: [20.0, -10.0],
        spread: [128.0, 78.0],
        elbows: [-14.0, 30.0],
        legs: [52.0, -6.0],
        knees: [86.0, 0.0],
    };
}

/// A jointed wooden figure, 1.75 m tall, that looks along +z; its limbs are closed bodies that reach into each other.
pub(super) fn figure(pose: &Pose) -> Mesh {
    let tilt = |forward: f64, out: f64| {
        DQuat::from_rotation_z(out.to_radians()) * DQuat::from_rotation_x(-forward.to_radians()) * DVec3::NEG_Y
    };
    let mut parts = vec![
        ellipsoid(DVec3::new(0.0, 1.62, 0.01), DVec3::new(0.088, 0.12, 0.105)),
        capsule(DVec3::new(0.0, 1.4, 0.0), 0.05, DVec3::new(0.0, 1.54, 0.0), 0.045, 16),
        ellipsoid(DVec3::new(0.0, 1.24, 0.0), DVec3::new(0.175, 0.24, 0.115)),
        ellipsoid(DVec3::new(0.0, 0.96, 0.0), DVec3::new(0.15, 0.13, 0.11)),
        capsule(DVec3::new(0.0, 0.98, 0.0), 0.09, DVec3::new(0.0, 1.16, 0.0), 0.09, 16),
    ];
    let mut ground = f64::INFINITY;
    for (side, sign) in [(0, 1.0), (1, -1.0)] {
        let shoulder = DVec3::new(0.205 * sign, 1.385, 0.0);
        let elbow = shoulder + tilt(pose.arms[side], sign * pose.spread[side]) * 0.29;
        let wrist = elbow + tilt(pose.arms[side] + pose.elbows[side], sign * pose.spread[side] * 0.9) * 0.25;
        let hand = wrist + (wrist - elbow).normalize() * 0.1;
        let hip = DVec3::new(0.095 * sign, 0.92, 0.0);
        let knee = hip + tilt(pose.legs[side], sign * 3.0) * 0.43;
        let ankle = knee + tilt(pose.legs[side] - pose.knees[side], sign * 2.0) * 0.42;
        let toe = ankle + tilt(pose.legs[side] - pose.knees[side] + 84.0, sign * 2.0) * 0.17;
        ground = ground.min(ankle.y - 0.055).min(toe.y - 0.03);
        parts.extend([
            capsule(shoulder, 0.062, elbow, 0.044, 16),
            capsule(elbow, 0.046, wrist, 0.03, 16),
            capsule(wrist, 0.032, hand, 0.036, 16),
            capsule(hip, 0.088, knee, 0.058, 16),
            capsule(knee, 0.06, ankle, 0.04, 16),
            capsule(ankle, 0.055, toe, 0.03, 16),
        ]);
    }
    moved(merged("figure", parts), &DAffine3::from_translation(DVec3::Y * -ground))
}

fn ellipsoid(center: DVec3, radii: DVec3) -> Mesh {
    let place = DAffine3::from_translation(center) * DAffine3::from_scale(radii);
    moved(uv_sphere(1.0, 20, 12), &place)
}

/// `n` directions evenly around the y axis, as (position on the unit circle, degrees to face outward).
pub(super) fn around(n: u32) -> impl Iterator<Item = (DVec3, f64)> {
    (0..n).map(move |k| {
        let angle = TAU * f64::from(k) / f64::from(n);
        (DVec3::new(angle.sin(), 0.0, angle.cos()), angle.to_degrees())
    })
}
