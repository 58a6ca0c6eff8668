//! The facts of a scene, in the shape of the JSON output.
//!
//! Lengths are in metres, angles in degrees, colours linear RGB; positions and directions are in world space.

use crate::error::Error;
use rayon::prelude::*;
use serde::Serialize;
use zfail_plan::scene::{AlphaMode, Bounds, Camera, Instance, Light, LightKind, Material, Mesh, Scene};
use zfail_plan::topology::{NONE, Part, Shape, Topology};
use zfail_plan::view::Projection;
use zfail_scene::{Animated, Animation, FileInfo};

/// A scene.
#[derive(Serialize)]
pub struct Report {
    pub scene: String,
    /// `null` for a built-in scene.
    pub file: Option<FileReport>,
    pub bounds: Option<[[f64; 3]; 2]>,
    pub triangles: usize,
    pub meshes: Vec<MeshReport>,
    pub instances: Vec<InstanceReport>,
    pub lights: Vec<LightReport>,
    pub cameras: Vec<CameraReport>,
    pub animations: Vec<AnimationReport>,
    pub materials: Vec<MaterialReport>,
    pub textures: usize,
    pub images: usize,
    pub notices: Vec<String>,
}

/// What the file says about itself.
#[derive(Serialize)]
pub struct FileReport {
    pub version: String,
    pub generator: Option<String>,
    pub extensions_used: Vec<String>,
    pub extensions_required: Vec<String>,
    pub skins: usize,
    pub morphed_meshes: usize,
}

/// A mesh: its size and how closed it is.
#[derive(Serialize)]
pub struct MeshReport {
    pub name: String,
    pub vertices: usize,
    /// Vertices left after welding equal positions.
    pub points: usize,
    pub triangles: usize,
    /// Share of the triangles that lie in parts without a border, 0 to 1.
    pub closed_share: f64,
    /// Share of the triangles that cast with single weight, 0 to 1.
    pub single_share: f64,
    /// Edges of one triangle.
    pub boundary_edges: usize,
    /// Edges of more than two triangles.
    pub non_manifold_edges: usize,
    /// Edges of two triangles that run the same way.
    pub inconsistent_edges: usize,
    /// Triangles that never cast: degenerate, or of a blended material.
    pub not_casting: usize,
    pub parts: Vec<PartReport>,
}

/// An edge-connected part of a mesh.
#[derive(Serialize)]
pub struct PartReport {
    pub triangles: u32,
    pub casting: &'static str,
    pub why: &'static str,
}

/// A placed mesh.
#[derive(Serialize)]
pub struct InstanceReport {
    pub name: String,
    pub mesh: usize,
    pub position: [f64; 3],
    pub mirrored: bool,
    pub casts_shadow: bool,
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
    /// Whether it moves instances, lights or cameras; one of skins or morph targets alone does not.
    pub moves: bool,
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

impl Report {
    /// Gathers the facts; the topology of each mesh is built for this.
    ///
    /// # Errors
    /// If a mesh is beyond what topology supports.
    pub fn new(Animated { scene, animations, .. }: &Animated, file: Option<FileInfo>) -> Result<Self, Error> {
        let meshes = scene.meshes.par_iter().enumerate().map(|(m, mesh)| MeshReport::new(scene, m, mesh));
        Ok(Self {
            scene: scene.name.clone(),
            file: file.map(FileReport::new),
            bounds: Some(scene.bounds()).filter(|b| !b.is_empty()).map(|Bounds { min, max }| [min.into(), max.into()]),
            triangles: scene.instances.iter().map(|i| scene.meshes[i.mesh].triangles.len()).sum(),
            meshes: meshes.collect::<Result<_, _>>()?,
            instances: scene.instances.iter().map(InstanceReport::new).collect(),
            lights: scene.lights.iter().map(LightReport::new).collect(),
            cameras: scene.cameras.iter().map(CameraReport::new).collect(),
            animations: animations.iter().map(AnimationReport::new).collect(),
            materials: scene.materials.iter().map(MaterialReport::new).collect(),
            textures: scene.textures.len(),
            images: scene.images.len(),
            notices: scene.notices.clone(),
        })
    }
}

impl FileReport {
    fn new(info: FileInfo) -> Self {
        Self {
            version: info.version,
            generator: info.generator,
            extensions_used: info.extensions_used,
            extensions_required: info.extensions_required,
            skins: info.skins,
            morphed_meshes: info.morphed_meshes,
        }
    }
}

impl MeshReport {
    fn new(scene: &Scene, index: usize, mesh: &Mesh) -> Result<Self, Error> {
        let topology = Topology::of(scene, index)
            .map_err(|e| Error::failed(format!("mesh {index} '{}' cannot cast shadows: {e}", mesh.name)))?;
        let [boundary_edges, _, non_manifold_edges] = topology.edge_counts();
        let inconsistent = topology.incidence().filter(|(_, incident)| {
            let (count, sum) = incident.iter().fold((0, 0), |(count, sum), (_, o)| (count + 1, sum + o));
            count == 2 && sum != 0
        });
        let share = |of: fn(&Part) -> bool| {
            let triangles: u32 =
                topology.parts.iter().filter(|part| of(part)).map(|part| part.triangles.len() as u32).sum();
            f64::from(triangles) / mesh.triangles.len().max(1) as f64
        };
        Ok(Self {
            name: mesh.name.clone(),
            vertices: mesh.positions.len(),
            points: topology.positions.len(),
            triangles: mesh.triangles.len(),
            closed_share: share(|part| part.shape != Shape::Open),
            single_share: share(|part| matches!(part.shape, Shape::Solid { .. })),
            boundary_edges,
            non_manifold_edges,
            inconsistent_edges: inconsistent.count(),
            not_casting: topology.part_of.iter().filter(|part| **part == NONE).count(),
            parts: topology.parts.iter().map(PartReport::new).collect(),
        })
    }
}

impl PartReport {
    fn new(part: &Part) -> Self {
        let (casting, why) = match part.shape {
            Shape::Solid { inside: 1.. } => ("single", "closed, facing outward"),
            Shape::Solid { .. } => ("single", "closed, facing inward"),
            Shape::SelfIntersecting => ("double", "closed, but it meets itself"),
            Shape::Bending => ("double", "closed, but it bends"),
            Shape::Open => ("double", "it has a border, a fin or inconsistent winding"),
        };
        Self { triangles: part.triangles.len() as u32, casting, why }
    }
}

impl InstanceReport {
    fn new(instance: &Instance) -> Self {
        Self {
            name: instance.name.clone(),
            mesh: instance.mesh,
            position: instance.world_from_object.translation.into(),
            mirrored: instance.world_from_object.matrix3.determinant() < 0.0,
            casts_shadow: instance.casts_shadow,
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
    fn new(animation: &Animation) -> Self {
        Self { name: animation.name.clone(), duration: animation.duration, moves: animation.moves_anything() }
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
            alpha: match material.alpha {
                AlphaMode::Opaque => "opaque",
                AlphaMode::Mask(_) => "mask",
                AlphaMode::Blend => "blend",
            },
            double_sided: material.double_sided,
            unlit: material.unlit,
            textures: textures.iter().flatten().count(),
        }
    }
}
