//! What takes long, said before it does.

use zfail_scene::Scene;

/// What is to be said before shadows that take long: what makes them so, and what takes less.
pub fn effort(scene: &Scene, lights: &[usize]) -> Option<String> {
    /// Triangles of casters under all lights, from which on a picture takes seconds and much memory.
    const MANY: usize = 10_000_000;
    /// What each of them takes in index lists, here and on the device.
    const BYTES: f64 = 70.0;
    let casters = scene.instances.iter().filter(|instance| instance.casts_shadow);
    let triangles: usize = casters.map(|instance| scene.meshes[instance.mesh].triangles.len()).sum();
    let all = triangles.saturating_mul(lights.len());
    (all > MANY).then(|| {
        format!(
            "the shadows of {triangles} triangles in {} instances under {} lights take about {:.1} GB of memory and a \
             while; fewer lights (--light N) or --no-shadows take less",
            scene.instances.len(),
            lights.len(),
            all as f64 * BYTES / 1e9
        )
    })
}

#[cfg(test)]
mod tests {
    use super::effort;

    #[test]
    fn many_copies_under_many_lights_are_said_to_take_long() {
        let mut scene = zfail_builtin::scene("jail").unwrap();
        assert_eq!(effort(&scene, &[0, 1]), None);
        let copy = scene.instances[0].clone();
        let triangles = scene.meshes[copy.mesh].triangles.len();
        scene.instances = vec![copy; 11_000_000 / triangles];
        let said = effort(&scene, &[0]).unwrap();
        assert!(said.contains("instances") && said.contains("--light N"), "{said}");
        scene.instances.iter_mut().for_each(|instance| instance.casts_shadow = false);
        assert_eq!(effort(&scene, &[0]), None);
    }
}
