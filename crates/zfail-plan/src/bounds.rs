//! Boxes in f64: along the axes, and with axes of their own.

use glam::{DAffine3, DVec3, DVec4};

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

/// A box with axes of its own.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OrientedBox {
    /// Its middle.
    pub center: DVec3,
    /// From the middle to three of its faces; at right angles, none of them zero.
    pub half_axes: [DVec3; 3],
}

impl OrientedBox {
    /// The corners, ordered as [`Bounds::corners`] orders them.
    #[must_use]
    pub fn corners(&self) -> [DVec3; 8] {
        let [x, y, z] = self.half_axes;
        Bounds { min: DVec3::NEG_ONE, max: DVec3::ONE }.corners().map(|c| self.center + x * c.x + y * c.y + z * c.z)
    }

    /// The planes of its faces: inside, `dot(plane.xyz, p) + plane.w >= 0` for all of them, a distance.
    #[must_use]
    pub fn planes(&self) -> [DVec4; 6] {
        std::array::from_fn(|i| {
            let axis = self.half_axes[i / 2];
            let inward = if i % 2 == 0 { axis } else { -axis }.normalize();
            inward.extend(axis.length() - inward.dot(self.center))
        })
    }

    /// The box around it that is larger by `margin` on every side.
    #[must_use]
    pub fn grown(&self, margin: f64) -> Self {
        let half_axes = self.half_axes.map(|axis| axis * (1.0 + margin / axis.length()));
        Self { half_axes, ..*self }
    }

    /// The same box where `origin` is the origin.
    #[must_use]
    pub fn relative_to(&self, origin: DVec3) -> Self {
        Self { center: self.center - origin, ..*self }
    }

    /// Whether something of `bounds` may be inside: whether no face of either box has the other one before it.
    #[must_use]
    pub fn meets(&self, bounds: &Bounds) -> bool {
        let around = Bounds::of(self.corners());
        let apart = bounds.min.cmpgt(around.max).any() || bounds.max.cmplt(around.min).any();
        let (middle, half) = (bounds.center(), bounds.half());
        let before = |plane: &DVec4| plane.truncate().dot(middle) + plane.w + plane.truncate().abs().dot(half) < 0.0;
        !bounds.is_empty() && !apart && !self.planes().iter().any(before)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_turned_box_holds_what_lies_between_its_planes() {
        let (sin, cos) = 0.6_f64.sin_cos();
        let half_axes = [DVec3::new(cos, sin, 0.0) * 2.0, DVec3::new(-sin, cos, 0.0), DVec3::Z * 0.5];
        let turned = OrientedBox { center: DVec3::new(3.0, -1.0, 2.0), half_axes };
        for corner in turned.corners() {
            let heights = turned.planes().map(|plane| plane.truncate().dot(corner) + plane.w);
            assert_eq!(heights.iter().filter(|height| height.abs() < 1e-12).count(), 3, "{heights:?}");
            assert!(turned.grown(0.1).planes().iter().all(|p| p.truncate().dot(corner) + p.w > 0.0999));
        }
        let at = |x: f64, y: f64| {
            let middle = turned.center + half_axes[0] * x + half_axes[1] * y;
            turned.meets(&Bounds { min: middle - 0.01, max: middle + 0.01 })
        };
        assert!(at(0.0, 0.0) && at(0.99, 0.99) && at(-1.0, 1.0));
        // Within the axis-parallel bounds of it, but not within it.
        assert!(!at(1.05, 0.0) && !at(0.9, -1.1) && !turned.meets(&Bounds::EMPTY));
    }
}
