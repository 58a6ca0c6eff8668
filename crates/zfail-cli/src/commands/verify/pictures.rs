//! The pictures of a report: where it looked, and what it found there.
//!
//! Per light `light-N-expected.png` is the true mask and `light-N-checked.png` shows which pixels could be checked (blue
//! ones could not); per mismatch `light-N-TECHNIQUE-rendered.png` is the mask that was drawn and
//! `light-N-TECHNIQUE-wrong.png` marks what is wrong with it: red is lit and should not be, green is dark and should not be.

use super::examined::Examined;
use super::report::Report;
use super::variants::Variant;
use crate::console;
use crate::error::Error;
use crate::input::Shot;
use crate::output::{self, Outputs, encode};
use std::fs;
use std::path::{Path, PathBuf};
use zfail_oracle::Truth;

/// Whether a report may go into `folder`.
///
/// # Errors
/// If it cannot be written, or has something in it.
pub fn check_folder(folder: &Path) -> Result<(), Error> {
    output::check_folder(folder)?;
    let empty = fs::read_dir(folder).map_or(true, |mut entries| entries.next().is_none());
    if empty {
        return Ok(());
    }
    let folder = folder.display();
    Err(Error::failed(format!("the folder '{folder}' is not empty; a report never overwrites, so name a new one")))
}

/// Writes report and pictures, of the view that was asked for or of the one that is wrong, into `folder`, or if something is wrong into a new one. Says where.
///
/// # Errors
/// If they cannot be written.
pub fn write(
    folder: Option<&Path>,
    report: &Report,
    shot: &Shot,
    shown: &Examined,
    variants: &[Variant],
) -> Result<Option<PathBuf>, Error> {
    let folder = match folder {
        Some(folder) => folder.to_owned(),
        None if report.passed => return Ok(None),
        None => temporary()?,
    };
    let size = if report.passed { report.size } else { shot.view.size };
    let mut outputs = Outputs::default();
    outputs.add(folder.join("report.json"), console::json(report)?.into_bytes());
    for (i, (light, truth)) in shown.lights.iter().zip(&shown.truths).enumerate() {
        let mut add =
            |name: &str, file: Vec<u8>| outputs.add(folder.join(format!("light-{}-{name}", light.judged.light)), file);
        let expected = truth.mask();
        add("expected.png", encode::png_grey(size, &expected)?);
        add("checked.png", difference(truth, &expected)?);
        for ((row, variant), images) in light.techniques.iter().zip(variants).zip(&shown.images) {
            if let Some(mask) = images.shadow.get(i).filter(|_| !row.passes()) {
                add(&format!("{}-rendered.png", variant.name), encode::png_grey(size, mask)?);
                add(&format!("{}-wrong.png", variant.name), difference(truth, mask)?);
            }
        }
    }
    outputs.commit()?;
    Ok(Some(folder))
}

fn difference(truth: &Truth, mask: &[u8]) -> Result<Vec<u8>, Error> {
    let rgb = truth.diff_image(mask)?;
    encode::png_picture(truth.size, &rgb, None)
}

/// A folder that nobody else uses.
fn temporary() -> Result<PathBuf, Error> {
    let folder = tempfile::Builder::new().prefix("zfail-verify-").tempdir();
    folder.map(tempfile::TempDir::keep).map_err(|e| Error::failed(format!("cannot make a temporary folder: {e}")))
}
