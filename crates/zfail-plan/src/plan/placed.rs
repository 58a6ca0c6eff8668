//! A caster, or a section of one, as this frame's lights find it.
//!
//! In: topology and transform. Out: its box relative to the eye, and lights and eye in its object space. Computed once a
//! frame, whatever the number of lights. From here on "caster" means whichever is decided on by itself.

use super::Caster;
use crate::bounds::Bounds;
use crate::casting::{self, ObjectLight};
use crate::light::LightKind;
use crate::topology::Topology;
use crate::view::{Projection, View};
use glam::{DAffine3, DMat3, DVec3, DVec4};

/// What is placed; told apart from frame to frame.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Source {
    /// [`Caster::mesh`].
    pub mesh: u64,
    /// Which of the topology's sections; the whole if none.
    pub section: Option<u32>,
}

impl Source {
    pub fn topology<'a>(&self, caster: &Caster<'a>) -> &'a Topology {
        let section = self.section.and_then(|section| caster.topology.sections().get(section as usize));
        section.map_or(caster.topology, |section| &section.topology)
    }
}

/// A caster's placement; "relative" is relative to the eye, in world directions.
#[derive(Clone, Copy, Debug)]
pub(super) struct Placed {
    /// Index into the frame's casters.
    pub caster: u32,
    pub source: Source,
    /// The mesh's vertex that is vertex 0 of the topology.
    pub first_vertex: u32,
    pub world_from_object: DAffine3,
    pub relative_from_object: DAffine3,
    object_from_world_directions: DMat3,
    /// Of what casts, object space; empty if nothing does.
    pub bounds: Bounds,
    /// The box, corners as [`Bounds::corners`] orders them.
    pub exact_corners: [DVec3; 8],
    /// The same, grown by what rounding may move.
    pub corners: [DVec3; 8],
    /// Axis-parallel bounds of the corners.
    pub world: Bounds,
    pub center: DVec3,
    /// Half axes of the box.
    pub axes: [DVec3; 3],
    /// Largest distance of a corner from the eye.
    pub reach: f64,
    pub mirrored: bool,
}

impl Placed {
    /// Places caster number `index` before `view`, section by section if `by_section` and it has any.
    pub fn all(index: usize, caster: &Caster<'_>, view: &View, by_section: bool) -> impl Iterator<Item = Self> {
        let sections = if by_section { caster.topology.sections().len() } else { 0 };
        let pieces = (0..sections as u32).map(Some).chain((sections == 0).then_some(None));
        pieces.map(move |section| Self::new(index, caster, section, view))
    }

    fn new(index: usize, caster: &Caster<'_>, section: Option<u32>, view: &View) -> Self {
        let source = Source { mesh: caster.mesh, section };
        let first_vertex = section.map_or(0, |section| caster.topology.sections()[section as usize].first_vertex);
        let world_from_object = caster.world_from_object;
        let relative_from_object =
            DAffine3 { translation: world_from_object.translation - view.eye(), ..world_from_object };
        let bounds = source.topology(caster).bounds();
        let mut placed = Self {
            caster: index as u32,
            source,
            first_vertex,
            world_from_object,
            relative_from_object,
            object_from_world_directions: world_from_object.matrix3.inverse(),
            bounds,
            exact_corners: [DVec3::ZERO; 8],
            corners: [DVec3::ZERO; 8],
            world: Bounds::EMPTY,
            center: DVec3::ZERO,
            axes: [DVec3::ZERO; 3],
            reach: 0.0,
            mirrored: world_from_object.matrix3.determinant() < 0.0,
        };
        if !bounds.is_empty() {
            let margin = 1e-6 * (bounds.half() + bounds.center().abs());
            let grown = Bounds { min: bounds.min - margin, max: bounds.max + margin };
            placed.exact_corners = bounds.corners().map(|c| relative_from_object.transform_point3(c));
            placed.corners = grown.corners().map(|c| relative_from_object.transform_point3(c));
            placed.world = Bounds::of(placed.corners);
            placed.center = relative_from_object.transform_point3(grown.center());
            let half = grown.half();
            let m = world_from_object.matrix3;
            placed.axes = [m.x_axis * half.x, m.y_axis * half.y, m.z_axis * half.z];
            placed.reach = placed.corners.iter().map(|c| c.length()).fold(0.0, f64::max);
        }
        placed
    }

    /// Object space from the eye's world directions.
    pub fn object_from_relative(&self) -> DAffine3 {
        let matrix3 = self.object_from_world_directions;
        DAffine3 { matrix3, translation: -(matrix3 * self.relative_from_object.translation) }
    }

    /// The light in object space, computed in f64 and rounded once; `None` if the transform cannot be inverted.
    pub fn object_light(&self, kind: &LightKind) -> Option<ObjectLight> {
        casting::object_light(kind, &self.object_from_world_directions, self.world_from_object.translation)
    }

    /// The homogeneous eye in object space.
    pub fn object_eye(&self, view: &View) -> DVec4 {
        match view.projection {
            Projection::Perspective { .. } => self.object_from_relative().translation.extend(1.0),
            Projection::Orthographic { .. } => {
                (self.object_from_world_directions * view.world_from_view.matrix3.z_axis).extend(0.0)
            }
        }
    }

    /// Whether a point light keeps so far from the box that all directions to it lie well within a hemisphere.
    pub fn is_strictly_outside(&self, light: ObjectLight) -> bool {
        let (light, half) = (light.truncate().as_dvec3(), self.bounds.half());
        let margin = 0.05 * half.length();
        let beyond = (light - self.bounds.center()).abs() - half;
        beyond.max_element() > margin
    }
}
