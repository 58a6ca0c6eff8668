//! Boxes around everything that can be seen, so that shadows are drawn only where they can fall.
//!
//! In: a scene's meshes, and where its instances are. Out: boxes in world space that together hold every drawn triangle. A box
//! for every instance tells what lies in a shadow's depth and what only beside it in the picture; of a large mesh, a room above all, a
//! single box would say that shadows may fall in mid-air, so it has several.

use crate::{Instance, Mesh, Scene};
use glam::DVec3;
use zfail_plan::bounds::Bounds;

/// Boxes of a scene, about.
const MOST: usize = 4096;
/// Boxes of one mesh.
const MOST_OF_MESH: usize = 32;
/// Triangles that one box may hold without being divided.
const FEW: usize = 2;

/// Boxes around a scene's triangles by mesh, object space.
#[derive(Clone, Debug)]
pub struct Receivers {
    by_mesh: Vec<Vec<Bounds>>,
}

impl Receivers {
    /// Those of `scene`'s meshes in the pose in which they are stored.
    #[must_use]
    pub fn new(scene: &Scene) -> Self {
        let most = (MOST / scene.instances.len().max(1)).clamp(1, MOST_OF_MESH);
        let boxes = |mesh: &Mesh| if mesh.bends() { vec![mesh.bounds()] } else { boxes(mesh, most) };
        Self { by_mesh: scene.meshes.iter().map(boxes).collect() }
    }

    /// Takes new positions of the vertices of mesh number `mesh`, which bends.
    pub fn bend(&mut self, mesh: usize, positions: &[[f32; 3]]) {
        if let Some(boxes) = self.by_mesh.get_mut(mesh) {
            *boxes = vec![Bounds::of(positions.iter().map(|p| DVec3::from(p.map(f64::from))))];
        }
    }

    /// The boxes of all instances where they are, world space, put into `out`.
    pub fn place<'a>(&self, instances: impl IntoIterator<Item = &'a Instance>, out: &mut Vec<Bounds>) {
        out.clear();
        for instance in instances {
            let boxes = self.by_mesh.get(instance.mesh).into_iter().flatten();
            let placed = boxes.map(|bounds| bounds.transformed(&instance.world_from_object));
            out.extend(placed.filter(|bounds| !bounds.is_empty()));
        }
    }
}

/// Some boxes around a mesh's triangles: halves of halves, along the axis that leaves the smallest boxes.
fn boxes(mesh: &Mesh, most: usize) -> Vec<Bounds> {
    let mut triangles: Vec<Bounds> = mesh.triangles.iter().map(|t| Bounds::of(t.map(|v| mesh.position(v)))).collect();
    let mut out = Vec::new();
    if !triangles.is_empty() {
        divide(&mut triangles, most, &mut out);
    }
    out
}

fn divide(triangles: &mut [Bounds], most: usize, out: &mut Vec<Bounds>) {
    let middle = triangles.len() / 2;
    if most < 2 || triangles.len() <= FEW {
        out.push(around(triangles));
        return;
    }
    let mut halve = |axis: usize| {
        triangles.select_nth_unstable_by(middle, |a, b| a.center()[axis].total_cmp(&b.center()[axis]));
        area(&around(&triangles[..middle])) + area(&around(&triangles[middle..]))
    };
    let areas = [0, 1, 2].map(&mut halve);
    let best = (0..3).fold(0, |best, axis| if areas[axis] < areas[best] { axis } else { best });
    halve(best);
    let (lower, upper) = triangles.split_at_mut(middle);
    divide(lower, most / 2, out);
    divide(upper, most - most / 2, out);
}

fn around(boxes: &[Bounds]) -> Bounds {
    Bounds::of(boxes.iter().flat_map(|bounds| [bounds.min, bounds.max]))
}

fn area(bounds: &Bounds) -> f64 {
    let half = bounds.half();
    half.x * half.y + half.y * half.z + half.z * half.x
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DAffine3;

    /// A floor of so many quads, and a wall at its end.
    fn corner(quads: u16) -> Mesh {
        let mut mesh = Mesh::default();
        for x in 0..=quads {
            let far = if x == quads { 5.0 } else { 0.0 };
            mesh.positions.extend([[f32::from(x), 0.0, 0.0], [f32::from(x.min(quads - 1)), far, 4.0]]);
        }
        mesh.positions.extend([[f32::from(quads), 5.0, 0.0], [f32::from(quads), 5.0, 4.0]]);
        mesh.triangles = (0..u32::from(quads))
            .flat_map(|q| [[2 * q, 2 * q + 1, 2 * q + 2], [2 * q + 1, 2 * q + 3, 2 * q + 2]])
            .collect();
        mesh
    }

    fn scene(instances: usize) -> Scene {
        let instance = |i: usize| Instance {
            name: String::new(),
            mesh: 0,
            world_from_object: DAffine3::from_translation(DVec3::Y * i as f64),
            casts_shadow: true,
            receives_shadow: true,
        };
        Scene { meshes: vec![corner(100)], instances: (0..instances).map(instance).collect(), ..Scene::default() }
    }

    fn placed(scene: &Scene) -> Vec<Bounds> {
        let mut out = Vec::new();
        Receivers::new(scene).place(&scene.instances, &mut out);
        out
    }

    #[test]
    fn every_triangle_is_in_a_box() {
        let scene = scene(3);
        let boxes = placed(&scene);
        assert_eq!(boxes.len(), 3 * MOST_OF_MESH);
        let holds = |boxes: &[Bounds]| {
            scene.meshes[0].triangles.iter().all(|t| {
                let t = t.map(|v| scene.meshes[0].position(v) + DVec3::Y);
                boxes.iter().any(|b| t.iter().all(|&p| b.distance_squared(p) == 0.0))
            })
        };
        assert!(holds(&boxes) && !holds(&boxes[..40]), "the comparison can fail");
        let whole = area(&around(&boxes[..MOST_OF_MESH]));
        let sum: f64 = boxes[..MOST_OF_MESH].iter().map(area).sum();
        assert!(sum < 0.7 * whole, "{sum} of {whole}");
    }

    #[test]
    fn many_instances_have_a_box_each() {
        assert_eq!(placed(&scene(5000)).len(), 5000);
        assert!(placed(&Scene { instances: Vec::new(), ..scene(1) }).is_empty());
    }
}
