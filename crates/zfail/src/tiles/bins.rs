//! Which tiles a convex polygon can touch.
//!
//! In: footprints in pixels. Out: for every 8x8 tile the list of footprints that may cover one of its pixel centres.

use glam::DVec2;

/// Pixels along a tile's edge.
pub(super) const TILE: u32 = 8;
/// How far, in pixels, a footprint may miss a pixel centre and still be listed: far more than the f32 edge functions err.
const MARGIN: f64 = 1.0 / 64.0;

/// A run of tiles within one row.
#[derive(Clone, Copy, Debug)]
struct Span {
    first: u32,
    end: u32,
    item: u32,
}

/// Lists of items by tile, in compressed rows.
#[derive(Debug, Default)]
pub(super) struct Bins {
    /// Tiles across and down.
    pub tiles: [u32; 2],
    size: [f64; 2],
    spans: Vec<Span>,
    /// Reach of the polygon in each row of tiles.
    reach: Vec<[f64; 2]>,
    lengths: Vec<u32>,
    order: Vec<u32>,
    next: Vec<u32>,
    pub pairs: u32,
    pub groups: Vec<[u32; 2]>,
    /// Items, tile by tile.
    pub entries: Vec<u32>,
    /// Tiles that have entries.
    pub occupied: Vec<u32>,
}

impl Bins {
    /// Empties the lists for an image of `size` pixels.
    pub fn clear(&mut self, size: [u32; 2]) {
        self.tiles = size.map(|n| n.div_ceil(TILE));
        self.size = size.map(f64::from);
        self.spans.clear();
        self.reach.clear();
        self.reach.resize(self.tiles[1] as usize, EMPTY);
    }

    /// Lists `item` in every tile with a pixel centre inside the convex `polygon` (pixels, y down).
    pub fn add(&mut self, polygon: &[DVec2], item: u32) {
        let (mut top, mut bottom) = (f64::INFINITY, f64::NEG_INFINITY);
        for p in polygon {
            top = top.min(p.y);
            bottom = bottom.max(p.y);
        }
        let Some((first, last)) = centres(top, bottom, self.size[1]) else { return };
        let (first, last) = (first / TILE, last / TILE);
        let rows = first as usize..=last as usize;
        let mut previous = polygon[polygon.len() - 1];
        for &p in polygon {
            self.walk(previous, p, first, last);
            previous = p;
        }
        for row in rows {
            let [lo, hi] = std::mem::replace(&mut self.reach[row], EMPTY);
            if let Some((from, to)) = centres(lo, hi, self.size[0]) {
                let start = row as u32 * self.tiles[0];
                self.spans.push(Span { first: start + from / TILE, end: start + to / TILE + 1, item });
            }
        }
    }

    /// Widens the reach of every row between `first` and `last` by the part of the edge `p q` within it.
    fn walk(&mut self, p: DVec2, q: DVec2, first: u32, last: u32) {
        let (p, q) = if p.y <= q.y { (p, q) } else { (q, p) };
        let tile = f64::from(TILE);
        let row = |y: f64| ((y / tile).max(0.0) as u32).clamp(first, last);
        let (from, to) = (row(p.y - 0.5 - MARGIN), row(q.y + 0.5 + MARGIN));
        let slope = if q.y > p.y { (q.x - p.x) / (q.y - p.y) } else { 0.0 };
        for row in from..=to {
            // The outermost pixel centres of the row.
            let top = f64::from(row) * tile + 0.5 - MARGIN;
            let bottom = top + tile - 1.0 + 2.0 * MARGIN;
            if q.y < top || p.y > bottom {
                continue;
            }
            let x0 = if p.y < top { p.x + slope * (top - p.y) } else { p.x };
            let x1 = if q.y > bottom { p.x + slope * (bottom - p.y) } else { q.x };
            let [lo, hi] = &mut self.reach[row as usize];
            *lo = lo.min(x0.min(x1));
            *hi = hi.max(x0.max(x1));
        }
    }

    /// Lists `item` in every tile.
    pub fn add_everywhere(&mut self, item: u32) {
        self.spans.push(Span { first: 0, end: self.tiles[0] * self.tiles[1], item });
    }

    /// Sorts the items by tile and the tiles by number of items, and interleaves the lists of every eight tiles.
    pub fn finish(&mut self) {
        let tiles = (self.tiles[0] * self.tiles[1]) as usize;
        self.lengths.clear();
        self.lengths.resize(tiles, 0);
        for span in &self.spans {
            for count in &mut self.lengths[span.first as usize..span.end as usize] {
                *count += 1;
            }
        }
        self.order.clear();
        self.order.extend((0..tiles as u32).filter(|&t| self.lengths[t as usize] > 0));
        self.order.sort_unstable_by_key(|&t| (std::cmp::Reverse(self.lengths[t as usize]), t));
        self.groups.clear();
        self.occupied.clear();
        self.next.clear();
        self.next.resize(tiles, 0);
        let mut sum = 0;
        for group in self.order.chunks(8) {
            let length = self.lengths[group[0] as usize];
            self.groups.push([sum, length]);
            for (lane, &tile) in group.iter().enumerate() {
                self.next[tile as usize] = sum + lane as u32;
                self.occupied.push((tile / self.tiles[0]) << 16 | tile % self.tiles[0]);
            }
            sum += length * 8;
        }
        self.occupied.resize(self.groups.len() * 8, 0x0fff_0fff);
        self.entries.clear();
        self.entries.resize((sum as usize).next_multiple_of(2048), 0);
        self.pairs = self.lengths.iter().sum();
        for span in &self.spans {
            for next in &mut self.next[span.first as usize..span.end as usize] {
                self.entries[*next as usize] = span.item;
                *next += 8;
            }
        }
    }
}

const EMPTY: [f64; 2] = [f64::INFINITY, f64::NEG_INFINITY];

/// First and last of `n` pixels whose centres lie in `lo..=hi`, with the margin.
fn centres(lo: f64, hi: f64, n: f64) -> Option<(u32, u32)> {
    let first = (lo - 0.5 - MARGIN).ceil().max(0.0);
    let last = (hi - 0.5 + MARGIN).floor().min(n - 1.0);
    (first <= last).then_some((first as u32, last as u32))
}
impl Bins {
    pub fn debug(&self, tx: u32, ty: u32, item: u32) -> bool {
        let t = ty * self.tiles[0] + tx;
        self.spans.iter().any(|s| s.first <= t && t < s.end && s.item == item)
    }
}
