//! The program `zfail`.
fn main() {}
