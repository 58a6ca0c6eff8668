//! KTX 2.0 images (KHR_texture_basisu): ETC1S, UASTC and plain texels, with or without Zstandard.
//!
//! In: a file's bytes. Out: the RGBA texels of its first level. The container is read by a crate before the transcoder
//! sees it, so that dimensions and lengths are known to be sane before anything is allocated for them.

use crate::shared::fence::fenced;
use basisu::{DecodeFlags, TargetFormat, Transcoder};
use ktx2::{ColorModel, Format, Header, Level, Reader, SupercompressionScheme};
use ruzstd::StreamingDecoder;
use ruzstd::io::Read;

/// The first bytes of every KTX 2.0 file.
pub(super) const SIGNATURE: &[u8] = b"\xabKTX 20\xbb\r\n\x1a\n";

/// A container whose header is sound.
pub(super) struct Ktx<'a> {
    bytes: &'a [u8],
    reader: Reader<&'a [u8]>,
}

impl<'a> Ktx<'a> {
    pub fn open(bytes: &'a [u8]) -> Result<Self, String> {
        let reader = fenced(|| Reader::new(bytes))?.map_err(|e| e.to_string())?;
        Ok(Self { bytes, reader })
    }

    /// Width and height, pixels; at least 1.
    pub fn dimensions(&self) -> (u32, u32) {
        let Header { pixel_width, pixel_height, .. } = self.reader.header();
        (pixel_width.max(1), pixel_height.max(1))
    }

    /// Four bytes per pixel. Allocates no more than some small multiple of that beside the bytes given.
    pub fn rgba(&self) -> Result<Vec<u8>, String> {
        let header = self.reader.header();
        if header.pixel_height == 0 || header.pixel_depth > 0 || header.face_count != 1 || header.layer_count > 1 {
            return Err("it is no plain two-dimensional image".into());
        }
        let level = self.reader.levels().next().ok_or("it has no levels")?;
        match (header.format, self.reader.color_model()) {
            (None, Some(ColorModel::ETC1S)) => self.transcode(),
            (None, Some(ColorModel::UASTC)) => {
                let (width, height) = self.dimensions();
                let size = 16 * u64::from(width.div_ceil(4)) * u64::from(height.div_ceil(4));
                if header.supercompression_scheme.is_some() && level.uncompressed_byte_length != size {
                    return Err("the size of its first level does not fit its dimensions".into());
                }
                self.transcode()
            }
            (Some(format), _) => self.plain(format, header.supercompression_scheme, &level),
            (None, _) => Err("its texels are neither ETC1S nor UASTC".into()),
        }
    }

    fn transcode(&self) -> Result<Vec<u8>, String> {
        let (width, height) = self.dimensions();
        let rgba = fenced(|| {
            let transcoder = Transcoder::new(self.bytes).map_err(|e| format!("{e:?}"))?;
            transcoder.transcode(0, TargetFormat::Rgba32, DecodeFlags::NONE).map_err(|e| format!("{e:?}"))
        })??;
        if rgba.len() as u64 == 4 * u64::from(width) * u64::from(height) {
            Ok(rgba)
        } else {
            Err("its texels do not fill the image".into())
        }
    }

    fn plain(
        &self,
        format: Format,
        scheme: Option<SupercompressionScheme>,
        level: &Level<'_>,
    ) -> Result<Vec<u8>, String> {
        let channels: usize = match format {
            Format::R8_UNORM | Format::R8_SRGB => 1,
            Format::R8G8_UNORM | Format::R8G8_SRGB => 2,
            Format::R8G8B8_UNORM | Format::R8G8B8_SRGB => 3,
            Format::R8G8B8A8_UNORM | Format::R8G8B8A8_SRGB => 4,
            _ => return Err("its texel format is not one that glTF allows, nor eight bits per channel".into()),
        };
        let (width, height) = self.dimensions();
        let size = u64::from(width) * u64::from(height) * channels as u64;
        let size = usize::try_from(size).map_err(|_| "it is too large")?;
        let inflated;
        let texels = match scheme {
            None => level.data.get(..size).ok_or("its first level is cut off")?,
            Some(SupercompressionScheme::Zstandard) => {
                inflated = fenced(|| inflate(level.data, size))??;
                &inflated
            }
            Some(_) => return Err("it is compressed with something other than Zstandard".into()),
        };
        let texel = |t: &[u8]| match *t {
            [r] => [r, 0, 0, 255],
            [r, g] => [r, g, 0, 255],
            [r, g, b] => [r, g, b, 255],
            [r, g, b, a, ..] => [r, g, b, a],
            [] => [0; 4],
        };
        Ok(texels.chunks_exact(channels).flat_map(texel).collect())
    }
}

/// The `size` bytes to which `compressed`, one Zstandard frame, expands.
fn inflate(compressed: &[u8], size: usize) -> Result<Vec<u8>, String> {
    let mut decoder = StreamingDecoder::new(compressed).map_err(|e| e.to_string())?;
    let mut bytes = vec![0; size];
    decoder.read_exact(&mut bytes).map_err(|e| format!("its Zstandard data are damaged: {e}"))?;
    Ok(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A KTX 2.0 file of one level; `model` is the colour model of its data format descriptor.
    fn file(format: u32, [width, height]: [u32; 2], scheme: u32, model: u8, level: &[u8], inflated: u64) -> Vec<u8> {
        const DESCRIPTOR: usize = 80 + 24;
        const LENGTH: u32 = 44;
        let start = DESCRIPTOR + LENGTH as usize;
        let words = |words: &[u32]| words.iter().flat_map(|w| w.to_le_bytes()).collect::<Vec<u8>>();
        let longs = |longs: &[u64]| longs.iter().flat_map(|w| w.to_le_bytes()).collect::<Vec<u8>>();
        let dimensions = words(&[format, 1, width, height, 0, 0, 1, 1, scheme]);
        let index = [words(&[DESCRIPTOR as u32, LENGTH, 0, 0]), longs(&[0, 0])].concat();
        let levels = longs(&[start as u64, level.len() as u64, inflated]);
        // One block of one sample: vendor and type, version and size, model and transfer function, block, bytes.
        let descriptor = words(&[LENGTH, 0, 2 | 40 << 16, u32::from(model) | 1 << 8 | 1 << 16, 0x0303, 16, 0]);
        let sample = words(&[127 << 16, 0, 0, u32::MAX]);
        let mut file = [SIGNATURE, &dimensions, &index, &levels, &descriptor, &sample].concat();
        assert_eq!(file.len(), start);
        file.extend(level);
        file
    }

    /// A Zstandard frame that stores `bytes` as they are.
    fn stored(bytes: &[u8]) -> Vec<u8> {
        let header = (bytes.len() as u32) << 3 | 1;
        [&[0x28, 0xb5, 0x2f, 0xfd, 0x20, bytes.len() as u8], &header.to_le_bytes()[..3], bytes].concat()
    }

    fn rgba(file: &[u8]) -> Result<Vec<u8>, String> {
        Ktx::open(file)?.rgba()
    }

    #[test]
    fn plain_texels() {
        let texels: Vec<u8> = (0..24).collect();
        assert_eq!(rgba(&file(37, [3, 2], 0, 1, &texels, 24)).unwrap(), texels);
        assert_eq!(rgba(&file(43, [3, 2], 2, 1, &stored(&texels), 24)).unwrap(), texels);
        assert_eq!(rgba(&file(23, [1, 2], 0, 1, &texels[..6], 6)).unwrap(), [0, 1, 2, 255, 3, 4, 5, 255]);
        assert_eq!(rgba(&file(9, [2, 1], 0, 1, &[7, 8], 2)).unwrap(), [7, 0, 0, 255, 8, 0, 0, 255]);
        for (broken, expected) in [
            (file(37, [3, 3], 0, 1, &texels, 24), "cut off"),
            (file(43, [3, 3], 2, 1, &stored(&texels), 24), "Zstandard"),
            (file(37, [3, 2], 3, 1, &texels, 24), "other than Zstandard"),
            (file(109, [1, 1], 0, 1, &texels, 16), "texel format"),
            (file(0, [4, 4], 0, 1, &texels, 16), "neither ETC1S nor UASTC"),
            (texels, ""),
        ] {
            assert!(rgba(&broken).unwrap_err().contains(expected), "{expected}");
        }
    }

    /// Mode 8 of UASTC is one colour for the whole block: five bits of mode, then eight bits per channel.
    #[test]
    fn uastc_blocks() {
        let color = u128::from(u32::from_le_bytes([10, 20, 30, 40]));
        let block = (color << 5 | 0b10111).to_le_bytes();
        let expected = [10, 20, 30, 40].repeat(5 * 3);
        let blocks = [block, block].concat();
        assert_eq!(rgba(&file(0, [5, 3], 0, 166, &blocks, 32)).unwrap(), expected);
        assert_eq!(rgba(&file(0, [5, 3], 2, 166, &stored(&blocks), 32)).unwrap(), expected);
        let lie = file(0, [5, 3], 2, 166, &stored(&blocks), u64::MAX);
        assert!(rgba(&lie).unwrap_err().contains("does not fit its dimensions"));
        assert!(rgba(&file(0, [5, 3], 0, 166, &blocks[..31], 32)).is_err());
    }
}
