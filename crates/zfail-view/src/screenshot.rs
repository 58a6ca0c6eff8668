//! Files that never take another one's place.

use std::fs::{self, File, OpenOptions};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// Writes files that share a numbered name and differ in extension, `STEM-001.EXT` or the next number at which none of
/// them exists; returns their paths in order.
///
/// # Errors
/// If the folder cannot be written. Nothing is left behind then.
pub fn save(folder: &Path, stem: &str, files: &[(&str, &[u8])]) -> io::Result<Vec<PathBuf>> {
    for number in 1..100_000 {
        let paths: Vec<PathBuf> =
            files.iter().map(|(extension, _)| folder.join(format!("{stem}-{number:03}.{extension}"))).collect();
        match reserve(&paths) {
            Ok(reserved) => {
                let written =
                    reserved.into_iter().zip(files).try_for_each(|(mut file, (_, bytes))| file.write_all(bytes));
                return written.map(|()| paths.clone()).inspect_err(|_| remove(&paths));
            }
            Err(e) if e.kind() == io::ErrorKind::AlreadyExists => {}
            Err(e) => return Err(e),
        }
    }
    Err(io::ErrorKind::AlreadyExists.into())
}

/// Creates all files, or none.
fn reserve(paths: &[PathBuf]) -> io::Result<Vec<File>> {
    let mut files = Vec::new();
    for path in paths {
        match OpenOptions::new().write(true).create_new(true).open(path) {
            Ok(file) => files.push(file),
            Err(e) => {
                remove(&paths[..files.len()]);
                return Err(e);
            }
        }
    }
    Ok(files)
}

fn remove(paths: &[PathBuf]) {
    for path in paths {
        // It is ours and empty or incomplete; if it cannot be removed, the first error says more.
        let _ = fs::remove_file(path);
    }
}

/// A name for the files of a scene: its last part without extension, of harmless characters.
#[must_use]
pub fn stem(source: &str) -> String {
    let name = source.rsplit(['/', '\\', ':']).next().unwrap_or(source);
    let name = name.rsplit_once('.').map_or(name, |(stem, _)| stem);
    let harmless: String =
        name.chars().map(|c| if c.is_alphanumeric() || "-_.".contains(c) { c } else { '-' }).collect();
    if harmless.trim_matches(['.', '-']).is_empty() { "scene".to_owned() } else { harmless }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_is_overwritten() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let names = |paths: Vec<PathBuf>| -> Vec<String> {
            paths.iter().map(|p| p.file_name().unwrap_or_default().to_string_lossy().into_owned()).collect()
        };
        let first = save(folder.path(), "a", &[("png", b"1")]).expect("room");
        assert_eq!(names(first), ["a-001.png"]);
        let both = save(folder.path(), "a", &[("json", b"2"), ("png", b"3")]).expect("room");
        assert_eq!(names(both), ["a-002.json", "a-002.png"]);
        assert_eq!(fs::read(folder.path().join("a-001.png")).expect("it is there"), b"1");
        assert_eq!(fs::read_dir(folder.path()).expect("a folder").count(), 3, "no reserved name is left");
        assert!(save(&folder.path().join("missing"), "a", &[("png", b"")]).is_err());
    }

    #[test]
    fn stems_are_file_names() {
        for (source, expected) in
            [("builtin:room", "room"), ("/x/my model.v2.glb", "my-model.v2"), ("..", "scene"), ("", "scene")]
        {
            assert_eq!(stem(source), expected);
        }
    }
}
