//! Tests of the glTF reader through its public interface.

mod animating;
mod bending;
mod build;
mod compressed;
mod files;
mod forgiving;
mod geometry;
mod hostile;
mod images;
mod nodes;
mod plain;
mod posing;
