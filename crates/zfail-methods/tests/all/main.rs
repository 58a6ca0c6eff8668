//! Methods of the books side by side.

mod claims;
mod images;
mod support;
