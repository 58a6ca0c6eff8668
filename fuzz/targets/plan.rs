#![no_main]

libfuzzer_sys::fuzz_target!(init: zfail_fuzz::prepare(), |bytes: &[u8]| zfail_fuzz::deep::check(bytes));
