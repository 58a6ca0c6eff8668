//! PNG, JPEG, WebP and KTX 2.0 images, decoded in parallel to eight bits per channel.

use super::document::Document;
use super::error::{Fault, Result};
use super::ktx::{self, Ktx};
use super::limits::Budget;
use super::raster::Raster;
use super::schema;
use super::uri;
use rayon::prelude::*;
use std::borrow::Cow;
use std::path::Path;
use zfail_plan::scene::Image;

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

/// An image, or why it is left out.
type Decoded = std::result::Result<Image, String>;

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
    let name = name(source, i);
    if bytes.starts_with(ktx::SIGNATURE) {
        return decode_ktx(name, &bytes, &document.budget, &element);
    }
    match Raster::open(&bytes) {
        Some(raster) => decode_raster(name, raster, &document.budget, &element),
        None => Ok(Err("is neither PNG, JPEG, WebP nor KTX 2.0".into())),
    }
}

fn decode_raster(
    name: String,
    raster: std::result::Result<Raster<'_>, String>,
    budget: &Budget,
    element: &str,
) -> Result<Decoded> {
    let damaged = |why: String| format!("is damaged ({why})");
    let raster = match raster {
        Ok(raster) => raster,
        Err(why) => return Ok(Err(damaged(why))),
    };
    let (width, height) = raster.dimensions();
    if let Err(why) = charge((width, height), budget, element)? {
        return Ok(Err(why));
    }
    Ok(match raster.rgba() {
        Ok(rgba) => Ok(Image { name, width, height, rgba }),
        Err(why) => Err(damaged(why)),
    })
}

fn decode_ktx(name: String, bytes: &[u8], budget: &Budget, element: &str) -> Result<Decoded> {
    let unreadable = |why: String| format!("cannot be read ({why})");
    let ktx = match Ktx::open(bytes) {
        Ok(ktx) => ktx,
        Err(why) => return Ok(Err(unreadable(why))),
    };
    let (width, height) = ktx.dimensions();
    if let Err(why) = charge((width, height), budget, element)? {
        return Ok(Err(why));
    }
    Ok(match ktx.rgba() {
        Ok(rgba) => Ok(Image { name, width, height, rgba }),
        Err(why) => Err(unreadable(why)),
    })
}

/// Charges for an image before anything is allocated for it, or says why it is left out.
fn charge((width, height): (u32, u32), budget: &Budget, element: &str) -> Result<std::result::Result<(), String>> {
    let side = budget.image_side();
    if width.max(height) > side {
        return Ok(Err(format!("is {width} times {height} pixels, and the limit is {side} a side")));
    }
    // Decoders hold up to 16 bits per channel beside the result.
    budget.charge(u64::from(width) * u64::from(height), 12, || element.into()).map(Ok)
}
