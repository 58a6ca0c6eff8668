//! The program `zfail`: exact stencil shadows of glTF scenes, headless or in a window.
//!
//! In: a command line. Out: files, or text on standard output; notices and errors on standard error. Exit code 0 for
//! done, 1 for failed, 2 for wrong usage.
//!
//! Floors, each of which knows only those below it: `cli` (the command line as a whole) -> `commands` (one each, with its own
//! arguments) -> `input` (scenes) -> `groups` (arguments that several commands have) -> `output` (files) -> `console` (what is
//! said) -> `names` -> `error`.

mod cli;
mod commands;
mod console;
mod error;
mod groups;
mod input;
mod names;
mod output;

use std::process::ExitCode;

fn main() -> ExitCode {
    console::mesa::silence();
    match cli::run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            console::error(&error);
            error.exit_code()
        }
    }
}
