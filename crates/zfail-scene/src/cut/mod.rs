//! Masked surfaces as geometry: triangles cut along the contour of their texture's alpha.
//!
//! In: a scene, and how far the cut may be off, in texels. Out: the same scene with opaque triangles where masked ones
//! were, which are drawn and cast like all others, so that the picture and the shadows agree exactly.
//!
//! Data flow: `field` (alpha as a function) -> `trace` (its contour) -> `simplify` (fewer points) -> `outline` (to be asked
//! by place, with the buckets of `grid`) -> `triangle` (one triangle's pieces) -> `vertices` -> `mesh` (a whole mesh).
//! Where vertices differ in alpha, `product` takes the place of the first four, triangle by triangle: `edge` (crossings of
//! edges) -> `cells` (the contour in between). `masks` says what a mesh is cut along, `limits` what that may cost.
//!
//! # What the bound says
//! A contour is where alpha on the texture's largest level, bilinearly interpolated (or not, if the texture is magnified
//! without), times the material's and the vertices' alpha, equals the cutoff, which is moved by less than 10^-6 to keep
//! clear of texels. Every polygon lies within the tolerance of its contour and the contour within the tolerance of its
//! polygon, and the two have the same shape: no hole closes, no island vanishes, nothing joins or parts.
//!
//! Positions are then interpolated in `f64` and rounded to `f32`. On an edge between two triangles both have the same
//! points, bit for bit, if they have the same texture coordinates and the same alpha there.
//!
//! # Where it does not hold
//! What would exceed the [`Limits`] is cut more coarsely, and loses details where it has no end of them; a notice states the
//! error (decision 0025). For triangles without area on the texture, its alpha in their middle counts everywhere.

mod cells;
mod edge;
mod field;
mod grid;
mod limits;
mod masks;
mod mesh;
mod outline;
mod product;
mod simplify;
mod trace;
mod triangle;
mod vertices;

#[cfg(test)]
mod product_tests;
#[cfg(test)]
mod tests;

pub use limits::Limits;
pub use mesh::{CutMesh, cut_masked};
pub(crate) use vertices::extend;
pub use vertices::{Source, derive};
