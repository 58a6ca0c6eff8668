//! The header of a .ply file.
//!
//! In: the bytes of a file. Out: its elements with their properties in order, and where its body begins. What no one knows is
//! passed over.

use crate::plain::text::{shown, split_word, trim, words};
use crate::shared::error::{Fault, Result, malformed};
use crate::shared::limits::Budget;

/// More unknown lines than these are not told of.
const MAX_NOTICES: usize = 16;

/// How the body is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Encoding {
    Ascii,
    Little,
    Big,
}

/// The type of a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Scalar {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    I64,
    U64,
    F32,
    F64,
    /// It can be passed over in ASCII only.
    Unknown,
}

impl Scalar {
    fn named(name: &[u8]) -> Self {
        match name.to_ascii_lowercase().as_slice() {
            b"char" | b"int8" => Self::I8,
            b"uchar" | b"uint8" | b"byte" | b"ubyte" => Self::U8,
            b"short" | b"int16" => Self::I16,
            b"ushort" | b"uint16" => Self::U16,
            b"int" | b"int32" => Self::I32,
            b"uint" | b"uint32" => Self::U32,
            b"long" | b"int64" | b"longlong" => Self::I64,
            b"ulong" | b"uint64" | b"ulonglong" => Self::U64,
            b"float" | b"float32" => Self::F32,
            b"double" | b"float64" => Self::F64,
            _ => Self::Unknown,
        }
    }

    /// Bytes of a number in a binary file.
    pub fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::I64 | Self::U64 | Self::F64 => 8,
            Self::Unknown => 0,
        }
    }

    pub fn is_integer(self) -> bool {
        !matches!(self, Self::F32 | Self::F64 | Self::Unknown)
    }
}

pub(super) struct Property<'a> {
    pub name: &'a [u8],
    pub scalar: Scalar,
    /// The type of a list's length, if it is one.
    pub list: Option<Scalar>,
}

impl Property<'_> {
    pub fn is(&self, names: &[&str]) -> bool {
        names.iter().any(|name| self.name.eq_ignore_ascii_case(name.as_bytes()))
    }
}

pub(super) struct Element<'a> {
    pub name: &'a [u8],
    pub count: u64,
    pub properties: Vec<Property<'a>>,
}

pub(super) struct Header<'a> {
    pub encoding: Encoding,
    pub elements: Vec<Element<'a>>,
    /// The texture that MeshLab and its kin name in a comment.
    pub texture: Option<&'a [u8]>,
    pub body: &'a [u8],
    /// Number of the body's first line.
    pub line: usize,
    pub notices: Vec<String>,
}

impl<'a> Header<'a> {
    /// Reads the header of `bytes`; `None` if they are not PLY at all.
    pub fn read(bytes: &'a [u8], budget: &Budget) -> Result<Option<Self>> {
        let mut lines = HeaderLines::new(bytes);
        if !lines.next_line().is_some_and(|line| line.eq_ignore_ascii_case(b"ply")) {
            return Ok(None);
        }
        let mut encoding = None;
        let (mut elements, mut texture, mut notices) = (Vec::new(), None, Vec::new());
        while let Some(line) = lines.next_line() {
            let (keyword, rest) = split_word(line);
            let fault = |problem: &str| fault(lines.number, problem);
            match keyword.to_ascii_lowercase().as_slice() {
                b"format" => encoding = Some(encoding_named(rest).ok_or_else(|| fault("names an unknown format"))?),
                b"comment" => texture = texture.or(trim(rest).strip_prefix(b"TextureFile").map(trim)),
                b"obj_info" | b"" => {}
                b"element" => {
                    budget.charge(1, 256, || "the header".into())?;
                    elements.push(element(rest).ok_or_else(|| fault("needs a name and a number after it"))?);
                }
                b"property" => {
                    // It is larger than its line.
                    budget.charge(1, 128, || "the header".into())?;
                    let element: &mut Element<'_> =
                        elements.last_mut().ok_or_else(|| fault("is a property without an element"))?;
                    element.properties.push(property(rest).ok_or_else(|| fault("needs a type and a name after it"))?);
                }
                b"end_header" => {
                    let encoding = encoding.ok_or_else(|| fault("ends a header that names no format"))?;
                    let (body, line) = (lines.rest, lines.number + 1);
                    return Ok(Some(Self { encoding, elements, texture, body, line, notices }));
                }
                _ if notices.len() < MAX_NOTICES => {
                    notices.push(format!("header line `{}` is unknown and ignored", shown(trim(line))));
                }
                _ => {}
            }
        }
        let remedy = "its end is missing: copy or download it again";
        Err(malformed("the header", "has no line `end_header`", remedy))
    }
}

fn fault(line: usize, problem: &str) -> Fault {
    malformed(format!("line {line}"), problem, "export the file again from the program that it comes from")
}

fn encoding_named(rest: &[u8]) -> Option<Encoding> {
    match words(rest).next()?.to_ascii_lowercase().as_slice() {
        b"ascii" => Some(Encoding::Ascii),
        b"binary_little_endian" => Some(Encoding::Little),
        b"binary_big_endian" => Some(Encoding::Big),
        _ => None,
    }
}

fn element(rest: &[u8]) -> Option<Element<'_>> {
    let mut words = words(rest);
    let name = words.next()?;
    let count = std::str::from_utf8(words.next()?).ok()?.parse().ok()?;
    Some(Element { name, count, properties: Vec::new() })
}

fn property(rest: &[u8]) -> Option<Property<'_>> {
    let (kind, rest) = split_word(rest);
    if !kind.eq_ignore_ascii_case(b"list") {
        return Some(Property { name: words(rest).next()?, scalar: Scalar::named(kind), list: None });
    }
    let (length, rest) = split_word(rest);
    let (scalar, rest) = split_word(rest);
    Some(Property { name: words(rest).next()?, scalar: Scalar::named(scalar), list: Some(Scalar::named(length)) })
}

/// The lines of a header.
struct HeaderLines<'a> {
    rest: &'a [u8],
    number: usize,
    /// Whether lines end with CR alone: then a LF behind one belongs to the body.
    bare: bool,
}

impl<'a> HeaderLines<'a> {
    fn new(bytes: &'a [u8]) -> Self {
        let end = bytes.iter().position(|b| is_end(*b)).map_or(b"\n".as_slice(), |at| &bytes[at..]);
        Self { rest: bytes, number: 0, bare: end.starts_with(b"\r") && !end.starts_with(b"\r\n") }
    }

    /// The next line without spaces around it.
    fn next_line(&mut self) -> Option<&'a [u8]> {
        if self.rest.is_empty() {
            return None;
        }
        let length = self.rest.iter().position(|b| is_end(*b)).unwrap_or(self.rest.len());
        let (line, rest) = self.rest.split_at(length);
        let end = if rest.starts_with(b"\r\n") && !self.bare { 2 } else { 1 };
        self.rest = rest.get(end..).unwrap_or_default();
        self.number += 1;
        Some(trim(line))
    }
}

fn is_end(byte: u8) -> bool {
    matches!(byte, b'\n' | b'\r')
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Limits;

    const FILE: &str = "ply\nformat binary_big_endian 1.0\ncomment TextureFile a b.png\nelement vertex 4\n\
                        property float x\nelement face 2\nproperty list uchar int vertex_indices\nend_header\nBODY";

    fn read(text: &str) -> Result<Option<Header<'_>>> {
        Header::read(text.as_bytes(), &Budget::new(Limits::default()))
    }

    #[test]
    fn however_lines_end() {
        for (text, body) in [
            (FILE.to_owned(), "BODY"),
            (FILE.replace('\n', "\r\n"), "BODY"),
            (FILE.replace('\n', "\r"), "BODY"),
            (FILE.replace('\n', " \n"), "BODY"),
            (FILE.replace('\n', "\r").replace("BODY", "\nBODY"), "\nBODY"),
            (FILE.replace("BODY", "\nBODY"), "\nBODY"),
            (FILE.replace("end_header\n", "end_header\r\n"), "BODY"),
            (FILE.replace(' ', "  ").replace("  b.", " b.").replace("\nel", "\n\n\tel"), "BODY"),
        ] {
            let header = read(&text).unwrap().unwrap();
            assert_eq!((shown(header.body), header.encoding), (body.into(), Encoding::Big), "{text:?}");
            assert_eq!((header.texture, header.notices.len()), (Some(b"a b.png".as_slice()), 0));
            let elements: Vec<_> = header.elements.iter().map(|e| (e.name, e.count, e.properties.len())).collect();
            assert_eq!(elements, [(b"vertex".as_slice(), 4, 1), (b"face", 2, 1)]);
            let list = &header.elements[1].properties[0];
            assert_eq!((list.list, list.scalar), (Some(Scalar::U8), Scalar::I32));
        }
    }

    #[test]
    fn what_nobody_knows() {
        let odd = FILE.replace("element vertex", "vendor \u{e4} 1\nelement vertex").replace("float x", "half x");
        let header = read(&odd).unwrap().unwrap();
        assert_eq!(header.notices, ["header line `vendor \u{e4} 1` is unknown and ignored"]);
        assert_eq!(header.elements[0].properties[0].scalar, Scalar::Unknown);
        assert!(read("plx\n").unwrap().is_none());
        for (from, to, expected) in [
            ("binary_big_endian", "text", "line 2: names an unknown format"),
            ("format", "comment", "line 8: ends a header that names no format"),
            ("element vertex 4", "element vertex x", "line 4: needs a name and a number"),
            ("element vertex 4", "comment", "line 5: is a property without an element"),
            ("end_header", "comment", "the header: has no line `end_header`"),
        ] {
            let error = read(&FILE.replace(from, to)).err().unwrap().to_string();
            assert!(error.starts_with(expected), "{error}");
        }
    }
}
