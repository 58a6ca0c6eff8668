//! What can go wrong, as the user reads it: one line that names the thing and the remedy, and an exit code.

use std::fmt;
use std::process::ExitCode;

/// Why the program stops.
#[derive(Debug, PartialEq, Eq)]
pub enum Error {
    /// The command line asks for something that does not exist: exit code 2.
    Usage(String),
    /// The work could not be done: exit code 1.
    Failed(String),
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
        match self {
            Self::Failed(_) => ExitCode::from(1),
            Self::Usage(_) => ExitCode::from(2),
        }
    }
}

impl fmt::Display for Error {
    /// Always a single line, whatever the source of the message.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (Self::Usage(message) | Self::Failed(message)) = self;
        let mut words = message.split_whitespace();
        f.write_str(words.next().unwrap_or("unknown error"))?;
        words.try_for_each(|word| write!(f, " {word}"))
    }
}

impl std::error::Error for Error {}

#[cfg(test)]
mod tests {
    use super::Error;

    #[test]
    fn a_message_of_many_lines_becomes_one_line() {
        assert_eq!(Error::failed("a\n  b\tc\n").to_string(), "a b c");
        assert_eq!(Error::usage("").to_string(), "unknown error");
    }
}
