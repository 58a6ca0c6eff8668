//! The program `zfail`: exact stencil shadows of glTF scenes, headless.
//!
//! In: a command line. Out: files, or text on standard output; notices and errors on standard error. Exit code 0 for
//! done, 1 for failed, 2 for wrong usage.

mod adapters;
mod args;
mod bench;
mod compare;
mod console;
mod contact_sheet;
mod encode;
mod error;
mod gallery;
mod html;
mod info;
mod input;
mod judged;
mod mesa;
mod names;
mod numbering;
mod output;
mod render;
mod verify;

use args::{Cli, Command};
use clap::Parser;
use std::process::ExitCode;

fn main() -> ExitCode {
    mesa::silence();
    let result = match Cli::try_parse() {
        Ok(cli) => console::contain_faults(|| run(&cli.command)),
        Err(help_or_error) => console::explain(&help_or_error),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            console::error(&error);
            error.exit_code()
        }
    }
}

fn run(command: &Command) -> Result<(), error::Error> {
    match command {
        Command::Render(args) => render::run(args),
        Command::Info(args) => info::run(args),
        Command::Bench(args) => bench::run(args),
        Command::Verify(args) => verify::run(args),
        Command::Compare(args) => compare::run(args),
        Command::Adapters(args) => adapters::run(args),
        Command::Gallery(args) => gallery::run(args),
    }
}
