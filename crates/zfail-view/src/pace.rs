//! How large pictures are drawn while something moves, so that slow devices stay usable.
//!
//! In: how long pictures took. Out: the size of the next one. What stands still is drawn at full size.

use std::time::Duration;

/// Time that a picture in motion may take before pictures become smaller.
const SLOW: Duration = Duration::from_millis(50);
/// What a smaller picture is to take.
const AIM: Duration = Duration::from_millis(40);
/// The least share of width and height.
const LEAST: f64 = 0.25;

/// Remembers how long pictures took.
#[derive(Clone, Copy, Debug)]
pub struct Pace {
    /// Whether pictures become smaller at all.
    pub enabled: bool,
    /// Seconds per pixel of late; 0 while unknown.
    per_pixel: f64,
}

impl Default for Pace {
    fn default() -> Self {
        Self { enabled: true, per_pixel: 0.0 }
    }
}

impl Pace {
    /// The size to draw at, for a picture shown at `full`.
    #[must_use]
    pub fn size(&self, full: [u32; 2], moving: bool) -> [u32; 2] {
        let expected = self.per_pixel * pixels(full);
        if !moving || !self.enabled || expected <= SLOW.as_secs_f64() {
            return full;
        }
        let share = (AIM.as_secs_f64() / expected).sqrt().clamp(LEAST, 1.0);
        // In steps of an eighth, for every size has targets of its own.
        let share = (8.0 * share).floor().max(8.0 * LEAST) / 8.0;
        full.map(|side| ((f64::from(side) * share).round() as u32).max(1))
    }

    /// A picture of `size` took so long.
    pub fn took(&mut self, size: [u32; 2], time: Duration) {
        let now = time.as_secs_f64() / pixels(size);
        // Single slow pictures, such as the first one, are forgotten soon.
        self.per_pixel = if self.per_pixel == 0.0 { now } else { 0.5 * (self.per_pixel + now) };
    }
}

fn pixels(size: [u32; 2]) -> f64 {
    (f64::from(size[0]) * f64::from(size[1])).max(1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    const FULL: [u32; 2] = [1280, 720];

    #[test]
    fn only_slow_pictures_in_motion_are_smaller() {
        let mut pace = Pace::default();
        assert_eq!(pace.size(FULL, true), FULL, "nothing is known yet");
        pace.took(FULL, Duration::from_millis(20));
        assert_eq!(pace.size(FULL, true), FULL);
        (0..8).for_each(|_| pace.took(FULL, Duration::from_millis(160)));
        assert_eq!(pace.size(FULL, false), FULL);
        assert_eq!(pace.size(FULL, true), [640, 360]);
        pace.enabled = false;
        assert_eq!(pace.size(FULL, true), FULL);
    }

    #[test]
    fn sizes_settle_and_have_a_least() {
        let mut pace = Pace::default();
        for _ in 0..40 {
            let size = pace.size(FULL, true);
            pace.took(size, Duration::from_secs_f64(pixels(size) * 0.15 / pixels(FULL)));
        }
        let settled = pace.size(FULL, true);
        assert!(settled[0] < FULL[0] && settled[0] > 500, "{settled:?}");
        (0..20).for_each(|_| pace.took(FULL, Duration::from_secs(60)));
        assert_eq!(pace.size(FULL, true), [320, 180]);
        assert_eq!(pace.size([1, 1], true), [1, 1]);
    }
}
