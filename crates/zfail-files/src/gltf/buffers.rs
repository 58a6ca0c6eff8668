//! The bytes of the document's buffer views, decompressed.
//!
//! In: the schema, the binary chunk and the files that it names. Out: the bytes of any buffer view, checked to lie inside
//! its buffer when something needs them.

use super::meshopt;
use super::schema::{Buffer, Root};
use crate::shared::error::{Fault, Result, invalid, misunderstood};
use crate::shared::limits::Budget;
use crate::shared::uri;
use rayon::prelude::*;
use std::borrow::Cow;
use std::path::Path;

pub(crate) struct Buffers<'a> {
    buffers: Vec<Cow<'a, [u8]>>,
    /// Per buffer view, if it had to be decompressed.
    decoded: Vec<Option<Decoded>>,
}

/// The bytes of a buffer view, or the element in which it is broken, and how.
type Decoded = std::result::Result<Vec<u8>, (String, String)>;

impl<'a> Buffers<'a> {
    /// Fetches every buffer that is needed, and decompresses the buffer views that are compressed.
    pub fn open(
        root: &Root,
        bin: Option<Cow<'a, [u8]>>,
        folder: &Path,
        budget: &Budget,
        notices: &mut Vec<String>,
    ) -> Result<Self> {
        let mut needed = vec![false; root.buffers.len()];
        for view in &root.buffer_views {
            let buffer = view.extensions.meshopt().map_or(view.buffer, |(_, meshopt)| meshopt.buffer);
            needed.get_mut(buffer).into_iter().for_each(|needed| *needed = true);
        }
        let mut buffers = Vec::with_capacity(root.buffers.len());
        let mut bin = bin;
        for (i, buffer) in root.buffers.iter().enumerate() {
            // What only stands in for compressed data need not exist.
            let skipped = buffer.is_fallback() && !needed[i];
            let chunk = if i == 0 { bin.take() } else { None };
            let bytes =
                if skipped { Cow::Borrowed([].as_slice()) } else { fetch(i, buffer, chunk, folder, budget, notices)? };
            buffers.push(bytes);
        }
        let mut open = Self { buffers, decoded: Vec::new() };
        let decode = |i: usize| match open.decode(root, i, budget) {
            Ok(bytes) => Ok(bytes.map(Ok)),
            // It may be that nothing needs it.
            Err(Fault::Invalid { element, problem, .. }) => Ok(Some(Err((element, problem)))),
            Err(fault) => Err(fault),
        };
        open.decoded = (0..root.buffer_views.len()).into_par_iter().map(decode).collect::<Result<_>>()?;
        Ok(open)
    }

    fn decode(&self, root: &Root, index: usize, budget: &Budget) -> Result<Option<Vec<u8>>> {
        let view = &root.buffer_views[index];
        let Some((extension, meshopt)) = view.extensions.meshopt() else { return Ok(None) };
        let path = format!("bufferViews[{index}].extensions.{extension}");
        let source = self.range(meshopt.buffer, meshopt.byte_offset, meshopt.byte_length, &path)?;
        meshopt::decode(meshopt, view, source, budget, &path).map(Some)
    }

    /// The bytes of buffer view `index` of `root`.
    pub fn view(&self, root: &Root, index: usize) -> Result<&[u8]> {
        let element = || format!("bufferViews[{index}]");
        let Some(view) = root.buffer_views.get(index) else {
            return Err(invalid(element(), format!("is not there: the file has {}", root.buffer_views.len())));
        };
        match (self.decoded.get(index), &view.fault) {
            (Some(Some(Ok(bytes))), _) => Ok(bytes),
            (Some(Some(Err((element, problem)))), _) => Err(invalid(element, problem)),
            (_, Some(fault)) => Err(misunderstood(fault)),
            _ => self.range(view.buffer, view.byte_offset, view.byte_length, &element()),
        }
    }

    /// Supplies the bytes of the buffer view that is added to the document next.
    pub fn push(&mut self, bytes: Vec<u8>) {
        self.decoded.push(Some(Ok(bytes)));
    }

    fn range(&self, buffer: usize, offset: u64, length: u64, element: &str) -> Result<&[u8]> {
        let Some(bytes) = self.buffers.get(buffer) else {
            let problem = format!("refers to buffers[{buffer}], but the file has {}", self.buffers.len());
            return Err(invalid(element, problem));
        };
        slice(bytes, offset, length).ok_or_else(|| {
            let problem = format!("covers {length} bytes from {offset}, but buffers[{buffer}] has {}", bytes.len());
            invalid(element, problem)
        })
    }
}

fn fetch<'a>(
    i: usize,
    buffer: &Buffer,
    chunk: Option<Cow<'a, [u8]>>,
    folder: &Path,
    budget: &Budget,
    notices: &mut Vec<String>,
) -> Result<Cow<'a, [u8]>> {
    let mut bytes: Cow<'a, [u8]> = match (&buffer.uri, chunk) {
        (Some(uri), _) => uri::read(uri, folder, budget, &format!("buffers[{i}].uri"))?.into(),
        (None, Some(chunk)) => chunk,
        (None, None) => return Err(invalid(format!("buffers[{i}]"), "has neither a uri nor a binary chunk")),
    };
    if (bytes.len() as u64) < buffer.byte_length {
        // Whether something needs them, the buffer views will show.
        notices.push(format!(
            "buffers[{i}].byteLength says {} bytes, but there are {}",
            buffer.byte_length,
            bytes.len()
        ));
        return Ok(bytes);
    }
    match &mut bytes {
        Cow::Borrowed(b) => *b = &b[..buffer.byte_length as usize],
        Cow::Owned(b) => b.truncate(buffer.byte_length as usize),
    }
    Ok(bytes)
}

/// `length` bytes from `offset`, if there are so many.
pub(super) fn slice(bytes: &[u8], offset: u64, length: u64) -> Option<&[u8]> {
    let start = usize::try_from(offset).ok()?;
    let end = usize::try_from(offset.checked_add(length)?).ok()?;
    bytes.get(start..end)
}
