//! The graphics device: how it is opened, waited for, read and timed.

pub mod gpu;
pub mod read_back;
pub mod timing;
