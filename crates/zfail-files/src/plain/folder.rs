//! The files that a model names plainly: material libraries and textures, at or below the model's own folder.
//!
//! In: names as they are spelt on whatever machine. Out: the files that they mean here. Where the name is a path of that
//! machine, the file of the same name beside the model is meant; letters may differ in case.

use crate::shared::error::Result;
use crate::shared::limits::Budget;
use crate::shared::uri;
use std::cell::RefCell;
use std::collections::BTreeMap;
use std::ffi::OsString;
use std::fs;
use std::path::{Component, Path, PathBuf};

/// Listing folders takes time, which a file cannot be allowed to choose.
const MAX_ENTRIES: usize = 1 << 16;

pub(crate) struct Folder<'a> {
    path: &'a Path,
    budget: &'a Budget,
    /// What lies in the folders that have been listed, by their path from this one.
    listings: RefCell<BTreeMap<PathBuf, Vec<OsString>>>,
}

impl<'a> Folder<'a> {
    pub fn new(path: &'a Path, budget: &'a Budget) -> Self {
        let path = if path.as_os_str().is_empty() { Path::new(".") } else { path };
        Self { path, budget, listings: RefCell::default() }
    }

    /// The path from here to the file that `name` means in the folder `inner` below, or here; or what is wrong with it.
    pub fn find(&self, name: &[u8], inner: &Path) -> std::result::Result<PathBuf, &'static str> {
        let name: Vec<u8> = name.iter().filter(|b| **b != b'"').map(|b| if *b == b'\\' { b'/' } else { *b }).collect();
        let file = name.rsplit(|b| *b == b'/').next().unwrap_or_default();
        let (whole, file) = (native(&name), native(file));
        let candidates = [inner.join(&whole), whole.clone(), inner.join(&file), file];
        match candidates.iter().find_map(|candidate| self.spelt(candidate)) {
            Some(path) => Ok(path),
            None if is_inside(&whole) => Err("is not there"),
            None => Err("lies outside of the model's folder, which is not searched, and not in it"),
        }
    }

    /// The bytes of the file at `path`, which [`Self::find`] has found; or what is wrong with it.
    pub fn read(&self, path: &Path) -> Result<std::result::Result<Vec<u8>, String>> {
        let file = uri::below(path, self.path);
        let length = file.as_ref().map_err(Clone::clone).and_then(|file| uri::regular_file_length(file));
        let (file, length) = match (file, length) {
            (Ok(file), Ok(length)) => (file, length),
            (Err(problem), _) | (_, Err(problem)) => return Ok(Err(problem)),
        };
        self.budget.charge(length, 1, || path.display().to_string())?;
        Ok(fs::read(file).map_err(|e| e.to_string()))
    }

    /// `path` with the letters that its folders and file have here.
    fn spelt(&self, path: &Path) -> Option<PathBuf> {
        if !is_inside(path) {
            return None;
        }
        let mut here = PathBuf::new();
        for component in path.components() {
            let Component::Normal(name) = component else { continue };
            let exact = here.join(name);
            here = if self.path.join(&exact).exists() {
                exact
            } else {
                let mut listings = self.listings.borrow_mut();
                let listing = listings.entry(here.clone()).or_insert_with(|| list(&self.path.join(&here)));
                here.join(listing.iter().find(|other| other.eq_ignore_ascii_case(name))?)
            };
        }
        uri::below(&here, self.path).ok().filter(|file| file.is_file()).map(|_| here)
    }
}

fn list(folder: &Path) -> Vec<OsString> {
    fs::read_dir(folder).into_iter().flatten().take(MAX_ENTRIES).flatten().map(|entry| entry.file_name()).collect()
}

fn is_inside(path: &Path) -> bool {
    path.components().all(|c| matches!(c, Component::Normal(_) | Component::CurDir))
        && path.components().any(|c| matches!(c, Component::Normal(_)))
        && !path.as_os_str().as_encoded_bytes().contains(&b':')
}

/// The path of these bytes, which need not be UTF-8 where paths need not be.
fn native(name: &[u8]) -> PathBuf {
    #[cfg(unix)]
    return <std::ffi::OsStr as std::os::unix::ffi::OsStrExt>::from_bytes(name).into();
    #[cfg(not(unix))]
    return String::from_utf8_lossy(name).into_owned().into();
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Limits;

    #[test]
    fn names_of_other_machines() {
        let outer = tempfile::tempdir().unwrap();
        let path = outer.path().join("scene");
        fs::create_dir_all(path.join("Sub")).unwrap();
        fs::write(outer.path().join("secret"), b"s").unwrap();
        fs::write(path.join("Sub/a b%20#.png"), b"x").unwrap();
        fs::write(path.join("Bark.png"), b"y").unwrap();
        let budget = Budget::new(Limits::default());
        let folder = Folder::new(&path, &budget);
        let read = |name: &str, inner: &str| {
            folder.find(name.as_bytes(), Path::new(inner)).map(|file| folder.read(&file).unwrap().unwrap())
        };
        for (name, inner, bytes) in [
            ("Sub\\a b%20#.png", "", b"x"),
            ("sub/A B%20#.png", "", b"x"),
            ("a b%20#.png", "Sub", b"x"),
            ("./Bark.png", "Sub", b"y"),
            ("\"bark.PNG\"", "", b"y"),
            ("C:\\Users\\me\\bark.png", "", b"y"),
            ("/home/me/Bark.png", "", b"y"),
            ("../textures/Bark.png", "Sub", b"y"),
        ] {
            assert_eq!(read(name, inner), Ok(bytes.to_vec()), "{name}");
        }
        for absent in ["missing", "Sub", "sub/missing", "", ".", "Bark.png/x"] {
            assert!(read(absent, "").is_err(), "{absent}");
        }
        assert_eq!(read("missing", ""), Err("is not there"));
        for outside in ["../secret", "/etc/passwd", "C:\\a.png"] {
            assert!(read(outside, "").unwrap_err().starts_with("lies outside"), "{outside}");
        }
        #[cfg(unix)]
        {
            std::os::unix::fs::symlink(outer.path().join("secret"), path.join("link")).unwrap();
            assert_eq!(read("link", ""), Err("is not there"));
            fs::write(path.join(native(b"\xea.png")), b"z").unwrap();
            assert!(folder.find(b"\xea.png", Path::new("")).is_ok());
        }
    }
}
