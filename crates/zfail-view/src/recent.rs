//! The files that were open lately, one path a line in a small text file of the user's state folder.
//!
//! It is a convenience: whatever goes wrong with it is passed over.

use std::env;
use std::fs;
use std::path::{Path, PathBuf};

/// How many are remembered.
const MOST: usize = 12;

/// Recently opened files, the latest first.
#[derive(Clone, Debug, Default)]
pub struct Recent {
    file: Option<PathBuf>,
    paths: Vec<String>,
}

impl Recent {
    /// What the user's state folder remembers.
    #[must_use]
    pub fn load() -> Self {
        Self::from_file(state_folder().map(|folder| folder.join("zfail/recent")))
    }

    fn from_file(file: Option<PathBuf>) -> Self {
        let text = file.as_ref().and_then(|file| fs::read_to_string(file).ok()).unwrap_or_default();
        let paths = text.lines().filter(|line| !line.is_empty()).take(MOST).map(str::to_owned).collect();
        Self { file, paths }
    }

    /// Paths, the latest first.
    #[must_use]
    pub fn paths(&self) -> &[String] {
        &self.paths
    }

    /// Puts a file first.
    pub fn add(&mut self, path: &str) {
        let path = std::path::absolute(path).map_or(path.to_owned(), |absolute| absolute.display().to_string());
        if path.contains('\n') {
            return;
        }
        self.paths.retain(|known| *known != path);
        self.paths.insert(0, path);
        self.paths.truncate(MOST);
        if let Some(file) = &self.file {
            // Nobody is helped by an error here.
            let _ = file.parent().map(fs::create_dir_all);
            let _ = fs::write(file, self.paths.join("\n") + "\n");
        }
    }
}

/// Where programs keep such things.
fn state_folder() -> Option<PathBuf> {
    let absolute = |name: &str| env::var_os(name).map(PathBuf::from).filter(|path| path.is_absolute());
    let home = |below: &str| env::home_dir().filter(|home| home.is_absolute()).map(|home| home.join(below));
    if cfg!(windows) {
        absolute("LOCALAPPDATA")
    } else if cfg!(target_os = "macos") {
        home("Library/Application Support")
    } else {
        absolute("XDG_STATE_HOME").or_else(|| home(".local/state"))
    }
}

/// The last part of a path, for lists.
#[must_use]
pub fn short(path: &str) -> &str {
    Path::new(path).file_name().and_then(|name| name.to_str()).unwrap_or(path)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_latest_comes_first_and_is_there_next_time() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let file = folder.path().join("new/recent");
        let mut recent = Recent::from_file(Some(file.clone()));
        assert!(recent.paths().is_empty());
        for name in ["/a.glb", "/b.glb", "/a.glb"] {
            recent.add(name);
        }
        assert_eq!(Recent::from_file(Some(file)).paths(), ["/a.glb", "/b.glb"]);
        (0..50).for_each(|i| recent.add(&format!("/{i}")));
        assert_eq!(recent.paths().len(), MOST);
    }

    #[test]
    fn a_place_that_cannot_be_written_is_no_error() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let blocked = folder.path().join("file");
        fs::write(&blocked, "").expect("a file");
        let mut recent = Recent::from_file(Some(blocked.join("recent")));
        recent.add("/a.glb");
        assert_eq!(recent.paths(), ["/a.glb"]);
    }
}
