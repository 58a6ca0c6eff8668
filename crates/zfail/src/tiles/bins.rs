//! Which tiles each quad can touch.
//!
//! In: footprints, convex polygons in pixels. Out: for every tile the quads whose footprints hold one of its pixel centres.
//! Tiles with lists of like length are gathered into groups, whose lists are interleaved, so that the invocations of a
//! workgroup read side by side and end together.

use glam::DVec2;
use std::cmp::Reverse;
use zfail_plan::scissor::Rectangle;

/// Pixels along a tile's edge.
pub(super) const TILE: u32 = 8;
/// Tiles in a group.
pub(super) const LANES: usize = 8;
/// The place of a missing tile in a group that is not full.
pub(super) const NO_TILE: u32 = !0;

/// How far, in pixels, a footprint may miss a pixel centre and still be listed: far above the rounding of the f32 functions
/// that decide.
const MARGIN: f64 = 1.0 / 64.0;
const NOWHERE: [f64; 2] = [f64::INFINITY, f64::NEG_INFINITY];

/// A run of tiles in one row.
#[derive(Clone, Copy, Debug)]
struct Span {
    first: u32,
    end: u32,
    quad: u32,
}

/// Tiles with lists of like length.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Group {
    /// Where its lists begin among the entries.
    pub first: u32,
    /// Entries in each of them, those of the longest.
    pub length: u32,
}

/// Tiles of one light and their lists. Memory is kept between frames.
#[derive(Debug, Default)]
pub(super) struct Bins {
    /// Tiles across and down.
    tiles: [u32; 2],
    /// Pixels across and down.
    size: [f64; 2],
    spans: Vec<Span>,
    /// From where to where the current footprint reaches in each row of tiles.
    reach: Vec<[f64; 2]>,
    /// Length of each tile's list, then the place of its next entry.
    lists: Vec<u32>,
    occupied: Vec<u32>,
}

impl Bins {
    /// Empties all lists and sets the image's size in pixels.
    pub fn clear(&mut self, size: [u32; 2]) {
        self.tiles = size.map(|n| n.div_ceil(TILE));
        self.size = size.map(f64::from);
        self.spans.clear();
        self.reach.clear();
        self.reach.resize(self.tiles[1] as usize, NOWHERE);
    }

    /// Lists `quad` in every tile that `scissor` touches and that has a pixel centre within the convex `footprint`
    /// (pixels, y down).
    pub fn add(&mut self, quad: u32, footprint: &[DVec2], scissor: Rectangle) {
        let [x, y, width, height] = scissor;
        let Some(last) = footprint.last() else { return };
        let (top, bottom) =
            footprint.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(lo, hi), p| (lo.min(p.y), hi.max(p.y)));
        let Some(rows) = centres(top, bottom, self.size[1]).and_then(|rows| tiles(rows, y, height)) else { return };
        let mut previous = *last;
        for &p in footprint {
            self.walk(previous, p, rows);
            previous = p;
        }
        for row in rows[0]..=rows[1] {
            let [lo, hi] = std::mem::replace(&mut self.reach[row as usize], NOWHERE);
            if let Some([first, last]) = centres(lo, hi, self.size[0]).and_then(|columns| tiles(columns, x, width)) {
                let start = row * self.tiles[0];
                self.spans.push(Span { first: start + first, end: start + last + 1, quad });
            }
        }
    }

    /// Extends the reach in each of `rows` by the part of the edge `p q` between the row's outermost pixel centres.
    fn walk(&mut self, p: DVec2, q: DVec2, rows: [u32; 2]) {
        let (p, q) = if p.y <= q.y { (p, q) } else { (q, p) };
        let tile = f64::from(TILE);
        let row = |y: f64| ((y / tile).max(0.0) as u32).clamp(rows[0], rows[1]);
        let slope = if q.y > p.y { (q.x - p.x) / (q.y - p.y) } else { 0.0 };
        for row in row(p.y - 1.0)..=row(q.y + 1.0) {
            let top = f64::from(row) * tile + 0.5 - MARGIN;
            let bottom = top + tile - 1.0 + 2.0 * MARGIN;
            if q.y < top || p.y > bottom {
                continue;
            }
            let from = if p.y < top { p.x + slope * (top - p.y) } else { p.x };
            let to = if q.y > bottom { p.x + slope * (bottom - p.y) } else { q.x };
            let (from, to) = if from < to { (from, to) } else { (to, from) };
            let [lo, hi] = &mut self.reach[row as usize];
            // Unlike `min` and `max` without regard to NaN, one instruction each.
            *lo = if from < *lo { from } else { *lo };
            *hi = if to > *hi { to } else { *hi };
        }
    }

    /// How many pairs of quad and tile there are.
    pub fn pairs(&self) -> usize {
        self.spans.iter().map(|span| (span.end - span.first) as usize).sum()
    }

    /// Appends the lists to `entries`, each group's to `groups`, and its [`LANES`] tiles to `places`: x in the lower 16
    /// bits, y in the upper, or [`NO_TILE`].
    pub fn append(&mut self, entries: &mut Vec<u32>, groups: &mut Vec<Group>, places: &mut Vec<u32>) {
        self.lists.clear();
        self.lists.resize((self.tiles[0] * self.tiles[1]) as usize, 0);
        for span in &self.spans {
            for length in &mut self.lists[span.first as usize..span.end as usize] {
                *length += 1;
            }
        }
        self.occupied.clear();
        self.occupied.extend((0..self.lists.len() as u32).filter(|&tile| self.lists[tile as usize] > 0));
        self.occupied.sort_unstable_by_key(|&tile| (Reverse(self.lists[tile as usize]), tile));

        let mut end = entries.len();
        for tiles in self.occupied.chunks(LANES) {
            let length = self.lists[tiles[0] as usize];
            groups.push(Group { first: end as u32, length });
            for (lane, &tile) in tiles.iter().enumerate() {
                self.lists[tile as usize] = (end + lane) as u32;
                places.push(((tile / self.tiles[0]) << 16) | (tile % self.tiles[0]));
            }
            places.resize(places.len().next_multiple_of(LANES), NO_TILE);
            end += length as usize * LANES;
        }
        // Shorter lists end with entries of the null quad.
        entries.resize(end, 0);
        for span in &self.spans {
            for next in &mut self.lists[span.first as usize..span.end as usize] {
                entries[*next as usize] = span.quad;
                *next += LANES as u32;
            }
        }
    }
}

/// First and last of `n` pixels whose centres lie in `lo..=hi`, give or take the margin.
fn centres(lo: f64, hi: f64, n: f64) -> Option<[u32; 2]> {
    let first = (lo - 0.5 - MARGIN).max(0.0);
    let last = (hi - 0.5 + MARGIN).min(n - 1.0);
    if last < first {
        return None;
    }
    // Rounding up by hand: this runs for every row of every quad, and `ceil` is a call on old instruction sets.
    let below = first as u32;
    let range = [below + u32::from(f64::from(below) < first), last as u32];
    (range[0] <= range[1]).then_some(range)
}

/// First and last of the tiles that hold `pixels` and some of the `length` pixels from `start` on.
fn tiles(pixels: [u32; 2], start: u32, length: u32) -> Option<[u32; 2]> {
    let last = start.saturating_add(length).checked_sub(1)? / TILE;
    let range = [(pixels[0] / TILE).max(start / TILE), (pixels[1] / TILE).min(last)];
    (length > 0 && range[0] <= range[1]).then_some(range)
}

#[cfg(test)]
mod tests;
