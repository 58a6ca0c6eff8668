//! Which of a scene's animations, cameras and lights are asked for.

use crate::error::{Error, chain};
use crate::groups::Moment;
use crate::names;
use std::path::Path;
use zfail_scene::{Animated, Camera, SavedView, SavedViewError, Scene};

/// The scene at the moment that `--time` and `--animation` ask for: of the first animation unless one is named, at
/// its start unless a time is given, and at rest if neither is.
///
/// # Errors
/// If there is no such animation.
pub fn at_moment(animated: Animated, moment: &Moment) -> Result<Scene, Error> {
    if moment.shown().is_none() {
        return Ok(animated.scene);
    }
    let animation = animation(&animated, moment)?;
    let pose = animated.pose(animation, moment.time.unwrap_or(0.0));
    let mut scene = animated.scene;
    if animated.animations.is_empty() {
        scene.notices.push("the scene has no animation; --time changes nothing".into());
    }
    scene.set_pose(&pose);
    Ok(scene)
}

/// Index of the animation that `--animation` numbers or names, or 0, which may not exist.
///
/// # Errors
/// If there is no animation as named.
pub fn animation(animated: &Animated, moment: &Moment) -> Result<usize, Error> {
    let Some(wanted) = &moment.animation else { return Ok(0) };
    let names: Vec<&str> = animated.animations.iter().map(|animation| animation.name.as_str()).collect();
    names::index_of("animation", wanted, &names)
}

/// Index of the camera that `wanted` numbers or names.
///
/// # Errors
/// If there is none.
pub fn camera(scene: &Scene, wanted: &str) -> Result<usize, Error> {
    let names: Vec<&str> = scene.cameras.iter().map(|camera| camera.name.as_str()).collect();
    names::index_of("camera", wanted, &names)
}

/// The camera that is asked for: of the scene, or of a saved view, whose lights and casters `scene` has afterwards.
///
/// # Errors
/// If there is none, or the view is not one of this scene.
pub fn eye(scene: &mut Scene, wanted: &str, view: Option<&Path>) -> Result<Camera, Error> {
    let Some(path) = view else { return Ok(scene.cameras[camera(scene, wanted)?].clone()) };
    let failed = |e: SavedViewError| Error::failed(format!("{}: {}", path.display(), chain(&e)));
    SavedView::read(path).and_then(|view| view.apply(scene)).map_err(failed)
}

/// The lights that shine, in ascending order: all of them, or those in `wanted`.
///
/// # Errors
/// If one of them does not exist.
pub fn lights(scene: &Scene, wanted: &[usize]) -> Result<Vec<usize>, Error> {
    if wanted.is_empty() {
        return Ok((0..scene.lights.len()).collect());
    }
    if let Some(light) = wanted.iter().find(|light| **light >= scene.lights.len()) {
        let names: Vec<&str> = scene.lights.iter().map(|light| light.name.as_str()).collect();
        return Err(names::unknown_index("light", &light.to_string(), &names));
    }
    let mut lights = wanted.to_vec();
    lights.sort_unstable();
    lights.dedup();
    Ok(lights)
}

#[cfg(test)]
mod tests {
    use super::lights;
    use zfail_plan::light::LightKind;
    use zfail_scene::{Light, LightShape, Scene};

    #[test]
    fn lights_are_chosen_by_the_numbers_of_the_file() {
        let light = Light {
            name: "sun".to_owned(),
            kind: LightKind::Directional { direction: zfail_plan::glam::DVec3::NEG_Y },
            color: [1.0; 3],
            intensity: 1.0,
            excluded: Vec::new(),
            shape: LightShape::default(),
        };
        let scene = Scene { lights: vec![light; 3], ..Scene::default() };
        assert_eq!(lights(&scene, &[]).unwrap(), [0, 1, 2]);
        assert_eq!(lights(&scene, &[2, 0, 2]).unwrap(), [0, 2]);
        assert!(lights(&scene, &[0, 3]).unwrap_err().to_string().starts_with("unknown light '3'; there are: 0 'sun'"));
    }
}
