//! Claims, what is said to them, and the page on which both meet.
//!
//! Data flow: `experiments` and the program's own output -> `said` -> the figures of a `claim`, and by its rule the verdict ->
//! `page`. `claims` is the list.

pub mod claim;
pub mod claims;
pub mod experiments;
pub mod page;
pub mod said;

pub use said::Inputs;
