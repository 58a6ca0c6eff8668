//! A view of a scene that a user has set up: the eye, all lights, what the scene stands in, and what casts.
//!
//! In: a scene, changed by hand, and a camera; or the JSON text of a view. Out: the text; or the changes, made again in a
//! scene that was loaded from the same file. Numbers come back bit for bit.

mod text;

use crate::{Camera, Ground, Light, Scene, Sky};
use std::path::Path;
use std::{fs, io};
use zfail_plan::light::LightKind;
use zfail_plan::view::Projection;

/// What `zfail render --view` takes from a file.
#[derive(Clone, Debug)]
pub struct SavedView {
    /// The eye.
    pub camera: Camera,
    /// All lights; they replace the scene's.
    pub lights: Vec<Light>,
    /// What the scene stands in; `None` in files of older programs, which leave that as it is.
    pub surroundings: Option<Surroundings>,
    /// By instance, whether it casts shadows.
    pub casts: Vec<bool>,
}

/// Light from all sides, and what is seen and shadowed around a scene; as in [`Scene`].
#[derive(Clone, Debug, PartialEq)]
pub struct Surroundings {
    /// [`Scene::ambient`].
    pub ambient: [f32; 3],
    /// [`Scene::background`].
    pub background: [f32; 3],
    /// [`Scene::sky`].
    pub sky: Option<Sky>,
    /// [`Scene::ground`].
    pub ground: Option<Ground>,
}

impl Surroundings {
    /// Those of `scene`.
    #[must_use]
    pub fn of(scene: &Scene) -> Self {
        let Scene { ambient, background, sky, ground, .. } = *scene;
        Self { ambient, background, sky, ground }
    }

    fn set(&self, scene: &mut Scene) {
        (scene.ambient, scene.background) = (self.ambient, self.background);
        (scene.sky, scene.ground) = (self.sky, self.ground);
    }
}

/// Why there is no such view, or not of this scene.
#[derive(Debug, thiserror::Error)]
pub enum SavedViewError {
    /// The file cannot be read.
    #[error("the view cannot be read")]
    Read(#[from] io::Error),
    /// It is not what [`SavedView::to_json`] writes.
    #[error("this is no saved view: {0}")]
    Format(String),
    /// It belongs to another scene.
    #[error("this view belongs to another scene: {0}")]
    OtherScene(String),
    /// A number in it makes no sense.
    #[error("this view cannot be shown: {0}")]
    Value(String),
}

impl SavedView {
    /// The view of `scene` through `camera`.
    #[must_use]
    pub fn new(scene: &Scene, camera: &Camera) -> Self {
        Self {
            camera: camera.clone(),
            lights: scene.lights.clone(),
            surroundings: Some(Surroundings::of(scene)),
            casts: scene.instances.iter().map(|instance| instance.casts_shadow).collect(),
        }
    }

    /// Reads a file.
    ///
    /// # Errors
    /// If it cannot be read or is no view.
    pub fn read(path: &Path) -> Result<Self, SavedViewError> {
        Self::from_json(&fs::read_to_string(path)?)
    }

    /// Sets up `scene` like this and returns the camera.
    ///
    /// # Errors
    /// If the scene has another number of instances, or a value is out of range. The scene is unchanged then.
    pub fn apply(&self, scene: &mut Scene) -> Result<Camera, SavedViewError> {
        let (here, there) = (scene.instances.len(), self.casts.len());
        if here != there {
            return Err(SavedViewError::OtherScene(format!("it has {there} instances, and the scene has {here}")));
        }
        check_camera(&self.camera).map_err(|what| SavedViewError::Value(format!("its camera {what}")))?;
        for (i, light) in self.lights.iter().enumerate() {
            check_light(light, scene).map_err(|what| SavedViewError::Value(format!("light {i} {what}")))?;
        }
        if let Some(surroundings) = &self.surroundings {
            check_surroundings(surroundings).map_err(|what| SavedViewError::Value(what.to_owned()))?;
            surroundings.set(scene);
        }
        scene.lights.clone_from(&self.lights);
        for (instance, &casts) in scene.instances.iter_mut().zip(&self.casts) {
            instance.casts_shadow = casts;
        }
        Ok(self.camera.clone())
    }
}

/// How far rotations and unit vectors may be from that.
const TOLERANCE: f64 = 1e-6;

fn check_camera(camera: &Camera) -> Result<(), String> {
    let axes = camera.world_from_view.matrix3;
    let rotation = (axes.transpose() * axes - glam::DMat3::IDENTITY).to_cols_array();
    let ok =
        camera.world_from_view.is_finite() && rotation.iter().all(|x| x.abs() <= TOLERANCE) && axes.determinant() > 0.0;
    if !ok {
        return Err("has axes that are no rotation, or a place that is not finite".to_owned());
    }
    let positive = |x: f64| x.is_finite() && x > 0.0;
    let fine = match camera.projection {
        Projection::Perspective { yfov, near, far } => {
            positive(yfov) && yfov < std::f64::consts::PI && positive(near) && far.is_none_or(|far| far > near)
        }
        Projection::Orthographic { ymag, near, far } => {
            positive(ymag) && near.is_finite() && far.is_finite() && far > near
        }
    };
    if fine { Ok(()) } else { Err(format!("has the impossible projection {:?}", camera.projection)) }
}

fn check_surroundings(surroundings: &Surroundings) -> Result<(), &'static str> {
    let Surroundings { ambient, background, sky, ground } = surroundings;
    let colors = sky.map_or(vec![], |sky| vec![sky.zenith, sky.horizon, sky.nadir]);
    if !colors.iter().chain([ambient, background]).flatten().all(|c| c.is_finite() && *c >= 0.0) {
        return Err("its sky has a colour that is negative or not finite");
    }
    let fine = |g: &Ground| g.height.is_finite() && g.center.iter().all(|x| x.is_finite()) && g.radius > 0.0;
    match ground {
        Some(ground) if !(fine(ground) && ground.radius.is_finite()) => Err("its ground is nowhere, or has no extent"),
        _ => Ok(()),
    }
}

fn check_light(light: &Light, scene: &Scene) -> Result<(), String> {
    let unit = |v: glam::DVec3| (v.length_squared() - 1.0).abs() <= TOLERANCE;
    let (placed, reach) = match light.kind {
        LightKind::Point { position, range } => (position.is_finite(), range),
        LightKind::Spot { position, direction, range, inner, outer } => {
            let cone = 0.0 <= inner && inner <= outer && outer <= std::f64::consts::FRAC_PI_2;
            (position.is_finite() && unit(direction) && cone, range)
        }
        LightKind::Directional { direction } => (unit(direction), 1.0),
    };
    let shape = &light.shape;
    if !placed {
        return Err("has a place, direction or cone that is out of range".to_owned());
    }
    if reach.is_nan() || reach <= 0.0 {
        return Err("has a range that is not greater than 0".to_owned());
    }
    if !light.color.iter().chain([&light.intensity]).all(|x| x.is_finite() && *x >= 0.0) {
        return Err("has a colour or intensity that is negative or not finite".to_owned());
    }
    if let Some(e) = light.excluded.iter().find(|&&e| e >= scene.instances.len()) {
        return Err(format!("excludes instance {e}, which does not exist"));
    }
    if !shape.axes.is_finite() {
        return Err("has axes that are not finite".to_owned());
    }
    let problems = [
        ("falloff", shape.falloff_problem(&light.kind)),
        ("cookie", shape.cookie_problem(&light.kind, scene.textures.len())),
        ("box", shape.box_problem(&light.kind)),
    ];
    match problems.into_iter().find_map(|(part, problem)| problem.map(|problem| (part, problem))) {
        None => Ok(()),
        Some((part, problem)) => Err(format!("has a {part} that {problem}")),
    }
}

#[cfg(test)]
mod tests;
