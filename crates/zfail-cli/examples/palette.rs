//! Makes pictures small enough to live in a repository: `palette FILE.png...`.
//!
//! In: 8-bit PNG files. Out: the same files, with 256 colours of their own and compressed as well as PNG can.

use color_quant::NeuQuant;
use std::collections::HashMap;
use std::error::Error;
use std::fs::File;
use std::io::BufWriter;
use std::path::Path;

type Rgb = [u8; 3];

/// Colours in a palette.
const COLORS: usize = 256;

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
    let mut counts = HashMap::<Rgb, u32>::new();
    for pixel in picture.pixels() {
        *counts.entry([pixel[0], pixel[1], pixel[2]]).or_default() += 1;
    }
    let mut palette = flat(&counts);
    let mixed = NeuQuant::new(SAMPLING, COLORS - palette.len(), picture.as_raw()).color_map_rgb();
    palette.extend(mixed.as_chunks::<3>().0);

    let nearest = |color: &Rgb| (0..palette.len()).min_by_key(|&i| distance(palette[i], *color)).unwrap_or(0) as u8;
    let index: HashMap<Rgb, u8> = counts.keys().map(|color| (*color, nearest(color))).collect();
    let pixels: Vec<u8> = picture.pixels().map(|pixel| index[&[pixel[0], pixel[1], pixel[2]]]).collect();

    let mut encoder = png::Encoder::new(BufWriter::new(File::create(path)?), picture.width(), picture.height());
    encoder.set_color(png::ColorType::Indexed);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_palette(palette.concat());
    encoder.set_compression(png::Compression::High);
    // Neighbouring numbers of a palette have nothing in common.
    encoder.set_filter(png::Filter::NoFilter);
    encoder.write_header()?.write_image_data(&pixels)?;
    Ok(())
}

/// Colours of flat areas, such as a legend's. They keep their exact values: an area may be small, and its colour have a meaning.
fn flat(counts: &HashMap<Rgb, u32>) -> Vec<Rgb> {
    /// Pixels of one colour that make an area.
    const AREA: u32 = 24;
    /// Squared distance within which one colour stands for others.
    const ALIKE: u32 = 24 * 24;
    let mut frequent: Vec<(u32, Rgb)> = counts.iter().map(|(&color, &n)| (n, color)).filter(|c| c.0 >= AREA).collect();
    frequent.sort_unstable_by(|a, b| b.cmp(a));
    let mut kept: Vec<Rgb> = Vec::new();
    for (_, color) in frequent {
        if kept.len() < COLORS / 4 && kept.iter().all(|&other| distance(other, color) > ALIKE) {
            kept.push(color);
        }
    }
    kept
}

fn distance(a: Rgb, b: Rgb) -> u32 {
    a.iter().zip(b).map(|(&x, y)| u32::from(x.abs_diff(y)).pow(2)).sum()
}
