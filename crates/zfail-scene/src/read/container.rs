//! The outermost layer: from a file's bytes to its JSON text and binary chunk.

use super::error::{Fault, Result};

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
    let broken = |what: String| Fault::NotGltf(format!("the GLB container is damaged: {what}"));
    let (Some(version), Some(length)) = (word(bytes, 4), word(bytes, 8)) else {
        return Err(broken("it ends within its header".into()));
    };
    if version != 2 {
        return Err(Fault::NotGltf(format!("it is GLB version {version}; only version 2 can be read")));
    }
    let length = length as usize;
    if length > bytes.len() {
        return Err(broken(format!("its header says {length} bytes, the file has {}", bytes.len())));
    }
    if length < bytes.len() {
        notices.push(format!("{} bytes after the end of the GLB container are ignored", bytes.len() - length));
    }
    let bytes = &bytes[..length];

    let (mut json, mut bin) = (None, None);
    let mut at = HEADER;
    while at < bytes.len() {
        let (Some(size), Some(kind)) = (word(bytes, at), word(bytes, at + 4)) else {
            return Err(broken(format!("a chunk header at byte {at} is cut off")));
        };
        let start = at + CHUNK_HEADER;
        let Some(chunk) = start.checked_add(size as usize).and_then(|end| bytes.get(start..end)) else {
            return Err(broken(format!("the chunk at byte {at} says {size} bytes, {} follow", bytes.len() - start)));
        };
        match kind {
            JSON if json.is_none() => json = Some(chunk),
            BIN if bin.is_none() && json.is_some() => bin = Some(chunk),
            _ => {}
        }
        // Chunks are padded to four bytes; a last chunk without its padding is tolerated.
        at = start + (size as usize).next_multiple_of(4);
    }
    let json = json.ok_or_else(|| broken("it has no JSON chunk".into()))?;
    Ok(Container { json, bin })
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
    fn damage_is_reported() {
        for (file, expected) in [
            (glb(1, 12, b""), "version 1"),
            (glb(2, 12, b""), "no JSON chunk"),
            (glb(2, 0, b""), "no JSON chunk"),
            (glb(2, 99, b""), "says 99 bytes, the file has 12"),
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
