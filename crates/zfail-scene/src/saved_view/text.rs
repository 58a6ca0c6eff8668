//! A saved view as JSON. What JSON has no number for is `null`: a range without end.

use super::{SavedView, SavedViewError, Surroundings};
use crate::{Camera, Ground, Light, LightShape, Sky};
use glam::{DAffine3, DMat3, DVec3};
use serde::{Deserialize, Serialize};
use zfail_plan::light::LightKind;
use zfail_plan::view::Projection;

/// The format's number, under which the file says what it is.
const VERSION: u32 = 1;

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    zfail_view: u32,
    camera: CameraText,
    lights: Vec<LightText>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    surroundings: Option<SurroundingsText>,
    casts: Vec<bool>,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct SurroundingsText {
    ambient: [f32; 3],
    background: [f32; 3],
    /// Zenith, horizon and nadir.
    sky: Option<[[f32; 3]; 3]>,
    ground: Option<GroundText>,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct GroundText {
    height: f64,
    center: [f64; 2],
    radius: f64,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct CameraText {
    name: String,
    /// Columns: right, up, back, the eye.
    world_from_view: [f64; 12],
    projection: ProjectionText,
}

#[derive(Serialize, Deserialize)]
#[serde(rename_all = "lowercase", deny_unknown_fields)]
enum ProjectionText {
    Perspective { yfov: f64, near: f64, far: Option<f64> },
    Orthographic { ymag: f64, near: f64, far: f64 },
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct LightText {
    name: String,
    kind: KindText,
    color: [f32; 3],
    intensity: f32,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    excluded: Vec<usize>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    falloff: Vec<f32>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    cookie: Option<usize>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    half_extents: Option<[f64; 3]>,
    axes: [f64; 9],
}

#[derive(Serialize, Deserialize)]
#[serde(rename_all = "lowercase", deny_unknown_fields)]
enum KindText {
    Point { position: [f64; 3], range: Option<f64> },
    Spot { position: [f64; 3], direction: [f64; 3], range: Option<f64>, inner: f64, outer: f64 },
    Directional { direction: [f64; 3] },
}

impl SavedView {
    /// The text of a file.
    #[must_use]
    pub fn to_json(&self) -> String {
        let file = File {
            zfail_view: VERSION,
            camera: CameraText::from(&self.camera),
            lights: self.lights.iter().map(LightText::from).collect(),
            surroundings: self.surroundings.as_ref().map(SurroundingsText::from),
            casts: self.casts.clone(),
        };
        // Maps with keys of text and finite numbers always have a text; infinities become null.
        serde_json::to_string_pretty(&file).unwrap_or_default() + "\n"
    }

    /// The view that a file's text tells of.
    ///
    /// # Errors
    /// If it is not such a text, or one of a later version.
    pub fn from_json(text: &str) -> Result<Self, SavedViewError> {
        let file: File = serde_json::from_str(text).map_err(|e| SavedViewError::Format(e.to_string()))?;
        if file.zfail_view != VERSION {
            let found = file.zfail_view;
            return Err(SavedViewError::Format(format!("its version is {found}, and this program knows {VERSION}")));
        }
        Ok(Self {
            camera: file.camera.into(),
            lights: file.lights.into_iter().map(Light::from).collect(),
            surroundings: file.surroundings.map(Surroundings::from),
            casts: file.casts,
        })
    }
}

impl From<&Surroundings> for SurroundingsText {
    fn from(surroundings: &Surroundings) -> Self {
        let Surroundings { ambient, background, sky, ground } = *surroundings;
        let ground = ground.map(|Ground { height, center, radius }| GroundText { height, center, radius });
        Self { ambient, background, sky: sky.map(|Sky { zenith, horizon, nadir }| [zenith, horizon, nadir]), ground }
    }
}

impl From<SurroundingsText> for Surroundings {
    fn from(text: SurroundingsText) -> Self {
        let SurroundingsText { ambient, background, sky, ground } = text;
        let ground = ground.map(|GroundText { height, center, radius }| Ground { height, center, radius });
        Self { ambient, background, sky: sky.map(|[zenith, horizon, nadir]| Sky { zenith, horizon, nadir }), ground }
    }
}

impl From<&Camera> for CameraText {
    fn from(camera: &Camera) -> Self {
        let projection = match camera.projection {
            Projection::Perspective { yfov, near, far } => ProjectionText::Perspective { yfov, near, far },
            Projection::Orthographic { ymag, near, far } => ProjectionText::Orthographic { ymag, near, far },
        };
        let world_from_view = camera.world_from_view.to_cols_array();
        Self { name: camera.name.clone(), world_from_view, projection }
    }
}

impl From<CameraText> for Camera {
    fn from(text: CameraText) -> Self {
        let projection = match text.projection {
            ProjectionText::Perspective { yfov, near, far } => Projection::Perspective { yfov, near, far },
            ProjectionText::Orthographic { ymag, near, far } => Projection::Orthographic { ymag, near, far },
        };
        Self { name: text.name, world_from_view: DAffine3::from_cols_array(&text.world_from_view), projection }
    }
}

impl From<&Light> for LightText {
    fn from(light: &Light) -> Self {
        let end = |range: f64| Some(range).filter(|range| range.is_finite());
        let kind = match light.kind {
            LightKind::Point { position, range } => {
                KindText::Point { position: position.to_array(), range: end(range) }
            }
            LightKind::Spot { position, direction, range, inner, outer } => KindText::Spot {
                position: position.to_array(),
                direction: direction.to_array(),
                range: end(range),
                inner,
                outer,
            },
            LightKind::Directional { direction } => KindText::Directional { direction: direction.to_array() },
        };
        let LightShape { falloff, cookie, half_extents, axes } = light.shape.clone();
        Self {
            name: light.name.clone(),
            kind,
            color: light.color,
            intensity: light.intensity,
            excluded: light.excluded.clone(),
            falloff,
            cookie,
            half_extents: half_extents.map(|half| half.to_array()),
            axes: axes.to_cols_array(),
        }
    }
}

impl From<LightText> for Light {
    fn from(text: LightText) -> Self {
        let end = |range: Option<f64>| range.unwrap_or(f64::INFINITY);
        let kind = match text.kind {
            KindText::Point { position, range } => LightKind::Point { position: position.into(), range: end(range) },
            KindText::Spot { position, direction, range, inner, outer } => {
                let [position, direction] = [position, direction].map(DVec3::from);
                LightKind::Spot { position, direction, range: end(range), inner, outer }
            }
            KindText::Directional { direction } => LightKind::Directional { direction: direction.into() },
        };
        let shape = LightShape {
            falloff: text.falloff,
            cookie: text.cookie,
            half_extents: text.half_extents.map(DVec3::from),
            axes: DMat3::from_cols_array(&text.axes),
        };
        Self { name: text.name, kind, color: text.color, intensity: text.intensity, excluded: text.excluded, shape }
    }
}
