//! Host example.
fn main() {}
