//! The program from outside: what it prints, what it writes, how it ends.

mod assets;
mod bench;
mod benchmarks;
mod claims;
mod compare;
mod compare_page;
mod documents;
mod floors;
mod frames;
mod guide;
mod info;
mod overlays;
mod readmes;
mod render;
mod sections;
mod support;
mod usage;
mod verify;
mod view;
