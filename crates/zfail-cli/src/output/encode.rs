//! Pixels to file bytes and back: PNG for what is looked at, OpenEXR (32-bit float, lossless) for what is measured.
//!
//! Rows go from top to bottom everywhere. The same pixels give the same bytes on every run. A picture may carry a line of
//! text, its seal, which viewers ignore.

use crate::error::Error;
use exr::prelude as openexr;
use openexr::{Encoding, LineOrder, ReadChannels, ReadLayers, WritableImage};
use std::io::Cursor;

/// Under which the seal stands in a file's metadata.
const SEAL: &str = "zfail-seal";

/// A picture read back.
#[derive(Debug, PartialEq, Eq)]
pub struct Sealed {
    /// What [`rgb8`] or [`rgb32f`] gave when it was written.
    pub pixels: Vec<u8>,
    /// Its seal.
    pub seal: String,
}

/// 8-bit sRGB-encoded colour as bytes; alpha is dropped, because a picture is opaque.
pub fn rgb8(rgba: &[u8]) -> Vec<u8> {
    rgba.chunks_exact(4).flat_map(|p| [p[0], p[1], p[2]]).collect()
}

/// 32-bit float colour as bytes.
pub fn rgb32f(rgb: impl IntoIterator<Item = [f32; 3]>) -> Vec<u8> {
    rgb.into_iter().flatten().flat_map(f32::to_le_bytes).collect()
}

/// 8-bit RGB as PNG.
pub fn png_picture(size: [u32; 2], rgb: &[u8], seal: Option<&str>) -> Result<Vec<u8>, Error> {
    png(size, rgb, png::ColorType::Rgb, seal)
}

/// 8-bit grey as PNG.
pub fn png_grey(size: [u32; 2], grey: &[u8]) -> Result<Vec<u8>, Error> {
    png(size, grey, png::ColorType::Grayscale, None)
}

/// 8-bit RGB as PNG, from values of 0 to 1 that are stored as they are.
pub fn png_rgb(size: [u32; 2], rgb: impl IntoIterator<Item = [f32; 3]>) -> Result<Vec<u8>, Error> {
    // Float to integer casts saturate, and NaN becomes 0.
    let bytes: Vec<u8> = rgb.into_iter().flatten().map(|c| (c * 255.0).round() as u8).collect();
    png(size, &bytes, png::ColorType::Rgb, None)
}

/// One number per pixel in 32-bit float as OpenEXR, the same in R, G and B, because every reader knows those channels.
pub fn exr_scalar(size: [u32; 2], values: &[f32]) -> Result<Vec<u8>, Error> {
    exr_rgb(size, &rgb32f(values.iter().map(|&v| [v; 3])), None)
}

/// The bytes of [`rgb32f`] as OpenEXR.
pub fn exr_rgb(size: [u32; 2], rgb: &[u8], seal: Option<&str>) -> Result<Vec<u8>, Error> {
    check_length(size, rgb, 12)?;
    let [width, height] = size.map(|side| side as usize);
    let number = |at: usize| rgb.get(at..).and_then(|b| b.first_chunk()).map_or(0.0, |b| f32::from_le_bytes(*b));
    let channels = openexr::SpecificChannels::rgb(|openexr::Vec2(x, y)| {
        let at = 12 * (y * width + x);
        (number(at), number(at + 4), number(at + 8))
    });
    let mut attributes = openexr::LayerAttributes::default();
    if let Some(seal) = seal {
        attributes.other.insert(SEAL.into(), openexr::AttributeValue::Text(seal.into()));
    }
    // In an unspecified order, blocks would lie in the file as the threads happen to finish them.
    let encoding = Encoding { line_order: LineOrder::Increasing, ..Encoding::FAST_LOSSLESS };
    let layer = openexr::Layer::new((width, height), attributes, encoding, channels);
    let mut file = Cursor::new(Vec::new());
    openexr::Image::from_layer(layer).write().to_buffered(&mut file)?;
    Ok(file.into_inner())
}

/// Reads a sealed PNG picture of this size; `None` for any other file, and for one that is damaged.
pub fn read_png(size: [u32; 2], file: &[u8]) -> Option<Sealed> {
    let mut reader = png::Decoder::new(Cursor::new(file)).read_info().ok()?;
    let info = reader.info();
    let is_ours = (info.color_type, info.bit_depth) == (png::ColorType::Rgb, png::BitDepth::Eight);
    if [info.width, info.height] != size || !is_ours {
        return None;
    }
    let seal = info.uncompressed_latin1_text.iter().find(|text| text.keyword == SEAL)?.text.clone();
    let mut pixels = vec![0; reader.output_buffer_size()?];
    reader.next_frame(&mut pixels).ok()?;
    reader.finish().ok()?;
    Some(Sealed { pixels, seal })
}

/// Reads a sealed OpenEXR picture of this size; `None` for any other file, and for one that is damaged.
pub fn read_exr(size: [u32; 2], file: &[u8]) -> Option<Sealed> {
    let [width, height] = size.map(|side| side as usize);
    let image = openexr::read()
        .no_deep_data()
        .largest_resolution_level()
        .rgb_channels(
            // A file of another size gets no memory.
            |found, _| if found == openexr::Vec2(width, height) { vec![0; 12 * width * height] } else { Vec::new() },
            move |pixels: &mut Vec<u8>, openexr::Vec2(x, y), (r, g, b): (f32, f32, f32)| {
                let at = 12 * (y * width + x);
                if let Some(slot) = pixels.get_mut(at..at + 12) {
                    slot.copy_from_slice(&rgb32f([[r, g, b]]));
                }
            },
        )
        .first_valid_layer()
        .all_attributes()
        .from_buffered(Cursor::new(file))
        .ok()?;
    let openexr::AttributeValue::Text(seal) = image.layer_data.attributes.other.get(&openexr::Text::from(SEAL))? else {
        return None;
    };
    let pixels = image.layer_data.channel_data.pixels;
    (!pixels.is_empty()).then(|| Sealed { pixels, seal: seal.to_string() })
}

/// The sRGB transfer function: linear 0 to 1 in, encoded 0 to 1 out.
pub fn srgb_from_linear(linear: f32) -> f32 {
    let linear = linear.clamp(0.0, 1.0);
    if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 }
}

fn png(size: [u32; 2], bytes: &[u8], color: png::ColorType, seal: Option<&str>) -> Result<Vec<u8>, Error> {
    check_length(size, bytes, color.samples())?;
    let mut file = Vec::new();
    let mut encoder = png::Encoder::new(&mut file, size[0], size[1]);
    encoder.set_color(color);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_compression(png::Compression::Fast);
    encoder.set_filter(png::Filter::Adaptive);
    if let Some(seal) = seal {
        encoder.add_text_chunk(SEAL.to_owned(), seal.to_owned())?;
    }
    let mut writer = encoder.write_header()?;
    writer.write_image_data(bytes)?;
    writer.finish()?;
    Ok(file)
}

/// The encoders panic on a buffer of the wrong length, or fill it up.
fn check_length(size: [u32; 2], bytes: &[u8], bytes_per_pixel: usize) -> Result<(), Error> {
    let expected = u64::from(size[0]) * u64::from(size[1]) * bytes_per_pixel as u64;
    if bytes.len() as u64 == expected {
        return Ok(());
    }
    Err(Error::failed(format!("an image of {expected} bytes came as {} bytes", bytes.len())))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn png_round_trips() {
        let grey = image::load_from_memory(&png_grey([2, 1], &[0, 200]).unwrap()).unwrap();
        assert_eq!(grey.as_luma8().unwrap().as_raw(), &[0, 200]);
        let picture =
            image::load_from_memory(&png_picture([1, 2], &rgb8(&[1, 2, 3, 4, 5, 6, 7, 8]), None).unwrap()).unwrap();
        assert_eq!((picture.width(), picture.height()), (1, 2));
        assert_eq!(picture.as_rgb8().unwrap().as_raw(), &[1, 2, 3, 5, 6, 7]);
        let rgb = image::load_from_memory(&png_rgb([2, 1], [[0.0, 0.5, 1.0], [-1.0, 2.0, f32::NAN]]).unwrap()).unwrap();
        assert_eq!(rgb.as_rgb8().unwrap().as_raw(), &[0, 128, 255, 0, 255, 0]);
    }

    #[test]
    fn exr_keeps_every_bit() {
        let values = [0.1, -1e30, 1e-30, f32::INFINITY, 65_505.0, 0.0];
        let read = image::load_from_memory(&exr_scalar([3, 2], &values).unwrap()).unwrap();
        let read = read.as_rgb32f().unwrap();
        assert_eq!(read.dimensions(), (3, 2));
        assert_eq!(read.pixels().map(|p| p.0[0]).collect::<Vec<_>>(), values);
        let read = image::load_from_memory(&exr_rgb([1, 1], &rgb32f([[1.5, 2.5, 3.5]]), None).unwrap()).unwrap();
        assert_eq!(read.as_rgb32f().unwrap().as_raw(), &[1.5, 2.5, 3.5]);
    }

    #[test]
    fn a_wrong_number_of_pixels_is_an_error() {
        assert!(exr_rgb([2, 2], &rgb32f([[0.0; 3]]), None).is_err());
        assert!(png_rgb([2, 2], [[0.0; 3]]).is_err());
    }

    #[test]
    fn srgb_known_values() {
        assert_eq!(srgb_from_linear(0.0), 0.0);
        assert!((srgb_from_linear(1.0) - 1.0).abs() < 1e-6);
        assert!((srgb_from_linear(0.214_041_14) - 0.5).abs() < 1e-5);
    }

    #[test]
    fn seals_come_back_with_the_pixels() {
        let size = [70, 3];
        let rgb: Vec<u8> = (0..630_u32).map(|i| (i * i) as u8).collect();
        let floats = rgb32f(rgb.chunks_exact(3).map(|p| [f32::from(p[0]), -0.0, f32::from(p[2]).sqrt()]));
        let files = [png_picture(size, &rgb, Some("a")).unwrap(), exr_rgb(size, &floats, Some("a")).unwrap()];
        let pixels = [rgb.clone(), floats.clone()];
        for ((file, pixels), read) in files.iter().zip(pixels).zip([read_png, read_exr]) {
            assert_eq!(read(size, file), Some(Sealed { pixels, seal: "a".to_owned() }));
            assert_eq!(read([3, 70], file), None, "another size");
            for end in 0..file.len() {
                assert_eq!(read(size, &file[..end]), None, "{end} of {} bytes", file.len());
            }
        }
        assert_eq!(read_png(size, &files[1]), None, "another format");
        assert_eq!(read_png(size, &png_picture(size, &rgb, None).unwrap()), None, "no seal");
        assert_eq!(read_exr(size, &exr_rgb(size, &floats, None).unwrap()), None, "no seal");
    }

    #[test]
    fn the_same_pixels_give_the_same_bytes() {
        // Many blocks, which threads compress at the same time.
        let size = [1024, 512];
        let pixels = rgb32f((0..size[0] * size[1]).map(|i| [i as f32, (i % 7) as f32, (i as f32).sin()]));
        let first = exr_rgb(size, &pixels, None).unwrap();
        assert!((0..8).all(|_| exr_rgb(size, &pixels, None).unwrap() == first));
    }
}
