//! What a scene stands in: a sky that lights it from all sides, and a ground that catches its shadows.

use crate::{Mesh, Primitive};
use glam::{DAffine3, DVec3};
use zfail_plan::bounds::Bounds;
use zfail_plan::view::{Projection, View};

/// A sky without features, lit from nowhere in particular: its radiance depends on the height of a direction alone.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Sky {
    /// Radiance straight above (+y), linear RGB.
    pub zenith: [f32; 3],
    /// Radiance of horizontal directions, linear RGB.
    pub horizon: [f32; 3],
    /// Radiance straight below, as a ground reflects it, linear RGB.
    pub nadir: [f32; 3],
}

impl Sky {
    /// The same sky, so many times as bright.
    #[must_use]
    pub fn scaled(&self, factor: f32) -> Self {
        let [zenith, horizon, nadir] = [self.zenith, self.horizon, self.nadir].map(|color| color.map(|c| c * factor));
        Self { zenith, horizon, nadir }
    }
}

/// A horizontal disc that shows the shadows that fall on it from above, fading out towards its rim, and is otherwise not
/// there: it casts none, and no mask, count or measured output knows of it. One that is to be a surface like all others
/// belongs to the scene's instances.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ground {
    /// World-space y, in metres.
    pub height: f64,
    /// World-space x and z of its middle, in metres.
    pub center: [f64; 2],
    /// Where it has faded out entirely, in metres from the middle.
    pub radius: f64,
}

impl Ground {
    /// Triangles about the middle.
    const SECTORS: u32 = 64;

    /// A disc of radius 1 about the origin that faces up (+y), of one primitive without a material.
    #[must_use]
    pub fn disc() -> Mesh {
        let angle = |i: u32| std::f64::consts::TAU * f64::from(i) / f64::from(Self::SECTORS);
        let rim = (0..Self::SECTORS).map(|i| [angle(i).cos() as f32, 0.0, angle(i).sin() as f32]);
        let positions: Vec<[f32; 3]> = std::iter::once([0.0; 3]).chain(rim).collect();
        Mesh {
            name: "ground".into(),
            normals: vec![[0.0, 1.0, 0.0]; positions.len()],
            tangents: vec![[0.0; 4]; positions.len()],
            uv0: vec![[0.0; 2]; positions.len()],
            uv1: vec![[0.0; 2]; positions.len()],
            colors: vec![[1.0; 4]; positions.len()],
            positions,
            triangles: (0..Self::SECTORS).map(|i| [0, 1 + (i + 1) % Self::SECTORS, 1 + i]).collect(),
            primitives: vec![Primitive { triangles: 0..Self::SECTORS, material: None }],
            ..Mesh::default()
        }
    }

    /// World space, its middle.
    #[must_use]
    pub fn middle(&self) -> DVec3 {
        DVec3::new(self.center[0], self.height, self.center[1])
    }

    /// Places [`Self::disc`].
    #[must_use]
    pub fn world_from_disc(&self) -> DAffine3 {
        DAffine3::from_translation(self.middle()) * DAffine3::from_scale(DVec3::splat(self.radius))
    }

    /// Whether `view` looks on it from above: from below it is not there.
    #[must_use]
    pub fn faces(&self, view: &View) -> bool {
        match view.projection {
            Projection::Perspective { .. } => view.eye().y > self.height,
            Projection::Orthographic { .. } => view.world_from_view.matrix3.z_axis.y > 0.0,
        }
    }

    /// World space; flat.
    #[must_use]
    pub fn bounds(&self) -> Bounds {
        let half = DVec3::new(self.radius, 0.0, self.radius);
        Bounds { min: self.middle() - half, max: self.middle() + half }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::world_triangle;

    #[test]
    fn the_disc_faces_up_and_fills_its_bounds() {
        let ground = Ground { height: -3.0, center: [1.0, 2.0], radius: 4.0 };
        let disc = Ground::disc();
        for t in 0..disc.triangles.len() {
            let [a, b, c] = world_triangle(&disc, &ground.world_from_disc(), t);
            assert!((b - a).cross(c - a).normalize().abs_diff_eq(DVec3::Y, 1e-12), "triangle {t}");
        }
        let placed = Bounds::of(
            disc.positions.iter().map(|p| ground.world_from_disc().transform_point3(DVec3::from(p.map(f64::from)))),
        );
        assert!(placed.min.abs_diff_eq(ground.bounds().min, 1e-6) && placed.max.abs_diff_eq(ground.bounds().max, 1e-6));
    }
}
