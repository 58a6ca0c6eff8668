//! Comparing pictures and masks. Where they differ, what was drawn and where it differs can be looked at.

use std::fs::{self, File};
use std::io::BufWriter;
use std::path::{Path, PathBuf};

/// Asserts that no byte of `actual` is more than `tolerance` from `expected`'s, as [`compare`] does.
///
/// # Panics
/// If one is.
#[track_caller]
pub fn assert_alike(name: &str, size: [u32; 2], actual: &[u8], expected: &[u8], tolerance: u8) {
    compare(name, size, actual, expected, tolerance).unwrap_or_else(|difference| panic!("{difference}"));
}

/// Compares images of one byte per pixel, masks or counts, or of four.
///
/// # Errors
/// If a byte differs by more than `tolerance`: how much, where first, and where the pictures of both and of their
/// difference have been written.
pub fn compare(name: &str, size: [u32; 2], actual: &[u8], expected: &[u8], tolerance: u8) -> Result<(), String> {
    if actual.len() != expected.len() {
        return Err(format!("{name}: {} bytes instead of {}", actual.len(), expected.len()));
    }
    let channels = actual.len() / (size[0] * size[1]).max(1) as usize;
    let away: Vec<u8> = actual.iter().zip(expected).map(|(a, b)| a.abs_diff(*b)).collect();
    let pixels: Vec<u8> = away.chunks(channels.max(1)).map(|c| c.iter().copied().max().unwrap_or(0)).collect();
    let Some(first) = pixels.iter().position(|&d| d > tolerance) else { return Ok(()) };
    let count = pixels.iter().filter(|&&d| d > tolerance).count();
    let most = pixels.iter().max().unwrap_or(&0);
    let [x, y] = [first % size[0] as usize, first / size[0] as usize];
    // What differs by 1 has to be seen, too.
    let marks: Vec<u8> = pixels.iter().map(|&d| if d > tolerance { 64 + d / 4 * 3 } else { 0 }).collect();
    let pictures = keep(name, size, &[("actual", actual), ("expected", expected), ("difference", &marks)]);
    Err(format!("{name}: {count} pixels differ, by {most} of 255 at most, first at {x}, {y}; {pictures}"))
}

/// Writes pictures of one or four bytes per pixel as `name-KIND.png` into `target/tmp/pictures`; says where.
#[must_use]
pub fn keep(name: &str, size: [u32; 2], pictures: &[(&str, &[u8])]) -> String {
    let folder = folder();
    let word: String = name.chars().map(|c| if c.is_alphanumeric() { c } else { '-' }).collect();
    let path = |kind: &str| folder.join(format!("{word}-{kind}.png"));
    let write = |(kind, bytes): &(&str, &[u8])| write(&path(kind), size, bytes).map(|()| (*kind).to_owned());
    // A failure to write must not hide the failure that it is to show.
    match fs::create_dir_all(&folder).and_then(|()| pictures.iter().map(write).collect::<Result<Vec<_>, _>>()) {
        Ok(kinds) => format!("see {}", path(&format!("{{{}}}", kinds.join(","))).display()),
        Err(error) => format!("its pictures could not be written to {}: {error}", folder.display()),
    }
}

/// Beside what cargo gives the integration tests to write to, which it does not tell the others.
fn folder() -> PathBuf {
    let target = std::env::var_os("CARGO_TARGET_DIR").map(PathBuf::from);
    let target = target.unwrap_or_else(|| Path::new(env!("CARGO_MANIFEST_DIR")).join("../../target"));
    target.join("tmp/pictures")
}

fn write(path: &Path, [width, height]: [u32; 2], bytes: &[u8]) -> std::io::Result<()> {
    let mut encoder = png::Encoder::new(BufWriter::new(File::create(path)?), width, height);
    let gray = bytes.len() == (width * height) as usize;
    encoder.set_color(if gray { png::ColorType::Grayscale } else { png::ColorType::Rgba });
    encoder.write_header()?.write_image_data(bytes)?;
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::BufReader;

    #[test]
    fn a_difference_is_noticed_and_shown() {
        let expected: Vec<u8> = (0..4 * 3 * 4).collect();
        let mut actual = expected.clone();
        compare("same", [4, 3], &actual, &expected, 0).expect("no difference");
        actual[4 * 6 + 1] += 2;
        compare("close", [4, 3], &actual, &expected, 2).expect("within the tolerance");
        let told = compare("a test's picture", [4, 3], &actual, &expected, 1).expect_err("a difference");
        assert!(told.contains("1 pixels differ, by 2 of 255 at most, first at 2, 1; see "), "{told}");
        let shown = folder().join("a-test-s-picture-difference.png");
        assert!(told.ends_with("a-test-s-picture-{actual,expected,difference}.png"), "{told}");
        let mut reader =
            png::Decoder::new(BufReader::new(File::open(shown).expect("a file"))).read_info().expect("a PNG");
        let mut marks = [0; 12];
        reader.next_frame(&mut marks).expect("a frame");
        assert_eq!(marks.iter().enumerate().filter(|(_, m)| **m > 0).map(|(i, _)| i).collect::<Vec<_>>(), [6]);
        compare("too short", [4, 3], &actual[4..], &expected, 255).expect_err("a length");
    }

    #[test]
    fn pictures_that_cannot_be_written_are_no_second_failure() {
        assert!(keep("of the wrong size", [4, 3], &[("actual", &[0; 5])]).contains("could not be written"));
    }
}
