//! The oracle against closed forms, brute force and seeded faults.

mod brute_force;
mod closed_form;
mod common;
mod controls;
