//! Every shadow method that the papers tell of, runnable side by side.
