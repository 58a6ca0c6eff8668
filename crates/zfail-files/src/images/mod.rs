//! PNG, JPEG, WebP and KTX 2.0 images, decoded to eight bits per channel.
//!
//! In: a file's bytes. Out: an image, or why it is left out. `raster` reads the first three formats, `ktx` the last.

#[cfg(feature = "codecs")]
mod ktx;
mod raster;

#[cfg(not(feature = "codecs"))]
use crate::absent::ktx;
use crate::shared::error::Result;
use crate::shared::limits::Budget;
use ktx::Ktx;
use raster::Raster;
use zfail_scene::Image;

/// An image, or why it is left out.
pub(crate) type Decoded = std::result::Result<Image, String>;

/// Decodes what `element` of a file refers to.
pub(crate) fn decode(name: String, bytes: &[u8], budget: &Budget, element: &str) -> Result<Decoded> {
    if bytes.starts_with(ktx::SIGNATURE) {
        return decode_ktx(name, bytes, budget, element);
    }
    match Raster::open(bytes) {
        Some(raster) => decode_raster(name, raster, budget, element),
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
