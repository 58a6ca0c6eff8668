//! Tests of the glTF reader through its public interface.

mod animating;
mod bending;
mod build;
mod files;
mod geometry;
mod hostile;
mod nodes;
mod posing;
