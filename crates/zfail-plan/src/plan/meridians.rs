//! A quick bound on how many layers a ray from the light can cross, from silhouettes alone.
//!
//! In: the silhouettes of a light's casters. Out: a number that the count along no ray exceeds. Along a line of
//! directions from one pole to the other the count begins and ends with the count at the poles and changes only where the
//! line crosses silhouette edges; what goes up has to come down, so the count is at most half of poles and crossings
//! together. The lines are binned into columns, and every edge counts in all columns it touches. This costs as much as the
//! silhouette is long; the exact subdivision of [`crate::stack`] costs as much as the mesh is large.
//!
//! The poles lie askew to the axes of the world, for edges along a line all count in one column, and upright edges abound.

use super::near_count;
use super::placed::Placed;
use crate::bounds::Bounds;
use crate::casting::ObjectLight;
use crate::topology::Topology;
use glam::{DAffine3, DVec3, DVec4};
use std::f64::consts::{PI, TAU};

/// Columns of directions: those kept for every caster, and those tried where they are too coarse.
pub(super) const COARSE: usize = 256;
pub(super) const FINE: usize = 8192;

/// The direction of one pole, and two directions across it; no small multiple of any axis.
const POLE: DVec3 = DVec3::new(0.260_604_5, 0.864_313_2, 0.430_226_6);

/// How lines of directions are numbered, the same for all casters of a light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Lines {
    /// Great semicircles between both poles about a point light, by azimuth.
    Meridians {
        /// Of the columns' width on the whole circle, the part that they have. Narrow ones repeat, as parallels do.
        zoom: f64,
    },
    /// Parallel rays: by where they cross an axis, in steps. Columns repeat, which can only raise the bound.
    Parallels {
        /// Steps per unit along a direction across the light, world space.
        axis: DVec3,
    },
}

impl Lines {
    /// The lines for a homogeneous light over casters within `bounds`.
    pub fn new(light: DVec4, bounds: &Bounds) -> Self {
        if light.w != 0.0 {
            return Self::Meridians { zoom: 1.0 };
        }
        let (u, v) = light.truncate().normalize_or(DVec3::Y).any_orthonormal_pair();
        let across = u * 0.5547 + v * 0.8321;
        // A power of two, so that it seldom changes.
        let extent = 2.0 * bounds.half().length();
        let step = if extent > 0.0 && extent.is_finite() { (extent / 100.0).log2().ceil().exp2() } else { 1.0 };
        Self::Parallels { axis: across / step }
    }

    /// The lines for one caster alone, close enough to tell its own layers apart.
    pub fn of(light: DVec4, eye: DVec3, caster: &Placed) -> Self {
        if light.w == 0.0 {
            return Self::new(light, &caster.world);
        }
        let azimuths = caster.corners.map(|corner| azimuth(corner + eye - light.truncate()));
        let turns = azimuths.map(|a| (a - azimuths[0] + PI).rem_euclid(TAU) - PI);
        let width = turns.iter().fold(0.0, |w, t| f64::max(w, *t)) - turns.iter().fold(0.0, |w, t| f64::min(w, *t));
        Self::Meridians { zoom: (0.9 * TAU / width).clamp(1.0, 1e6) }
    }
}

/// Of a direction from the light, about the poles.
fn azimuth(direction: DVec3) -> f64 {
    let (east, north) = POLE.any_orthonormal_pair();
    direction.dot(north).atan2(direction.dot(east))
}

/// What one caster adds to every column.
#[derive(Clone, Debug, Default)]
pub(super) struct Crossings {
    /// By how much each column has more than the one before.
    steps: Vec<i32>,
    /// In every column, and layers at both poles together.
    everywhere: u32,
}

impl Crossings {
    /// No caster, in so many columns.
    pub fn clear(&mut self, columns: usize) {
        self.steps.clear();
        self.steps.resize(columns, 0);
        self.everywhere = 0;
    }

    /// Adds the crossings of one caster's silhouette for `light` in its object space. `silhouette` yields each edge as
    /// often as it has sides.
    pub fn count(
        &mut self,
        topology: &Topology,
        weights: &[i8],
        silhouette: impl Iterator<Item = [u32; 2]>,
        world_from_object: &DAffine3,
        light: ObjectLight,
        lines: Lines,
    ) {
        let columns = self.steps.len() as f64;
        let origin = light.truncate().as_dvec3();
        let matrix = world_from_object.matrix3;
        for edge in silhouette {
            let ends = edge.map(|v| topology.position(v));
            match lines {
                Lines::Meridians { zoom } => {
                    let [a, b] = ends.map(|p| azimuth(matrix * (p - origin)));
                    let turn = (b - a).rem_euclid(TAU);
                    // The arc of the edge is less than half a circle; through a pole it may be either half.
                    let (from, by) = if turn <= PI { (a, turn) } else { (b, TAU - turn) };
                    let scale = columns / TAU * zoom;
                    if by > 0.999 * PI || !by.is_finite() {
                        self.add(0.0, columns);
                    } else {
                        self.add(from * scale, (from + by) * scale);
                    }
                }
                Lines::Parallels { axis } => {
                    let [a, b] = ends.map(|p| axis.dot(world_from_object.transform_point3(p)));
                    let scale = columns / COARSE as f64;
                    self.add(a.min(b) * scale, a.max(b) * scale);
                }
            }
        }
        if matches!(lines, Lines::Meridians { .. }) {
            let object_from_world = matrix.inverse();
            for pole in [POLE, -POLE] {
                let way = object_from_world * pole;
                if crosses(&topology.bounds(), origin, way) {
                    self.everywhere += near_count::layers(topology, weights, light, way.extend(0.0));
                }
            }
        }
    }

    fn add(&mut self, from: f64, to: f64) {
        let (first, last) = (from.floor(), to.floor());
        let columns = self.steps.len();
        if last - first < columns as f64 - 1.0 {
            let start = (first as i64).rem_euclid(columns as i64) as usize;
            let end = start + (last - first) as usize + 1;
            self.steps[start] += 1;
            if end < columns {
                self.steps[end] -= 1;
            } else if end > columns {
                self.steps[0] += 1;
                self.steps[end - columns] -= 1;
            }
        } else {
            self.everywhere += 1;
        }
    }

    /// Adds those of another caster.
    pub fn merge(&mut self, other: &Self) {
        self.everywhere += other.everywhere;
        self.steps.iter_mut().zip(&other.steps).for_each(|(sum, n)| *sum += n);
    }

    /// The most layers that any ray can cross.
    pub fn bound(&self) -> usize {
        let mut column = 0;
        let columns = self.steps.iter().map(|step| {
            column += step;
            column
        });
        let most = columns.max().unwrap_or(0);
        (most.unsigned_abs() as usize + self.everywhere as usize) / 2
    }
}

/// Whether a ray may meet a box.
fn crosses(bounds: &Bounds, from: DVec3, way: DVec3) -> bool {
    let margin = 1e-9 * (bounds.half() + bounds.center().abs() + from.abs());
    let (mut near, mut far) = (0.0_f64, f64::INFINITY);
    for i in 0..3 {
        let (lo, hi) = (bounds.min[i] - margin[i] - from[i], bounds.max[i] + margin[i] - from[i]);
        if way[i] == 0.0 {
            if lo > 0.0 || hi < 0.0 {
                return false;
            }
        } else {
            let (a, b) = (lo / way[i], hi / way[i]);
            near = near.max(a.min(b));
            far = far.min(a.max(b));
        }
    }
    near <= far
}
