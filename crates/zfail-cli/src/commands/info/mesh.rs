//! One mesh: how closed it is, how it casts, and why.

use crate::error::Error;
use serde::Serialize;
use zfail_plan::topology::{Blocking, NONE, Part, Shape};
use zfail_scene::{AlphaMode, Scene};

/// A mesh: its size, how closed it is, and how it casts.
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
    /// Triangles that never cast: degenerate, or of a material that lets light through.
    pub not_casting: usize,
    pub surfaces: Vec<SurfaceReport>,
    pub parts: Vec<PartReport>,
}

/// The triangles of one material.
#[derive(Serialize)]
pub struct SurfaceReport {
    /// `null` is glTF's default material.
    pub material: Option<usize>,
    pub alpha: &'static str,
    pub casts: bool,
    pub triangles: usize,
}

/// An edge-connected part of a mesh.
#[derive(Serialize)]
pub struct PartReport {
    pub triangles: u32,
    pub casting: &'static str,
    pub why: &'static str,
}

impl MeshReport {
    /// Builds the topology of mesh number `index`.
    ///
    /// # Errors
    /// If the mesh is beyond what topology supports.
    pub fn new(scene: &Scene, index: usize) -> Result<Self, Error> {
        let mesh = &scene.meshes[index];
        let topology = scene
            .topology(index)
            .map_err(|e| Error::failed(format!("mesh {index} '{}' cannot cast shadows: {e}", mesh.name)))?;
        let [boundary_edges, _, non_manifold_edges] = topology.edge_counts();
        let inconsistent = topology.incidence().filter(|(_, incident)| {
            let (count, sum) = incident.iter().fold((0, 0), |(count, sum), (_, o)| (count + 1, sum + o));
            count == 2 && sum != 0
        });
        let share = |of: fn(&Part) -> bool| {
            let triangles: usize =
                topology.parts().iter().filter(|part| of(part)).map(|part| part.triangles.len()).sum();
            triangles as f64 / mesh.triangles.len().max(1) as f64
        };
        Ok(Self {
            name: mesh.name.clone(),
            vertices: mesh.positions.len(),
            points: topology.positions().len(),
            triangles: mesh.triangles.len(),
            closed_share: share(|part| part.shape != Shape::Open),
            single_share: share(|part| matches!(part.shape, Shape::Solid { .. })),
            boundary_edges,
            non_manifold_edges,
            inconsistent_edges: inconsistent.count(),
            not_casting: topology.part_of().iter().filter(|part| **part == NONE).count(),
            surfaces: surfaces(scene, index),
            parts: topology.parts().iter().map(PartReport::new).collect(),
        })
    }
}

/// The mesh's triangles by material, in the order of the materials.
fn surfaces(scene: &Scene, index: usize) -> Vec<SurfaceReport> {
    let mut surfaces: Vec<SurfaceReport> = Vec::new();
    for primitive in scene.meshes[index].primitives.iter().filter(|primitive| !primitive.triangles.is_empty()) {
        let triangles = primitive.triangles.len();
        match surfaces.iter_mut().find(|surface| surface.material == primitive.material) {
            Some(surface) => surface.triangles += triangles,
            None => surfaces.push(SurfaceReport {
                material: primitive.material,
                alpha: alpha_name(primitive.material.map_or(AlphaMode::Opaque, |m| scene.materials[m].alpha)),
                casts: scene.triangle_blocking(index, primitive.triangles.start as usize) != Blocking::Nothing,
                triangles,
            }),
        }
    }
    surfaces.sort_by_key(|surface| surface.material);
    surfaces
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

/// glTF's word in small letters.
pub fn alpha_name(alpha: AlphaMode) -> &'static str {
    match alpha {
        AlphaMode::Opaque => "opaque",
        AlphaMode::Mask(_) => "mask",
        AlphaMode::Blend => "blend",
    }
}
