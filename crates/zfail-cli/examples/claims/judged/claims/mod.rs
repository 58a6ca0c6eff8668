//! The list, by what the claims are about.

mod cases;
mod letter;
mod order;
mod precision;
mod right;
mod speed;

use super::claim::Claim;

/// Titles, and the claims under each.
pub fn themes() -> [(&'static str, Vec<Claim>); 6] {
    [
        ("Bits", precision::claims()),
        ("How much is drawn", order::claims()),
        ("How likely each case is", cases::claims()),
        ("How fast", speed::claims()),
        ("Carmack's letter: what volumes cost, and shadow maps", letter::claims()),
        ("Right everywhere", right::claims()),
    ]
}
