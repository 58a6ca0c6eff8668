//! The node hierarchy, walked once.
//!
//! In: the validated document. Out: every node's world transform, and the default scene's nodes in depth-first order.

use super::error::{Result, invalid};
use super::schema::{Node, Root};
use crate::animate::Trs;
use crate::placement::{is_moderate, unit_quaternion};
use glam::{DAffine3, DMat3, DQuat, DVec3};

/// World transforms and the order of visit. Nothing here recurses, so a chain of a million nodes is fine.
pub(super) struct Graph {
    /// By node, including those outside the default scene.
    pub world_from_node: Vec<DAffine3>,
    /// By node.
    pub parent_from_node: Vec<DAffine3>,
    /// The default scene's nodes, parents before children, in the order of the file.
    pub visits: Vec<Visit>,
}

/// A node of the default scene.
pub(super) struct Visit {
    /// Index into the document's nodes.
    pub node: usize,
    /// Index of the first visit after this node's descendants.
    pub end: usize,
    /// Neither this node nor an ancestor says `castShadow: false`.
    pub casts_shadow: bool,
}

impl Graph {
    /// Walks the default scene: the one that the file names, or its first, or all its nodes if it has no scene.
    pub fn new(root: &Root, notices: &mut Vec<String>) -> Result<Self> {
        let nodes = &root.nodes;
        let mut is_child = vec![false; nodes.len()];
        nodes.iter().flat_map(|n| &n.children).for_each(|&c| is_child[c] = true);
        let roots: Vec<usize> = (0..nodes.len()).filter(|&i| !is_child[i]).collect();

        let all = depth_first(nodes, &roots);
        let mut world_from_node = vec![DAffine3::IDENTITY; nodes.len()];
        let mut parent_from_node = vec![DAffine3::IDENTITY; nodes.len()];
        for &i in &all {
            parent_from_node[i] = local_transform(i, &nodes[i], notices)?;
            // Parents come first and have left their own transform here.
            let world = world_from_node[i] * parent_from_node[i];
            if !is_moderate(&world) {
                return Err(invalid(format!("nodes[{i}]"), "its world transform is beyond all measure"));
            }
            world_from_node[i] = world;
            nodes[i].children.iter().for_each(|&c| world_from_node[c] = world);
        }
        let mut descendants = vec![0; nodes.len()];
        for &i in all.iter().rev() {
            descendants[i] = nodes[i].children.iter().map(|&c| 1 + descendants[c]).sum();
        }

        let chosen = root.scenes.get(root.scene.unwrap_or(0)).map_or(&roots, |scene| &scene.nodes);
        let mut inherited = vec![true; nodes.len()];
        let visit = |(at, node): (usize, usize)| {
            let own = nodes[node].extras.get("castShadow").and_then(serde_json::Value::as_bool);
            let casts_shadow = inherited[node] && own != Some(false);
            nodes[node].children.iter().for_each(|&c| inherited[c] = casts_shadow);
            Visit { node, end: at + 1 + descendants[node], casts_shadow }
        };
        let visits = depth_first(nodes, chosen).into_iter().enumerate().map(visit).collect();
        Ok(Self { world_from_node, parent_from_node, visits })
    }
}

fn depth_first(nodes: &[Node], roots: &[usize]) -> Vec<usize> {
    let mut order = Vec::new();
    let mut stack: Vec<usize> = roots.iter().rev().copied().collect();
    while let Some(i) = stack.pop() {
        order.push(i);
        stack.extend(nodes[i].children.iter().rev());
    }
    order
}

fn local_transform(i: usize, node: &Node, notices: &mut Vec<String>) -> Result<DAffine3> {
    if let Some(m) = node.matrix {
        return affine(&m).ok_or_else(|| invalid(format!("nodes[{i}].matrix"), "its last row is not 0 0 0 1"));
    }
    if node.rotation.is_some_and(|q| unit_quaternion(DQuat::from_array(q)).is_none()) {
        notices.push(format!("nodes[{i}].rotation has no length; the node is not rotated"));
    }
    Ok(properties(node).affine())
}

/// Translation, rotation and scale of a node that has no matrix.
pub(super) fn properties(node: &Node) -> Trs {
    Trs {
        translation: node.translation.map_or(DVec3::ZERO, DVec3::from),
        rotation: node.rotation.map(DQuat::from_array).and_then(unit_quaternion).unwrap_or(DQuat::IDENTITY),
        scale: node.scale.map_or(DVec3::ONE, DVec3::from),
    }
}

/// A column-major 4x4 matrix whose last row is (0, 0, 0, 1) but for rounding.
pub(super) fn affine(m: &[f64; 16]) -> Option<DAffine3> {
    let last_row = [m[3], m[7], m[11], m[15] - 1.0];
    let column = |c: usize| DVec3::new(m[c], m[c + 1], m[c + 2]);
    last_row
        .iter()
        .all(|x| x.abs() < 1e-4)
        .then(|| DAffine3 { matrix3: DMat3::from_cols(column(0), column(4), column(8)), translation: column(12) })
}
