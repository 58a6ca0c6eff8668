//! The proof that volumes are closed, of all casters of all lights that shine, within bounds.
//!
//! Copies of a mesh that the light sees alike have the same volume, which is examined once; and after so many triangles the
//! rest is left out and counted.

use rayon::prelude::*;
use std::collections::HashSet;
use std::hash::BuildHasher;
use zfail_plan::casting;
use zfail_plan::closure::{self, Closure};
use zfail_plan::topology::Topology;
use zfail_scene::Scene;

/// Triangles of meshes that are examined at most, under all lights together: some ten seconds.
const MOST: usize = 8_000_000;

/// What was found, and how many casters were left out.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Closed {
    pub closure: Closure,
    /// Pairs of caster and light beyond the bound.
    pub left_out: usize,
}

/// Examines the volumes that `lights` give the casters of `scene`, given its topologies.
pub fn of(scene: &Scene, topologies: &[Option<Topology>], lights: impl Iterator<Item = usize>) -> Closed {
    within(scene, topologies, lights, MOST)
}

fn within(scene: &Scene, topologies: &[Option<Topology>], lights: impl Iterator<Item = usize>, most: usize) -> Closed {
    let mut closed = Closed::default();
    let (mut seen, mut work, mut triangles) = (HashSet::new(), Vec::new(), 0);
    for light in lights {
        for i in 0..scene.instances.len() {
            let Some((topology, weights, converging)) = weighed(scene, topologies, light, i) else { continue };
            let key = seen.hasher().hash_one((scene.instances[i].mesh, converging, &weights));
            if !seen.insert(key) {
                continue;
            }
            if triangles + weights.len() > most && triangles > 0 {
                closed.left_out += 1;
                continue;
            }
            triangles += weights.len();
            work.push((topology, weights, converging, i as u64));
        }
    }
    let found = work.into_par_iter().map(|(topology, weights, converging, seed)| {
        let mut sum = closure::of_weights(topology, &weights, converging);
        sum += closure::of_random_weights(topology, seed, converging);
        sum
    });
    closed.closure = found.reduce(Closure::default, |mut a, b| {
        a += b;
        a
    });
    closed
}

/// Weights of an instance under a light, if it casts, and whether its sides converge.
fn weighed<'t>(
    scene: &Scene,
    topologies: &'t [Option<Topology>],
    light: usize,
    i: usize,
) -> Option<(&'t Topology, Vec<i8>, bool)> {
    let (instance, light) = (&scene.instances[i], &scene.lights[light]);
    let topology = topologies[instance.mesh].as_ref().filter(|_| instance.casts_shadow)?;
    let placement = &instance.world_from_object;
    let found = casting::object_light(&light.kind, &placement.matrix3.inverse(), placement.translation)?;
    if light.excluded.contains(&i) {
        return None;
    }
    let (mut castings, mut weights) = (Vec::new(), Vec::new());
    casting::castings(topology, found, &mut castings);
    casting::weights(topology, &castings, found, &mut weights);
    Some((topology, weights, found.w == 0.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn copies_are_examined_once_and_what_is_left_out_is_counted() {
        let scene = zfail_builtin::scene("jail").unwrap();
        let topologies = scene.topologies().unwrap();
        let lights = || 0..scene.lights.len();
        let all = of(&scene, &topologies, lights());
        assert!(all.left_out == 0 && all.closure.open_edges == 0 && all.closure.volumes > 10, "{all:?}");
        let mut twice = scene.clone();
        twice.instances.extend(scene.instances.clone());
        assert_eq!(of(&twice, &topologies, lights()).closure.volumes, all.closure.volumes);
        let few = within(&scene, &topologies, lights(), 100);
        assert!(few.left_out > 0 && few.closure.volumes < all.closure.volumes, "{few:?}");
    }
}
