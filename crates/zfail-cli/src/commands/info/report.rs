//! The facts of a scene, in the shape of the JSON output.
//!
//! Lengths are in metres, angles in degrees, colours linear RGB; positions and directions are in world space. Every list
//! has the scene's order, so an index here is the index there.

use super::mesh::{MeshReport, alpha_name};
use crate::error::Error;
use rayon::prelude::*;
use serde::Serialize;
use zfail_files::{ChannelInfo, FileInfo, Treatment, extension_treatment};
use zfail_plan::bounds::Bounds;
use zfail_plan::light::LightKind;
use zfail_plan::view::Projection;
use zfail_scene::{Animated, Animation, Camera, Instance, Light, Material};

/// A scene.
#[derive(Serialize)]
pub struct Report {
    pub scene: String,
    /// `null` for a built-in scene.
    pub file: Option<FileInfo>,
    pub extensions: Vec<ExtensionReport>,
    pub bounds: Option<[[f64; 3]; 2]>,
    /// Of all instances.
    pub triangles: usize,
    pub meshes: Vec<MeshReport>,
    pub instances: Vec<InstanceReport>,
    pub lights: Vec<LightReport>,
    pub cameras: Vec<CameraReport>,
    pub animations: Vec<AnimationReport>,
    pub materials: Vec<MaterialReport>,
    pub textures: usize,
    pub images: Vec<ImageReport>,
    pub notices: Vec<String>,
}

/// An extension that the file uses.
#[derive(Serialize)]
pub struct ExtensionReport {
    pub name: String,
    pub required: bool,
    /// What is made of it, in words.
    pub treatment: String,
}

/// A placed mesh.
#[derive(Serialize)]
pub struct InstanceReport {
    pub name: String,
    pub mesh: usize,
    pub position: [f64; 3],
    pub mirrored: bool,
    pub casts_shadow: bool,
    pub receives_shadow: bool,
}

/// A light.
#[derive(Serialize)]
pub struct LightReport {
    pub name: String,
    pub kind: &'static str,
    pub position: Option<[f64; 3]>,
    pub direction: Option<[f64; 3]>,
    /// `null` where the light has none.
    pub range: Option<f64>,
    /// Inner and outer half angle of the cone.
    pub cone: Option<[f64; 2]>,
    pub color: [f32; 3],
    /// Candela, or lux for a directional light.
    pub intensity: f32,
    /// Irradiance per intensity at equal steps over the range; empty for the inverse-square law.
    pub falloff: Vec<f32>,
    /// The texture that it projects.
    pub cookie: Option<usize>,
    /// Half extents of the box beyond which it reaches nothing.
    #[serde(rename = "box")]
    pub half_extents: Option<[f64; 3]>,
    pub excluded_instances: usize,
}

/// A camera.
#[derive(Serialize)]
pub struct CameraReport {
    pub name: String,
    pub kind: &'static str,
    pub position: [f64; 3],
    pub direction: [f64; 3],
    pub yfov: Option<f64>,
    pub ymag: Option<f64>,
    pub near: f64,
}

/// An animation.
#[derive(Serialize)]
pub struct AnimationReport {
    pub name: String,
    /// Seconds.
    pub duration: f64,
    /// Whether it changes anything that is rendered.
    pub moves: bool,
    /// `null` for a built-in scene.
    pub channels: Option<ChannelInfo>,
}

/// A material.
#[derive(Serialize)]
pub struct MaterialReport {
    pub name: String,
    pub alpha: &'static str,
    pub double_sided: bool,
    pub unlit: bool,
    pub textures: usize,
}

/// A decoded image.
#[derive(Serialize)]
pub struct ImageReport {
    pub name: String,
    /// Pixels.
    pub size: [u32; 2],
}

impl Report {
    /// Gathers the facts; the topology of each mesh is built for this.
    ///
    /// # Errors
    /// If a mesh is beyond what topology supports.
    pub fn new(Animated { scene, animations, .. }: &Animated, file: Option<FileInfo>) -> Result<Self, Error> {
        let meshes = (0..scene.meshes.len()).into_par_iter().map(|mesh| MeshReport::new(scene, mesh));
        let channels = |animation: usize| file.as_ref().and_then(|file| file.channels.get(animation).copied());
        Ok(Self {
            scene: scene.name.clone(),
            extensions: file.as_ref().map(extensions).unwrap_or_default(),
            bounds: Some(scene.tight_bounds())
                .filter(|b| !b.is_empty())
                .map(|Bounds { min, max }| [min.into(), max.into()]),
            triangles: scene.instances.iter().map(|i| scene.meshes[i.mesh].triangles.len()).sum(),
            meshes: meshes.collect::<Result<_, _>>()?,
            instances: scene.instances.iter().map(InstanceReport::new).collect(),
            lights: scene.lights.iter().map(LightReport::new).collect(),
            cameras: scene.cameras.iter().map(CameraReport::new).collect(),
            animations: (0..)
                .zip(animations)
                .map(|(i, animation)| AnimationReport::new(animation, channels(i)))
                .collect(),
            materials: scene.materials.iter().map(MaterialReport::new).collect(),
            textures: scene.textures.len(),
            images: scene
                .images
                .iter()
                .map(|i| ImageReport { name: i.name.clone(), size: [i.width, i.height] })
                .collect(),
            notices: scene.notices.clone(),
            file,
        })
    }
}

/// The extensions of a file, and what becomes of them.
fn extensions(file: &FileInfo) -> Vec<ExtensionReport> {
    let FileInfo { extensions_used: used, extensions_required: required, .. } = file;
    let mut names: Vec<&String> = used.iter().chain(required).collect();
    names.sort();
    names.dedup();
    let report = |name: &String| ExtensionReport {
        name: name.clone(),
        required: required.contains(name),
        treatment: match extension_treatment(name) {
            Treatment::Read => "read".to_owned(),
            Treatment::Approximated(how) => format!("approximated: {how}"),
            Treatment::Ignored(consequence) => format!("ignored: {consequence}"),
        },
    };
    names.into_iter().map(report).collect()
}

impl InstanceReport {
    fn new(instance: &Instance) -> Self {
        Self {
            name: instance.name.clone(),
            mesh: instance.mesh,
            position: instance.world_from_object.translation.into(),
            mirrored: instance.world_from_object.matrix3.determinant() < 0.0,
            casts_shadow: instance.casts_shadow,
            receives_shadow: instance.receives_shadow,
        }
    }
}

impl LightReport {
    fn new(light: &Light) -> Self {
        let (kind, position, direction, range, cone) = match light.kind {
            LightKind::Point { position, range } => ("point", Some(position), None, Some(range), None),
            LightKind::Spot { position, direction, range, inner, outer } => {
                ("spot", Some(position), Some(direction), Some(range), Some([inner.to_degrees(), outer.to_degrees()]))
            }
            LightKind::Directional { direction } => ("directional", None, Some(direction), None, None),
        };
        Self {
            name: light.name.clone(),
            kind,
            position: position.map(Into::into),
            direction: direction.map(Into::into),
            range: range.filter(|range| range.is_finite()),
            cone,
            color: light.color,
            intensity: light.intensity,
            falloff: light.shape.falloff.clone(),
            cookie: light.shape.cookie,
            half_extents: light.shape.half_extents.map(Into::into),
            excluded_instances: light.excluded.len(),
        }
    }
}

impl CameraReport {
    fn new(camera: &Camera) -> Self {
        let (kind, yfov, ymag, near) = match camera.projection {
            Projection::Perspective { yfov, near, .. } => ("perspective", Some(yfov.to_degrees()), None, near),
            Projection::Orthographic { ymag, near, .. } => ("orthographic", None, Some(ymag), near),
        };
        Self {
            name: camera.name.clone(),
            kind,
            position: camera.world_from_view.translation.into(),
            direction: (-camera.world_from_view.matrix3.z_axis).into(),
            yfov,
            ymag,
            near,
        }
    }
}

impl AnimationReport {
    fn new(animation: &Animation, channels: Option<ChannelInfo>) -> Self {
        let Animation { name, duration, .. } = animation;
        Self { name: name.clone(), duration: *duration, moves: animation.moves_anything(), channels }
    }
}

impl MaterialReport {
    fn new(material: &Material) -> Self {
        let textures = [
            material.base_color_texture,
            material.metallic_roughness_texture,
            material.normal_texture,
            material.occlusion_texture,
            material.emissive_texture,
        ];
        Self {
            name: material.name.clone(),
            alpha: alpha_name(material.alpha),
            double_sided: material.double_sided,
            unlit: material.unlit,
            textures: textures.iter().flatten().count(),
        }
    }
}
