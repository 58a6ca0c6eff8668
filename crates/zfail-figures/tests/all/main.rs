//! Figures, read back and compared with what they must show.

mod over_picture;
mod paper;
mod support;
