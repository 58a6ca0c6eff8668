//! The node hierarchy, walked once.
//!
//! In: the validated document. Out: every node's world transform, and the default scene's nodes in depth-first order.

use super::error::{Result, invalid};
use super::schema::{Node, Root};
use glam::{DAffine3, DMat3, DQuat, DVec3};

/// World transforms and the order of visit. Nothing here recurses, so a chain of a million nodes is fine.
pub(super) struct Graph {
    /// By node, including those outside the default scene.
    pub world_from_node: Vec<DAffine3>,
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
        for &i in &all {
            // Parents come first and have left their own transform here.
            let world = world_from_node[i] * local_transform(i, &nodes[i], notices)?;
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
        Ok(Self { world_from_node, visits })
    }
}

/// Whether all entries are finite and so small that their products and squares are finite too.
pub(super) fn is_moderate(m: &DAffine3) -> bool {
    m.to_cols_array().iter().all(|x| x.abs() <= 1e30)
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
    let quaternion = node.rotation.map_or(DQuat::IDENTITY, DQuat::from_array);
    let rotation = unit_quaternion(quaternion).unwrap_or_else(|| {
        notices.push(format!("nodes[{i}].rotation has no length; the node is not rotated"));
        DQuat::IDENTITY
    });
    let scale = node.scale.map_or(DVec3::ONE, DVec3::from);
    let translation = node.translation.map_or(DVec3::ZERO, DVec3::from);
    Ok(DAffine3::from_scale_rotation_translation(scale, rotation, translation))
}

/// `q` at unit length. One that is a unit quaternion but for rounding stays bit for bit.
pub(super) fn unit_quaternion(q: DQuat) -> Option<DQuat> {
    let length = q.length();
    if (length - 1.0).abs() <= 4.0 * f64::EPSILON {
        return Some(q);
    }
    (length.is_finite() && length > 1e-12).then(|| q / length)
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
