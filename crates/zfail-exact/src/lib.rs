//! The renderer against the ray-cast oracle.
//!
//! In: seeds. Out: random scenes as lists of parts ([`recipe`], [`kinds`]), the comparison of their masks and counts
//! with the truth ([`mod@bench`]), and, where they differ, the least list of parts that still does ([`shrink`]).

pub mod bench;
pub mod kinds;
pub mod random;
pub mod recipe;
pub mod shapes;
pub mod shrink;
pub mod tally;
