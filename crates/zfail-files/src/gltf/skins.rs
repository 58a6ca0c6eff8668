//! Skins, as transforms of their joints.
//!
//! In: the skins of a validated document, and where its nodes are. Out: per skin, what takes its meshes to the world.

use super::animations::Motion;
use super::document::Document;
use super::graph::{Graph, upper_rows};
use crate::shared::error::Result;
use glam::{DAffine3, DMat3};
use rustc_hash::FxHashMap;
use zfail_scene::deform::Joint;
use zfail_scene::placement::is_moderate;

/// The joints of a skin.
pub(super) struct Skin {
    /// From mesh space to the world, in the rest pose.
    pub at_rest: Vec<DAffine3>,
    pub joints: Vec<Joint>,
}

impl Skin {
    pub fn moves(&self) -> bool {
        self.joints.iter().any(|joint| matches!(joint, Joint::Moving { .. }))
    }
}

/// Reads all skins; those that nothing wears have no joints.
pub(super) fn read(
    document: &Document<'_>,
    graph: &Graph,
    motion: &Motion,
    notices: &mut Vec<String>,
) -> Result<Vec<Skin>> {
    let mut known = FxHashMap::default();
    let skins = document.root.skins.iter().enumerate().map(|(s, skin)| {
        let size = (size_of::<DAffine3>() * 2 + size_of::<Joint>()) as u64;
        document.budget.charge(skin.joints.len() as u64, size, || format!("skins[{s}].joints"))?;
        let mut inverse_binds = match skin.inverse_bind_matrices {
            None => Vec::new(),
            Some(accessor) => inverse_binds(
                document,
                accessor,
                &format!("skins[{s}].inverseBindMatrices"),
                skin.joints.len(),
                notices,
            )?,
        };
        inverse_binds.resize(skin.joints.len(), DAffine3::IDENTITY);
        let joint = |(&node, node_from_mesh): (&usize, DAffine3)| {
            let at_rest = graph.world_from_node(&document.root.nodes, node, &mut known)? * node_from_mesh;
            let rig_node = graph.visit_of(node).and_then(|visit| motion.rig_node[visit]);
            let moving = rig_node.map(|node| Joint::Moving { node, node_from_mesh });
            Ok((at_rest, moving.unwrap_or(Joint::Fixed(at_rest))))
        };
        let joints: Vec<(DAffine3, Joint)> = skin.joints.iter().zip(inverse_binds).map(joint).collect::<Result<_>>()?;
        let (at_rest, joints) = joints.into_iter().unzip();
        Ok(Skin { at_rest, joints })
    });
    skins.collect()
}

/// The matrices for up to `count` joints. Those that cannot be meant become the identity.
fn inverse_binds(
    document: &Document<'_>,
    accessor: usize,
    path: &str,
    count: usize,
    notices: &mut Vec<String>,
) -> Result<Vec<DAffine3>> {
    let found = document.floats::<16>(accessor)?;
    if found.len() < count {
        notices.push(format!("{path} has {} matrices for {count} joints: the rest are the identity", found.len()));
    }
    let (mut replaced, mut cut) = (0, 0);
    let matrix = |m: &[f32; 16]| {
        let m = m.map(f64::from);
        let affine = upper_rows(&m);
        if !is_moderate(&affine) || affine.matrix3 == DMat3::ZERO {
            replaced += 1;
            return DAffine3::IDENTITY;
        }
        let last_row = [m[3], m[7], m[11], m[15] - 1.0];
        cut += usize::from(!last_row.iter().all(|x| x.abs() < 1e-4));
        affine
    };
    let matrices = found.iter().take(count).map(matrix).collect();
    for (n, what) in [
        (replaced, "of zeros or not finite: replaced by the identity"),
        (cut, "whose last row is not 0 0 0 1: read without it"),
    ] {
        if n > 0 {
            notices.push(format!("{path} has {n} {} {what}", if n == 1 { "matrix" } else { "matrices" }));
        }
    }
    Ok(matrices)
}
