//! What the tests of the workspace share: the rule of what happens where a machine lacks something.
//!
//! A test that needs a graphics adapter, a display or a browser fails without one: a test that passes without having looked
//! proves nothing. Who has none and knows it says so in the environment, and then the test says that it is skipped.

use std::env;
use std::fmt::Display;

/// What a test may need of the machine.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Need {
    /// A graphics adapter, be it a software one. `ZFAIL_WITHOUT_GPU` does without.
    Gpu,
    /// An X server and what drives it. `ZFAIL_WITHOUT_DISPLAY` does without.
    Display,
    /// A browser and what drives it. `ZFAIL_WITHOUT_BROWSER` does without.
    Browser,
}

impl Need {
    /// The variable with which a user does without.
    #[must_use]
    pub const fn variable(self) -> &'static str {
        match self {
            Self::Gpu => "ZFAIL_WITHOUT_GPU",
            Self::Display => "ZFAIL_WITHOUT_DISPLAY",
            Self::Browser => "ZFAIL_WITHOUT_BROWSER",
        }
    }

    /// What was found; `None`, and a line that says so, where it was not and need not be.
    ///
    /// # Panics
    /// Where it was not found and has to be.
    pub fn found<T>(self, outcome: Result<T, impl Display>) -> Option<T> {
        self.unless(outcome, env::var_os(self.variable()).is_some_and(|value| !value.is_empty()))
    }

    fn unless<T>(self, outcome: Result<T, impl Display>, without: bool) -> Option<T> {
        match outcome {
            Ok(found) => Some(found),
            Err(why) if without => {
                eprintln!("skipped, for {} is set: {why}", self.variable());
                None
            }
            Err(why) => panic!("{why}; set {}=1 to skip what needs it", self.variable()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Need;

    #[test]
    fn what_is_there_is_taken_and_what_is_not_may_be_done_without() {
        assert_eq!(Need::Gpu.unless(Ok::<_, String>(3), false), Some(3));
        assert_eq!(Need::Gpu.unless(Err::<u32, _>("no adapter"), true), None);
    }

    #[test]
    #[should_panic(expected = "no adapter; set ZFAIL_WITHOUT_GPU=1")]
    fn otherwise_the_test_fails() {
        let _ = Need::Gpu.unless(Err::<u32, _>("no adapter"), false);
    }
}
