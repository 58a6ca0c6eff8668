//! zfail-scene
