//! The node hierarchy, walked once.
//!
//! In: the document, of which nothing is checked yet. Out: the nodes of the scene to draw in depth-first order, each as
//! often as it is drawn: a node with two parents hangs below both.

use super::roots;
use super::schema::{Node, Root};
use crate::shared::error::{Result, invalid, refused};
use crate::shared::limits::Budget;
use glam::{DAffine3, DMat3, DQuat, DVec3};
use rustc_hash::FxHashMap;
use zfail_scene::animate::Trs;
use zfail_scene::placement::{is_moderate, unit_quaternion};

/// The scene's nodes. Nothing here recurses, so a chain of a million nodes is fine.
pub(super) struct Graph {
    /// The scene's nodes, parents before children, in the order of the file.
    pub visits: Vec<Visit>,
    /// By node, the first of its visits.
    first: Vec<Option<usize>>,
    /// By node, its first parent.
    parent: Vec<Option<usize>>,
}

/// A node of the scene, once for every path from a root to it.
pub(super) struct Visit {
    /// Index into the document's nodes.
    pub node: usize,
    /// Index of the visit of the node above.
    pub parent: Option<usize>,
    /// Index of the first visit after this node's descendants.
    pub end: usize,
    pub parent_from_node: DAffine3,
    pub world_from_node: DAffine3,
    /// Neither this node nor an ancestor says `castShadow: false`.
    pub casts_shadow: bool,
    /// The same of `receiveShadow`.
    pub receives_shadow: bool,
    /// Neither this node nor one above is hidden (KHR_node_visibility).
    pub is_visible: bool,
}

impl Graph {
    /// Walks the scene that the file names, or its first, or all its nodes if it has no scene.
    pub fn new(root: &Root, budget: &Budget, notices: &mut Vec<String>) -> Result<Self> {
        let nodes = &root.nodes;
        let mut parent = vec![None; nodes.len()];
        for (i, child) in nodes.iter().enumerate().flat_map(|(i, n)| n.children.iter().map(move |&c| (i, c))) {
            if let Some(parent @ None) = parent.get_mut(child) {
                *parent = Some(i);
            }
        }
        let roots = roots::choose(root, &parent, notices)?;
        let visits = walk(nodes, &roots, budget, notices)?;
        let mut first = vec![None; nodes.len()];
        visits.iter().enumerate().rev().for_each(|(v, visit)| first[visit.node] = Some(v));
        let repeated = visits.len() - first.iter().flatten().count();
        if repeated > 0 {
            let plural = if repeated == 1 { "node is" } else { "nodes are" };
            notices.push(format!("{repeated} {plural} drawn again below a second parent"));
        }
        let hides = |visit: &&Visit| !visit.is_visible && visit.parent.is_none_or(|above| visits[above].is_visible);
        let hidden = visits.iter().filter(hides).count();
        if hidden > 0 {
            let plural = if hidden == 1 { " is" } else { "s are" };
            let consequence = "neither drawn nor casting, with all that hangs below";
            notices.push(format!("{hidden} node{plural} hidden (KHR_node_visibility): {consequence}"));
        }
        Ok(Self { visits, first, parent })
    }

    /// The first visit of `node`, if the scene has it.
    pub fn visit_of(&self, node: usize) -> Option<usize> {
        self.first[node]
    }

    /// The world transform of a node that may lie outside of the scene, as joints do. What it takes to find out is kept in
    /// `known`.
    pub fn world_from_node(
        &self,
        nodes: &[Node],
        node: usize,
        known: &mut FxHashMap<usize, DAffine3>,
    ) -> Result<DAffine3> {
        let mut below = Vec::new();
        let mut at = Some(node);
        let mut world = loop {
            let Some(above) = at else { break DAffine3::IDENTITY };
            if let Some(visit) = self.first[above] {
                break self.visits[visit].world_from_node;
            }
            if let Some(world) = known.get(&above) {
                break *world;
            }
            if below.len() > nodes.len() {
                return Err(roots::hangs_below_itself(node));
            }
            below.push(above);
            at = self.parent[above];
        };
        for node in below.into_iter().rev() {
            world = moderate(node, world * local_transform(node, &nodes[node], &mut Vec::new())?)?;
            known.insert(node, world);
        }
        Ok(world)
    }
}

fn moderate(node: usize, world: DAffine3) -> Result<DAffine3> {
    if is_moderate(&world) {
        return Ok(world);
    }
    let problem = "its world transform is beyond all measure";
    Err(refused(format!("nodes[{node}]"), problem, "give it and the nodes above it smaller scales and translations"))
}

/// The visits from `roots` on, which reach no loop.
fn walk(nodes: &[Node], roots: &[usize], budget: &Budget, notices: &mut Vec<String>) -> Result<Vec<Visit>> {
    /// Bytes that a further visit of the same node costs, with its instance and what is made of that. The nodes themselves
    /// are bounded by the file, but there may be a great many ways to each.
    const AGAIN: u64 = 16384;
    let mut visits: Vec<Visit> = Vec::with_capacity(nodes.len());
    let mut is_known = vec![false; nodes.len()];
    let mut twice = vec![usize::MAX; nodes.len()];
    let mut stack: Vec<(usize, Option<usize>)> = roots.iter().rev().map(|&node| (node, None)).collect();
    while let Some((node, parent)) = stack.pop() {
        let source = &nodes[node];
        if std::mem::replace(&mut is_known[node], true) {
            budget.charge(1, AGAIN, || format!("nodes[{node}], reached by many ways"))?;
        }
        let parent_from_node = local_transform(node, source, notices)?;
        let above = parent.map(|parent| &visits[parent]);
        let world_from_parent = above.map_or(DAffine3::IDENTITY, |above| above.world_from_node);
        let own = |word: &str| source.extras.get(word).and_then(serde_json::Value::as_bool) != Some(false);
        let visit = Visit {
            node,
            parent,
            end: visits.len() + 1,
            parent_from_node,
            world_from_node: moderate(node, world_from_parent * parent_from_node)?,
            casts_shadow: above.is_none_or(|above| above.casts_shadow) && own("castShadow"),
            receives_shadow: above.is_none_or(|above| above.receives_shadow) && own("receiveShadow"),
            is_visible: above.is_none_or(|above| above.is_visible) && source.extensions.visibility.visible,
        };
        let here = visits.len();
        visits.push(visit);
        let before = stack.len();
        for (j, &child) in source.children.iter().enumerate() {
            if twice[child] == here {
                notices.push(format!("nodes[{node}].children[{j}] names nodes[{child}] twice: drawn once"));
            } else {
                twice[child] = here;
                stack.push((child, Some(here)));
            }
        }
        stack[before..].reverse();
    }
    for v in (0..visits.len()).rev() {
        if let Some(parent) = visits[v].parent {
            visits[parent].end = visits[parent].end.max(visits[v].end);
        }
    }
    Ok(visits)
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
fn affine(m: &[f64; 16]) -> Option<DAffine3> {
    let last_row = [m[3], m[7], m[11], m[15] - 1.0];
    last_row.iter().all(|x| x.abs() < 1e-4).then(|| upper_rows(m))
}

/// A column-major 4x4 matrix without its last row.
pub(super) fn upper_rows(m: &[f64; 16]) -> DAffine3 {
    let column = |c: usize| DVec3::new(m[c], m[c + 1], m[c + 2]);
    DAffine3 { matrix3: DMat3::from_cols(column(0), column(4), column(8)), translation: column(12) }
}
