//! A ground below what has none.

use super::posed::{Posed, spread};
use super::sight::{Blocks, Lens, Sight};
use crate::{Ground, Instance, Material, Scene};
use glam::DVec3;
use zfail_plan::bounds::Bounds;
use zfail_plan::topology::Blocking;

/// Whether there is a ground.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum GroundChoice {
    /// One that only catches shadows, at the lowest point of a scene without lights, unless the scene has a floor there.
    #[default]
    Auto,
    /// None.
    None,
    /// A surface of the scene like any other, but that casts no shadow, at this height, metres.
    Height(f64),
}

/// The share of the rectangle around a scene that a floor covers.
const FLOOR: f64 = 0.4;

/// Whether the lowest of the scene is a floor below all the rest: level, seen from above, and nearly as wide.
pub(super) fn has_floor(posed: Posed<'_>, bounds: &Bounds) -> bool {
    /// Points on a triangle.
    const POINTS: usize = 16;
    let half = bounds.half();
    let wide = half.x.max(half.z);
    let low = bounds.min.y + 0.01 * wide.min(half.y.max(0.1 * wide));
    // Bottoms of things are as low; but those are below what they are the bottoms of.
    let above = Sight::new(Lens::parallel(DVec3::Y, bounds), posed, bounds, Blocks::Eyes).strict();
    let mut area = 0.0;
    for placed in posed.placed() {
        let side = placed.world_from_object.matrix3.determinant().signum();
        for t in 0..placed.mesh.triangles.len() {
            let [a, b, c] = placed.triangle(t);
            if a.y.max(b.y).max(c.y) > low {
                continue;
            }
            let up = side * (b - a).cross(c - a).y;
            let up = match posed.scene.triangle_blocking(placed.index, t) {
                Blocking::Nothing => 0.0,
                Blocking::Front => up.max(0.0),
                Blocking::BothSides | Blocking::Partly => up.abs(),
            };
            let seen = (0..POINTS).filter(|&k| above.reaches(spread([a, b, c], k))).count();
            area += up * seen as f64 / POINTS as f64;
        }
    }
    0.5 * area >= FLOOR * 4.0 * half.x * half.z
}

/// A ground at `height` around `bounds`, so many times as wide as shadows need that are `reach` long.
pub(super) fn around(bounds: &Bounds, height: f64, reach: f64, wide: f64) -> Ground {
    let unit = Bounds { min: DVec3::splat(-1.0), max: DVec3::ONE };
    let bounds = if bounds.is_empty() { &unit } else { bounds };
    let (center, half) = (bounds.center(), bounds.half());
    let radius = 2.5 * wide * (half.with_y(0.0).length() + reach);
    let radius = if radius > 0.0 && radius.is_finite() { radius } else { 1.0 };
    Ground { height, center: [center.x, center.z], radius }
}

/// A ground that catches shadows at the lowest point of `scene`.
#[must_use]
pub fn fitting_ground(scene: &Scene) -> Ground {
    let bounds = scene.tight_bounds();
    let height = if bounds.is_empty() { -1.0 } else { bounds.min.y };
    around(&bounds, height, bounds.half().y.max(0.0), 1.0)
}

/// Makes a surface of `ground`, which casts no shadow.
pub(super) fn add(scene: &mut Scene, ground: &Ground) {
    let mut mesh = Ground::disc();
    mesh.primitives.iter_mut().for_each(|primitive| primitive.material = Some(scene.materials.len()));
    let grey = Material { base_color: [0.5, 0.5, 0.5, 1.0], metallic: 0.0, roughness: 1.0, ..Material::default() };
    scene.materials.push(Material { name: mesh.name.clone(), ..grey });
    let (name, world_from_object) = (mesh.name.clone(), ground.world_from_disc());
    scene.instances.push(Instance {
        name,
        mesh: scene.meshes.len(),
        world_from_object,
        casts_shadow: false,
        receives_shadow: true,
    });
    scene.meshes.push(mesh);
}
