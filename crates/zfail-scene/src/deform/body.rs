//! A mesh that bends, and where it stands while it does.
//!
//! In: morph weights and the world transforms of moving nodes. Out: the vertices of the scene's mesh, and for skins the
//! origin about which they are given. Vertices along the cuts of masks stay where they are on their bent triangles.

use super::Section;
use crate::BentMesh;
use crate::animate::MAX_COORDINATE;
use crate::cut::{Source, extend};
use crate::placement::localize;
use glam::{DAffine3, DVec3};

/// A mesh that bends.
#[derive(Clone, Debug)]
pub struct Body {
    /// Index into the scene's meshes.
    pub mesh: usize,
    /// The mesh's vertices, section after section.
    pub sections: Vec<Section>,
    /// Those behind them, which were added along the cuts of masks.
    pub cuts: Vec<Source>,
    /// Morph weights at rest.
    pub weights: Vec<f64>,
    /// What it is relative to.
    pub frame: Frame,
}

/// What a body's coordinates are relative to.
#[derive(Clone, Debug)]
pub enum Frame {
    /// The mesh's own space, less this origin.
    Object {
        /// In the mesh's own space.
        origin: DVec3,
    },
    /// The world, about an origin in its midst.
    Skin {
        /// What [`super::Influences::joints`] refers to.
        joints: Vec<Joint>,
        /// Those of the scene's that show it: they stand at the origin.
        instances: Vec<usize>,
    },
}

/// A joint of a skin, as a transform from the mesh's space to the world.
#[derive(Clone, Copy, Debug)]
pub enum Joint {
    /// Of a node that nothing moves: world from mesh.
    Fixed(DAffine3),
    /// Of a node of the rig.
    Moving {
        /// Index into the rig's nodes.
        node: usize,
        /// The inverse of how the mesh was bound to it.
        node_from_mesh: DAffine3,
    },
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

    /// Poses the body into `bent`, whose lists have the mesh's lengths. Returns the origin, or `None`, with anything in `bent`, if
    /// a vertex would go beyond all measure.
    pub fn pose(&self, weights: &[f64], world_from_node: &[DAffine3], bent: &mut BentMesh) -> Option<DVec3> {
        let joints: Vec<DAffine3> = match &self.frame {
            Frame::Object { .. } => Vec::new(),
            Frame::Skin { joints, .. } => joints.iter().map(|joint| joint.world_from_mesh(world_from_node)).collect(),
        };
        let count = self.sections.iter().map(|section| section.positions.len()).sum();
        bent.normals.truncate(count);
        bent.tangents.truncate(count);
        let mut points = vec![DVec3::ZERO; count];
        let mut positions = &mut points[..];
        let (mut normals, mut tangents) = (&mut bent.normals[..], &mut bent.tangents[..]);
        for section in &self.sections {
            let (p, n, t);
            (p, positions) = positions.split_at_mut_checked(section.positions.len())?;
            (n, normals) = normals.split_at_mut_checked(section.positions.len())?;
            (t, tangents) = tangents.split_at_mut_checked(section.positions.len())?;
            section.pose(weights, &joints, p, n, t);
        }
        // What is not a number is beyond measure too.
        if !points.iter().all(|p| p.abs().cmple(DVec3::splat(MAX_COORDINATE)).all()) {
            return None;
        }
        let (origin, positions) = match self.frame {
            Frame::Object { origin } => (origin, points.iter().map(|&p| (p - origin).as_vec3().to_array()).collect()),
            Frame::Skin { .. } => localize(&points),
        };
        bent.positions = positions;
        extend(&self.cuts, &mut bent.positions, &mut bent.normals, &mut bent.tangents);
        Some(origin)
    }
}

#[cfg(test)]
mod tests {
    use super::super::Target;
    use super::*;

    #[test]
    fn cuts_bend_with_their_triangle() {
        let tip = Target { positions: vec![[0.0, 0.0, 4.0], [0.0; 3], [0.0; 3]], ..Target::default() };
        let section = Section {
            positions: vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
            normals: vec![[0.0, 0.0, 1.0]; 3],
            tangents: vec![[0.0; 4]; 3],
            targets: vec![tip],
            ..Section::default()
        };
        let cuts = vec![Source { corners: [0, 1, 1], weights: [0.25, 0.75, 0.0] }];
        let frame = Frame::Object { origin: DVec3::ZERO };
        let body = Body { mesh: 0, sections: vec![section], cuts, weights: vec![0.0], frame };
        let lists = |n| (vec![[0.0; 3]; n], vec![[0.0; 3]; n], vec![[0.0; 4]; n]);
        let (positions, normals, tangents) = lists(4);
        let mut bent = BentMesh { mesh: 0, positions, normals, tangents };
        assert_eq!(body.pose(&[0.5], &[], &mut bent), Some(DVec3::ZERO));
        assert_eq!(bent.positions[0], [0.0, 0.0, 2.0]);
        assert_eq!(bent.positions[3], [0.75, 0.0, 0.5]);
        assert_eq!((bent.normals.len(), bent.tangents.len()), (4, 4));
        assert_eq!(body.pose(&[0.0], &[], &mut bent), Some(DVec3::ZERO));
        assert_eq!((bent.positions[3], bent.positions.len()), ([0.75, 0.0, 0.0], 4), "again in the same memory");
        assert_eq!(body.pose(&[f64::INFINITY], &[], &mut bent), None);
    }
}
