//! Which triangles lie near a ray.
//!
//! In: the soup. Out: a visitor of all triangles whose boxes a thickened ray meets. There is a tree over the instances and one
//! over the triangles of every mesh, whose boxes are placed with the instance on the way. The trees come from `obvhs`, with
//! boxes rounded outwards to f32; the traversal is in f64 and misses nothing.

use crate::soup::{Face, Id, Placement, Soup};
use glam::{DMat3, DVec3, Vec3A};
use obvhs::{Boundable, BvhBuildParams, aabb::Aabb, bvh2::Bvh2, bvh2::builder::build_bvh2};
use rayon::prelude::*;
use std::time::Duration;
use zfail_plan::bounds::Bounds;

/// Trees over a soup.
pub(crate) struct Bvh {
    instances: Tree,
    meshes: Vec<Tree>,
}

/// A ray that widens.
struct Beam<W> {
    origin: DVec3,
    inverse: DVec3,
    /// How far from it something at most so far away still counts.
    width: W,
}

impl Bvh {
    pub fn new(soup: &Soup) -> Self {
        let mesh = |faces: &Vec<Face>| Tree::new(&faces.iter().map(|f| Bounds::of(f.corners)).collect::<Vec<_>>());
        let meshes: Vec<Tree> = soup.faces.par_iter().map(mesh).collect();
        let placed = |placement: &Option<Placement>| {
            let root = placement.as_ref().and_then(|place| Some((place, meshes[place.mesh].nodes.first()?)));
            root.map_or(Bounds::EMPTY, |(place, root)| {
                let (center, half) = root.placed(place);
                Bounds { min: center - half, max: center + half }
            })
        };
        let instances = Tree::new(&soup.placements.iter().map(placed).collect::<Vec<_>>());
        Self { instances, meshes }
    }

    /// Calls `visit` for the triangles in all boxes that come within `width(farthest distance to the box)` of
    /// `origin + t * direction` for some t in `0..=reach`; `visit` may lower the reach. Nearer boxes come first.
    pub fn visit(
        &self,
        soup: &Soup,
        origin: DVec3,
        direction: DVec3,
        mut reach: f64,
        width: impl Fn(f64) -> f64,
        mut visit: impl FnMut(Id, &mut f64),
    ) {
        let inverse = direction.to_array().map(|d| if d.abs() < 1e-300 { 1e300 } else { 1.0 / d });
        let beam = Beam { origin, inverse: DVec3::from_array(inverse), width };
        let as_it_is = |node: &Node| (node.center, node.half);
        self.instances.walk(&beam, &mut reach, as_it_is, |instance, reach| {
            if let Some(place) = &soup.placements[instance as usize] {
                self.meshes[place.mesh].walk(
                    &beam,
                    reach,
                    |node| node.placed(place),
                    |face, reach| {
                        visit(Id { instance, face }, reach);
                    },
                );
            }
        });
    }
}

impl<W: Fn(f64) -> f64> Beam<W> {
    /// Where it first meets a box.
    fn enter(&self, (center, half): (DVec3, DVec3)) -> Option<f64> {
        let to = center - self.origin;
        let half = half + (self.width)(to.length() + half.length());
        let (a, b) = ((to - half) * self.inverse, (to + half) * self.inverse);
        let (enter, exit) = (a.min(b).max_element().max(0.0), a.max(b).min_element());
        (enter <= exit * (1.0 + 1e-12)).then_some(enter)
    }
}

/// A tree over boxes.
struct Tree {
    nodes: Vec<Node>,
    items: Vec<u32>,
}

/// A box, and either two children from `first` on or `count` items.
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

impl Tree {
    /// Over those of `boxes` that are not empty.
    fn new(boxes: &[Bounds]) -> Self {
        let kept: Vec<u32> = (0..boxes.len() as u32).filter(|&i| !boxes[i as usize].is_empty()).collect();
        let boxed: Vec<_> = kept.iter().map(|&i| Boxed(outward(&boxes[i as usize]))).collect();
        let mut time = Duration::ZERO;
        let tree = match boxed.is_empty() {
            true => Bvh2::default(),
            false => build_bvh2(&boxed, BvhBuildParams::medium_build(), &mut time),
        };
        let nodes = tree.nodes.iter().map(|n| {
            let (min, max) = (n.aabb().min.as_dvec3(), n.aabb().max.as_dvec3());
            // Half sizes grow by a little more than the rounding of centre and half.
            let half = (max - min) * 0.5 * (1.0 + 1e-14) + (max.abs() + min.abs()) * 1e-15;
            Node { center: (max + min) * 0.5, half, first: n.first_index, count: n.prim_count }
        });
        let nodes = nodes.collect();
        Self { nodes, items: tree.primitive_indices.iter().map(|&i| kept[i as usize]).collect() }
    }

    /// Calls `visit` for the items in all boxes that `beam` meets, which are where `place` puts them.
    fn walk<W: Fn(f64) -> f64>(
        &self,
        beam: &Beam<W>,
        reach: &mut f64,
        place: impl Fn(&Node) -> (DVec3, DVec3),
        mut visit: impl FnMut(u32, &mut f64),
    ) {
        let enter = |index: u32| beam.enter(place(&self.nodes[index as usize])).map(|t| (index, t));
        if self.nodes.is_empty() {
            return;
        }
        let mut stack: Vec<(u32, f64)> = enter(0).into_iter().collect();
        while let Some((index, entry)) = stack.pop() {
            if entry > *reach {
                continue;
            }
            let node = &self.nodes[index as usize];
            if node.count > 0 {
                let first = node.first as usize;
                for &item in &self.items[first..first + node.count as usize] {
                    visit(item, reach);
                }
                continue;
            }
            match (enter(node.first), enter(node.first + 1)) {
                (Some(a), Some(b)) if a.1 <= b.1 => stack.extend([b, a]),
                (Some(a), Some(b)) => stack.extend([a, b]),
                (a, b) => stack.extend(a.or(b)),
            }
        }
    }
}

impl Node {
    /// Centre and half of the box around the box in its place, with whatever rounding may do to the triangles in it.
    fn placed(&self, place: &Placement) -> (DVec3, DVec3) {
        let DMat3 { x_axis, y_axis, z_axis } = place.linear;
        let linear = DMat3::from_cols(x_axis.abs(), y_axis.abs(), z_axis.abs());
        let size =
            place.magnitude * (self.center.abs() + self.half).element_sum() + place.translation.abs().max_element();
        (place.linear * self.center + place.translation, linear * self.half + 4e-15 * size)
    }
}

/// A box with f32 corners that encloses it.
fn outward(bounds: &Bounds) -> Aabb {
    let [down, up] = [f32::next_down, f32::next_up]
        .map(|round| move |p: DVec3| Vec3A::from_array(p.to_array().map(|x| round(x as f32))));
    Aabb::new(down(bounds.min), up(bounds.max))
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DAffine3;
    use zfail_scene::{Instance, Mesh, Scene};

    /// A triangle in the plane z = 0, at these places.
    fn soup(places: &[DAffine3]) -> Soup {
        let positions = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
        let mesh = Mesh { positions, triangles: vec![[0, 1, 2]], ..Mesh::default() };
        let instance = |&world_from_object: &DAffine3| Instance {
            name: String::new(),
            mesh: 0,
            world_from_object,
            casts_shadow: true,
            receives_shadow: true,
        };
        let instances = places.iter().map(instance).collect();
        let mut soup = Soup::new(&Scene { meshes: vec![mesh], instances, ..Scene::default() });
        // Relative to the world's own origin.
        for place in soup.placements.iter_mut().flatten() {
            place.translation += soup.origin;
        }
        soup.origin = DVec3::ZERO;
        soup
    }

    fn at(x: f64, y: f64, z: f64) -> DAffine3 {
        DAffine3::from_translation(DVec3::new(x, y, z))
    }

    fn visited(soup: &Soup, origin: DVec3, direction: DVec3, width: f64) -> Vec<u32> {
        let mut found = Vec::new();
        Bvh::new(soup).visit(soup, origin, direction, f64::INFINITY, |_| width, |id, _| found.push(id.instance));
        found.sort_unstable();
        found
    }

    #[test]
    fn nothing_and_one_triangle() {
        assert!(visited(&soup(&[]), DVec3::ZERO, DVec3::Z, 1.0).is_empty());
        let one = soup(&[at(0.0, 0.0, 5.0)]);
        assert_eq!(visited(&one, DVec3::new(0.2, 0.2, 0.0), DVec3::Z, 0.0), [0]);
        assert!(visited(&one, DVec3::new(1.2, 0.2, 0.0), DVec3::Z, 0.0).is_empty());
        assert_eq!(visited(&one, DVec3::new(1.2, 0.2, 0.0), DVec3::Z, 0.25), [0]);
        assert!(visited(&one, DVec3::new(0.2, 0.2, 6.0), DVec3::Z, 0.25).is_empty());
    }

    #[test]
    fn a_stack_is_visited_whole_unless_the_reach_shrinks() {
        let stack = soup(&(0..300).map(|i| at(0.0, 0.0, f64::from(i))).collect::<Vec<_>>());
        let origin = DVec3::new(0.2, 0.2, -1.0);
        assert_eq!(visited(&stack, origin, DVec3::Z, 0.0).len(), 300);
        let mut count = 0;
        let shrink = |_: Id, reach: &mut f64| {
            count += 1;
            *reach = 1.0;
        };
        Bvh::new(&stack).visit(&stack, origin, DVec3::Z, f64::INFINITY, |_| 0.0, shrink);
        assert!(count < 20, "nearest first: {count}");
    }

    #[test]
    fn instances_are_found_where_they_are() {
        let turned = DAffine3::from_rotation_y(0.7) * DAffine3::from_scale(DVec3::new(3.0, -0.5, 2.0));
        let soup = soup(&[at(5.0, 0.0, 0.0) * turned, at(0.0, 5.0, 0.0), at(5.0, 0.0, 3.0) * turned]);
        for instance in [0, 1, 2] {
            let triangle = soup.triangle(Id { instance, face: 0 });
            let middle = triangle.v.iter().sum::<DVec3>() / 3.0;
            let way = DVec3::new(0.0, 1e-3, if instance == 1 { 1.0 } else { -1.0 });
            assert!(visited(&soup, middle - way, way, 0.0).contains(&instance), "{instance}");
            assert!(visited(&soup, middle + way * 9.0, way, 0.0).is_empty(), "{instance}: it is behind");
        }
        // Mirrored, the front is still the front.
        let normal = |i| soup.triangle(Id { instance: i, face: 0 }).normal;
        assert!(normal(0).dot(turned.matrix3.inverse().transpose() * DVec3::Z) > 0.0);
    }
}
