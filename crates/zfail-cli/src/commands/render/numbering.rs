//! Numbered frames: which ones are wanted, and what their files are called.
//!
//! In: `A..B` and names such as `frames/%04d.png`. Out: numbers, and a name for each.

use std::ops::Range;
use std::path::{Path, PathBuf};

/// Frames from the first one up to, and without, the last number.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FrameRange(pub Range<u32>);

impl FrameRange {
    /// More is a slip of the finger: ten hours at 25 frames per second.
    const MOST: u32 = 1_000_000;

    /// Reads `A..B`.
    pub fn parse(text: &str) -> Result<Self, String> {
        let ends = text.split_once("..").and_then(|(a, b)| Some((a.parse().ok()?, b.parse().ok()?)));
        let Some((first, end)) = ends else {
            return Err("write it as A..B, such as 0..60 for the 60 frames from 0 to 59".to_owned());
        };
        match end {
            _ if end <= first => Err(format!("it has no frame: B is the first number left out, such as {}", first + 1)),
            _ if end - first > Self::MOST => Err(format!("it has more than {} frames", Self::MOST)),
            _ => Ok(Self(first..end)),
        }
    }
}

/// Whether the name has a place for the frame's number.
pub fn is_pattern(path: &Path) -> bool {
    pieces(&path.to_string_lossy()).is_ok_and(|pieces| pieces.iter().any(|piece| matches!(piece, Piece::Number { .. })))
}

/// The name that `pattern` gives to `frame`: `%d` stands for the number, `%04d` for the number with at least four digits,
/// `%%` for a percent sign.
///
/// # Errors
/// If there is no place for the number, or a percent sign stands for nothing.
pub fn name_of(pattern: &Path, frame: u32) -> Result<PathBuf, String> {
    let mut name = String::new();
    let mut numbered = false;
    for piece in pieces(&pattern.to_string_lossy())? {
        match piece {
            Piece::Text(text) => name += text,
            Piece::Number { digits } => {
                name += &format!("{frame:0digits$}");
                numbered = true;
            }
        }
    }
    if numbered { Ok(name.into()) } else { Err("it needs a place for the frame's number, such as %04d".to_owned()) }
}

/// A part of a pattern.
enum Piece<'a> {
    Text(&'a str),
    Number { digits: usize },
}

fn pieces(pattern: &str) -> Result<Vec<Piece<'_>>, String> {
    let mut pieces = Vec::new();
    let mut rest = pattern;
    while let Some(at) = rest.find('%') {
        let (text, percent) = rest.split_at(at);
        pieces.push(Piece::Text(text));
        let code = &percent[1..];
        let digits = code.len() - code.trim_start_matches(|c: char| c.is_ascii_digit()).len();
        let width = &code[..digits];
        rest = &code[digits..];
        if let Some(after) = rest.strip_prefix('d')
            && let Some(digits) = width_of(width)
        {
            pieces.push(Piece::Number { digits });
            rest = after;
        } else if let Some(after) = rest.strip_prefix('%')
            && width.is_empty()
        {
            pieces.push(Piece::Text("%"));
            rest = after;
        } else {
            return Err("after % it takes d, 0 with a number of digits and d (as in %04d), or another %".to_owned());
        }
    }
    pieces.push(Piece::Text(rest));
    Ok(pieces)
}

/// `""` is 0, `"04"` is 4; more than 20 digits are more than any file name needs.
fn width_of(text: &str) -> Option<usize> {
    match text.strip_prefix('0') {
        None => text.is_empty().then_some(0),
        Some(digits) => digits.parse().ok().filter(|width| (1..=20).contains(width)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_leave_their_end_out() {
        assert_eq!(FrameRange::parse("0..60"), Ok(FrameRange(0..60)));
        assert_eq!(FrameRange::parse("7..8"), Ok(FrameRange(7..8)));
        for wrong in ["", "5", "5..", "..5", "5..5", "6..5", "-1..5", "0..=5", "0...5", "0..1000001", "0..4294967296"] {
            assert!(FrameRange::parse(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn numbers_take_the_place_of_the_pattern() {
        let name = |pattern: &str| name_of(Path::new(pattern), 42).map(|path| path.to_string_lossy().into_owned());
        assert_eq!(name("frames/%04d.png").unwrap(), "frames/0042.png");
        assert_eq!(name("%d.png").unwrap(), "42.png");
        assert_eq!(name("%01d.png").unwrap(), "42.png");
        assert_eq!(name("100%%-%03d/%d.png").unwrap(), "100%-042/42.png");
        for wrong in ["a.png", "100%%.png", "%.png", "%4d.png", "%0d.png", "%05.png", "%x", "%d%", "%099d.png", "%0%"] {
            assert!(name(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn patterns_are_told_from_names() {
        assert!(is_pattern(Path::new("a/%d.png")) && is_pattern(Path::new("%06d/a.png")));
        assert!(
            !is_pattern(Path::new("a.png")) && !is_pattern(Path::new("100%.png")) && !is_pattern(Path::new("50%%d"))
        );
    }
}
