//! How many triangles a ray from the light can cross: a bound that keeps 8-bit stencil counts from wrapping to "lit".
//!
//! In: the silhouettes of a light's casters, or their boxes. Out: whether no ray crosses more than a given number of layers.
//! Since weights may be restricted to any subset of triangles and still give a closed volume, casters that fail are drawn in
//! batches, each folded into a sticky stencil bit before the next.
//!
//! E&K section 3.1 and McGuire et al. section 4 ask for enough stencil bits instead.
//!
//! The search is a quadtree over directions: a cell in which so many layers are impossible is done, others are divided.
//! Everything is decided conservatively and no search goes on for longer than its [`Work`] allows, so the bound can only be
//! too high, which costs time and never a pixel.

mod bodies;
mod cell;
mod outline;
mod star;

pub use bodies::{Body, are_within};
pub use outline::{Caster, Outline};

use crate::casting::ObjectLight;
use glam::{DAffine3, DMat3, DVec3, DVec4};

/// Divisions after which a cell counts as indivisible: about 10^-6 of a cube face.
const DEPTH: u32 = 20;

/// What searches may still cost, in members of cells that are looked at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Work {
    left: u64,
    spent: u64,
}

impl Work {
    /// As much.
    #[must_use]
    pub const fn of(most: u64) -> Self {
        Self { left: most, spent: 0 }
    }

    /// What has been done so far.
    #[must_use]
    pub const fn spent(&self) -> u64 {
        self.spent
    }

    /// Whether nothing more may be done.
    #[must_use]
    pub const fn is_over(&self) -> bool {
        self.left == 0
    }

    /// Whether so much may be done; it counts as done.
    fn take(&mut self, members: usize) -> bool {
        let members = members as u64;
        let allowed = members <= self.left;
        self.left = self.left.saturating_sub(members);
        self.spent += if allowed { members } else { 0 };
        allowed
    }
}

/// How directions are parametrised.
#[derive(Clone, Debug)]
pub enum Chart {
    /// All directions from a point, on the faces of a cube.
    Sphere,
    /// Parallel rays, told apart by where they cross a plane.
    Plane {
        /// First axis of the plane.
        u: DVec3,
        /// Second axis of the plane.
        v: DVec3,
        /// Its normal, towards the light; a right-handed chart with the axes.
        normal: DVec3,
        /// Centre of the casters.
        center: DVec3,
        /// Scales the casters into -1..1.
        scale: f64,
    },
}

impl Chart {
    /// The chart for a homogeneous light and the bounding box of all casters.
    #[must_use]
    pub fn new(light: DVec4, bounds: &crate::bounds::Bounds) -> Self {
        if light.w != 0.0 {
            return Self::Sphere;
        }
        let normal = light.truncate().normalize_or(DVec3::Y);
        let (u, v) = normal.any_orthonormal_pair();
        let v = if u.cross(v).dot(normal) < 0.0 { -v } else { v };
        let radius = bounds.half().length();
        // Slightly inside the unit square, so that rounding pushes nothing over its border.
        let scale = if radius > 0.0 { 0.999 / radius } else { 1.0 };
        Self::Plane { u, v, normal, center: bounds.center(), scale }
    }

    /// Where a ray from the light through `p` goes, in homogeneous coordinates of the chart.
    fn direction(&self, p: DVec3, light: DVec4) -> DVec3 {
        match self {
            Self::Sphere => p * light.w - light.truncate(),
            Self::Plane { u, v, center, scale, .. } => {
                let p = (p - *center) * *scale;
                DVec3::new(p.dot(*u), p.dot(*v), 1.0)
            }
        }
    }

    fn faces(&self) -> usize {
        match self {
            Self::Sphere => 6,
            Self::Plane { .. } => 1,
        }
    }

    /// How one caster's points are seen from its own light, object space, which is rounded as its volume is.
    fn sight(&self, world_from_object: &DAffine3, light: ObjectLight) -> Sight {
        let origin = light.truncate().as_dvec3();
        let matrix = world_from_object.matrix3;
        let mirror = if matrix.determinant() < 0.0 { -1.0 } else { 1.0 };
        match *self {
            // What is counter-clockwise from the light is clockwise about a ray that goes away from it.
            Self::Sphere => Sight { matrix, origin, shift: DVec3::ZERO, turn: -mirror },
            Self::Plane { u, v, normal, center, scale } => {
                let way = matrix * origin;
                let steep = normal.dot(way);
                // Along the caster's own rays into the plane through the middle, and there into its coordinates.
                let shear = if steep > 0.5 * way.length() { way / steep } else { normal };
                let flat = DMat3::IDENTITY - DMat3::from_cols(shear * normal.x, shear * normal.y, shear * normal.z);
                let flat = DMat3::from_cols(u, v, DVec3::ZERO).transpose() * flat * scale;
                let shift = flat * (world_from_object.translation - center) + DVec3::Z;
                Sight { matrix: flat * matrix, origin: DVec3::ZERO, shift, turn: mirror }
            }
        }
    }
}

/// Maps a caster's points to directions of a [`Chart`].
#[derive(Clone, Copy, Debug)]
struct Sight {
    matrix: DMat3,
    origin: DVec3,
    shift: DVec3,
    /// 1 if what is counter-clockwise from the light has positive determinants, -1 if it has negative ones.
    turn: f64,
}

impl Sight {
    /// Of unit length, the same for the same point.
    fn direction(&self, p: DVec3) -> DVec3 {
        (self.matrix * (p - self.origin) + self.shift).normalize_or_zero()
    }
}
