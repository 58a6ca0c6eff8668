//! What is said besides results.

use clap::Args;

/// What is said besides results.
#[derive(Args, Clone, Debug)]
pub struct Verbosity {
    /// No notices and no progress; errors are still reported.
    #[arg(short, long)]
    pub quiet: bool,
}
