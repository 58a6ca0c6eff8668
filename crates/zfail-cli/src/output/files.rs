//! Files that appear whole or not at all.
//!
//! In: finished bytes and where they go. Out: files in place, or an error and nothing changed. Until [`Outputs::commit`]
//! everything stays in memory; then every file is written beside its destination, and only when all of them are safely
//! on the disk are they renamed into place, in the order in which they were added. What a killed run leaves behind under
//! temporary names, [`sweep`] removes.

use crate::error::Error;
use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use tempfile::NamedTempFile;

/// Finished files on their way to the disk.
#[derive(Default)]
pub struct Outputs {
    files: Vec<(PathBuf, Vec<u8>)>,
}

impl Outputs {
    /// Adds a file; nothing touches the disk yet.
    pub fn add(&mut self, path: impl Into<PathBuf>, bytes: Vec<u8>) {
        self.files.push((path.into(), bytes));
    }

    /// Puts every file in its place, making folders where they are missing.
    ///
    /// # Errors
    /// If a folder or a file cannot be written. No destination has changed then, and new folders are gone again,
    /// unless the disk fails between one rename and the next.
    pub fn commit(self) -> Result<(), Error> {
        let mut folders = NewFolders::default();
        let mut written: Vec<(NamedTempFile, PathBuf)> = Vec::with_capacity(self.files.len());
        for (path, bytes) in &self.files {
            let path = destination(path)?;
            if written.iter().any(|(_, other)| *other == path) {
                return Err(Error::failed(format!(
                    "two results would go to '{}'; give each its own name",
                    path.display()
                )));
            }
            let folder = folder_of(&path);
            folders.create(folder)?;
            let file = write_beside(folder, bytes).map_err(|e| cannot_write(&path, &e))?;
            written.push((file, path));
        }
        for (file, path) in written {
            file.persist(&path).map_err(|e| cannot_write(&path, &e.error))?;
        }
        folders.keep();
        Ok(())
    }
}

/// Whether a file could be written at `path`; the check is a real one, so that an hour of work is not lost to a typo.
///
/// # Errors
/// If the folder is missing or not writable, or `path` is something other than a writable file.
pub fn check_file(path: &Path) -> Result<(), Error> {
    let path = destination(path)?;
    let folder = folder_of(&path);
    if !folder.exists() {
        return Err(Error::failed(format!(
            "cannot write '{}': the folder '{}' does not exist; create it first",
            path.display(),
            folder.display()
        )));
    }
    probe(folder).map_err(|e| cannot_write(&path, &e))
}

/// Whether files could be written into the folder `path`, which need not exist yet.
///
/// # Errors
/// If `path` is not a folder, or neither it nor its nearest existing ancestor is writable.
pub fn check_folder(path: &Path) -> Result<(), Error> {
    let existing = path.ancestors().map(or_here).find(|p| p.exists()).unwrap_or(Path::new("."));
    probe(existing).map_err(|e| cannot_write(path, &e))
}

/// Where a file called `path` really goes: through symbolic links, never over a folder, a device or a read-only file.
fn destination(path: &Path) -> Result<PathBuf, Error> {
    let refuse = |why: &str| Err(Error::failed(format!("cannot write '{}': {why}", path.display())));
    match fs::metadata(path) {
        Ok(meta) if meta.is_dir() => refuse("it is a folder; name a file in it"),
        Ok(meta) if !meta.is_file() => refuse("it is not a regular file; choose another name"),
        Ok(meta) if meta.permissions().readonly() => refuse("it is read-only; make it writable or choose another name"),
        Ok(_) => fs::canonicalize(path).map_err(|e| cannot_write(path, &e)),
        Err(e) if e.kind() == io::ErrorKind::NotFound => Ok(path.to_owned()),
        Err(e) => Err(cannot_write(path, &e)),
    }
}

/// The folder that holds `path`.
pub fn folder_of(path: &Path) -> &Path {
    or_here(path.parent().unwrap_or(Path::new("")))
}

/// The empty path means the working folder.
fn or_here(path: &Path) -> &Path {
    if path.as_os_str().is_empty() { Path::new(".") } else { path }
}

/// Makes and removes a file in `folder`.
fn probe(folder: &Path) -> io::Result<()> {
    if !folder.is_dir() {
        return Err(io::Error::new(io::ErrorKind::NotADirectory, format!("'{}' is not a folder", folder.display())));
    }
    temporary(folder)?.close()
}

fn write_beside(folder: &Path, bytes: &[u8]) -> io::Result<NamedTempFile> {
    let mut file = temporary(folder)?;
    file.write_all(bytes)?;
    file.as_file().sync_all()?;
    Ok(file)
}

/// Names of temporary files.
const TEMPORARY: (&str, &str) = (".zfail-", ".part");

/// A temporary file that will have an ordinary file's permissions once it is renamed. It is locked as long as it is in use,
/// by which [`sweep`] knows it from one that is forgotten.
fn temporary(folder: &Path) -> io::Result<NamedTempFile> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(TEMPORARY.0).suffix(TEMPORARY.1);
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    let file = builder.tempfile_in(folder)?;
    // Where a file system has no locks, nothing is swept either.
    let _ = file.as_file().try_lock();
    Ok(file)
}

/// Removes the temporary files of killed runs from `folder`. Those of a run that still lives stay, and so does what
/// cannot be removed, for it does no harm.
pub fn sweep(folder: &Path) {
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        let name = entry.file_name();
        let name = name.to_string_lossy();
        if name.starts_with(TEMPORARY.0)
            && name.ends_with(TEMPORARY.1)
            && entry.file_type().is_ok_and(|kind| kind.is_file())
            && File::open(entry.path()).is_ok_and(|file| file.try_lock().is_ok())
        {
            let _ = fs::remove_file(entry.path());
        }
    }
}

fn cannot_write(path: &Path, error: &io::Error) -> Error {
    use io::ErrorKind as Kind;
    let (why, remedy) = match error.kind() {
        Kind::PermissionDenied => ("no permission".to_owned(), "choose a folder that you may write to"),
        Kind::ReadOnlyFilesystem => ("the file system is read-only".to_owned(), "choose another folder"),
        Kind::StorageFull | Kind::QuotaExceeded => ("the disk is full".to_owned(), "make room and run it again"),
        Kind::NotADirectory => ("part of the path is not a folder".to_owned(), "correct the path"),
        _ => (error.to_string(), "check the path"),
    };
    Error::failed(format!("cannot write '{}': {why}; {remedy}", path.display()))
}

/// Folders that this run has made, removed again unless it succeeds.
#[derive(Default)]
struct NewFolders(Vec<PathBuf>);

impl NewFolders {
    fn create(&mut self, folder: &Path) -> Result<(), Error> {
        let missing: Vec<_> = folder.ancestors().map(or_here).take_while(|p| !p.exists()).collect();
        for folder in missing.into_iter().rev() {
            fs::create_dir(folder).map_err(|e| cannot_write(folder, &e))?;
            self.0.push(folder.to_owned());
        }
        Ok(())
    }

    fn keep(mut self) {
        self.0.clear();
    }
}

impl Drop for NewFolders {
    fn drop(&mut self) {
        for folder in self.0.iter().rev() {
            // Only an empty folder goes; what somebody else has put there meanwhile is not ours to remove.
            let _ = fs::remove_dir(folder);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Outputs, check_file, check_folder, sweep, temporary};
    use std::fs;

    #[test]
    fn files_appear_together_with_their_folders() {
        let dir = tempfile::tempdir().unwrap();
        let mut outputs = Outputs::default();
        outputs.add(dir.path().join("a.txt"), b"a".to_vec());
        outputs.add(dir.path().join("new/deep/b.txt"), b"b".to_vec());
        outputs.commit().unwrap();
        assert_eq!(fs::read(dir.path().join("a.txt")).unwrap(), b"a");
        assert_eq!(fs::read(dir.path().join("new/deep/b.txt")).unwrap(), b"b");
        assert_eq!(fs::read_dir(dir.path()).unwrap().count(), 2, "temporary files are gone");
    }

    #[test]
    fn one_bad_destination_leaves_everything_as_it_was() {
        let dir = tempfile::tempdir().unwrap();
        let (good, bad) = (dir.path().join("good.txt"), dir.path().join("bad.txt"));
        fs::write(&good, "old").unwrap();
        fs::create_dir(&bad).unwrap();
        let mut outputs = Outputs::default();
        outputs.add(&good, b"new".to_vec());
        outputs.add(dir.path().join("new/c.txt"), b"c".to_vec());
        outputs.add(&bad, b"new".to_vec());
        let message = outputs.commit().unwrap_err().to_string();
        assert!(message.contains("bad.txt") && message.contains("folder"), "{message}");
        assert_eq!(fs::read(&good).unwrap(), b"old");
        assert_eq!(fs::read_dir(dir.path()).unwrap().count(), 2, "no temporary file and no new folder is left");
    }

    #[test]
    fn two_results_for_one_file_are_refused() {
        let dir = tempfile::tempdir().unwrap();
        let mut outputs = Outputs::default();
        outputs.add(dir.path().join("a"), Vec::new());
        outputs.add(dir.path().join("a"), Vec::new());
        assert!(outputs.commit().is_err());
        assert_eq!(fs::read_dir(dir.path()).unwrap().count(), 0);
    }

    #[test]
    fn checks_refuse_what_commit_would_refuse() {
        let dir = tempfile::tempdir().unwrap();
        let file = dir.path().join("file.png");
        fs::write(&file, "old").unwrap();
        assert!(check_file(&file).is_ok());
        assert!(check_file(&dir.path().join("new.png")).is_ok());
        assert!(check_folder(dir.path()).is_ok());
        assert!(check_folder(&dir.path().join("new/deep")).is_ok());

        assert!(check_file(dir.path()).is_err(), "a folder");
        assert!(check_file(&dir.path().join("missing/a.png")).is_err(), "a missing folder");
        assert!(check_file(&file.join("a.png")).is_err(), "a file as folder");
        assert!(check_folder(&file).is_err(), "a file as folder");
        assert!(check_folder(&file.join("deep")).is_err(), "a file as parent folder");
        let mut permissions = fs::metadata(&file).unwrap().permissions();
        permissions.set_readonly(true);
        fs::set_permissions(&file, permissions).unwrap();
        assert!(check_file(&file).is_err(), "a read-only file");
        assert_eq!(fs::read_dir(dir.path()).unwrap().count(), 1, "checks leave nothing behind");
    }

    #[test]
    fn forgotten_temporary_files_are_swept() {
        let dir = tempfile::tempdir().unwrap();
        let (_, forgotten) = temporary(dir.path()).unwrap().keep().unwrap();
        let in_use = temporary(dir.path()).unwrap();
        fs::write(dir.path().join(".zfail-notes"), "").unwrap();
        fs::write(dir.path().join("a.part"), "").unwrap();
        sweep(dir.path());
        assert!(!forgotten.exists());
        assert!(in_use.path().exists(), "another run is at work on it");
        assert_eq!(fs::read_dir(dir.path()).unwrap().count(), 3, "files of other names stay");
        sweep(&dir.path().join("missing"));
    }

    #[cfg(unix)]
    #[test]
    fn a_link_is_written_through_and_modes_are_ordinary() {
        use std::os::unix::fs::{MetadataExt, symlink};
        let dir = tempfile::tempdir().unwrap();
        let (file, link) = (dir.path().join("file"), dir.path().join("link"));
        fs::write(&file, "old").unwrap();
        symlink(&file, &link).unwrap();
        let mut outputs = Outputs::default();
        outputs.add(&link, b"new".to_vec());
        outputs.commit().unwrap();
        assert_eq!(fs::read(&file).unwrap(), b"new");
        assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
        let ordinary = dir.path().join("ordinary");
        fs::write(&ordinary, "").unwrap();
        assert_eq!(fs::metadata(&file).unwrap().mode(), fs::metadata(&ordinary).unwrap().mode());
    }
}
