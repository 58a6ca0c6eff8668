//! Text that nothing says the encoding of: bytes in any superset of ASCII, or UTF-16.
//!
//! In: the bytes of a file. Out: lines, words and numbers. Names stay bytes, so that those in an encoding that nobody
//! knows stay distinct; they are decoded only to be shown.

use crate::shared::error::Result;
use crate::shared::limits::Budget;
use std::borrow::Cow;

/// `bytes` without their byte-order mark, in UTF-8 if they were UTF-16.
pub(crate) fn decode<'a>(bytes: &'a [u8], budget: &Budget) -> Result<Cow<'a, [u8]>> {
    let little: fn([u8; 2]) -> u16 = u16::from_le_bytes;
    let big: fn([u8; 2]) -> u16 = u16::from_be_bytes;
    let (units, unit) = match bytes {
        [0xef, 0xbb, 0xbf, text @ ..] => return Ok(text.into()),
        [0xff, 0xfe, units @ ..] => (units, little),
        [0xfe, 0xff, units @ ..] => (units, big),
        // Two letters tell without a mark.
        [1..0x80, 0, 1..0x80, 0, ..] => (bytes, little),
        [0, 1..0x80, 0, 1..0x80, ..] => (bytes, big),
        _ => return Ok(bytes.into()),
    };
    budget.charge(units.len() as u64, 3, || "the file".into())?;
    let units = units.as_chunks().0.iter().map(|pair| unit(*pair));
    let text: String = char::decode_utf16(units).map(|c| c.unwrap_or(char::REPLACEMENT_CHARACTER)).collect();
    Ok(text.into_bytes().into())
}

/// A name as it is shown.
pub(crate) fn shown(name: &[u8]) -> Cow<'_, str> {
    String::from_utf8_lossy(name)
}

/// Whether `byte` stands between words. Control characters do, zeros at the end of padded files too.
fn is_space(byte: u8) -> bool {
    byte <= b' '
}

/// `text` without spaces around it.
pub(crate) fn trim(text: &[u8]) -> &[u8] {
    let start = text.iter().position(|b| !is_space(*b)).unwrap_or(text.len());
    let end = text.iter().rposition(|b| !is_space(*b)).map_or(start, |last| last + 1);
    &text[start..end]
}

/// `line` before its comment, which begins with a `#` anywhere.
pub(crate) fn uncommented(line: &[u8]) -> &[u8] {
    line.iter().position(|b| *b == b'#').map_or(line, |at| &line[..at])
}

/// The words of `text`; the backslash that continues a line is none.
pub(crate) fn words(text: &[u8]) -> impl Iterator<Item = &[u8]> {
    text.split(|b| is_space(*b) || *b == b'\\').filter(|word| !word.is_empty())
}

/// The first word of `text`, and what follows it.
pub(crate) fn split_word(text: &[u8]) -> (&[u8], &[u8]) {
    let start = text.iter().position(|b| !is_space(*b)).unwrap_or(text.len());
    let text = &text[start..];
    text.split_at(text.iter().position(|b| is_space(*b)).unwrap_or(text.len()))
}

/// The number that `word` spells, in any of the ways that exporters have; NaN where it says that it is none.
pub(crate) fn number(word: &[u8]) -> Option<f64> {
    let word = std::str::from_utf8(word).ok()?;
    word.parse().ok().or_else(|| odd_number(word))
}

/// Commas for points or after numbers, Fortran's exponents, and what the C library of Windows prints for no number.
fn odd_number(word: &str) -> Option<f64> {
    // Longer ones are no numbers, and would be copied.
    const MAX_LENGTH: usize = 64;
    let word = word.strip_suffix(',').unwrap_or(word);
    if word.len() > MAX_LENGTH {
        return None;
    }
    let plain = word.replace(['d', 'D'], "e");
    let plain = if plain.contains('.') { plain } else { plain.replacen(',', ".", 1) };
    let unsigned = word.trim_start_matches(['+', '-']).to_ascii_lowercase();
    let none = ["1.#", "nan", "-nan"].iter().any(|none| unsigned.starts_with(none));
    plain.parse().ok().or(none.then_some(f64::NAN))
}

/// The lines of a text, whichever way they end: with LF, CR LF or CR.
pub(crate) struct Lines<'a> {
    text: &'a [u8],
    /// Where the line that came last begins and ends, and where the next one begins.
    start: usize,
    end: usize,
    next: usize,
    /// Number of the line that came last, from 1.
    pub number: usize,
}

impl<'a> Lines<'a> {
    pub fn new(text: &'a [u8]) -> Self {
        Self { text, start: 0, end: 0, next: 0, number: 0 }
    }

    /// The line that came last with those that backslashes at its end join to it. Comments are not continued: they name
    /// folders.
    pub fn joined(&mut self) -> &'a [u8] {
        let start = self.start;
        let mut last = &self.text[start..self.end];
        while trim(last).last() == Some(&b'\\') && !last.contains(&b'#') {
            let Some(next) = self.next() else { break };
            last = next;
        }
        &self.text[start..self.end]
    }
}

impl<'a> Iterator for Lines<'a> {
    type Item = &'a [u8];

    fn next(&mut self) -> Option<&'a [u8]> {
        let rest = self.text.get(self.next..).filter(|rest| !rest.is_empty())?;
        let length = rest.iter().position(|b| matches!(b, b'\n' | b'\r')).unwrap_or(rest.len());
        self.start = self.next;
        self.end = self.start + length;
        self.next = self.end + if rest[length..].starts_with(b"\r\n") { 2 } else { 1 };
        self.number += 1;
        Some(&rest[..length])
    }
}

/// The words of a text that may stand on any line, without comments.
#[derive(Clone)]
pub(crate) struct Words<'a> {
    text: &'a [u8],
    at: usize,
    /// Number of the line that is read, from 1.
    pub line: usize,
    /// Whether no word of the line has come yet.
    pub fresh: bool,
}

impl<'a> Words<'a> {
    /// The words of `text`, which begins on line `line`.
    pub fn new(text: &'a [u8], line: usize) -> Self {
        Self { text, at: 0, line, fresh: true }
    }

    /// How many bytes are left.
    pub fn left(&self) -> usize {
        self.text.len() - self.at
    }

    /// The next word of this line.
    pub fn on_line(&mut self) -> Option<&'a [u8]> {
        let rest = &self.text[self.at..];
        let start = rest.iter().position(|b| !is_space(*b) || is_end(*b)).unwrap_or(rest.len());
        let rest = &rest[start..];
        let length = rest.iter().position(|b| is_space(*b)).unwrap_or(rest.len());
        self.at += start;
        if length == 0 {
            return None;
        }
        if rest[0] == b'#' {
            self.at += rest.iter().position(|b| is_end(*b)).unwrap_or(rest.len());
            return None;
        }
        self.at += length;
        self.fresh = false;
        Some(&rest[..length])
    }

    /// Goes to the begin of the next line; false at the end of the text.
    pub fn next_line(&mut self) -> bool {
        let rest = &self.text[self.at..];
        let Some(length) = rest.iter().position(|b| is_end(*b)) else {
            self.at = self.text.len();
            return false;
        };
        self.at += length + if rest[length..].starts_with(b"\r\n") { 2 } else { 1 };
        self.line += 1;
        self.fresh = true;
        true
    }
}

/// Wherever it stands.
impl<'a> Iterator for Words<'a> {
    type Item = &'a [u8];

    fn next(&mut self) -> Option<&'a [u8]> {
        loop {
            if let Some(word) = self.on_line() {
                return Some(word);
            }
            if !self.next_line() {
                return None;
            }
        }
    }
}

fn is_end(byte: u8) -> bool {
    matches!(byte, b'\n' | b'\r')
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Limits;

    fn decoded(bytes: &[u8]) -> Vec<u8> {
        decode(bytes, &Budget::new(Limits::default())).unwrap().into_owned()
    }

    #[test]
    fn encodings() {
        let wide = |unit: fn(u16) -> [u8; 2], mark: &str| -> Vec<u8> {
            format!("{mark}v 1 \u{e4}\u{1f600}").encode_utf16().flat_map(unit).collect()
        };
        let expected = "v 1 \u{e4}\u{1f600}".as_bytes();
        for mark in ["\u{feff}", ""] {
            assert_eq!(decoded(&wide(u16::to_le_bytes, mark)), expected);
            assert_eq!(decoded(&wide(u16::to_be_bytes, mark)), expected);
        }
        assert_eq!(decoded(&[b"\xef\xbb\xbf", expected].concat()), expected);
        assert_eq!(decoded(b"v \xff\xfe"), b"v \xff\xfe", "bytes that nobody knows stay");
        assert_eq!(decoded(b"\xff\xfe\0\xd8"), "\u{fffd}".as_bytes(), "half a pair");
    }

    #[test]
    fn numbers() {
        for (word, expected) in [
            ("1", 1.0),
            ("+1", 1.0),
            ("2.", 2.0),
            (".5", 0.5),
            ("-.5", -0.5),
            ("1e0", 1.0),
            ("1e+3", 1000.0),
            ("1E-03", 0.001),
            ("0,25", 0.25),
            ("1.5,", 1.5),
            ("1.0D+02", 100.0),
        ] {
            assert_eq!(number(word.as_bytes()), Some(expected), "{word}");
        }
        for word in ["nan", "-1.#IND", "1.#QNAN0", "-nan(ind)", "NaN", "1.#INF"] {
            assert!(number(word.as_bytes()).is_some_and(f64::is_nan), "{word}");
        }
        assert_eq!(number(b"-inf"), Some(f64::NEG_INFINITY));
        for word in ["", "x", "1x", "1/2", "--1", "1,2,3", "e5", "."] {
            assert_eq!(number(word.as_bytes()), None, "{word}");
        }
        assert_eq!(number(b"1\xff"), None);
    }

    #[test]
    fn lines_end_in_any_way() {
        let mut lines = Lines::new(b"a\nb\r\nc\r\rd \\ \r\n e\\\nf\n# g\\\nh");
        assert_eq!(lines.by_ref().take(4).collect::<Vec<_>>(), [b"a".as_slice(), b"b", b"c", b""]);
        assert_eq!(lines.next(), Some(b"d \\ ".as_slice()));
        assert_eq!(words(lines.joined()).collect::<Vec<_>>(), [b"d", b"e", b"f"]);
        assert_eq!((lines.number, lines.next()), (7, Some(b"# g\\".as_slice())));
        assert_eq!((lines.joined(), lines.next()), (b"# g\\".as_slice(), Some(b"h".as_slice())));
        assert_eq!((lines.joined(), lines.next(), lines.number), (b"h".as_slice(), None, 9));
    }

    #[test]
    fn words_know_their_line() {
        let mut words = Words::new(b" a  b # c\r\n\r\n#d\n\te\0f", 5);
        let next =
            |words: &mut Words<'_>| words.next().map(|word| (String::from_utf8_lossy(word).into_owned(), words.line));
        assert!(words.fresh);
        assert_eq!(next(&mut words), Some(("a".into(), 5)));
        assert_eq!(words.on_line(), Some(b"b".as_slice()));
        assert!(words.on_line().is_none() && words.on_line().is_none() && !words.fresh);
        assert_eq!(next(&mut words), Some(("e".into(), 8)));
        assert_eq!((next(&mut words), next(&mut words), words.left()), (Some(("f".into(), 8)), None, 0));
    }

    #[test]
    fn parts_of_lines() {
        assert_eq!((trim(b" \ta b\0"), trim(b"  ")), (b"a b".as_slice(), b"".as_slice()));
        assert_eq!(split_word(b"\tusemtl  a b "), (b"usemtl".as_slice(), b"  a b ".as_slice()));
        assert_eq!((split_word(b" "), uncommented(b"1 2#3")), ((b"".as_slice(), b"".as_slice()), b"1 2".as_slice()));
    }
}
