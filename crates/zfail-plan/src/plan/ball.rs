//! A bound on how many layers a ray can cross, for every light in a ball.
//!
//! In: a mesh, its castings and a ball of lights, all in object space. Out: a number that the count along no ray from any
//! light of the ball exceeds. It is the bound of [`super::meridians`] without knowing the silhouette, which the device finds:
//! a triangle that some light of the ball may see from its other side counts as either, an edge counts as often as it may
//! have sides, and its ends count in every column that they may lie in. As the silhouette crosses a line of directions as
//! often as it goes up as down, half of poles and crossings is the bound.
//!
//! Columns turn with the light so that the middle of the mesh stays in the same one; otherwise a light that moves a little
//! would move every edge through many columns.

use super::near_count;
use crate::casting::{Casting, ObjectLight};
use crate::topology::{NONE, Topology};
use glam::{DVec2, DVec3};
use std::f64::consts::{PI, TAU};
use std::ops::RangeInclusive;

/// Columns of directions.
const COLUMNS: usize = 8192;
/// Far above the rounding of f64 in azimuths, in radians.
const ROUNDING: f64 = 1e-9;

/// Lights about one light, in a caster's object space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Ball {
    pub center: ObjectLight,
    /// Of a directional light: the greatest difference of unit vectors.
    pub radius: f64,
}

impl Ball {
    /// Whether `light` lies in the ball.
    pub fn holds(&self, light: ObjectLight) -> bool {
        let away = light.truncate().as_dvec3() - self.center.truncate().as_dvec3();
        light.w == self.center.w && away.length() <= self.radius
    }

    /// The most layers that a ray from any light of the ball can cross, if triangles cast as `castings` tell of their parts;
    /// `None` where a light may touch a triangle, so that nothing is known.
    pub fn most_layers(&self, topology: &Topology, castings: &[Casting]) -> Option<usize> {
        let mut now = Vec::with_capacity(topology.triangles.len());
        let mut possible = Vec::with_capacity(topology.triangles.len());
        for (t, &part) in topology.part_of.iter().enumerate() {
            let Some(casting) = castings.get(part as usize).filter(|_| part != NONE) else {
                now.push(0);
                possible.push(0..=0);
                continue;
            };
            let corners = topology.corners(t);
            let (facing, certain) = self.facing(corners);
            if !certain && self.touches(corners) {
                return None;
            }
            let weight = casting.weight(facing);
            now.push(weight);
            possible.push(if certain { weight..=weight } else { casting.weight(-1).min(0)..=casting.weight(1).max(0) });
        }
        let lines = Lines::new(self, topology);
        let mut columns = Columns::new();
        for (edge, incident) in topology.incidence() {
            let sides = most_sides(incident.iter().map(|(t, orientation)| (&possible[t], orientation)));
            if sides > 0 {
                let ends = edge.map(|v| topology.position(v));
                columns.add(lines.span(self, ends), sides);
            }
        }
        let mut poles = 0;
        if let Lines::Meridians { pole, .. } = lines {
            for way in [pole, -pole] {
                if self.ray_may_meet(topology, way) {
                    // The ray of another light of the ball crosses as many layers, but for edges that it passes on the
                    // way there, all of which are in every column.
                    poles += near_count::layers(topology, &now, self.center, way.extend(0.0)) + columns.all;
                }
            }
        }
        Some((columns.most() + poles as usize) / 2)
    }

    /// Which side faces the middle of the ball, and whether all its lights agree, by f32 arithmetic too.
    fn facing(&self, [a, b, c]: [DVec3; 3]) -> (i8, bool) {
        /// Above the dead zone of the device's facing test, relative to the lengths of its factors.
        const DEAD_ZONE: f64 = 1.0 / (1_u64 << 17) as f64;
        let light = self.center.as_dvec4();
        let (ab, ac, to_light) = (b - a, c - a, light.truncate() - a * light.w);
        let normal = ab.cross(ac);
        let g = normal.dot(to_light);
        let doubt = DEAD_ZONE * ab.length() * ac.length() * (to_light.length() + self.radius);
        (if g > 0.0 { 1 } else { -1 }, g.abs() > normal.length() * self.radius + doubt)
    }

    /// Whether a light of the ball may lie on a triangle.
    fn touches(&self, corners: [DVec3; 3]) -> bool {
        let light = self.center.truncate().as_dvec3();
        let margin = self.radius * (1.0 + ROUNDING);
        let (least, most) = (corners[0].min(corners[1]).min(corners[2]), corners[0].max(corners[1]).max(corners[2]));
        self.center.w != 0.0 && light.cmpge(least - margin).all() && light.cmple(most + margin).all()
    }

    /// Whether a ray in direction `way` from a light of the ball may meet the mesh.
    fn ray_may_meet(&self, topology: &Topology, way: DVec3) -> bool {
        let (bounds, light) = (topology.bounds(), self.center.truncate().as_dvec3());
        let to_center = bounds.center() - light;
        let along = to_center.dot(way).max(0.0);
        (to_center - way * along).length() <= (bounds.half().length() + self.radius) * (1.0 + ROUNDING)
    }
}

/// The most sides of an edge whose triangles have one of the weights possible for them.
fn most_sides<'a>(triangles: impl Iterator<Item = (&'a RangeInclusive<i8>, i32)>) -> u32 {
    let (mut least, mut most) = (0, 0);
    for (weights, orientation) in triangles {
        let ends = [i32::from(*weights.start()) * orientation, i32::from(*weights.end()) * orientation];
        least += ends[0].min(ends[1]);
        most += ends[0].max(ends[1]);
    }
    (-least).max(most).max(0).unsigned_abs()
}

/// How lines of directions are numbered, alike for all lights of a ball.
enum Lines {
    /// Half planes that end in the line through a point light along `pole`, by azimuth against `middle`.
    Meridians {
        pole: DVec3,
        across: [DVec3; 2],
        /// The middle of the mesh from the ball's, across; `None` where the ball is not small beside that, and columns stay.
        middle: Option<DVec2>,
    },
    /// Parallel rays, by where they cross an axis, in columns from the middle of the mesh.
    Parallels { axis: DVec3, middle: DVec3 },
}

impl Lines {
    fn new(ball: &Ball, topology: &Topology) -> Self {
        // Edges along a line all count in one column; no line lies along an axis of the mesh.
        let askew = |(u, v): (DVec3, DVec3)| 0.5547 * u + 0.8321 * v;
        let (light, bounds) = (ball.center.truncate().as_dvec3(), topology.bounds());
        if ball.center.w == 0.0 {
            let axis = askew(light.normalize_or(DVec3::Y).any_orthonormal_pair()).normalize_or(DVec3::X);
            let extent = 2.0 * bounds.half().length() * (1.0 + ball.radius);
            let columns = 0.99 * COLUMNS as f64 / extent.max(f64::MIN_POSITIVE);
            return Self::Parallels { axis: axis * columns, middle: bounds.center() };
        }
        let to_middle = bounds.center() - light;
        // A pole across the way to the mesh misses it wherever that can be.
        let pole = askew(to_middle.normalize_or(DVec3::Z).any_orthonormal_pair()).normalize_or(DVec3::X);
        let east = to_middle.normalize_or(DVec3::Z);
        let across = [east, pole.cross(east)];
        let middle = DVec2::new(to_middle.dot(across[0]), to_middle.dot(across[1]));
        Self::Meridians { pole, across, middle: (middle.length() > 4.0 * ball.radius).then_some(middle) }
    }

    /// The columns that an edge may touch, as if there were no end to them; `None` for all.
    fn span(&self, ball: &Ball, ends: [DVec3; 2]) -> Option<[f64; 2]> {
        match self {
            Self::Parallels { axis, middle } => {
                let [a, b] = ends.map(|p| {
                    let p = p - middle;
                    // The axis follows the light to stay across it.
                    let drift = (ball.radius + ROUNDING) * axis.length() * p.length();
                    (axis.dot(p), drift)
                });
                Some([(a.0 - a.1).min(b.0 - b.1), (a.0 + a.1).max(b.0 + b.1)])
            }
            Self::Meridians { across, middle, .. } => {
                let light = ball.center.truncate().as_dvec3();
                let [a, b] = ends.map(|p| {
                    let p = DVec2::new((p - light).dot(across[0]), (p - light).dot(across[1]));
                    (p.y.atan2(p.x), drift(p, *middle, ball.radius))
                });
                let turn = (b.0 - a.0).rem_euclid(TAU);
                // Less than half a circle for every light; where it may be more, it may pass a pole.
                let (from, to, by) = if turn <= PI { (a, b, turn) } else { (b, a, TAU - turn) };
                let width = from.1 + by + to.1;
                let columns = COLUMNS as f64 / TAU;
                // Neither for infinite drifts nor for what is not a number.
                (width < 0.999 * PI).then_some([(from.0 - from.1) * columns, (from.0 + by + to.1) * columns])
            }
        }
    }
}

/// The most by which the azimuth of `p` changes against that of `middle`, as the light moves by at most `radius`: the
/// derivative of `arg((p - x) / (middle - x))` is at most `|p - middle| / (|p - x| |middle - x|)`.
fn drift(p: DVec2, middle: Option<DVec2>, radius: f64) -> f64 {
    let away = p.length();
    if away <= radius {
        return f64::INFINITY;
    }
    let alone = |away: f64| (radius / away).min(1.0).asin();
    ROUNDING
        + match middle {
            None => alone(away),
            Some(middle) => {
                let distance = middle.length();
                let apart = radius * p.distance(middle) / ((away - radius) * (distance - radius));
                apart.min(alone(away) + alone(distance))
            }
        }
}

/// How many sides may touch each column.
struct Columns {
    /// Differences between neighbours.
    steps: Vec<i64>,
    /// In every column.
    all: u32,
}

impl Columns {
    fn new() -> Self {
        Self { steps: vec![0; COLUMNS + 1], all: 0 }
    }

    fn add(&mut self, span: Option<[f64; 2]>, sides: u32) {
        let Some([first, last]) = span.map(|ends| ends.map(f64::floor)) else {
            self.all = self.all.saturating_add(sides);
            return;
        };
        if last - first >= COLUMNS as f64 - 1.0 {
            self.all = self.all.saturating_add(sides);
            return;
        }
        let start = (first as i64).rem_euclid(COLUMNS as i64) as usize;
        let end = start + (last - first) as usize + 1;
        let sides = i64::from(sides);
        self.steps[start] += sides;
        self.steps[end.min(COLUMNS)] -= sides;
        if end > COLUMNS {
            self.steps[0] += sides;
            self.steps[end - COLUMNS] -= sides;
        }
    }

    fn most(&self) -> usize {
        let mut sum = 0;
        let most = self.steps[..COLUMNS].iter().map(|step| {
            sum += step;
            sum
        });
        usize::try_from(most.max().unwrap_or(0)).unwrap_or(0) + self.all as usize
    }
}

#[cfg(test)]
mod tests;
