//! PNG, JPEG and WebP images.
//!
//! In: a file's bytes. Out: RGBA texels, eight bits per channel. The header is read first, so that dimensions are known
//! before anything is allocated for them.

use crate::shared::fence::fenced;
#[cfg(feature = "codecs")]
use image_webp::WebPDecoder;
use png::{ColorType, Transformations};
use std::io::Cursor;
use zune_jpeg::JpegDecoder;
use zune_jpeg::zune_core::bytestream::ZCursor;
use zune_jpeg::zune_core::colorspace::ColorSpace;
use zune_jpeg::zune_core::options::DecoderOptions;

/// An image whose header is sound.
pub(super) enum Raster<'a> {
    Png(Box<png::Reader<Cursor<&'a [u8]>>>),
    Jpeg(Box<JpegDecoder<ZCursor<&'a [u8]>>>, (u32, u32)),
    #[cfg(feature = "codecs")]
    WebP(Box<WebPDecoder<Cursor<&'a [u8]>>>),
}

impl<'a> Raster<'a> {
    /// Reads the header; `None` if the bytes are of no known format.
    pub fn open(bytes: &'a [u8]) -> Option<Result<Self, String>> {
        let open = match bytes {
            [0x89, b'P', b'N', b'G', ..] => Self::open_png,
            [0xff, 0xd8, 0xff, ..] => Self::open_jpeg,
            #[cfg(feature = "codecs")]
            [b'R', b'I', b'F', b'F', _, _, _, _, b'W', b'E', b'B', b'P', ..] => Self::open_webp,
            _ => return None,
        };
        Some(fenced(|| open(bytes)).flatten())
    }

    fn open_png(bytes: &'a [u8]) -> Result<Self, String> {
        let mut decoder = png::Decoder::new(Cursor::new(bytes));
        decoder.set_transformations(Transformations::EXPAND);
        decoder.read_info().map(|reader| Self::Png(Box::new(reader))).map_err(|e| e.to_string())
    }

    fn open_jpeg(bytes: &'a [u8]) -> Result<Self, String> {
        let options = DecoderOptions::default().set_strict_mode(false);
        let options = options.set_max_width(usize::MAX).set_max_height(usize::MAX);
        let mut decoder = JpegDecoder::new_with_options(ZCursor::new(bytes), options);
        decoder.decode_headers().map_err(|_| "its header is damaged")?;
        let (width, height) = decoder.dimensions().ok_or("it has no dimensions")?;
        // The decoder turns what it keeps as YCbCr, YCCK or CMYK into RGB.
        let kept = match decoder.input_colorspace() {
            Some(grey @ (ColorSpace::Luma | ColorSpace::LumaA)) => grey,
            _ => ColorSpace::RGB,
        };
        decoder.set_options(options.jpeg_set_out_colorspace(kept));
        Ok(Self::Jpeg(Box::new(decoder), (width as u32, height as u32)))
    }

    #[cfg(feature = "codecs")]
    fn open_webp(bytes: &'a [u8]) -> Result<Self, String> {
        WebPDecoder::new(Cursor::new(bytes)).map(|decoder| Self::WebP(Box::new(decoder))).map_err(|e| e.to_string())
    }

    /// Width and height, pixels.
    pub fn dimensions(&self) -> (u32, u32) {
        match self {
            Self::Png(reader) => reader.info().size(),
            Self::Jpeg(_, size) => *size,
            #[cfg(feature = "codecs")]
            Self::WebP(decoder) => decoder.dimensions(),
        }
    }

    /// Four bytes per pixel. Allocates no more than some small multiple of that beside the bytes given.
    pub fn rgba(self) -> Result<Vec<u8>, String> {
        let (width, height) = self.dimensions();
        let rgba = fenced(|| match self {
            Self::Png(reader) => png(*reader),
            Self::Jpeg(decoder, _) => jpeg(*decoder),
            #[cfg(feature = "codecs")]
            Self::WebP(decoder) => webp(*decoder),
        })
        .flatten()?;
        if rgba.len() as u64 == 4 * u64::from(width) * u64::from(height) {
            Ok(rgba)
        } else {
            Err("its texels do not fill the image".into())
        }
    }
}

fn png(mut reader: png::Reader<Cursor<&[u8]>>) -> Result<Vec<u8>, String> {
    let (color, depth) = reader.output_color_type();
    let mut texels = vec![0; reader.output_buffer_size().ok_or("it is too large")?];
    reader.next_frame(&mut texels).map_err(|e| e.to_string())?;
    if depth == png::BitDepth::Sixteen {
        let eight = |pair: &[u8]| ((u32::from(pair[0]) * 256 + u32::from(pair[1]) + 128) / 257) as u8;
        texels = texels.chunks_exact(2).map(eight).collect();
    }
    Ok(match color {
        ColorType::Grayscale => widen(&texels, |&[l]| [l, l, l, 255]),
        ColorType::GrayscaleAlpha => widen(&texels, |&[l, a]| [l, l, l, a]),
        ColorType::Rgb => widen(&texels, |&[r, g, b]| [r, g, b, 255]),
        ColorType::Rgba => texels,
        ColorType::Indexed => return Err("its palette is missing".into()),
    })
}

fn jpeg(mut decoder: JpegDecoder<ZCursor<&[u8]>>) -> Result<Vec<u8>, String> {
    let texels = decoder.decode().map_err(|_| "its data is damaged or cut off")?;
    Ok(match decoder.output_colorspace() {
        Some(ColorSpace::Luma) => widen(&texels, |&[l]| [l, l, l, 255]),
        Some(ColorSpace::LumaA) => widen(&texels, |&[l, a]| [l, l, l, a]),
        _ => widen(&texels, |&[r, g, b]| [r, g, b, 255]),
    })
}

#[cfg(feature = "codecs")]
fn webp(mut decoder: WebPDecoder<Cursor<&[u8]>>) -> Result<Vec<u8>, String> {
    let mut texels = vec![0; decoder.output_buffer_size().ok_or("it is too large")?];
    decoder.read_image(&mut texels).map_err(|e| e.to_string())?;
    Ok(if decoder.has_alpha() { texels } else { widen(&texels, |&[r, g, b]| [r, g, b, 255]) })
}

/// Pixels of `N` bytes as pixels of four.
fn widen<const N: usize>(texels: &[u8], rgba: impl Fn(&[u8; N]) -> [u8; 4]) -> Vec<u8> {
    texels.as_chunks().0.iter().flat_map(rgba).collect()
}

#[cfg(test)]
mod tests {
    use super::Raster;
    use image::{DynamicImage, ImageBuffer, ImageFormat, Luma, LumaA, Rgb, Rgba};
    use std::io::Cursor;

    fn file(image: &DynamicImage, format: ImageFormat) -> Vec<u8> {
        let mut file = Cursor::new(Vec::new());
        image.write_to(&mut file, format).unwrap();
        file.into_inner()
    }

    fn decoded(file: &[u8]) -> Result<Vec<u8>, String> {
        Raster::open(file).expect("a known format")?.rgba()
    }

    #[test]
    fn every_layout_of_texels_becomes_four_bytes_a_pixel() {
        let grey = |x: u32, y: u32| (40 * x + 7 * y) as u8;
        let images: [DynamicImage; 6] = [
            ImageBuffer::from_fn(5, 3, |x, y| Luma([grey(x, y)])).into(),
            ImageBuffer::from_fn(5, 3, |x, y| LumaA([grey(x, y), 9])).into(),
            ImageBuffer::from_fn(5, 3, |x, y| Rgb([grey(x, y), 1, 2])).into(),
            ImageBuffer::from_fn(5, 3, |x, y| Rgba([grey(x, y), 1, 2, 3])).into(),
            ImageBuffer::from_fn(5, 3, |x, y| Luma([u16::from(grey(x, y)) * 257 + 128])).into(),
            ImageBuffer::from_fn(5, 3, |x, y| Rgba([u16::from(grey(x, y)) * 257 + 129, 0, 65_535, 128])).into(),
        ];
        for image in &images {
            let expected = image.to_rgba8().into_raw();
            assert_eq!(decoded(&file(image, ImageFormat::Png)), Ok(expected.clone()), "{:?}", image.color());
            if image.color().bytes_per_pixel() <= 4 && image.color().has_color() {
                assert_eq!(decoded(&file(image, ImageFormat::WebP)), Ok(expected), "{:?}", image.color());
            }
        }
        for image in [&images[0], &images[2]] {
            let file = file(image, ImageFormat::Jpeg);
            let expected = image::load_from_memory(&file).unwrap().to_rgba8().into_raw();
            assert_eq!(decoded(&file), Ok(expected), "{:?}", image.color());
        }
    }

    #[test]
    fn damage_is_an_error_and_strangers_are_none() {
        let image = DynamicImage::from(ImageBuffer::from_fn(64, 64, |x, y| Rgb([(x * y) as u8, x as u8, y as u8])));
        for format in [ImageFormat::Png, ImageFormat::WebP] {
            let file = file(&image, format);
            for end in [16, 40, file.len() / 2] {
                assert!(decoded(&file[..end]).is_err(), "{format:?}, {end} bytes");
            }
        }
        assert!(Raster::open(b"BM").is_none() && Raster::open(&[]).is_none());
    }
}
