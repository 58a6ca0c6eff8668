//! What the viewer has to say.

/// A line in the window.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Message {
    /// Something did not work.
    Error(String),
    /// Something about the scene that one should know.
    Note(String),
    /// Something was done.
    Done(String),
    /// A command line.
    Command(String),
}

impl Message {
    /// Its words.
    #[must_use]
    pub fn text(&self) -> &str {
        let (Self::Error(text) | Self::Note(text) | Self::Done(text) | Self::Command(text)) = self;
        text
    }
}
