//! Where the results of a frame go.
//!
//! In: the command line and a frame's number. Out: paths, checked as far as they can be before any work is done.

use super::args::Args;
use super::files::AovFiles;
use super::numbering;
use crate::error::Error;
use crate::output;
use std::collections::HashSet;
use std::path::{Path, PathBuf};

/// Places for one frame.
#[derive(Clone, Debug)]
pub struct Destinations {
    /// The file of the picture.
    pub picture: PathBuf,
    /// The file or folder of each AOV, in the order of the command line.
    pub aovs: Vec<PathBuf>,
    /// The file of the figures.
    pub stats: Option<PathBuf>,
}

impl Destinations {
    /// The places of frame number `frame`, or of the only picture: as they stand on the command line.
    ///
    /// # Errors
    /// If there are numbers for names without a place for them, or places and no numbers.
    pub fn new(args: &Args, frame: Option<u32>) -> Result<Self, Error> {
        let name = |path: &PathBuf| match frame {
            Some(frame) => numbering::name_of(path, frame)
                .map_err(|why| Error::usage(format!("'{}' cannot name the files of --frames: {why}", path.display()))),
            None if numbering::is_pattern(path) => {
                let why = format!("'{}' has a place for a frame's number; add --frames A..B", path.display());
                Err(Error::usage(why))
            }
            None => Ok(path.clone()),
        };
        Ok(Self {
            picture: name(&args.output.path)?,
            aovs: args.aovs.iter().map(|aov| name(&aov.path)).collect::<Result<_, _>>()?,
            stats: args.stats.as_ref().map(name).transpose()?,
        })
    }

    /// Every place, and whether it is a folder.
    fn places<'a>(&'a self, aovs: &'a [AovFiles]) -> impl Iterator<Item = (&'a Path, bool)> {
        let files =
            [Some(self.picture.as_path()), self.stats.as_deref()].into_iter().flatten().map(|file| (file, false));
        files.chain(self.aovs.iter().zip(aovs).map(|(path, aov)| (path.as_path(), aov.is_folder())))
    }

    /// Finds places that cannot be written or that are the same. Folders of numbered frames are made where they are
    /// missing; that of a single file must exist, for there it is a typing error.
    ///
    /// # Errors
    /// If there is such a place.
    pub fn check(&self, aovs: &[AovFiles], numbered: bool) -> Result<(), Error> {
        let mut taken = HashSet::new();
        for (path, is_folder) in self.places(aovs) {
            if is_folder {
                output::check_folder(path)?;
            } else if numbered && !output::folder_of(path).exists() {
                output::check_folder(output::folder_of(path))?;
            } else {
                output::check_file(path)?;
            }
            if !taken.insert(resolved(path)) {
                return Err(named_twice(path));
            }
        }
        Ok(())
    }

    /// Adds all places to `taken`.
    ///
    /// # Errors
    /// If one is there already.
    pub fn claim(&self, aovs: &[AovFiles], taken: &mut HashSet<PathBuf>) -> Result<(), Error> {
        match self.places(aovs).find(|(path, _)| !taken.insert(path.to_path_buf())) {
            Some((path, _)) => Err(named_twice(path)),
            None => Ok(()),
        }
    }

    /// The folders in which files appear.
    pub fn folders<'a>(&'a self, aovs: &'a [AovFiles]) -> impl Iterator<Item = &'a Path> {
        self.places(aovs).map(|(path, is_folder)| if is_folder { path } else { output::folder_of(path) })
    }

    /// The files beside the picture, in order: of each AOV one, or one for each of `lights`; then the figures.
    pub fn sides(&self, aovs: &[AovFiles], lights: &[usize]) -> Vec<PathBuf> {
        let mut sides = Vec::new();
        for (path, aov) in self.aovs.iter().zip(aovs) {
            if aov.is_folder() {
                sides.extend(lights.iter().map(|light| path.join(format!("light-{light}.png"))));
            } else {
                sides.push(path.clone());
            }
        }
        sides.extend(self.stats.clone());
        sides
    }
}

fn named_twice(path: &Path) -> Error {
    Error::usage(format!("'{}' is named for two results; give each its own name", path.display()))
}

/// The same path for all spellings of one place, as far as it exists.
fn resolved(path: &Path) -> PathBuf {
    let mut missing = Vec::new();
    for ancestor in path.ancestors() {
        let here = if ancestor.as_os_str().is_empty() { Path::new(".") } else { ancestor };
        if let Ok(existing) = here.canonicalize() {
            return missing.iter().rev().fold(existing, |path, name| path.join(name));
        }
        missing.extend(ancestor.file_name());
    }
    path.to_owned()
}
