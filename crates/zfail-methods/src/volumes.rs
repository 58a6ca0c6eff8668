//! The closed shadow volumes of one light: the same for all methods but for where they end.
//!
//! In: the casters, the light, and how far it throws their shadows. Out: homogeneous vertices and index lists as
//! [`zfail_plan::volume`] defines them: vertex `v` in place at `2 * v`, thrown away from the light at `2 * v + 1`.

use crate::Error;
use crate::geometry::{Geometry, Mesh, object_eye, object_light};
use std::ops::Range;
use zfail_plan::casting;
use zfail_plan::glam::{DVec3, Vec3, Vec4};
use zfail_plan::plan::PlanError;
use zfail_plan::topology::{Cover, NONE};
use zfail_plan::view::View;
use zfail_plan::volume;
use zfail_scene::{Instance, Light};

/// Triangles to be counted.
#[derive(Clone, Debug, Default)]
pub struct Volumes {
    /// Homogeneous, in the space from which [`Draw::placement`] leads to clip space.
    pub vertices: Vec<[f32; 4]>,
    pub indices: Vec<u32>,
    pub draws: Vec<Draw>,
}

/// A run of triangles that are drawn alike.
#[derive(Clone, Debug)]
pub struct Draw {
    /// Number in [`Geometry::placements`].
    pub placement: u32,
    /// What is added to its indices.
    pub first_vertex: i32,
    /// Triangles that are counter-clockwise seen from outside of the volume.
    pub outward: Range<u32>,
    /// Triangles that are clockwise: light caps that cast from their back, kept as they are rendered so that they have the
    /// depth of the depth pass to the bit.
    pub inward: Range<u32>,
    /// Whether the placement mirrors, which exchanges the two.
    pub mirrored: bool,
    /// Pixels in which it is drawn, if not all: x, y, width, height.
    pub scissor: Option<[u32; 4]>,
}

/// How far shadows are thrown.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Extrusion {
    /// To `(p * Lw - L, 0)` (E&K 3.2.2).
    Infinite,
    /// So far from the vertex, in world units.
    By(f64),
}

/// Which faces of the volumes are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Faces {
    /// The sides, all that z-pass needs of a caster that hides its own light cap; and the light caps of those that do not,
    /// because the depth pass culls their backs or draws them elsewhere.
    Sides,
    /// All.
    All,
}

impl Volumes {
    /// The volumes of all that cast shadows from `light`.
    pub fn new(
        geometry: &Geometry,
        view: &View,
        light: &Light,
        extrusion: Extrusion,
        faces: Faces,
    ) -> Result<Self, Error> {
        let mut volumes = Self::default();
        for (number, instance, mesh) in geometry.casters(light) {
            volumes.add(number, instance, mesh, view, light, extrusion, faces)?;
        }
        Ok(volumes)
    }

    #[expect(clippy::too_many_arguments, reason = "a caster and what all casters have in common")]
    fn add(
        &mut self,
        number: usize,
        instance: &Instance,
        mesh: &Mesh,
        view: &View,
        light: &Light,
        extrusion: Extrusion,
        faces: Faces,
    ) -> Result<(), Error> {
        let topology = &mesh.topology;
        let (at, weights) = weigh(number, instance, mesh, light)?;
        let (mut visible, mut cap) = (Vec::new(), Vec::new());
        volume::visible_twins(topology, object_eye(instance, view), &mut visible);
        volume::cap_weights(topology, &weights, &visible, &mut cap);
        if faces == Faces::Sides {
            for (weight, &part) in cap.iter_mut().zip(topology.part_of()) {
                if part != NONE && topology.parts()[part as usize].cover != Cover::Nowhere {
                    *weight = 0;
                }
            }
        }
        // Rays from infinity meet there again in a single point.
        let converging = at.w == 0.0 && extrusion == Extrusion::Infinite;
        let mut volume = volume::build(topology, &weights, &cap, converging, &mut self.indices);
        if faces == Faces::Sides {
            let dark = volume.dark_cap.start as usize..volume.dark_cap.end as usize;
            let len = dark.len() as u32;
            self.indices.drain(dark);
            volume.light_cap = volume.light_cap.start - len..volume.light_cap.end - len;
            volume.light_cap_reversed = volume.light_cap_reversed.start - len..volume.light_cap_reversed.end - len;
        }
        let first_vertex = self.vertices.len() as i32;
        let throw = |p: Vec3| match extrusion {
            Extrusion::Infinite => (p * at.w - at.truncate()).extend(0.0),
            Extrusion::By(distance) => throw_by(distance, p, at, instance),
        };
        self.vertices.extend(topology.positions().iter().flat_map(|&position| {
            let p = Vec3::from(position);
            [p.extend(1.0).to_array(), throw(p).to_array()]
        }));
        self.draws.push(Draw {
            placement: number as u32,
            first_vertex,
            outward: volume.outward(),
            inward: volume.light_cap_reversed,
            mirrored: instance.world_from_object.matrix3.determinant() < 0.0,
            scissor: None,
        });
        Ok(())
    }

    /// Triangles of all draws.
    pub fn triangles(&self) -> u64 {
        self.draws.iter().map(|draw| u64::from((draw.outward.len() + draw.inward.len()) as u32 / 3)).sum()
    }
}

/// The light in a caster's object space, and the weights of its triangles.
pub fn weigh(number: usize, instance: &Instance, mesh: &Mesh, light: &Light) -> Result<(Vec4, Vec<i8>), PlanError> {
    let at = object_light(instance, light).ok_or(PlanError::Singular { caster: number })?;
    let (mut castings, mut weights) = (Vec::new(), Vec::new());
    casting::castings(&mesh.topology, at, &mut castings);
    casting::weights(&mesh.topology, &castings, at, &mut weights);
    Ok((at, weights))
}

/// `p` moved away from the light at `at` by so many world units, both in object space.
fn throw_by(distance: f64, p: Vec3, at: Vec4, instance: &Instance) -> Vec4 {
    let p = p.as_dvec3();
    let away = p * f64::from(at.w) - at.truncate().as_dvec3();
    let length = (instance.world_from_object.matrix3 * away).length();
    // A vertex at the light has no direction; its triangles are edge-on and cast nothing.
    let step = if length > 0.0 { away * (distance / length) } else { DVec3::ZERO };
    (p + step).as_vec3().extend(1.0)
}
