//! zfail-oracle
