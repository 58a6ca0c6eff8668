//! Axis-aligned bounds in f64.

use glam::{DAffine3, DVec3};

/// An axis-aligned box; `min > max` when empty.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// Least corner.
    pub min: DVec3,
    /// Greatest corner.
    pub max: DVec3,
}

impl Bounds {
    /// Contains nothing.
    pub const EMPTY: Self = Self { min: DVec3::INFINITY, max: DVec3::NEG_INFINITY };

    /// The smallest box around `points`.
    pub fn of(points: impl IntoIterator<Item = DVec3>) -> Self {
        let mut bounds = Self::EMPTY;
        for p in points {
            bounds.add(p);
        }
        bounds
    }

    /// Grows to contain `point`.
    pub fn add(&mut self, point: DVec3) {
        self.min = self.min.min(point);
        self.max = self.max.max(point);
    }

    /// Whether no point is inside.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        !self.min.cmple(self.max).all()
    }

    /// Centre; meaningless when empty.
    #[must_use]
    pub fn center(&self) -> DVec3 {
        (self.min + self.max) * 0.5
    }

    /// Half the edge lengths; meaningless when empty.
    #[must_use]
    pub fn half(&self) -> DVec3 {
        (self.max - self.min) * 0.5
    }

    /// The eight corners.
    #[must_use]
    pub fn corners(&self) -> [DVec3; 8] {
        std::array::from_fn(|i| {
            let pick = |bit: usize, lo: f64, hi: f64| if i >> bit & 1 == 0 { lo } else { hi };
            DVec3::new(
                pick(0, self.min.x, self.max.x),
                pick(1, self.min.y, self.max.y),
                pick(2, self.min.z, self.max.z),
            )
        })
    }

    /// Bounds of the box after `transform`.
    #[must_use]
    pub fn transformed(&self, transform: &DAffine3) -> Self {
        if self.is_empty() {
            return Self::EMPTY;
        }
        Self::of(self.corners().map(|c| transform.transform_point3(c)))
    }

    /// Squared distance from `point` to the box, 0 inside.
    #[must_use]
    pub fn distance_squared(&self, point: DVec3) -> f64 {
        point.clamp(self.min, self.max).distance_squared(point)
    }
}
