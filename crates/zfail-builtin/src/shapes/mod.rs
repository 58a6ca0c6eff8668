//! Generated meshes: solids, turned and swept bodies, pierced slabs and open sheets.
//!
//! In: sizes in metres, counts of facets. Out: a [`Mesh`] with one primitive without material.
//!
//! Every solid is closed after a weld of bit-equal positions, wound counter-clockwise seen from outside. Rings take
//! their angles from one table indexed modulo its length, so that the last column is the first one bit for bit; a pole
//! is one position. Faces meeting below a crease angle share vertices and normals, others are flat against each other.
//! Texture coordinates are in metres.

mod assembly;
mod facets;
mod sheets;
mod solids;
mod swept;
mod turned;

pub use assembly::{merged, moved, painted, tinted};
pub use facets::Facets;
pub use sheets::{Slab, sheet};
pub use solids::{cuboid, divided_cuboid, ico_sphere};
pub use swept::{extruded, stairs, torus_knot, tube};
pub use turned::{capsule, cone, curve, cylinder, lathe, ring, torus, uv_sphere};

use glam::DVec2;
use zfail_scene::Mesh;

/// Edges sharper than this are creases, in radians, unless a generator says otherwise.
pub const CREASE: f64 = 0.7;

/// `n` points of the unit circle, counter-clockwise from +x; index it modulo `n`.
fn circle(n: usize) -> Vec<DVec2> {
    (0..n).map(|k| DVec2::from_angle(std::f64::consts::TAU * k as f64 / n as f64)).collect()
}

#[cfg(test)]
pub(super) mod checks;
#[cfg(test)]
mod tests;
