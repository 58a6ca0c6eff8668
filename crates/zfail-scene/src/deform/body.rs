//! A mesh that bends, and where it stands while it does.
//!
//! In: morph weights and the world transforms of moving nodes. Out: the vertices of the scene's mesh, and for skins the
//! origin about which they are given.

use super::Section;
use crate::animate::MAX_COORDINATE;
use crate::placement::localize;
use glam::{DAffine3, DVec3};
use zfail_plan::scene::BentMesh;

/// A mesh that bends.
#[derive(Clone, Debug)]
pub(crate) struct Body {
    /// Index into the scene's meshes.
    pub mesh: usize,
    /// The mesh's vertices, section after section.
    pub sections: Vec<Section>,
    /// Morph weights at rest.
    pub weights: Vec<f64>,
    pub frame: Frame,
}

/// What a body's coordinates are relative to.
#[derive(Clone, Debug)]
pub(crate) enum Frame {
    /// The mesh's own space, less this origin.
    Object { origin: DVec3 },
    /// The world, about an origin in its midst.
    Skin {
        joints: Vec<Joint>,
        /// Those of the scene's that show it: they stand at the origin.
        instances: Vec<usize>,
    },
}

/// A joint of a skin, as a transform from the mesh's space to the world.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Joint {
    /// Of a node that nothing moves.
    Fixed(DAffine3),
    /// Of a node of the rig: node from mesh, the inverse of how it was bound.
    Moving { node: usize, node_from_mesh: DAffine3 },
}

impl Joint {
    fn world_from_mesh(&self, world_from_node: &[DAffine3]) -> DAffine3 {
        match self {
            Self::Fixed(world_from_mesh) => *world_from_mesh,
            Self::Moving { node, node_from_mesh } => world_from_node[*node] * *node_from_mesh,
        }
    }
}

impl Body {
    /// The nodes of the rig that bend it.
    pub fn nodes(&self) -> impl Iterator<Item = usize> {
        let joints = match &self.frame {
            Frame::Object { .. } => &[][..],
            Frame::Skin { joints, .. } => joints,
        };
        joints.iter().filter_map(|joint| match joint {
            Joint::Fixed(_) => None,
            Joint::Moving { node, .. } => Some(*node),
        })
    }

    /// Poses the body into `bent`, whose lists have its length. Returns the origin, or `None`, with anything in `bent`, if
    /// a vertex would go beyond all measure.
    pub fn pose(&self, weights: &[f64], world_from_node: &[DAffine3], bent: &mut BentMesh) -> Option<DVec3> {
        let joints: Vec<DAffine3> = match &self.frame {
            Frame::Object { .. } => Vec::new(),
            Frame::Skin { joints, .. } => joints.iter().map(|joint| joint.world_from_mesh(world_from_node)).collect(),
        };
        let mut points = vec![DVec3::ZERO; bent.positions.len()];
        let (mut positions, mut normals, mut tangents) =
            (&mut points[..], &mut bent.normals[..], &mut bent.tangents[..]);
        for section in &self.sections {
            let (p, n, t);
            (p, positions) = positions.split_at_mut_checked(section.positions.len())?;
            (n, normals) = normals.split_at_mut_checked(section.positions.len())?;
            (t, tangents) = tangents.split_at_mut_checked(section.positions.len())?;
            section.pose(weights, &joints, p, n, t);
        }
        // NaN is beyond measure too.
        if !points.iter().all(|p| p.abs().max_element() <= MAX_COORDINATE) || points.iter().any(|p| p.is_nan()) {
            return None;
        }
        match self.frame {
            Frame::Object { origin } => {
                bent.positions.clear();
                bent.positions.extend(points.iter().map(|&p| (p - origin).as_vec3().to_array()));
                Some(origin)
            }
            Frame::Skin { .. } => {
                let origin;
                (origin, bent.positions) = localize(&points);
                Some(origin)
            }
        }
    }
}
