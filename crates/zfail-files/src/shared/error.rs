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
    /// A GLB container that is damaged.
    #[error("the GLB container is damaged: {0}; download or export the file again")]
    Damaged(String),
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
    #[error("{element}: {problem}; {remedy}")]
    Invalid {
        /// JSON path.
        element: String,
        /// What is wrong.
        problem: String,
        /// What to do about it.
        remedy: &'static str,
    },
    /// An external file that the document names is missing, unreadable or out of bounds.
    #[error("{element}: cannot read `{uri}`: {problem}; {remedy}")]
    Resource {
        /// JSON path.
        element: String,
        /// The name of the file, or the begin of a data URI.
        uri: String,
        /// What went wrong.
        problem: String,
        /// What to do about it.
        remedy: &'static str,
    },
    /// The file has no variant of its materials as asked for.
    #[error("there is no variant '{wanted}'; there are: {there_are}")]
    Variant {
        /// Name or number.
        wanted: String,
        /// The names.
        there_are: String,
    },
    /// Loading would need more memory than [`crate::Limits`] allows.
    #[error("{element}: needs more than the limit of {limit}; simplify the scene, or raise the limit")]
    TooLarge {
        /// JSON path.
        element: String,
        /// The limit with its unit.
        limit: String,
    },
}

pub(crate) type Result<T> = std::result::Result<T, Fault>;

impl Fault {
    /// A file of the generation before glTF 2.0.
    pub(crate) fn old(version: &str) -> Self {
        let problem = format!("this is glTF {version}, an older format with another structure; only 2.x can be read");
        refused("asset.version", problem, "convert the file, for example with `gltf-pipeline -i OLD -o NEW.glb`")
    }

    /// What is wrong and where, if that is a part of the JSON or of its data.
    pub(crate) fn problem(&self) -> Option<String> {
        match self {
            Self::Invalid { element, problem, .. } => Some(format!("{element}: {problem}")),
            _ => None,
        }
    }
}

/// A fault of the file that its exporter has to mend.
pub(crate) fn invalid(element: impl AsRef<str>, problem: impl AsRef<str>) -> Fault {
    refused(element, problem, "export the file again, or see what the Khronos glTF validator says about it")
}

/// What the reader has left where a part of the JSON could not be understood.
pub(crate) fn misunderstood(fault: &str) -> Fault {
    let (element, problem) = fault.split_once(": ").unwrap_or(("the JSON", fault));
    invalid(element, problem)
}

/// A fault with another remedy.
pub(crate) fn refused(element: impl AsRef<str>, problem: impl AsRef<str>, remedy: &'static str) -> Fault {
    Fault::Invalid { element: one_line(element.as_ref()), problem: one_line(problem.as_ref()), remedy }
}

pub(crate) fn malformed(element: impl AsRef<str>, problem: impl AsRef<str>, remedy: &'static str) -> Fault {
    Fault::Malformed { element: one_line(element.as_ref()), problem: one_line(problem.as_ref()), remedy }
}

/// `text`, which may quote anything from a file, fit for one line on a terminal: without control characters, and
/// shortened.
pub(crate) fn one_line(text: &str) -> String {
    const MAX_CHARS: usize = 300;
    let mut line: String = text.chars().take(MAX_CHARS).map(|c| if c.is_control() { ' ' } else { c }).collect();
    if line.len() < text.len() {
        line.push_str("...");
    }
    line
}
