//! The command line as a whole: the commands, and what is said where there is none or a wrong one.

use crate::commands::{adapters, bench, compare, gallery, info, render, verify};
use crate::console;
use crate::error::Error;
use crate::names;
use clap::error::{ContextKind, ErrorKind};
use clap::{CommandFactory, Parser, Subcommand};

/// Exact stencil shadows of glTF scenes: every shadow boundary to the pixel, without bias and without a shadow map.
#[derive(Debug, Parser)]
#[command(name = "zfail", version, max_term_width = 100, subcommand_required = true, arg_required_else_help = true)]
struct Cli {
    /// What to do.
    #[command(subcommand)]
    command: Command,
}

/// The commands.
#[derive(Debug, Subcommand)]
#[allow(clippy::large_enum_variant, reason = "there is one of them")]
enum Command {
    /// Render a scene to a picture, headless.
    Render(Box<render::Args>),
    /// Show what is in a scene: meshes and how closed they are, lights, cameras, what is not supported.
    Info(info::Args),
    /// Measure what frames cost, by technique, with shadows and without.
    Bench(bench::Args),
    /// Check the picture against a ray-cast oracle, on this machine's adapter and driver.
    Verify(verify::Args),
    /// Show methods of shadows, old and new, on one scene side by side: pictures, a page, and a table of wrong pixels.
    Compare(compare::Args),
    /// List the graphics adapters, in the order in which they are tried.
    Adapters(adapters::Args),
    /// Write the built-in scenes as .glb files with their pictures.
    Gallery(gallery::Args),
    /// Look at a scene in a window: move eye and lights, play animations, save what you see.
    #[cfg(feature = "view")]
    View(crate::commands::view::Args),
}

/// Does what the command line asks for.
///
/// # Errors
/// If it asks for something that does not exist, or that cannot be done.
pub fn run() -> Result<(), Error> {
    match Cli::try_parse() {
        Ok(cli) => console::contain_faults(|| cli.command.run()),
        Err(help_or_error) => explain(&help_or_error),
    }
}

impl Command {
    fn run(&self) -> Result<(), Error> {
        match self {
            Self::Render(args) => render::run(args),
            Self::Info(args) => info::run(args),
            Self::Bench(args) => bench::run(args),
            Self::Verify(args) => verify::run(args),
            Self::Compare(args) => compare::run(args),
            Self::Adapters(args) => adapters::run(args),
            Self::Gallery(args) => gallery::run(args),
            #[cfg(feature = "view")]
            Self::View(args) => crate::commands::view::run(args),
        }
    }
}

/// Help and version go to standard output; anything else that `clap` reports becomes one line.
fn explain(report: &clap::Error) -> Result<(), Error> {
    let text = report.render().to_string();
    let commands: Vec<String> = Cli::command().get_subcommands().map(|command| command.get_name().to_owned()).collect();
    match report.kind() {
        ErrorKind::DisplayHelp | ErrorKind::DisplayVersion => console::print(&text),
        ErrorKind::DisplayHelpOnMissingArgumentOrSubcommand => {
            Err(Error::usage(format!("no command given; there are: {}", commands.join(", "))))
        }
        ErrorKind::InvalidSubcommand => {
            let wanted = report.get(ContextKind::InvalidSubcommand).map(ToString::to_string).unwrap_or_default();
            Err(names::unknown("command", &wanted, &commands.iter().map(String::as_str).collect::<Vec<_>>()))
        }
        _ => {
            let said = |paragraph: &&str| !paragraph.starts_with("Usage:") && !paragraph.starts_with("For more");
            let paragraphs = text.trim_start_matches("error: ").split("\n\n").filter(said).map(str::trim);
            Err(Error::usage(format!("{}; --help explains", paragraphs.collect::<Vec<_>>().join("; "))))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn clap_finds_no_fault_in_the_definitions() {
        Cli::command().debug_assert();
    }
}
