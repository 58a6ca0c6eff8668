//! zfail-render
