//! zfail
