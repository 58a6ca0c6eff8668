//! Pictures, read back and compared with what radiometry says.

mod blended;
mod edited;
mod exempt;
mod frame;
mod ground;
mod layers;
mod light;
mod shape;
mod sky;
mod support;
mod terminator;
mod textures;
