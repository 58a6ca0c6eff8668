//! Where the walk through the nodes begins.
//!
//! In: the document, of which nothing is checked yet. Out: the nodes at which the scene begins, none of them below
//! another, and the certainty that every node from there on exists and hangs in no loop.

use super::schema::{Node, Root};
use crate::shared::error::{Fault, Result, invalid};

/// The roots of the scene that the file names, or of its first; all nodes without a parent if it has none or names none.
pub(super) fn choose(root: &Root, parent: &[Option<usize>], notices: &mut Vec<String>) -> Result<Vec<usize>> {
    let nodes = &root.nodes;
    let (roots, is_whole) = match named(root, notices)? {
        Some(roots) => (roots, false),
        None => ((0..nodes.len()).filter(|&i| parent[i].is_none()).collect(), true),
    };
    let reached = reach(nodes, &roots)?;
    if is_whole && let Some(lost) = reached.iter().position(|state| *state == State::Unknown) {
        return Err(hangs_below_itself(lost));
    }
    let mut is_below = vec![false; nodes.len()];
    let inner = nodes.iter().zip(&reached).filter(|(_, state)| **state != State::Unknown);
    inner.flat_map(|(node, _)| &node.children).for_each(|&child| is_below[child] = true);
    let count = roots.len();
    let roots: Vec<usize> = roots.into_iter().filter(|&node| !is_below[node]).collect();
    if roots.len() < count {
        let what = "the scene lists nodes that hang below others of it";
        notices.push(format!("{what}: {} drawn where they hang, once", count - roots.len()));
    }
    Ok(roots)
}

/// What the scene to draw lists, each once; `None` if all there is shall be drawn.
fn named(root: &Root, notices: &mut Vec<String>) -> Result<Option<Vec<usize>>> {
    let index = root.scene.unwrap_or(0);
    let Some(scene) = root.scenes.get(index) else {
        if root.scene.is_some() {
            let count = root.scenes.len();
            notices.push(format!("scene is {index}, but the file has {count} scenes: all its nodes are drawn"));
        }
        return Ok(None);
    };
    if scene.nodes.is_empty() && !root.nodes.is_empty() {
        notices.push(format!("scenes[{index}] names no nodes: all nodes of the file are drawn"));
        return Ok(None);
    }
    let mut is_listed = vec![false; root.nodes.len()];
    let mut listed = Vec::with_capacity(scene.nodes.len());
    for (j, &node) in scene.nodes.iter().enumerate() {
        let element = || format!("scenes[{index}].nodes[{j}]");
        match is_listed.get_mut(node) {
            None => return Err(dangling(element(), node, root.nodes.len())),
            Some(true) => notices.push(format!("{} names nodes[{node}] twice: drawn once", element())),
            Some(known) => {
                *known = true;
                listed.push(node);
            }
        }
    }
    Ok(Some(listed))
}

fn dangling(element: String, node: usize, count: usize) -> Fault {
    invalid(element, format!("refers to nodes[{node}], but the file has {count}"))
}

pub(super) fn hangs_below_itself(node: usize) -> Fault {
    invalid(format!("nodes[{node}]"), "is or hangs below its own descendant, a loop")
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum State {
    Unknown,
    /// On the way from a root to where the walk is.
    Open,
    Done,
}

/// Which nodes can be reached from `roots`; an error if that leads to one that is not there, or back.
fn reach(nodes: &[Node], roots: &[usize]) -> Result<Vec<State>> {
    let mut states = vec![State::Unknown; nodes.len()];
    // Nodes with the next of their children.
    let mut way: Vec<(usize, usize)> = Vec::new();
    for &root in roots {
        if states[root] == State::Unknown {
            states[root] = State::Open;
            way.push((root, 0));
        }
        while let Some((node, next)) = way.last_mut() {
            let (node, j) = (*node, *next);
            *next += 1;
            let Some(&child) = nodes[node].children.get(j) else {
                states[node] = State::Done;
                way.pop();
                continue;
            };
            match states.get(child) {
                None => return Err(dangling(format!("nodes[{node}].children[{j}]"), child, nodes.len())),
                Some(State::Open) => return Err(hangs_below_itself(child)),
                Some(State::Done) => {}
                Some(State::Unknown) => {
                    states[child] = State::Open;
                    way.push((child, 0));
                }
            }
        }
    }
    Ok(states)
}
