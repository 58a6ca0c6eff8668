//! The library on a device: pictures, counts and verdicts against rays, planes and each other.

mod host;
mod stage;
mod stencil;
mod techniques;
mod tiles;
mod verdict_bits;
