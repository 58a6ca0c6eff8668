//! What the program does: a module for each command, with the command's own arguments beside what it does with them.

pub mod adapters;
pub mod bench;
pub mod compare;
pub mod gallery;
pub mod info;
mod judged;
pub mod render;
pub mod verify;
#[cfg(feature = "view")]
pub mod view;
