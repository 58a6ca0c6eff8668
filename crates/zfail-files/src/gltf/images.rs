//! The images of a document, decoded in parallel.

use super::document::Document;
use super::schema;
use crate::images::{self, Decoded};
use crate::shared::error::{Fault, Result};
use crate::shared::uri;
use rayon::prelude::*;
use std::borrow::Cow;
use std::path::Path;
use zfail_scene::Image;

/// Decodes every image of the document. One that is missing, unreadable, of another format or too large becomes `None` and
/// a notice, since the geometry is sound without it.
pub(super) fn read(document: &Document<'_>, folder: &Path, notices: &mut Vec<String>) -> Result<Vec<Option<Image>>> {
    let decode = |i: usize| decode(document, folder, i);
    let decoded: Vec<_> = (0..document.root.images.len()).into_par_iter().map(decode).collect::<Result<_>>()?;
    let keep = |(i, image)| match image {
        Ok(image) => Some(image),
        Err(why) => {
            notices.push(format!("image \"{}\" {why}: left out", name(&document.root.images[i], i)));
            None
        }
    };
    Ok(decoded.into_iter().enumerate().map(keep).collect())
}

/// What image number `i` is called in notices.
pub(super) fn name(image: &schema::Image, i: usize) -> String {
    let file = image.uri.as_deref().filter(|uri| !uri.starts_with("data:"));
    image.name.clone().or_else(|| file.map(uri::shown)).unwrap_or_else(|| format!("image {i}"))
}

fn decode(document: &Document<'_>, folder: &Path, i: usize) -> Result<Decoded> {
    let source = &document.root.images[i];
    let element = format!("images[{i}]");
    let bytes = match (&source.uri, source.buffer_view) {
        (Some(uri), _) => uri::read(uri, folder, &document.budget, &element).map(Cow::from),
        (None, Some(view)) => document.view(view).map(Cow::from),
        (None, None) => return Ok(Err("has neither a uri nor a bufferView".into())),
    };
    let bytes = match bytes {
        Ok(bytes) => bytes,
        Err(Fault::Resource { problem, .. }) => return Ok(Err(format!("cannot be read ({problem})"))),
        Err(Fault::Invalid { element, problem, .. }) => return Ok(Err(format!("needs {element}: {problem}"))),
        Err(fault) => return Err(fault),
    };
    images::decode(name(source, i), &bytes, &document.budget, &element)
}
