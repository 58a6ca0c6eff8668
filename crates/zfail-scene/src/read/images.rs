//! PNG, JPEG, WebP and KTX 2.0 images, decoded in parallel to eight bits per channel.

use super::document::Document;
use super::error::{Fault, Result, invalid};
use super::ktx::{self, Ktx};
use super::limits::Budget;
use super::raster::Raster;
use super::uri;
use rayon::prelude::*;
use std::borrow::Cow;
use std::path::Path;
use zfail_plan::scene::Image;

/// Decodes every image of the document. One in another format, or damaged inside, becomes `None`
/// and a notice, since the geometry is sound without it; one that is missing or cut off is an error.
pub(super) fn read(document: &Document<'_>, folder: &Path, notices: &mut Vec<String>) -> Result<Vec<Option<Image>>> {
    let decode = |i: usize| decode(document, folder, i);
    let decoded: Vec<_> = (0..document.root.images.len()).into_par_iter().map(decode).collect::<Result<_>>()?;
    let keep = |image| match image {
        Ok(image) => Some(image),
        Err(notice) => {
            notices.push(notice);
            None
        }
    };
    Ok(decoded.into_iter().map(keep).collect())
}

/// An image, or the notice why it is left out.
type Decoded = std::result::Result<Image, String>;

fn decode(document: &Document<'_>, folder: &Path, i: usize) -> Result<Decoded> {
    let source = &document.root.images[i];
    let bytes: Cow<'_, [u8]> = match (&source.uri, source.buffer_view) {
        (Some(uri), _) => uri::read(uri, folder, &document.budget, &format!("images[{i}].uri"))?.into(),
        (None, Some(view)) => document.view(view)?.into(),
        (None, None) => return Err(invalid(format!("images[{i}]"), "has neither a uri nor a bufferView")),
    };
    let file_name = source.uri.as_deref().filter(|uri| !uri.starts_with("data:"));
    let name = source.name.as_deref().or(file_name).map_or_else(|| format!("image {i}"), str::to_owned);
    let element = format!("images[{i}]");
    if bytes.starts_with(ktx::SIGNATURE) {
        return decode_ktx(name, &bytes, &document.budget, &element);
    }
    match Raster::open(&bytes) {
        Some(raster) => decode_raster(name, raster, &document.budget, &element),
        None => Ok(Err(format!("image \"{name}\" is neither PNG, JPEG, WebP nor KTX 2.0 and is left out"))),
    }
}

fn decode_raster(
    name: String,
    raster: std::result::Result<Raster<'_>, String>,
    budget: &Budget,
    element: &str,
) -> Result<Decoded> {
    let damaged = |why: String| format!("image \"{name}\" is damaged and is left out: {why}");
    let raster = match raster {
        Ok(raster) => raster,
        Err(why) => return Ok(Err(damaged(why))),
    };
    let (width, height) = raster.dimensions();
    charge((width, height), budget, element)?;
    Ok(match raster.rgba() {
        Ok(rgba) => Ok(Image { name, width, height, rgba }),
        Err(why) => Err(damaged(why)),
    })
}

fn decode_ktx(name: String, bytes: &[u8], budget: &Budget, element: &str) -> Result<Decoded> {
    let left_out = |why: String| format!("image \"{name}\" cannot be read and is left out: {why}");
    let ktx = match Ktx::open(bytes) {
        Ok(ktx) => ktx,
        Err(why) => return Ok(Err(left_out(why))),
    };
    let (width, height) = ktx.dimensions();
    charge((width, height), budget, element)?;
    Ok(match ktx.rgba() {
        Ok(rgba) => Ok(Image { name, width, height, rgba }),
        Err(why) => Err(left_out(why)),
    })
}

/// Refuses images beyond the limits before anything is allocated for them.
fn charge((width, height): (u32, u32), budget: &Budget, element: &str) -> Result<()> {
    let side = budget.image_side();
    if width.max(height) > side {
        return Err(Fault::TooLarge { element: element.into(), limit: format!("{side} pixels a side") });
    }
    // Decoders hold up to 16 bits per channel beside the result.
    budget.charge(u64::from(width) * u64::from(height), 12, || element.into())
}
