//! What a scene casts with: the topologies of its meshes, and from which side its triangles cast.
//!
//! In: a scene, one of its lights. Out: what [`zfail_plan`] makes of its meshes, by the scene's own indices.

use crate::{Instance, Scene};
use zfail_plan::casting::{self, Casting};
use zfail_plan::topology::{NONE, Topology, TopologyError};

impl Scene {
    /// The topology of mesh number `mesh`, with what its materials are to light.
    ///
    /// # Errors
    /// As [`Topology::new`] and [`Topology::bending`].
    ///
    /// # Panics
    /// If there is no such mesh.
    pub fn topology(&self, mesh: usize) -> Result<Topology, TopologyError> {
        let surface = |t| self.triangle_blocking(mesh, t);
        let mesh = &self.meshes[mesh];
        match mesh.bends() {
            false => Topology::new(&mesh.positions, &mesh.triangles, surface),
            true => Topology::bending(&mesh.positions, &mesh.triangles, &mesh.alike, surface),
        }
    }

    /// The topology of every mesh of which an instance casts; `None` for the others.
    ///
    /// # Errors
    /// If a mesh is invalid.
    ///
    /// # Panics
    /// If an instance refers to a mesh that does not exist.
    pub fn topologies(&self) -> Result<Vec<Option<Topology>>, TopologyError> {
        let casts = |mesh: usize| self.instances.iter().any(|instance| instance.mesh == mesh && instance.casts_shadow);
        (0..self.meshes.len()).map(|mesh| casts(mesh).then(|| self.topology(mesh)).transpose()).collect()
    }

    /// By instance and triangle, from which side it casts under light number `light`; `None` for what does not cast.
    /// `topologies` are [`Self::topologies`].
    ///
    /// # Panics
    /// If there is no such light, or the topologies are those of another scene.
    #[must_use]
    pub fn castings(&self, topologies: &[Option<Topology>], light: usize) -> Vec<Vec<Option<Casting>>> {
        let mut of_parts = Vec::new();
        let mut of_instance = |instance: &Instance| {
            let placement = &instance.world_from_object;
            let inverse = placement.matrix3.inverse();
            let light = casting::object_light(&self.lights[light].kind, &inverse, placement.translation);
            let (Some(topology), Some(light)) = (&topologies[instance.mesh], light) else {
                return vec![None; self.meshes[instance.mesh].triangles.len()];
            };
            casting::castings(topology, light, &mut of_parts);
            let of_part = |&part: &u32| if part == NONE { None } else { of_parts.get(part as usize).copied() };
            topology.part_of().iter().map(of_part).collect()
        };
        self.instances.iter().map(&mut of_instance).collect()
    }
}
