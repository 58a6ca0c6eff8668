//! The boxes around everything visible, in a tree.
//!
//! In: boxes, frame after frame. Out: a binary tree over them, built along the longest axis, refitted while the boxes move and
//! built anew once that has made it loose.

use crate::bounds::Bounds;
use glam::DVec3;

/// How much looser than when it was built a tree may become.
const LOOSE: f64 = 1.3;

/// A box around others, or one of the boxes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Node {
    pub bounds: Bounds,
    /// The upper child; the lower one comes next after its parent. A box that was given has none.
    upper: Option<u32>,
}

/// A tree over boxes; node 0 is around everything.
#[derive(Clone, Debug, Default)]
pub(super) struct Tree {
    /// Those given that are not empty.
    boxes: Vec<Bounds>,
    pub nodes: Vec<Node>,
    /// The box of each node without children, in the order of the nodes.
    leaves: Vec<u32>,
    /// The sum of the nodes' sizes when they were built.
    built: f64,
}

impl Tree {
    /// Becomes a tree over `boxes`. Returns whether anything is another than before.
    pub fn fit(&mut self, boxes: &[Bounds]) -> bool {
        let given = || boxes.iter().copied().filter(|bounds| !bounds.is_empty());
        if self.boxes.iter().copied().eq(given()) {
            return false;
        }
        self.boxes.clear();
        self.boxes.extend(given());
        if self.leaves.len() != self.boxes.len() || !self.refit() {
            self.build();
        }
        true
    }

    /// The children of node `n`, unless it is a box that was given.
    pub fn children(&self, n: u32) -> Option<[u32; 2]> {
        self.nodes[n as usize].upper.map(|upper| [n + 1, upper])
    }

    /// Moves the nodes with their boxes; whether they are still good enough.
    fn refit(&mut self) -> bool {
        let mut leaf = self.leaves.len();
        for n in (0..self.nodes.len()).rev() {
            self.nodes[n].bounds = match self.nodes[n].upper {
                Some(upper) => around(&self.nodes[n + 1].bounds, &self.nodes[upper as usize].bounds),
                None => {
                    leaf -= 1;
                    self.boxes[self.leaves[leaf] as usize]
                }
            };
        }
        self.size() <= LOOSE * self.built
    }

    fn build(&mut self) {
        self.nodes.clear();
        self.leaves.clear();
        self.leaves.extend(0..self.boxes.len() as u32);
        if !self.boxes.is_empty() {
            divide(&self.boxes, &mut self.leaves, &mut self.nodes);
        }
        self.built = self.size();
    }

    fn size(&self) -> f64 {
        self.nodes.iter().map(|node| node.bounds.half().element_sum()).sum()
    }
}

/// Appends the nodes over some of the boxes, which it puts into the order of the nodes.
fn divide(boxes: &[Bounds], leaves: &mut [u32], nodes: &mut Vec<Node>) {
    let bounds = leaves.iter().map(|&leaf| boxes[leaf as usize]).fold(Bounds::EMPTY, |all, b| around(&all, &b));
    let parent = nodes.len();
    nodes.push(Node { bounds, upper: None });
    if leaves.len() < 2 {
        return;
    }
    let center = |leaf: u32| boxes[leaf as usize].center();
    let half = Bounds::of(leaves.iter().map(|&leaf| center(leaf))).half();
    let axis = (0..3).fold(0, |longest, axis| if half[axis] > half[longest] { axis } else { longest });
    let middle = leaves.len() / 2;
    leaves.select_nth_unstable_by(middle, |&a, &b| center(a)[axis].total_cmp(&center(b)[axis]).then(a.cmp(&b)));
    let (lower, upper) = leaves.split_at_mut(middle);
    divide(boxes, lower, nodes);
    nodes[parent].upper = Some(nodes.len() as u32);
    divide(boxes, upper, nodes);
}

fn around(a: &Bounds, b: &Bounds) -> Bounds {
    Bounds { min: DVec3::min(a.min, b.min), max: DVec3::max(a.max, b.max) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn boxes(count: usize, seed: u64) -> Vec<Bounds> {
        let mut numbers = zfail_testing::Random(seed);
        let mut random = || numbers.signed();
        let one = |_| {
            let center = DVec3::new(random(), random(), random()) * 10.0;
            Bounds { min: center - 0.2, max: center + 0.2 }
        };
        (0..count).map(one).collect()
    }

    /// Every box once, every node around its children.
    fn holds(tree: &Tree, expected: &[Bounds]) -> bool {
        let mut found = Vec::new();
        let mut rest = vec![0];
        while let Some(n) = rest.pop() {
            let bounds = tree.nodes[n as usize].bounds;
            match tree.children(n) {
                None => found.push(bounds),
                Some(children) => {
                    let inside = |child: &u32| {
                        let child = tree.nodes[*child as usize].bounds;
                        around(&bounds, &child) == bounds
                    };
                    if !children.iter().all(inside) {
                        return false;
                    }
                    rest.extend(children);
                }
            }
        }
        let key = |b: &Bounds| b.min.to_array().map(f64::to_bits);
        let sorted = |mut list: Vec<Bounds>| {
            list.sort_by_key(key);
            list
        };
        sorted(found) == sorted(expected.to_vec())
    }

    #[test]
    fn a_tree_follows_its_boxes() {
        let mut tree = Tree::default();
        let mut boxes = boxes(37, 1);
        assert!(tree.fit(&boxes) && holds(&tree, &boxes));
        assert!(!tree.fit(&boxes), "nothing moved");
        let built = tree.built;
        boxes.iter_mut().for_each(|b| b.max.y += 0.1);
        assert!(tree.fit(&boxes) && holds(&tree, &boxes) && tree.built == built, "refitted");
        boxes.reverse();
        assert!(tree.fit(&boxes) && holds(&tree, &boxes) && tree.built != built, "built anew");
        boxes.push(Bounds::EMPTY);
        assert!(!tree.fit(&boxes), "nothing of it can be seen");
        assert!(!holds(&tree, &boxes[1..]), "the comparison can fail");
        assert!(tree.fit(&boxes[..1]) && holds(&tree, &boxes[..1]));
        assert!(tree.fit(&[]) && tree.nodes.is_empty());
    }
}
