//! Which triangles lie near a ray.
//!
//! In: the soup. Out: a visitor of all triangles whose boxes a thickened ray meets. The tree comes from `obvhs`, with
//! boxes rounded outwards to f32; the traversal is in f64 and misses nothing.

use crate::soup::Triangle;
use glam::DVec3;
use obvhs::{Boundable, BvhBuildParams, aabb::Aabb, bvh2::Bvh2, bvh2::builder::build_bvh2};
use std::time::Duration;

/// A tree over the triangles of a soup.
pub(crate) struct Bvh {
    nodes: Vec<Node>,
    triangles: Vec<u32>,
}

/// A box, and either two children from `first` on or `count` triangles.
struct Node {
    center: DVec3,
    half: DVec3,
    first: u32,
    count: u32,
}

struct Boxed(Aabb);

impl Boundable for Boxed {
    fn aabb(&self) -> Aabb {
        self.0
    }
}

impl Bvh {
    pub fn new(triangles: &[Triangle]) -> Self {
        let boxes: Vec<_> = triangles.iter().map(|t| Boxed(outward(t))).collect();
        let mut time = Duration::ZERO;
        let tree = match boxes.is_empty() {
            true => Bvh2::default(),
            false => build_bvh2(&boxes, BvhBuildParams::medium_build(), &mut time),
        };
        let nodes = tree.nodes.iter().map(|n| {
            let (min, max) = (n.aabb().min.as_dvec3(), n.aabb().max.as_dvec3());
            // Half sizes grow by a little more than the rounding of centre and half.
            let half = (max - min) * 0.5 * (1.0 + 1e-14) + (max.abs() + min.abs()) * 1e-15;
            Node { center: (max + min) * 0.5, half, first: n.first_index, count: n.prim_count }
        });
        Self { nodes: nodes.collect(), triangles: tree.primitive_indices }
    }

    /// Calls `visit` for the triangles in all boxes that come within `width(farthest distance to the box)` of
    /// `origin + t * direction` for some t in `0..=reach`; `visit` may lower the reach. Nearer boxes come first.
    pub fn visit(
        &self,
        origin: DVec3,
        direction: DVec3,
        mut reach: f64,
        width: impl Fn(f64) -> f64,
        mut visit: impl FnMut(u32, &mut f64),
    ) {
        let inverse = direction.to_array().map(|d| if d.abs() < 1e-300 { 1e300 } else { 1.0 / d });
        let inverse = DVec3::from_array(inverse);
        let enter = |node: &Node| {
            let to = node.center - origin;
            let half = node.half + width(to.length() + node.half.length());
            let (a, b) = ((to - half) * inverse, (to + half) * inverse);
            let (enter, exit) = (a.min(b).max_element().max(0.0), a.max(b).min_element());
            (enter <= exit * (1.0 + 1e-12)).then_some(enter)
        };
        let Some(root) = self.nodes.first() else { return };
        let Some(start) = enter(root) else { return };
        let mut stack = vec![(0u32, start)];
        while let Some((index, entry)) = stack.pop() {
            if entry > reach {
                continue;
            }
            let node = &self.nodes[index as usize];
            if node.count > 0 {
                let first = node.first as usize;
                for &t in &self.triangles[first..first + node.count as usize] {
                    visit(t, &mut reach);
                }
                continue;
            }
            let near = enter(&self.nodes[node.first as usize]).map(|t| (node.first, t));
            let far = enter(&self.nodes[node.first as usize + 1]).map(|t| (node.first + 1, t));
            match (near, far) {
                (Some(a), Some(b)) if a.1 <= b.1 => stack.extend([b, a]),
                (Some(a), Some(b)) => stack.extend([a, b]),
                (a, b) => stack.extend(a.or(b)),
            }
        }
    }
}

/// The triangle's box with f32 corners that enclose it.
fn outward(triangle: &Triangle) -> Aabb {
    let [a, b, c] = triangle.v;
    let down = |x: f64| (x as f32).next_down();
    let up = |x: f64| (x as f32).next_up();
    let (min, max) = (a.min(b).min(c), a.max(b).max(c));
    Aabb::new(
        glam::Vec3A::new(down(min.x), down(min.y), down(min.z)),
        glam::Vec3A::new(up(max.x), up(max.y), up(max.z)),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    fn triangle(corner: DVec3) -> Triangle {
        let v = [corner, corner + DVec3::X, corner + DVec3::Y];
        Triangle {
            v,
            normal: DVec3::Z,
            neighbours: [None; 3],
            extent: 1.0,
            instance: 0,
            index: 0,
            visible: true,
            masked: false,
            double_sided: false,
            casts: true,
        }
    }

    fn visited(bvh: &Bvh, origin: DVec3, direction: DVec3, width: f64) -> Vec<u32> {
        let mut found = Vec::new();
        bvh.visit(origin, direction, f64::INFINITY, |_| width, |t, _| found.push(t));
        found.sort_unstable();
        found
    }

    #[test]
    fn nothing_and_one_triangle() {
        assert!(visited(&Bvh::new(&[]), DVec3::ZERO, DVec3::Z, 1.0).is_empty());
        let one = Bvh::new(&[triangle(DVec3::new(0.0, 0.0, 5.0))]);
        assert_eq!(visited(&one, DVec3::new(0.2, 0.2, 0.0), DVec3::Z, 0.0), [0]);
        assert!(visited(&one, DVec3::new(1.2, 0.2, 0.0), DVec3::Z, 0.0).is_empty());
        assert_eq!(visited(&one, DVec3::new(1.2, 0.2, 0.0), DVec3::Z, 0.25), [0]);
        assert!(visited(&one, DVec3::new(0.2, 0.2, 6.0), DVec3::Z, 0.25).is_empty());
    }

    #[test]
    fn a_stack_is_visited_whole_unless_the_reach_shrinks() {
        let stack: Vec<_> = (0..300).map(|i| triangle(DVec3::new(0.0, 0.0, f64::from(i)))).collect();
        let bvh = Bvh::new(&stack);
        let origin = DVec3::new(0.2, 0.2, -1.0);
        assert_eq!(visited(&bvh, origin, DVec3::Z, 0.0).len(), 300);
        let mut count = 0;
        bvh.visit(
            origin,
            DVec3::Z,
            f64::INFINITY,
            |_| 0.0,
            |_, reach| {
                count += 1;
                *reach = 1.0;
            },
        );
        assert!(count < 20, "nearest first: {count}");
    }
}
