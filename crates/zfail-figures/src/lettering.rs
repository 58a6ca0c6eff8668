//! Letters and flat shapes on small images, for legends, labels and contact sheets.
//!
//! In: text, sizes in pixels, colours in sRGB. Out: an RGBA image with premultiplied alpha. The font is Ubuntu Light,
//! which comes with egui.

use crate::palette::Color;
use ab_glyph::{Font, FontRef, Glyph, PxScale, ScaleFont, point};
use std::sync::OnceLock;

/// An image to letter on.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Sheet {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Rows from top to bottom, premultiplied alpha.
    pub rgba: Vec<u8>,
}

impl Sheet {
    /// A sheet of one colour.
    #[must_use]
    pub fn new(size: [u32; 2], color: Color) -> Self {
        let pixels = size[0] as usize * size[1] as usize;
        Self { size, rgba: premultiplied(color, 1.0).repeat(pixels) }
    }

    /// Fills the rectangle `[x, y, width, height]`, as far as it lies on the sheet.
    pub fn fill(&mut self, [x, y, width, height]: [i32; 4], color: Color) {
        for row in y.max(0)..y.saturating_add(height).min(self.size[1] as i32) {
            for column in x.max(0)..x.saturating_add(width).min(self.size[0] as i32) {
                self.lay(column, row, color, 1.0);
            }
        }
    }

    /// Fills a disc with smooth edges; centre and radius in pixels.
    pub fn disc(&mut self, center: [f32; 2], radius: f32, color: Color) {
        let [from, to] = [-1.0, 1.0].map(|side| center.map(|c| (c + side * (radius + 1.0)).floor() as i32));
        for row in from[1]..=to[1] {
            for column in from[0]..=to[0] {
                let away = (column as f32 + 0.5 - center[0]).hypot(row as f32 + 0.5 - center[1]);
                self.lay(column, row, color, (radius + 0.5 - away).clamp(0.0, 1.0));
            }
        }
    }

    /// Writes one line of text, its left end and the top of its line at `at`, `height` pixels from line to line.
    pub fn write(&mut self, at: [f32; 2], height: f32, color: Color, text: &str) {
        set(text, height, |font, glyph, x| {
            let glyph = Glyph { position: point(at[0] + x, at[1] + glyph.position.y), ..glyph };
            let Some(outline) = font.outline_glyph(glyph) else { return };
            let corner = outline.px_bounds().min;
            let (left, top) = (corner.x as i32, corner.y as i32);
            outline.draw(|x, y, coverage| self.lay(left + x as i32, top + y as i32, color, coverage));
        });
    }

    /// Lays `color` over a pixel, or nothing outside of the sheet.
    fn lay(&mut self, x: i32, y: i32, color: Color, coverage: f32) {
        if x < 0 || y < 0 || x >= self.size[0] as i32 || y >= self.size[1] as i32 {
            return;
        }
        let i = 4 * (y as usize * self.size[0] as usize + x as usize);
        let above = premultiplied(color, coverage);
        let left = 255 - u32::from(above[3]);
        for (channel, above) in self.rgba[i..i + 4].iter_mut().zip(above) {
            *channel = above.saturating_add(((u32::from(*channel) * left + 127) / 255) as u8);
        }
    }
}

/// The width in pixels of one line of text with `height` pixels from line to line.
#[must_use]
pub fn width(text: &str, height: f32) -> f32 {
    set(text, height, |_, _, _| ())
}

/// Sets a line from left to right; returns its width.
fn set(text: &str, height: f32, mut place: impl FnMut(&FontRef<'_>, Glyph, f32)) -> f32 {
    let Some(font) = font() else { return 0.0 };
    // A finite size, whatever is asked for.
    let scaled = font.as_scaled(PxScale::from(height.clamp(1.0, 1000.0)));
    let (mut x, mut last) = (0.0, None);
    for c in text.chars() {
        let mut glyph = scaled.scaled_glyph(c);
        x += last.map_or(0.0, |last| scaled.kern(last, glyph.id));
        last = Some(glyph.id);
        let advance = scaled.h_advance(glyph.id);
        glyph.position.y = scaled.ascent();
        place(font, glyph, x);
        x += advance;
    }
    x
}

fn font() -> Option<&'static FontRef<'static>> {
    static FONT: OnceLock<Option<FontRef<'static>>> = OnceLock::new();
    FONT.get_or_init(|| FontRef::try_from_slice(epaint_default_fonts::UBUNTU_LIGHT).ok()).as_ref()
}

fn premultiplied([r, g, b, a]: Color, coverage: f32) -> Color {
    let a = f32::from(a) * coverage.clamp(0.0, 1.0);
    let scale = |c: u8| (f32::from(c) * a / 255.0).round() as u8;
    [scale(r), scale(g), scale(b), a.round() as u8]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ink(sheet: &Sheet) -> f32 {
        sheet.rgba.chunks_exact(4).map(|p| f32::from(p[3]) / 255.0).sum()
    }

    #[test]
    fn text_has_the_width_that_is_promised() {
        assert!(font().is_some());
        let (text, height) = ("dark cap, 17 and more", 24.0);
        let wide = width(text, height);
        let mut sheet = Sheet::new([400, 40], [0; 4]);
        sheet.write([10.0, 4.0], height, [255; 4], text);
        let columns: Vec<u32> =
            (0..400).filter(|x| (0..40).any(|y| sheet.rgba[4 * (y * 400 + *x as usize) + 3] > 0)).collect();
        let (first, last) = (columns[0] as f32, columns[columns.len() - 1] as f32);
        assert!((first - 10.0).abs() < 3.0 && (last - 10.0 - wide).abs() < 3.0, "{first} {last} {wide}");
        assert!(width("dark cap", height) < 0.6 * wide);
        assert_eq!(width("", height), 0.0);
    }

    #[test]
    fn shapes_cover_their_area_and_stay_on_the_sheet() {
        let mut sheet = Sheet::new([40, 40], [0; 4]);
        sheet.disc([20.0, 20.0], 10.0, [255; 4]);
        assert!((ink(&sheet) - 314.0).abs() < 6.0, "{}", ink(&sheet));
        sheet.disc([0.0, 0.0], 1e4, [0, 0, 0, 255]);
        assert_eq!(ink(&sheet), 1600.0);
        let mut sheet = Sheet::new([4, 4], [0; 4]);
        sheet.fill([2, -5, 100, 7], [200, 100, 0, 128]);
        assert_eq!(sheet.rgba[8..12], [100, 50, 0, 128]);
        assert!((ink(&sheet) - 4.0 * 128.0 / 255.0).abs() < 1e-5);
        sheet.write([f32::NAN, -9.0], f32::INFINITY, [255; 4], "far \u{10ffff}");
    }
}
