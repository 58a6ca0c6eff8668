//! The panel that tells which colour is what.
//!
//! In: headings and swatches. Out: a lettered sheet with a place in a corner of the image.

use crate::lettering::{self, Sheet};
use crate::palette::{self, with_opacity};

/// Lines of a legend, from top to bottom.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Legend {
    entries: Vec<(Option<[u8; 3]>, String)>,
}

/// A sheet and where its upper left corner is in the image, pixels.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Sticker {
    pub at: [i32; 2],
    pub sheet: Sheet,
}

impl Legend {
    /// Adds a line without a colour.
    pub fn heading(&mut self, text: impl Into<String>) {
        self.entries.push((None, text.into()));
    }

    /// Adds a colour and what it means.
    pub fn swatch(&mut self, color: [u8; 3], text: impl Into<String>) {
        self.entries.push((Some(color), text.into()));
    }

    /// The panel in the lower left corner of an image of `size`; none for images that it would cover too much of.
    pub fn panel(&self, size: [u32; 2]) -> Option<Sticker> {
        let [width, height] = size.map(|side| side as f32);
        let line = line_height(size);
        let (pad, gap) = (0.5 * line, 0.35 * line);
        let wide = self.entries.iter().map(|(color, text)| indent(*color, line) + lettering::width(text, line));
        let sheet = [wide.fold(0.0, f32::max) + 2.0 * pad, line * self.entries.len() as f32 + 2.0 * pad].map(f32::ceil);
        if self.entries.is_empty() || sheet[0] > 0.6 * width || sheet[1] > 0.75 * height {
            return None;
        }
        let mut panel = Sheet::new(sheet.map(|side| side as u32), palette::PANEL);
        for (row, (color, text)) in self.entries.iter().enumerate() {
            let top = pad + row as f32 * line;
            if let Some(color) = color {
                let side = (0.66 * line).round();
                let square = [pad, top + 0.5 * (line - side), side, side].map(|x| x.round() as i32);
                let [x, y, side, _] = square;
                panel.fill([x - 1, y - 1, side + 2, side + 2], with_opacity(palette::LETTERS, 0.6));
                panel.fill(square, with_opacity(*color, 1.0));
            }
            panel.write([pad + indent(*color, line), top], line, with_opacity(palette::LETTERS, 1.0), text);
        }
        Some(Sticker { at: [gap as i32, (height - gap - sheet[1]) as i32], sheet: panel })
    }
}

/// Pixels from line to line of text on an image of `size`.
pub fn line_height(size: [u32; 2]) -> f32 {
    (size[0].min(size[1]) as f32 / 32.0).clamp(11.0, 44.0).round()
}

fn indent(color: Option<[u8; 3]>, line: f32) -> f32 {
    if color.is_some() { 1.1 * line } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_panel_fits_its_image_and_shows_its_colours() {
        let mut legend = Legend::default();
        legend.heading("stencil count");
        legend.swatch([255, 0, 0], "1");
        let Sticker { at, sheet } = legend.panel([640, 360]).expect("a panel");
        assert!(at[0] > 0 && at[1] as u32 + sheet.size[1] < 360);
        assert!(sheet.rgba.chunks_exact(4).filter(|p| p[..3] == [255, 0, 0]).count() > 40);
        assert_eq!(legend.panel([64, 48]), None, "too small");
        assert_eq!(Legend::default().panel([640, 360]), None);
    }
}
