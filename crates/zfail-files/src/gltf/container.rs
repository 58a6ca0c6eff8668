//! The outermost layer: from a file's bytes to its JSON text and binary chunk.

use crate::shared::error::{Fault, Result};

/// A glTF file taken apart.
#[derive(Debug)]
pub(super) struct Container<'a> {
    /// The JSON document, without a byte order mark.
    pub json: &'a [u8],
    /// The binary chunk of a GLB file.
    pub bin: Option<&'a [u8]>,
}

const HEADER: usize = 12;
const CHUNK_HEADER: usize = 8;
const JSON: u32 = u32::from_le_bytes(*b"JSON");
const BIN: u32 = u32::from_le_bytes(*b"BIN\0");

/// Takes `bytes` apart; what had to be tolerated is added to `notices`.
pub(super) fn open<'a>(bytes: &'a [u8], notices: &mut Vec<String>) -> Result<Container<'a>> {
    if bytes.is_empty() {
        return Err(Fault::NotGltf("it is empty".into()));
    }
    if bytes.starts_with(b"glTF") {
        return open_glb(bytes, notices);
    }
    let json = match bytes.strip_prefix(b"\xef\xbb\xbf") {
        Some(rest) => {
            notices.push("the JSON begins with a byte order mark, which glTF forbids; it is skipped".into());
            rest
        }
        None => bytes,
    };
    if json.trim_ascii_start().first() != Some(&b'{') {
        return Err(Fault::NotGltf("it begins neither with the GLB signature nor with a JSON object".into()));
    }
    Ok(Container { json, bin: None })
}

fn open_glb<'a>(bytes: &'a [u8], notices: &mut Vec<String>) -> Result<Container<'a>> {
    let (Some(version), Some(length)) = (word(bytes, 4), word(bytes, 8)) else {
        return Err(Fault::Damaged("it ends within its header".into()));
    };
    match version {
        2 => {}
        1 => return Err(Fault::old("1.0")),
        _ => return Err(Fault::NotGltf(format!("it is GLB version {version}; only version 2 can be read"))),
    }
    let length = length as usize;
    if length > bytes.len() {
        // Whether something is missing, the chunks will show.
        notices.push(format!("the header of the GLB container says {length} bytes, the file has {}", bytes.len()));
    }

    let (mut json, mut bin) = (None, None);
    let mut at = HEADER;
    while at < bytes.len() {
        let is_complete = json.is_some() && bin.is_some();
        // Some writers leave the length at zero, or forget the binary chunk in it.
        let goes_on = json.is_none() || bin.is_none() && kind_at(bytes, at) == Some(BIN);
        if at >= length && !goes_on {
            break;
        }
        let (kind, chunk) = match chunk_at(bytes, at) {
            Ok(found) => found,
            Err(_) if is_complete => break,
            Err(what) => return Err(Fault::Damaged(what)),
        };
        match kind {
            JSON if json.is_none() => json = Some(chunk),
            BIN if bin.is_none() && json.is_some() => bin = Some(chunk),
            _ => {}
        }
        at = next_chunk(bytes, at + CHUNK_HEADER + chunk.len(), notices);
    }
    if at < bytes.len() {
        notices.push(format!("{} bytes after the end of the GLB container are ignored", bytes.len() - at));
    }
    let json = json.ok_or_else(|| Fault::Damaged("it has no JSON chunk".into()))?;
    Ok(Container { json, bin })
}

/// Kind and data of the chunk whose header is at `at`.
fn chunk_at(bytes: &[u8], at: usize) -> std::result::Result<(u32, &[u8]), String> {
    let (Some(size), Some(kind)) = (word(bytes, at), word(bytes, at + 4)) else {
        return Err(format!("a chunk header at byte {at} is cut off"));
    };
    let start = at + CHUNK_HEADER;
    let data = start.checked_add(size as usize).and_then(|end| bytes.get(start..end));
    data.map(|data| (kind, data))
        .ok_or_else(|| format!("the chunk at byte {at} says {size} bytes, {} follow", bytes.len() - start))
}

/// Where the chunk after one that ends at `end` begins. Chunks are padded to four bytes; a last one without its padding is
/// tolerated, and so is the next one if it follows at once.
fn next_chunk(bytes: &[u8], end: usize, notices: &mut Vec<String>) -> usize {
    let padded = end.next_multiple_of(4);
    let is_chunk = |at: usize| {
        let known = kind_at(bytes, at).is_some_and(|kind| kind == BIN || kind == JSON);
        known && word(bytes, at).is_some_and(|size| size as usize <= bytes.len() - at - CHUNK_HEADER)
    };
    if padded != end && is_chunk(end) && !is_chunk(padded) {
        notices.push(format!("a chunk of the GLB container ends at byte {end}, which is no multiple of four"));
        return end;
    }
    padded
}

fn kind_at(bytes: &[u8], at: usize) -> Option<u32> {
    word(bytes, at.checked_add(4)?)
}

fn word(bytes: &[u8], at: usize) -> Option<u32> {
    bytes.get(at..)?.first_chunk().map(|b| u32::from_le_bytes(*b))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn glb(version: u32, length: u32, chunks: &[u8]) -> Vec<u8> {
        [b"glTF".as_slice(), &version.to_le_bytes(), &length.to_le_bytes(), chunks].concat()
    }

    #[test]
    fn chunks_are_found_and_unknown_ones_skipped() {
        let chunks = b"\x02\0\0\0JSON{}  \x04\0\0\0XYZ\0....\x04\0\0\0BIN\0abcd";
        let file = glb(2, 12 + chunks.len() as u32, chunks);
        let container = open(&file, &mut Vec::new()).unwrap();
        assert_eq!((container.json, container.bin), (b"{}".as_slice(), Some(b"abcd".as_slice())));
    }

    #[test]
    fn lengths_that_are_no_multiple_of_four() {
        let expected = (b"{} ".as_slice(), Some(b"abcde".as_slice()));
        for (chunks, count) in [
            (b"\x03\0\0\0JSON{} \x05\0\0\0BIN\0abcde".as_slice(), 1),
            (b"\x03\0\0\0JSON{}  \x05\0\0\0BIN\0abcde", 0),
            (b"\x03\0\0\0JSON{}  \x05\0\0\0BIN\0abcde\0\0\0", 0),
        ] {
            let mut notices = Vec::new();
            let file = glb(2, 12 + chunks.len() as u32, chunks);
            let container = open(&file, &mut notices).unwrap();
            assert_eq!((container.json, container.bin, notices.len()), (expected.0, expected.1, count), "{notices:?}");
        }
    }

    #[test]
    fn the_length_in_the_header_is_only_a_word() {
        let chunks = b"\x04\0\0\0JSON{}  \x04\0\0\0BIN\0abcdmore";
        for (length, end, count) in [(36, 36, 0), (36, 40, 1), (40, 40, 1), (0, 36, 0), (24, 36, 0), (99, 36, 1)] {
            let mut notices = Vec::new();
            let file = glb(2, length, &chunks[..end - 12]);
            let container = open(&file, &mut notices).unwrap();
            assert_eq!((container.bin, notices.len()), (Some(b"abcd".as_slice()), count), "{length}: {notices:?}");
        }
    }

    #[test]
    fn damage_is_reported() {
        for (file, expected) in [
            (glb(1, 12, b""), "this is glTF 1.0"),
            (glb(3, 12, b""), "version 3"),
            (glb(2, 12, b""), "no JSON chunk"),
            (glb(2, 0, b""), "no JSON chunk"),
            (glb(2, 99, b""), "no JSON chunk"),
            (glb(2, 14, b"ab"), "chunk header at byte 12"),
            (glb(2, 22, b"\xff\xff\xff\xffJSON{}"), "says 4294967295 bytes, 2 follow"),
            (b"glTF".to_vec(), "within its header"),
            (b"PK\x03\x04".to_vec(), "neither"),
            (Vec::new(), "empty"),
        ] {
            let message = open(&file, &mut Vec::new()).unwrap_err().to_string();
            assert!(message.contains(expected), "{message:?} lacks {expected:?}");
        }
    }
}
