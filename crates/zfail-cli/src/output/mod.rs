//! Files: their bytes, and how they get to the disk.

pub mod encode;
mod files;
mod format;
pub mod html;

pub use files::{Outputs, check_file, check_folder, folder_of, sweep};
pub use format::Format;
