//! PNG and JPEG images, decoded in parallel to eight bits per channel.

use super::document::Document;
use super::error::{Fault, Result, invalid};
use super::uri;
use image::error::ImageError;
use image::{DynamicImage, ImageDecoder, ImageFormat, ImageReader};
use rayon::prelude::*;
use std::borrow::Cow;
use std::io::Cursor;
use std::path::Path;
use zfail_plan::scene::Image;

/// Decodes every image of the document. One in another format, or damaged inside, becomes `None` and a notice, since
/// the geometry is sound without it; one that is missing or cut off is an error.
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

fn decode(document: &Document<'_>, folder: &Path, i: usize) -> Result<std::result::Result<Image, String>> {
    let source = &document.root.images[i];
    let bytes: Cow<'_, [u8]> = match (&source.uri, source.buffer_view) {
        (Some(uri), _) => uri::read(uri, folder, &document.budget, &format!("images[{i}].uri"))?.into(),
        (None, Some(view)) => document.view(view)?.into(),
        (None, None) => return Err(invalid(format!("images[{i}]"), "has neither a uri nor a bufferView")),
    };
    let file_name = source.uri.as_deref().filter(|uri| !uri.starts_with("data:"));
    let name = source.name.as_deref().or(file_name).map_or_else(|| format!("image {i}"), str::to_owned);
    let format = match image::guess_format(&bytes) {
        Ok(format @ (ImageFormat::Png | ImageFormat::Jpeg)) => format,
        _ => return Ok(Err(format!("image \"{name}\" is neither PNG nor JPEG and is left out"))),
    };
    let pixels = |(width, height): (u32, u32)| {
        let side = document.budget.image_side();
        if width.max(height) > side {
            let limit = format!("{side} pixels a side");
            return Err(Fault::TooLarge { element: format!("images[{i}]"), limit });
        }
        // Decoders hold up to 16 bits per channel beside the result.
        document.budget.charge(u64::from(width) * u64::from(height), 12, || format!("images[{i}]"))
    };
    let decoded = ImageReader::with_format(Cursor::new(&bytes), format).into_decoder().and_then(|decoder| {
        let checked = pixels(decoder.dimensions());
        match checked {
            Ok(()) => DynamicImage::from_decoder(decoder).map(Ok),
            Err(fault) => Ok(Err(fault)),
        }
    });
    match decoded {
        Ok(Ok(image)) => {
            let rgba = image.into_rgba8();
            let (width, height) = rgba.dimensions();
            Ok(Ok(Image { name, width, height, rgba: rgba.into_raw() }))
        }
        Ok(Err(fault)) => Err(fault),
        Err(ImageError::IoError(_)) => Err(invalid(format!("images[{i}]"), format!("\"{name}\" is cut off"))),
        Err(e) => Ok(Err(format!("image \"{name}\" is damaged and is left out: {e}"))),
    }
}
