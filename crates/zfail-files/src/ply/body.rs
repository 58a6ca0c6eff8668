//! The numbers of a .ply file's body, row by row.
//!
//! Of an ASCII file each row has a line of its own, as the format wants it, if there are as many lines as rows; an odd row is
//! then odd alone. Otherwise rows are taken word by word.

use super::header::{Element, Encoding, Header, Scalar};
use crate::plain::text::{Words, number};

/// Where the numbers come from.
pub(super) enum Body<'a> {
    Ascii(Ascii<'a>),
    Binary { rest: &'a [u8], big: bool },
}

/// The row has no number any more where one must be.
pub(super) struct End;

impl<'a> Body<'a> {
    pub fn new(header: &Header<'a>) -> Self {
        let rows = |element: &Element<'_>| if element.properties.is_empty() { 0 } else { element.count };
        match header.encoding {
            Encoding::Ascii => {
                let count = header.elements.iter().map(rows).fold(0, u64::saturating_add);
                let words = Words::new(header.body, header.line);
                let by_line = count_lines(words.clone()) == count;
                Self::Ascii(Ascii { words, by_line })
            }
            order => Self::Binary { rest: header.body, big: order == Encoding::Big },
        }
    }

    /// How many bytes are left.
    pub fn left(&self) -> usize {
        match self {
            Self::Ascii(ascii) => ascii.words.left(),
            Self::Binary { rest, .. } => rest.len(),
        }
    }

    /// Number of the line, of a file that has lines.
    pub fn line(&self) -> Option<usize> {
        match self {
            Self::Ascii(ascii) => Some(ascii.words.line),
            Self::Binary { .. } => None,
        }
    }

    /// Begins a row.
    pub fn begin(&mut self) {
        if let Self::Ascii(Ascii { words, by_line: true }) = self {
            next_row(words);
        }
    }

    /// Ends a row; values without a property may follow.
    pub fn end(&mut self) {
        if let Self::Ascii(Ascii { words, by_line: true }) = self {
            while words.on_line().is_some() {}
        }
    }

    /// Whether the next row can be read although this one has ended too early.
    pub fn goes_on(&self) -> bool {
        matches!(self, Self::Ascii(Ascii { by_line: true, .. }))
    }

    /// The next number of the row; NaN for a word that is none.
    pub fn scalar(&mut self, scalar: Scalar) -> Result<f64, End> {
        match self {
            Self::Ascii(ascii) => ascii.number(),
            Self::Binary { rest, big } => {
                let (bytes, after) = rest.split_at_checked(scalar.size()).ok_or(End)?;
                *rest = after;
                Ok(decode(scalar, bytes, *big))
            }
        }
    }

    /// The length of the list that comes next, whose numbers are of type `scalar`; `None` if it is no length.
    pub fn length(&mut self, length: Scalar, scalar: Scalar) -> Result<Option<usize>, End> {
        let said = self.scalar(length)?;
        if said < 0.0 || said.fract() != 0.0 || said.is_nan() {
            return Ok(None);
        }
        // In ASCII a number takes a digit and a space.
        let least = if matches!(self, Self::Ascii(_)) { 2 } else { scalar.size() };
        let most = (self.left() + 1).checked_div(least).unwrap_or(0);
        if said > most as f64 { Err(End) } else { Ok(Some(said as usize)) }
    }

    /// Passes over `count` numbers.
    pub fn skip(&mut self, scalar: Scalar, count: u64) -> Result<(), End> {
        match self {
            Self::Ascii(ascii) => (0..count).try_for_each(|_| ascii.number().map(drop)),
            Self::Binary { rest, .. } => {
                let bytes = usize::try_from(count).ok().and_then(|count| count.checked_mul(scalar.size()));
                *rest = bytes.and_then(|bytes| rest.get(bytes..)).ok_or(End)?;
                Ok(())
            }
        }
    }
}

pub(super) struct Ascii<'a> {
    words: Words<'a>,
    /// Whether every row has a line of its own.
    by_line: bool,
}

impl Ascii<'_> {
    fn number(&mut self) -> Result<f64, End> {
        let word = if self.by_line { self.words.on_line() } else { next_word(&mut self.words) };
        Ok(number(word.ok_or(End)?).unwrap_or(f64::NAN))
    }
}

/// Passes over comments, of which a body should have none, to the next word.
fn next_word<'a>(words: &mut Words<'a>) -> Option<&'a [u8]> {
    loop {
        let fresh = words.clone();
        let word = words.next()?;
        let first = words.line != fresh.line || fresh.fresh;
        if !(first && matches!(word, b"comment" | b"obj_info")) {
            return Some(word);
        }
        words.next_line();
    }
}

/// Goes to the begin of the next line that has a row.
fn next_row(words: &mut Words<'_>) -> bool {
    loop {
        let before = words.clone();
        match words.on_line() {
            Some(b"comment" | b"obj_info") => {}
            Some(_) => {
                *words = before;
                return true;
            }
            None => {}
        }
        if !words.next_line() {
            return false;
        }
    }
}

fn count_lines(mut words: Words<'_>) -> u64 {
    let mut count = 0;
    while next_row(&mut words) {
        count += 1;
        words.next_line();
    }
    count
}

fn decode(scalar: Scalar, bytes: &[u8], big: bool) -> f64 {
    /// Little-endian bytes, filled with zeros.
    fn word(bytes: &[u8], big: bool) -> [u8; 8] {
        let mut word = [0; 8];
        word[..bytes.len()].copy_from_slice(bytes);
        if big {
            word[..bytes.len()].reverse();
        }
        word
    }
    let [a, b, c, d, e, f, g, h] = word(bytes, big);
    match scalar {
        Scalar::I8 => (a as i8).into(),
        Scalar::U8 => a.into(),
        Scalar::I16 => i16::from_le_bytes([a, b]).into(),
        Scalar::U16 => u16::from_le_bytes([a, b]).into(),
        Scalar::I32 => i32::from_le_bytes([a, b, c, d]).into(),
        Scalar::U32 => u32::from_le_bytes([a, b, c, d]).into(),
        Scalar::F32 => f32::from_le_bytes([a, b, c, d]).into(),
        // Beyond 2^53 they are rounded; no index is so large.
        Scalar::I64 => i64::from_le_bytes([a, b, c, d, e, f, g, h]) as f64,
        Scalar::U64 => u64::from_le_bytes([a, b, c, d, e, f, g, h]) as f64,
        Scalar::F64 => f64::from_le_bytes([a, b, c, d, e, f, g, h]),
        Scalar::Unknown => f64::NAN,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_of_every_type() {
        for (scalar, bytes, expected) in [
            (Scalar::I8, vec![0xfe], -2.0),
            (Scalar::U8, vec![0xfe], 254.0),
            (Scalar::I16, (-300_i16).to_le_bytes().into(), -300.0),
            (Scalar::U16, 65_000_u16.to_le_bytes().into(), 65_000.0),
            (Scalar::I32, (-70_000_i32).to_le_bytes().into(), -70_000.0),
            (Scalar::U32, u32::MAX.to_le_bytes().into(), 4_294_967_295.0),
            (Scalar::I64, (-1_i64).to_le_bytes().into(), -1.0),
            (Scalar::U64, (1_u64 << 40).to_le_bytes().into(), 1_099_511_627_776.0),
            (Scalar::F32, 0.5_f32.to_le_bytes().into(), 0.5),
            (Scalar::F64, 0.1_f64.to_le_bytes().into(), 0.1),
        ] {
            assert_eq!(bytes.len(), scalar.size());
            let reversed: Vec<u8> = bytes.iter().rev().copied().collect();
            assert_eq!((decode(scalar, &bytes, false), decode(scalar, &reversed, true)), (expected, expected));
        }
    }

    fn rows(body: &str, count: u64) -> Vec<Vec<f64>> {
        let property = |name| super::super::header::Property { name, scalar: Scalar::F32, list: None };
        let properties = vec![property(b"x".as_slice()), property(b"y")];
        let elements = vec![Element { name: b"vertex", count, properties }];
        let (texture, notices) = (None, Vec::new());
        let header = Header { encoding: Encoding::Ascii, elements, texture, body: body.as_bytes(), line: 1, notices };
        let mut body = Body::new(&header);
        let mut row = || {
            body.begin();
            let row = (0..2).map_while(|_| body.scalar(Scalar::F32).ok()).collect();
            body.end();
            row
        };
        (0..count).map(|_| row()).collect()
    }

    #[test]
    fn rows_and_lines() {
        for body in [
            "1 2\n3 4\n",
            "1 2\r3 4",
            "1 2 3 4",
            "1\n2\n3\n4",
            "# a\n1 2 # b\n\ncomment 9\n3 4 5 6\n\n",
            "obj_info 7\n1 2 3 4",
            "1\ncomment 8\n2 3\n4",
        ] {
            assert_eq!(rows(body, 2), [[1.0, 2.0], [3.0, 4.0]], "{body:?}");
        }
        assert_eq!(rows("1\n3 4", 2), [vec![1.0], vec![3.0, 4.0]], "one line, one row");
        assert_eq!(rows("1 2 3", 2), [vec![1.0, 2.0], vec![3.0]], "the end");
    }
}
