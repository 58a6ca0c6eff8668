//! One picture that is to be judged.

use super::choice::{at_moment, camera, lights};
use super::scene::complete;
use crate::console;
use crate::error::Error;
use crate::groups::Subject;
use zfail_plan::view::View;
use zfail_scene::Scene;

/// What is seen in one picture.
pub struct Shot {
    /// At its moment.
    pub scene: Scene,
    /// Name of the camera.
    pub camera: String,
    /// The camera.
    pub view: View,
    /// Which lights shine, ascending.
    pub lights: Vec<usize>,
}

/// Loads the scene of a picture that is to be judged, and says its notices.
///
/// # Errors
/// If the scene cannot be loaded, or has no such animation, camera or light.
pub fn shot(subject: &Subject, quiet: bool) -> Result<Shot, Error> {
    let (source, size) = (&subject.scene, subject.size.0);
    let animated = complete(&source.scene, &source.loading, subject.moment.shown(), size, &subject.sunlight.bare())?;
    let scene = at_moment(animated, &subject.moment)?;
    console::notices(&scene.notices, quiet);
    let camera = camera(&scene, &subject.camera)?;
    let view = scene.cameras[camera].view(size, &scene.bounds());
    let lights = lights(&scene, &subject.lights)?;
    let camera = scene.cameras[camera].name.clone();
    Ok(Shot { scene, camera, view, lights })
}
