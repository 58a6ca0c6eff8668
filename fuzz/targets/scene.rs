#![no_main]

libfuzzer_sys::fuzz_target!(init: zfail_fuzz::prepare(), |bytes: &[u8]| zfail_fuzz::loading::scene(bytes));
libfuzzer_sys::fuzz_mutator!(|data: &mut [u8], size: usize, max_size: usize, seed: u32| {
    zfail_fuzz::mutate::scene(data, size, max_size, seed)
});
