//! The built-in scenes as a user sees them.

mod framing;
