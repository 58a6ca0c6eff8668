//! Triangle meshes in object space.

use glam::DVec3;
use std::ops::Range;
use zfail_plan::bounds::Bounds;

/// A triangle mesh: what a glTF mesh with all its primitives becomes, so that edges shared between primitives weld.
///
/// All vertex attributes have the length of `positions`. Every position is finite. Winding is counter-clockwise seen
/// from the front. Coordinates lie near the object's own origin (loaders move far ones into the instance's transform).
#[derive(Clone, Debug, Default)]
pub struct Mesh {
    /// Name in the file, or an invented one.
    pub name: String,
    /// Object space, metres.
    pub positions: Vec<[f32; 3]>,
    /// Unit vectors, object space.
    pub normals: Vec<[f32; 3]>,
    /// Unit tangents with the handedness of the bitangent in w; zero where the mesh has none.
    pub tangents: Vec<[f32; 4]>,
    /// First texture coordinates.
    pub uv0: Vec<[f32; 2]>,
    /// Second texture coordinates.
    pub uv1: Vec<[f32; 2]>,
    /// Linear RGBA, multiplies the base colour.
    pub colors: Vec<[f32; 4]>,
    /// Vertex indices; all less than `positions.len()`.
    pub triangles: Vec<[u32; 3]>,
    /// Runs of triangles with one material, in order, covering all of `triangles`.
    pub primitives: Vec<Primitive>,
    /// Of a mesh that poses bend ([`crate::BentMesh`]), a number per vertex, equal for vertices that have bit-equal
    /// positions in every pose: shadow volumes weld these. Empty for a rigid mesh, whose vertices weld by position.
    pub alike: Vec<u32>,
}

/// A run of triangles with one material.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Primitive {
    /// Which triangles.
    pub triangles: Range<u32>,
    /// Index into [`crate::Scene::materials`]; `None` is glTF's default material.
    pub material: Option<usize>,
}

impl Mesh {
    /// Whether poses move its vertices against each other.
    #[must_use]
    pub fn bends(&self) -> bool {
        !self.alike.is_empty()
    }

    /// Object-space bounds of all vertices that a triangle uses.
    #[must_use]
    pub fn bounds(&self) -> Bounds {
        Bounds::of(self.triangles.iter().flatten().map(|&v| self.position(v)))
    }

    /// The vertices that triangles use, ascending.
    #[must_use]
    pub fn used_vertices(&self) -> Vec<u32> {
        let mut used = vec![false; self.positions.len()];
        self.triangles.iter().flatten().for_each(|&v| used[v as usize] = true);
        (0..).zip(used).filter_map(|(v, used)| used.then_some(v)).collect()
    }

    /// Position of vertex `v`.
    ///
    /// # Panics
    /// If `v` is out of range.
    #[must_use]
    pub fn position(&self, v: u32) -> DVec3 {
        let [x, y, z] = self.positions[v as usize];
        DVec3::new(x.into(), y.into(), z.into())
    }

    /// The material of `triangle`, `None` for the default one.
    #[must_use]
    pub fn material_of(&self, triangle: usize) -> Option<usize> {
        let i = self.primitives.partition_point(|p| p.triangles.end as usize <= triangle);
        self.primitives.get(i).and_then(|p| p.material)
    }
}
