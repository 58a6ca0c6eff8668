//! Pixels to file bytes: PNG for what is looked at, OpenEXR (32-bit float, lossless) for what is measured.
//!
//! Rows go from top to bottom everywhere.

use crate::error::Error;
use image::{ExtendedColorType, ImageFormat};
use std::io::Cursor;

/// 8-bit sRGB-encoded colour as PNG; the alpha of `rgba` is dropped, because a picture is opaque.
pub fn png_picture(size: [u32; 2], rgba: &[u8]) -> Result<Vec<u8>, Error> {
    let rgb: Vec<u8> = rgba.chunks_exact(4).flat_map(|p| [p[0], p[1], p[2]]).collect();
    encode(size, &rgb, ExtendedColorType::Rgb8, ImageFormat::Png)
}

/// 8-bit grey as PNG.
pub fn png_grey(size: [u32; 2], grey: &[u8]) -> Result<Vec<u8>, Error> {
    encode(size, grey, ExtendedColorType::L8, ImageFormat::Png)
}

/// 8-bit RGB as PNG, from values of 0 to 1 that are stored as they are.
pub fn png_rgb(size: [u32; 2], rgb: impl IntoIterator<Item = [f32; 3]>) -> Result<Vec<u8>, Error> {
    // Float to integer casts saturate, and NaN becomes 0.
    let bytes: Vec<u8> = rgb.into_iter().flatten().map(|c| (c * 255.0).round() as u8).collect();
    encode(size, &bytes, ExtendedColorType::Rgb8, ImageFormat::Png)
}

/// RGB in 32-bit float as OpenEXR.
pub fn exr_rgb(size: [u32; 2], rgb: impl IntoIterator<Item = [f32; 3]>) -> Result<Vec<u8>, Error> {
    let bytes: Vec<u8> = rgb.into_iter().flatten().flat_map(f32::to_ne_bytes).collect();
    encode(size, &bytes, ExtendedColorType::Rgb32F, ImageFormat::OpenExr)
}

/// One number per pixel in 32-bit float as OpenEXR, the same in R, G and B, because every reader knows those channels.
pub fn exr_scalar(size: [u32; 2], values: &[f32]) -> Result<Vec<u8>, Error> {
    exr_rgb(size, values.iter().map(|&v| [v; 3]))
}

/// The sRGB transfer function: linear 0 to 1 in, encoded 0 to 1 out.
pub fn srgb_from_linear(linear: f32) -> f32 {
    let linear = linear.clamp(0.0, 1.0);
    if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 }
}

fn encode(size: [u32; 2], bytes: &[u8], color: ExtendedColorType, format: ImageFormat) -> Result<Vec<u8>, Error> {
    // The encoders panic on a buffer of the wrong length.
    let expected = u64::from(size[0]) * u64::from(size[1]) * u64::from(color.bits_per_pixel()) / 8;
    if bytes.len() as u64 != expected {
        return Err(Error::failed(format!("an image of {expected} bytes came as {} bytes", bytes.len())));
    }
    let mut file = Cursor::new(Vec::new());
    image::write_buffer_with_format(&mut file, bytes, size[0], size[1], color, format)
        .map_err(|e| Error::failed(format!("cannot encode the image: {e}")))?;
    Ok(file.into_inner())
}

#[cfg(test)]
mod tests {
    use super::{exr_rgb, exr_scalar, png_grey, png_picture, png_rgb, srgb_from_linear};

    #[test]
    fn png_round_trips() {
        let grey = image::load_from_memory(&png_grey([2, 1], &[0, 200]).unwrap()).unwrap();
        assert_eq!(grey.as_luma8().unwrap().as_raw(), &[0, 200]);
        let picture = image::load_from_memory(&png_picture([1, 2], &[1, 2, 3, 4, 5, 6, 7, 8]).unwrap()).unwrap();
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
        let read = image::load_from_memory(&exr_rgb([1, 1], [[1.5, 2.5, 3.5]]).unwrap()).unwrap();
        assert_eq!(read.as_rgb32f().unwrap().as_raw(), &[1.5, 2.5, 3.5]);
    }

    #[test]
    fn a_wrong_number_of_pixels_is_an_error() {
        assert!(exr_rgb([2, 2], [[0.0; 3]]).is_err());
        assert!(png_rgb([2, 2], [[0.0; 3]]).is_err());
    }

    #[test]
    fn srgb_known_values() {
        assert_eq!(srgb_from_linear(0.0), 0.0);
        assert!((srgb_from_linear(1.0) - 1.0).abs() < 1e-6);
        assert!((srgb_from_linear(0.214_041_14) - 0.5).abs() < 1e-5);
    }
}
