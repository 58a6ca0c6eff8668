//! The contact sheet: every picture with its title, wrong pixels and time, in one PNG.

use super::pictures::Pictures;
use super::record::Record;
use crate::error::Error;
use crate::output::encode;
use zfail_figures::lettering::{self, Sheet};

const PAPER: [u8; 4] = [22, 24, 28, 255];
const INK: [u8; 4] = [232, 233, 235, 255];
const QUIET: [u8; 4] = [160, 164, 170, 255];
const WRONG: [u8; 4] = [255, 157, 102, 255];

/// Pictures in a row.
const COLUMNS: usize = 4;
/// Width in pixels to which smaller pictures are enlarged, so that there is room for letters.
const LEAST: u32 = 240;
/// Width in pixels beyond which pictures are reduced.
const GREATEST: u32 = 640;

/// A picture with what is written under it.
struct Tile<'a> {
    rgb: &'a [u8],
    title: &'a str,
    remark: String,
    wrong: bool,
}

/// The sheet as a file.
///
/// # Errors
/// If the encoder refuses.
pub fn png(record: &Record, pictures: &Pictures) -> Result<Vec<u8>, Error> {
    let mut tiles =
        vec![Tile { rgb: &pictures.truth, title: "The truth, ray-cast", remark: record.scene.clone(), wrong: false }];
    for drawn in &pictures.methods {
        let row = record.methods.iter().find(|row| row.method == drawn.method.name());
        let Some(result) = row.and_then(|row| row.result.as_ref()) else { continue };
        tiles.push(Tile {
            rgb: &drawn.picture,
            title: drawn.method.title(),
            remark: format!("{} wrong pixels, {:.1} ms", result.wrong_pixels, result.milliseconds()),
            wrong: result.wrong_pixels > 0,
        });
    }
    let sheet = lay_out(pictures.size, &tiles);
    encode::png_picture(sheet.size, &encode::rgb8(&sheet.rgba), None)
}

fn lay_out(size: [u32; 2], tiles: &[Tile<'_>]) -> Sheet {
    let (up, down) = (LEAST.div_ceil(size[0]).max(1), size[0].div_ceil(GREATEST).max(1));
    let tile = size.map(|side| (side * up / down).max(1));
    let line = (tile[0] as f32 / 20.0).clamp(14.0, 26.0);
    let gap = line as u32;
    let pitch = [tile[0] + gap, tile[1] + (2.6 * line) as u32 + gap];
    let columns = tiles.len().clamp(1, COLUMNS) as u32;
    let rows = tiles.len().div_ceil(COLUMNS).max(1) as u32;
    let mut sheet = Sheet::new([gap + columns * pitch[0], gap + rows * pitch[1]], PAPER);
    for (i, content) in (0_u32..).zip(tiles) {
        let corner = [gap + i % columns * pitch[0], gap + i / columns * pitch[1]];
        paste(&mut sheet, corner, tile, content.rgb, size, [up, down]);
        let below = (corner[1] + tile[1]) as f32 + 0.2 * line;
        let left = corner[0] as f32;
        sheet.write([left, below], fitting(content.title, line, tile[0]), INK, content.title);
        let color = if content.wrong { WRONG } else { QUIET };
        sheet.write([left, below + 1.2 * line], fitting(&content.remark, line, tile[0]), color, &content.remark);
    }
    sheet
}

/// The height of letters at which `text` is not wider than `room`.
fn fitting(text: &str, line: f32, room: u32) -> f32 {
    let width = lettering::width(text, line);
    if width > room as f32 { line * room as f32 / width } else { line }
}

/// Copies the picture `rgb` of `from` pixels to `corner`, enlarged `up` times and reduced `down` times; pixels that become
/// one are averaged.
fn paste(sheet: &mut Sheet, corner: [u32; 2], tile: [u32; 2], rgb: &[u8], from: [u32; 2], [up, down]: [u32; 2]) {
    for y in 0..tile[1] {
        for x in 0..tile[0] {
            let [left, top] = [x, y].map(|side| side * down / up);
            let (mut sum, mut count) = ([0_u32; 3], 0);
            for v in top..(top + down).min(from[1]) {
                for u in left..(left + down).min(from[0]) {
                    let at = 3 * (v as usize * from[0] as usize + u as usize);
                    if let Some(pixel) = rgb.get(at..at + 3) {
                        sum.iter_mut().zip(pixel).for_each(|(sum, &c)| *sum += u32::from(c));
                        count += 1;
                    }
                }
            }
            let at = 4 * ((corner[1] + y) as usize * sheet.size[0] as usize + (corner[0] + x) as usize);
            if let Some(slot) = sheet.rgba.get_mut(at..at + 3) {
                slot.iter_mut().zip(sum).for_each(|(slot, sum)| *slot = (sum / count.max(1)) as u8);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pixel(sheet: &Sheet, x: u32, y: u32) -> [u8; 3] {
        let at = 4 * (y as usize * sheet.size[0] as usize + x as usize);
        [sheet.rgba[at], sheet.rgba[at + 1], sheet.rgba[at + 2]]
    }

    #[test]
    fn small_pictures_are_enlarged_and_large_ones_averaged() {
        // Left half red, right half blue; every second row black.
        let picture = |[width, height]: [u32; 2]| -> Vec<u8> {
            let color = |x: u32, y: u32| match (y % 2, 2 * x < width) {
                (1, _) => [0; 3],
                (_, true) => [200, 0, 0],
                (_, false) => [0, 0, 200],
            };
            (0..height).flat_map(|y| (0..width).flat_map(move |x| color(x, y))).collect()
        };
        for (size, left, right) in [([4, 2], [200, 0, 0], [0, 0, 200]), ([1280, 720], [100, 0, 0], [0, 0, 100])] {
            let rgb = picture(size);
            let tile = || Tile { rgb: &rgb, title: "a title", remark: "a remark".to_owned(), wrong: true };
            let sheet = lay_out(size, &[tile(), tile(), tile(), tile(), tile()]);
            let second_row = (sheet.size[1] - sheet.size[1] / 2) + 20;
            assert!((LEAST * 4..(GREATEST + 60) * 4).contains(&sheet.size[0]), "{:?}", sheet.size);
            assert_eq!(pixel(&sheet, 30, 30), left);
            assert_eq!(pixel(&sheet, sheet.size[0] - 40, 30), right);
            assert_eq!(pixel(&sheet, 30, second_row + 10), left, "{:?}", sheet.size);
            assert_eq!(pixel(&sheet, sheet.size[0] - 40, second_row), PAPER[..3], "the sixth place is empty");
            // Orange, if thin letters leave it faint.
            let letters = sheet.rgba.chunks_exact(4).filter(|p| p[1] > 60 && p[0] > p[2].saturating_add(40)).count();
            assert!(letters > 20, "{letters}");
        }
    }

    #[test]
    fn long_titles_are_made_to_fit() {
        let text = "a title that is far longer than a small picture is wide";
        assert!(lettering::width(text, fitting(text, 20.0, 240)) <= 241.0);
        assert_eq!(fitting("short", 20.0, 240), 20.0);
    }
}
