//! Bodies of revolution about the y axis.
//!
//! A profile is a list of `(radius, height)`; going up along it, the body is on the side of the axis.

use super::{CREASE, Facets, Mesh, circle};
use glam::{DAffine3, DQuat, DVec2, DVec3};

/// Turns an open profile, from the bottom of the axis to its top; both ends should have radius 0, then the body is
/// closed. A profile that goes up outside and comes down inside makes a bowl with thickness.
#[must_use]
pub fn lathe(profile: &[DVec2], columns: usize, crease: f64) -> Mesh {
    turn(profile.windows(2), columns, crease, "lathe")
}

/// Turns a closed profile, counter-clockwise with the radius to the right and the height up, away from the axis.
#[must_use]
pub fn ring(profile: &[DVec2], columns: usize, crease: f64) -> Mesh {
    let mut closed = profile.to_vec();
    closed.extend(profile.first());
    turn(closed.windows(2), columns, crease, "ring")
}

fn turn<'a>(steps: impl Iterator<Item = &'a [DVec2]> + Clone, columns: usize, crease: f64, name: &str) -> Mesh {
    let around = circle(columns);
    let place = |p: DVec2, j: usize| {
        let direction = around[j % columns];
        DVec3::new(p.x * direction.x, p.y, -p.x * direction.y)
    };
    let widest = steps.clone().flatten().map(|p| p.x).fold(0.0, f64::max);
    // A whole number of metres around, so that a texture of 1 / n metres has no seam.
    let circumference = (widest * std::f64::consts::TAU).round().max(1.0);
    let mut facets = Facets::default();
    let mut length = 0.0;
    for step in steps {
        let (p, q) = (step[0], step[1]);
        let next = length + p.distance(q);
        for j in 0..columns {
            let u = |j: usize| circumference * j as f64 / columns as f64;
            facets.textured_quad([
                (place(p, j), DVec2::new(u(j), -length)),
                (place(p, j + 1), DVec2::new(u(j + 1), -length)),
                (place(q, j + 1), DVec2::new(u(j + 1), -next)),
                (place(q, j), DVec2::new(u(j), -next)),
            ]);
        }
        length = next;
    }
    facets.mesh(name, crease)
}

/// A sphere around the origin in rows of latitude and columns of longitude.
#[must_use]
pub fn uv_sphere(radius: f64, columns: usize, rows: usize) -> Mesh {
    let mut profile = arc(radius, rows, -std::f64::consts::FRAC_PI_2, std::f64::consts::FRAC_PI_2);
    profile[0].x = 0.0;
    profile[rows].x = 0.0;
    lathe(&profile, columns, std::f64::consts::PI)
}

/// A cylinder from the origin up to `height`.
#[must_use]
pub fn cylinder(radius: f64, height: f64, columns: usize) -> Mesh {
    lathe(&[(0.0, 0.0), (radius, 0.0), (radius, height), (0.0, height)].map(DVec2::from), columns, CREASE)
}

/// A cone on the origin's plane with its tip at `height`.
#[must_use]
pub fn cone(radius: f64, height: f64, columns: usize) -> Mesh {
    lathe(&[(0.0, 0.0), (radius, 0.0), (0.0, height)].map(DVec2::from), columns, CREASE)
}

/// A torus around the y axis: `radius` to the middle of a tube of radius `tube`.
#[must_use]
pub fn torus(radius: f64, tube: f64, columns: usize, rows: usize) -> Mesh {
    let profile: Vec<DVec2> = circle(rows).iter().map(|c| DVec2::new(radius, 0.0) + *c * tube).collect();
    ring(&profile, columns, std::f64::consts::PI)
}

/// A ball of radius `ra` at `a`, one of `rb` at `b`, and the cone between them. The points must differ.
#[must_use]
pub fn capsule(a: DVec3, ra: f64, b: DVec3, rb: f64, columns: usize) -> Mesh {
    let length = a.distance(b);
    let quarter = (columns / 4).max(2);
    // The cone touches both balls at this latitude.
    let tilt = ((ra - rb) / length).clamp(-1.0, 1.0).asin();
    let mut profile = arc(ra, quarter, -std::f64::consts::FRAC_PI_2, tilt);
    let upper = arc(rb, quarter, tilt, std::f64::consts::FRAC_PI_2);
    profile.extend(upper.iter().map(|p| DVec2::new(p.x, p.y + length)));
    profile[0].x = 0.0;
    profile[2 * quarter + 1].x = 0.0;
    let body = lathe(&profile, columns, std::f64::consts::PI);
    let turn = DQuat::from_rotation_arc(DVec3::Y, (b - a).normalize());
    super::moved(body, &DAffine3::from_rotation_translation(turn, a))
}

/// `n + 1` points of a circle around the origin, between two angles.
fn arc(radius: f64, n: usize, from: f64, to: f64) -> Vec<DVec2> {
    (0..=n).map(|k| DVec2::from_angle(from + (to - from) * k as f64 / n as f64) * radius).collect()
}

/// A smooth curve through `points` (uniform Catmull-Rom) in `steps` pieces per span;
/// negative radii that it overshoots to become 0.
#[must_use]
pub fn curve(points: &[(f64, f64)], steps: usize) -> Vec<DVec2> {
    let at = |i: isize| DVec2::from(points[i.clamp(0, points.len() as isize - 1) as usize]);
    let mut out = Vec::new();
    for span in 0..points.len().saturating_sub(1) as isize {
        let [p, q, r, s] = [at(span - 1), at(span), at(span + 1), at(span + 2)];
        for k in 0..steps {
            let t = k as f64 / steps as f64;
            let bend = (2.0 * p - 5.0 * q + 4.0 * r - s) * (t * t) + (3.0 * q - p - 3.0 * r + s) * (t * t * t);
            let point = q + 0.5 * ((r - p) * t + bend);
            out.push(DVec2::new(point.x.max(0.0), point.y));
        }
    }
    out.extend(points.last().map(|&p| DVec2::from(p)));
    out
}
