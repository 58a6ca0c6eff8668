//! Masked surfaces as geometry: triangles cut along the contour of their texture's alpha.
//!
//! In: a scene, and how far the cut may be off, in texels. Out: the same scene with opaque triangles where masked ones
//! were, which are drawn and cast like all others, so that the picture and the shadows agree exactly.
//!
//! Data flow: `field` (alpha as a function) -> `trace` (its contour) -> `simplify` (fewer points) -> `outline` (to be asked
//! by place, with the buckets of `grid`) -> `triangle` (one triangle's pieces) -> `vertices` -> `mesh` (a whole mesh).
//!
//! # What the bound says
//! A contour is where alpha on the texture's largest level, bilinearly interpolated (or not, if the texture is magnified
//! without), times the material's and the vertices' alpha, equals the cutoff, which is moved by less than 10^-6 to keep
//! clear of texels. Every polygon lies within the tolerance of its contour and the contour within the tolerance of its
//! polygon, and the two have the same shape: no hole closes, no island vanishes, nothing joins or parts.
//!
//! Positions are then interpolated in `f64` and rounded to `f32`. On an edge between two triangles both have the same
//! points, bit for bit, if they have the same texture coordinates there.
//!
//! # What stays as it is
//! Masked triangles whose vertices differ in alpha, and all that would exceed the [`Limits`]; a notice says so. Triangles
//! without area on the texture are kept or left out as a whole, as alpha in their middle is.

mod field;
mod grid;
mod mesh;
mod outline;
mod simplify;
mod trace;
mod triangle;
mod vertices;

#[cfg(test)]
mod tests;

pub use mesh::{CutMesh, Limits, cut_masked};
pub(crate) use vertices::extend;
pub use vertices::{Source, derive};
