//! Makes pictures small enough to live in a repository: `palette FILE.png...`.
//!
//! In: 8-bit PNG files. Out: the same files, with 256 colours of their own and compressed as well as PNG can.

use color_quant::NeuQuant;
use std::error::Error;
use std::fs::File;
use std::io::BufWriter;
use std::path::Path;

fn main() -> Result<(), Box<dyn Error>> {
    for path in std::env::args_os().skip(1) {
        shrink(Path::new(&path)).map_err(|e| format!("{}: {e}", path.display()))?;
    }
    Ok(())
}

fn shrink(path: &Path) -> Result<(), Box<dyn Error>> {
    /// Every so many pixels are looked at to choose the colours.
    const SAMPLING: i32 = 3;
    let picture = image::open(path)?.into_rgba8();
    let colors = NeuQuant::new(SAMPLING, 256, picture.as_raw());
    let pixels: Vec<u8> = picture.pixels().map(|pixel| colors.index_of(&pixel.0) as u8).collect();

    let mut encoder = png::Encoder::new(BufWriter::new(File::create(path)?), picture.width(), picture.height());
    encoder.set_color(png::ColorType::Indexed);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_palette(colors.color_map_rgb());
    encoder.set_compression(png::Compression::High);
    // Neighbouring numbers of a palette have nothing in common.
    encoder.set_filter(png::Filter::NoFilter);
    encoder.write_header()?.write_image_data(&pixels)?;
    Ok(())
}
