//! What can go wrong, as the user reads it: one line that names the thing and the remedy, and an exit code.
//!
//! An error that tells all of this by itself converts; one that does not, such as that of a file, which does not know its
//! name, is turned into a sentence where it happens.

use std::error::Error as StdError;
use std::fmt;
use std::process::ExitCode;
use zfail_oracle::SizeMismatch;
use zfail_render::{RenderError, wgpu, zfail};

/// Why the program stops.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// The command line asks for something that does not exist: exit code 2.
    Usage(String),
    /// The work could not be done; exit code 1, as for all below.
    Failed(String),
    /// Nothing could be rendered.
    Render(#[from] RenderError),
    /// The library refused.
    Shadows(#[from] zfail::Error),
    /// The device did not finish.
    Device(#[from] wgpu::PollError),
    /// Figures could not be drawn.
    Figures(#[from] zfail_figures::Error),
    /// A method failed.
    Method(#[from] zfail_methods::Error),
    /// A picture cannot be compared with the truth.
    Incomparable(#[from] SizeMismatch),
    /// The viewer stopped.
    #[cfg(feature = "view")]
    View(#[from] zfail_view::ViewError),
    /// A report could not be encoded, which is a bug.
    Report(#[from] serde_json::Error),
    /// An image could not be encoded.
    Png(#[from] png::EncodingError),
    /// Likewise.
    Exr(#[from] exr::error::Error),
}

impl Error {
    /// A wrong command line.
    pub fn usage(message: impl Into<String>) -> Self {
        Self::Usage(message.into())
    }

    /// Work that could not be done.
    pub fn failed(message: impl Into<String>) -> Self {
        Self::Failed(message.into())
    }

    /// 1 for work that failed, 2 for wrong usage.
    pub fn exit_code(&self) -> ExitCode {
        ExitCode::from(if matches!(self, Self::Usage(_)) { 2 } else { 1 })
    }

    fn message(&self) -> String {
        match self {
            Self::Usage(message) | Self::Failed(message) => message.clone(),
            Self::Render(e) => chain(e),
            Self::Shadows(e) => chain(e),
            Self::Device(e) => chain(e),
            Self::Figures(e) => chain(e),
            Self::Method(e) => chain(e),
            Self::Incomparable(e) => chain(e),
            #[cfg(feature = "view")]
            Self::View(e) => chain(e),
            Self::Report(e) => format!("cannot encode the report: {e}"),
            Self::Png(e) => format!("cannot encode the image: {e}"),
            Self::Exr(e) => format!("cannot encode the image: {e}"),
        }
    }
}

impl fmt::Display for Error {
    /// Always a single line, whatever the source of the message.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let message = self.message();
        let mut words = message.split_whitespace();
        f.write_str(words.next().unwrap_or("unknown error"))?;
        words.try_for_each(|word| write!(f, " {word}"))
    }
}

/// An error with its causes, each said once.
pub fn chain(error: &dyn StdError) -> String {
    let mut text = error.to_string();
    let mut cause = error.source();
    while let Some(error) = cause {
        let reason = error.to_string();
        if !text.contains(&reason) {
            text = format!("{text}: {reason}");
        }
        cause = error.source();
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_message_of_many_lines_becomes_one_line() {
        assert_eq!(Error::failed("a\n  b\tc\n").to_string(), "a b c");
        assert_eq!(Error::usage("").to_string(), "unknown error");
    }

    #[test]
    fn causes_are_told_once() {
        #[derive(Debug, thiserror::Error)]
        #[error("{0}")]
        struct Said(&'static str, #[source] Option<Box<Said>>);
        let cause = |text| Some(Box::new(Said(text, None)));
        assert_eq!(chain(&Said("no scene", cause("no file"))), "no scene: no file");
        assert_eq!(chain(&Said("no scene: no file", cause("no file"))), "no scene: no file");
    }
}
