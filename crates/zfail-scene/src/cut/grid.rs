//! Buckets over the plane of a texture, to find what is near.
//!
//! In: points and segments. Out: those that may meet a triangle, wherever on the repeating plane it lies.

use super::field::Axis;
use glam::DVec2;
use std::ops::RangeInclusive;

/// Texels along a bucket's side, about, and things that should be in it on average; the smaller of the two holds, but no
/// bucket is smaller than a texel.
const BUCKET: f64 = 8.0;
const CROWD: f64 = 8.0;

/// By how much queries look farther than they have to, texels: more than coordinates are rounded by.
const MARGIN: f64 = 1.0 / 1024.0;

/// One direction of the buckets.
#[derive(Clone, Copy, Debug)]
struct Row {
    buckets: i64,
    width: f64,
    period: Option<f64>,
}

impl Row {
    fn new(axis: Axis, width: f64) -> Self {
        let length = length(axis);
        let buckets = (length / width).ceil().max(1.0);
        Self { buckets: buckets as i64, width: length / buckets, period: axis.period() }
    }

    /// The buckets from `low` to `high`, numbered on through all periods. The outermost ones of a plane without period
    /// have no end.
    fn range(&self, low: f64, high: f64) -> RangeInclusive<i64> {
        let bucket = |x: f64| {
            let k = (x / self.width).floor() as i64;
            if self.period.is_some() { k } else { k.clamp(0, self.buckets - 1) }
        };
        bucket(low - MARGIN)..=bucket(high + MARGIN)
    }

    /// From where to where bucket `k` goes.
    fn extent(&self, k: i64) -> [f64; 2] {
        let open = |is: bool, end: f64| if is && self.period.is_none() { end } else { 0.0 };
        [
            k as f64 * self.width + open(k == 0, f64::NEG_INFINITY),
            (k + 1) as f64 * self.width + open(k == self.buckets - 1, f64::INFINITY),
        ]
    }

    /// The bucket that holds what is in bucket `k`, and how far from there that is.
    fn home(&self, k: i64) -> (i64, f64) {
        (k.rem_euclid(self.buckets), k.div_euclid(self.buckets) as f64 * self.period.unwrap_or(0.0))
    }
}

/// A thing's number, and how far the place where it was put lies from the bucket's.
type Entry = (u32, DVec2);

/// Numbers of points or segments by place.
#[derive(Debug)]
pub(super) struct Grid {
    rows: [Row; 2],
    buckets: Vec<Vec<Entry>>,
}

impl Grid {
    /// For about so many `things`.
    pub fn new(axes: [Axis; 2], things: usize) -> Self {
        let crowd = length(axes[0]) * length(axes[1]) * CROWD / things.max(1) as f64;
        let rows = axes.map(|axis| Row::new(axis, crowd.sqrt().clamp(1.0, BUCKET)));
        Self { rows, buckets: vec![Vec::new(); (rows[0].buckets * rows[1].buckets) as usize] }
    }

    /// Puts thing number `thing` into every bucket that `shape` meets.
    pub fn put(&mut self, thing: u32, shape: [DVec2; 3]) {
        let mut places = Vec::new();
        self.cover(shape, |bucket, shift| places.push((bucket, shift)));
        for (bucket, shift) in places {
            self.buckets[bucket].push((thing, shift));
        }
    }

    /// Calls `found` with everything that may meet the triangle `shape`, some of it several times, and with the whole
    /// periods by which the thing has to be moved to lie there.
    pub fn near(&self, shape: [DVec2; 3], mut found: impl FnMut(u32, DVec2)) {
        self.cover(shape, |bucket, shift| {
            for &(thing, from) in &self.buckets[bucket] {
                found(thing, shift - from);
            }
        });
    }

    /// How many buckets [`Self::near`] looks into, at most.
    pub fn effort(&self, shape: [DVec2; 3]) -> f64 {
        let [low, high] = extent(shape);
        (0..2).map(|k| (high[k] - low[k]) / self.rows[k].width + 2.0).product()
    }

    /// Everything in the same row of buckets as `point`, bucket by bucket in the direction of x, once around. `found`
    /// gets where the bucket ends, and its things; it stops the walk by returning true.
    pub fn walk(&self, point: DVec2, mut found: impl FnMut(f64, &mut dyn Iterator<Item = Entry>) -> bool) {
        let [columns, rows] = &self.rows;
        let (row, y) = rows.home(*rows.range(point.y, point.y).start());
        let first = *columns.range(point.x, point.x).start();
        let last = if columns.period.is_some() { first + columns.buckets } else { columns.buckets - 1 };
        for column in first..=last {
            let (home, x) = columns.home(column);
            let bucket = &self.buckets[(row * columns.buckets + home) as usize];
            let mut things = bucket.iter().map(|&(thing, from)| (thing, DVec2::new(x, y) - from));
            if found(columns.extent(column)[1], &mut things) {
                return;
            }
        }
    }

    /// Calls `visit` with every bucket that a triangle may meet, row by row, and with the periods from there.
    fn cover(&self, shape: [DVec2; 3], mut visit: impl FnMut(usize, DVec2)) {
        let [columns, rows] = &self.rows;
        let [low, high] = extent(shape);
        for k in rows.range(low.y, high.y) {
            let [bottom, top] = rows.extent(k);
            let (mut left, mut right) = (f64::INFINITY, f64::NEG_INFINITY);
            for i in 0..3 {
                if let Some(xs) = within(shape[i], shape[(i + 1) % 3], bottom - MARGIN, top + MARGIN) {
                    left = left.min(xs[0]).min(xs[1]);
                    right = right.max(xs[0]).max(xs[1]);
                }
            }
            if left > right {
                continue;
            }
            let (row, y) = rows.home(k);
            for column in columns.range(left, right) {
                let (home, x) = columns.home(column);
                visit((row * columns.buckets + home) as usize, DVec2::new(x, y));
            }
        }
    }
}

/// Texels that have buckets of their own.
fn length(axis: Axis) -> f64 {
    axis.period().unwrap_or(axis.texels())
}

/// Least and greatest coordinates.
fn extent([a, b, c]: [DVec2; 3]) -> [DVec2; 2] {
    [a.min(b).min(c), a.max(b).max(c)]
}

/// Where the segment from `a` to `b` enters and leaves the strip between two heights.
fn within(a: DVec2, b: DVec2, bottom: f64, top: f64) -> Option<[f64; 2]> {
    if a.y.min(b.y) > top || a.y.max(b.y) < bottom {
        return None;
    }
    let x_at = |y: f64| {
        let along = if a.y == b.y { 0.0 } else { ((y - a.y) / (b.y - a.y)).clamp(0.0, 1.0) };
        a.x + (b.x - a.x) * along
    };
    if a.y == b.y { Some([a.x, b.x]) } else { Some([x_at(bottom), x_at(top)]) }
}
