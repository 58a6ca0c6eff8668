//! Coverage-guided fuzzing of the loaders, and of planning.
//!
//! In: bytes that libFuzzer makes up. Out: a crash where loading panics, takes more memory than its limits allow, or
//! returns a scene that breaks the rules of its types; hangs are libFuzzer's to find (`-timeout`). What a target does
//! with its bytes is in `crates/zfail-files/tests/corpus/loading.rs`, where an ordinary test replays seeds and findings.
//! Planning crashes where its search goes beyond its budget or counts wrap; see `crates/zfail-plan/tests/all/deep`.

#[path = "../../crates/zfail-files/tests/corpus/loading.rs"]
pub mod loading;
#[path = "../../crates/zfail-plan/tests/all/deep/mod.rs"]
pub mod deep;
pub mod mutate;

use cap::Cap;
use std::alloc::System;

/// Refuses what is beyond the limit, which ends the process.
#[global_allocator]
static ALLOCATOR: Cap<System> = Cap::new(System, loading::MEMORY);

/// To be called once, before the first input.
pub fn prepare() {
    // Threads would only wait for each other: inputs are small, and libFuzzer runs one process per core.
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).use_current_thread();
    pool.build_global().expect("the first thread pool");
}
