//! Why a file cannot be loaded, in words that name the file, the element and the remedy.

use std::io;
use std::path::PathBuf;
use thiserror::Error;

/// A file that cannot be loaded.
#[derive(Debug, Error)]
#[error("{}: {fault}", file.display())]
pub struct LoadError {
    /// The file that was asked for.
    pub file: PathBuf,
    /// What is wrong with it.
    pub fault: Fault,
}

/// What is wrong with a file. Elements are named by their JSON path, such as `accessors[3].byteOffset`, or by
/// their line.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum Fault {
    /// The file itself cannot be read.
    #[error("cannot be read: {0}")]
    Unreadable(io::Error),
    /// Neither a GLB container nor a JSON document.
    #[error("is not a glTF 2.0 file: {0}; the other formats that are read end in .obj, .stl or .ply")]
    NotGltf(String),
    /// An .obj, .stl or .ply file that its format does not allow, or that has nothing to draw.
    #[error("{element}: {problem}; {remedy}")]
    Malformed {
        /// Line or element.
        element: String,
        /// What is wrong.
        problem: String,
        /// What helps.
        remedy: &'static str,
    },
    /// The JSON breaks the specification in a way that leaves no doubt-free repair.
    #[error("{element}: {problem}; export the file again, or see what the Khronos glTF validator says about it")]
    Invalid {
        /// JSON path.
        element: String,
        /// What is wrong.
        problem: String,
    },
    /// An external file that the document names is missing, unreadable or out of bounds.
    #[error("{element}: cannot read `{uri}`: {problem}; put the file there, or export as one .glb")]
    Resource {
        /// JSON path.
        element: String,
        /// The reference as written, shortened.
        uri: String,
        /// What went wrong.
        problem: String,
    },
    /// The file has no variant of its materials as asked for.
    #[error("there is no variant '{wanted}'; there are: {there_are}")]
    Variant {
        /// Name or number.
        wanted: String,
        /// The names.
        there_are: String,
    },
    /// Loading would need more memory than [`super::Limits`] allows.
    #[error("{element}: needs more than the limit of {limit}; simplify the scene, or raise the limit")]
    TooLarge {
        /// JSON path.
        element: String,
        /// The limit with its unit.
        limit: String,
    },
}

pub(super) type Result<T> = std::result::Result<T, Fault>;

pub(super) fn invalid(element: impl AsRef<str>, problem: impl AsRef<str>) -> Fault {
    Fault::Invalid { element: one_line(element.as_ref()), problem: one_line(problem.as_ref()) }
}

pub(super) fn malformed(element: impl AsRef<str>, problem: impl AsRef<str>, remedy: &'static str) -> Fault {
    Fault::Malformed { element: one_line(element.as_ref()), problem: one_line(problem.as_ref()), remedy }
}

/// `text`, which may quote anything from a file, fit for one line on a terminal: without control characters, and
/// shortened.
pub(super) fn one_line(text: &str) -> String {
    const MAX_CHARS: usize = 300;
    let mut line: String = text.chars().take(MAX_CHARS).map(|c| if c.is_control() { ' ' } else { c }).collect();
    if line.len() < text.len() {
        line.push_str("...");
    }
    line
}
