//! Where a caster's shadow can fall on something visible.
//!
//! In: boxes around everything visible, the view, the light's reach; then a caster's box. Out: the pixels in which the
//! caster's volume can matter. Everywhere else the volume's count is zero on every visible surface, so that neither
//! z-pass nor z-fail misses it there. Distances are relative to the eye.
//!
//! What lies in a caster's rectangle but not in its shadow's depth is no reason to draw anything there: with a box for every object this
//! is what `SetDepthBounds` of McGuire et al. 2003, section 6, does for the rectangle as a whole.

mod shadow;
mod tree;

use super::reach::Reach;
use crate::bounds::Bounds;
use crate::convex::{Knife, Polyhedron};
use crate::scissor::{self, Rectangle};
use crate::view::{Projection, View};
use glam::{DVec2, DVec3, DVec4};
use tree::Tree;

/// Boxes that are looked into for all casters of a light together, about; of the rest, what is within is not asked.
const LOOKS: usize = 8192;
/// The fewest and the most for one caster.
const FEW_OR_MANY: [usize; 2] = [8, 32];

/// What one light can reach of what the view shows.
#[derive(Clone, Debug, Default)]
pub(super) struct Receivers {
    tree: Tree,
    /// Tells lights and frames apart.
    now: u64,
    /// What is visible and reached lies within `dot(xyz, p) + w >= 0` for all of these.
    planes: Vec<DVec4>,
    eye: DVec3,
    /// Boxes that are looked into for one caster.
    looks: usize,
}

/// Memory for looking, which belongs to one thread at a time.
#[derive(Clone, Debug, Default)]
pub(super) struct Looking {
    /// By node, as far as it has been asked for.
    visible: Vec<Visible>,
    rest: Polyhedron,
    knife: Knife,
    /// Nodes to look at, with the number of their pixels.
    waiting: Vec<(u64, u32)>,
}

/// What can be seen and reached of a node's box.
#[derive(Clone, Debug, Default)]
struct Visible {
    /// For which light and frame it is known.
    known: u64,
    /// The box, relative to the eye.
    center: DVec3,
    half: DVec3,
    polyhedron: Polyhedron,
    pixels: Option<Rectangle>,
}

/// Where a box is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Side {
    Outside,
    Across,
    Inside,
}

impl Receivers {
    /// Takes the frame's boxes, in world space, for so many casters.
    pub fn fit(&mut self, boxes: &[Bounds], casters: usize) {
        self.tree.fit(boxes);
        let [few, many] = FEW_OR_MANY;
        self.looks = (LOOKS / casters.max(1)).clamp(few, many);
    }

    /// Prepares for a light.
    pub fn set(&mut self, view: &View, reach: &Reach) {
        self.now += 1;
        self.eye = view.eye();
        self.planes.clear();
        self.planes.extend(frustum(view));
        self.planes.extend(&reach.planes);
    }

    /// The pixels in which the shadow of a box (corners as [`Bounds::corners`] orders them) can be seen; `None` if in
    /// none. `light` is homogeneous.
    pub fn shadowed(
        &self,
        looking: &mut Looking,
        view: &View,
        corners: &[DVec3; 8],
        light: DVec4,
    ) -> Option<Rectangle> {
        let mut planes = [DVec4::ZERO; shadow::MOST];
        let planes = shadow::planes(corners, light, &mut planes);
        looking.visible.resize_with(self.tree.nodes.len(), Visible::default);
        looking.waiting.clear();
        let (mut pixels, mut looks) = (None, 0);
        self.wait(looking, view, (!self.tree.nodes.is_empty()).then_some(0));
        while let Some((_, n)) = take_largest(&mut looking.waiting) {
            let Some(whole) = self.pixels(looking, view, n) else { continue };
            if pixels.is_some_and(|known| scissor::union(known, whole) == known) {
                continue;
            }
            let visible = &looking.visible[n as usize];
            let more = match (visible.side(planes), self.tree.children(n)) {
                (Side::Outside, _) => None,
                (Side::Inside, _) => Some(whole),
                (Side::Across, Some(children)) if looks < self.looks => {
                    looks += 1;
                    self.wait(looking, view, children);
                    continue;
                }
                (Side::Across, _) => {
                    looking.rest.set(&visible.polyhedron);
                    planes.iter().for_each(|&plane| looking.rest.cut(plane, &mut looking.knife));
                    scissor::of_visible(view, looking.rest.points())
                }
            };
            if let Some(more) = more {
                pixels = Some(pixels.map_or(more, |known| scissor::union(known, more)));
            }
        }
        pixels
    }

    /// Lets nodes of which anything can be seen and reached wait, with how large they are.
    fn wait(&self, looking: &mut Looking, view: &View, nodes: impl IntoIterator<Item = u32>) {
        for n in nodes {
            if let Some([_, _, width, height]) = self.pixels(looking, view, n) {
                looking.waiting.push((u64::from(width) * u64::from(height), n));
            }
        }
    }

    /// The pixels of what can be seen and reached of node `n`.
    fn pixels(&self, looking: &mut Looking, view: &View, n: u32) -> Option<Rectangle> {
        let visible = &mut looking.visible[n as usize];
        if visible.known != self.now {
            visible.known = self.now;
            let bounds = grown(&self.tree.nodes[n as usize].bounds, self.eye);
            (visible.center, visible.half) = (bounds.center(), bounds.half());
            visible.polyhedron.set_box(&bounds.corners());
            self.planes.iter().for_each(|&plane| visible.polyhedron.cut(plane, &mut looking.knife));
            visible.pixels = scissor::of_visible(view, visible.polyhedron.points());
        }
        visible.pixels
    }
}

impl Visible {
    /// On which side of `planes` the node's box lies; across if in doubt.
    fn side(&self, planes: &[DVec4]) -> Side {
        let mut side = Side::Inside;
        for plane in planes {
            let normal = plane.truncate();
            let (height, extent) = (normal.dot(self.center) + plane.w, normal.abs().dot(self.half));
            if height + extent < 0.0 {
                return Side::Outside;
            }
            if height - extent < 0.0 {
                side = Side::Across;
            }
        }
        side
    }
}

/// The one with the most pixels: what lies within its pixels need not be looked at afterwards.
fn take_largest(waiting: &mut Vec<(u64, u32)>) -> Option<(u64, u32)> {
    let largest = (0..waiting.len()).max_by_key(|&i| waiting[i])?;
    Some(waiting.swap_remove(largest))
}

/// A box relative to the eye, with room for surfaces that rounding has moved out of it.
fn grown(bounds: &Bounds, eye: DVec3) -> Bounds {
    let (center, half) = (bounds.center() - eye, bounds.half());
    let half = half + 1e-6 * (half + center.abs());
    Bounds { min: center - half, max: center + half }
}

/// The view volume's planes, relative to the eye, grown by a pixel.
fn frustum(view: &View) -> [DVec4; 5] {
    let (x, y) = (view.world_from_view.matrix3.x_axis, view.world_from_view.matrix3.y_axis);
    let forward = -view.world_from_view.matrix3.z_axis;
    let grown = DVec2::from(view.size.map(|s| 1.0 + 2.0 / f64::from(s)));
    // Nothing nearer is visible.
    let near = forward.extend(-view.near() + 1e-6 * view.near().abs());
    let [lower, upper] = [-1.0, 1.0].map(|border| view.on_image_plane(grown * border));
    match view.projection {
        Projection::Perspective { .. } => {
            let side = |n: DVec3| n.extend(0.0);
            [
                side(forward * upper.x - x),
                side(x - forward * lower.x),
                side(forward * upper.y - y),
                side(y - forward * lower.y),
                near,
            ]
        }
        Projection::Orthographic { .. } => {
            [(-x).extend(upper.x), x.extend(-lower.x), (-y).extend(upper.y), y.extend(-lower.y), near]
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::light::LightKind;
    use crate::plan::ShadowLight;
    use glam::DAffine3;

    #[test]
    fn every_visible_point_in_a_shadow_lies_in_its_pixels() {
        let projection = Projection::Perspective { yfov: 1.0, near: 0.1, far: None };
        let view = View::new(DAffine3::IDENTITY, projection, [160, 120]);
        let mut numbers = zfail_testing::Random(21);
        let mut random = || numbers.signed();
        let (mut shadowed, mut small) = (0, 0);
        for round in 0..400 {
            let room =
                Bounds { min: DVec3::new(-6.0, -2.0, -12.0), max: DVec3::new(6.0, -1.0 + 3.0 * random().abs(), 2.0) };
            let center = DVec3::new(4.0 * random(), 1.5 * random(), -6.0 + 5.0 * random());
            let half = DVec3::new(random(), random(), random()).abs() * 0.5 + 0.05;
            let corners = Bounds { min: center - half, max: center + half }.corners();
            let at = DVec3::new(5.0 * random(), 3.0 * random(), -5.0 + 6.0 * random());
            // A sun, also along edges of boxes but for rounding, or a lamp.
            let light = match round % 3 {
                0 if round % 2 == 0 => DVec4::new(1e-17 * random(), 1.0, 1e-17 * random(), 0.0),
                0 => at.extend(0.0),
                _ => at.extend(1.0),
            };
            let mut reach = Reach::default();
            if round % 3 == 1 {
                reach.set(&ShadowLight::new(LightKind::Point { position: at, range: 6.0 }), DVec3::ZERO);
            }
            let mut receivers = Receivers::default();
            // One box, or many side by side that are the same one.
            let mut boxes = vec![room];
            for cut in 0..if round % 2 == 0 { 0 } else { 30 } {
                let mut piece = boxes.swap_remove(cut * 7 % boxes.len());
                let mut other = piece;
                let middle = piece.min[cut % 3] + piece.half()[cut % 3] * (1.0 + 0.9 * random());
                (piece.max[cut % 3], other.min[cut % 3]) = (middle, middle);
                boxes.extend([piece, other]);
            }
            receivers.fit(&boxes, 1);
            receivers.set(&view, &reach);
            let pixels = receivers.shadowed(&mut Looking::default(), &view, &corners, light);
            small += usize::from(pixels.is_none_or(|[_, _, w, h]| w * h < 4800));
            for _ in 0..300 {
                let on = center + half * DVec3::new(random(), random(), random());
                let away = (on * light.w - light.truncate()) * (20.0 * random().abs());
                let p = on + away;
                let reached = reach.planes.is_empty() || p.distance(at) <= 6.0;
                let visible = p.cmpge(room.min).all() && p.cmple(room.max).all() && p.z < -0.1 && reached;
                let c = view.clip_from_view() * p.extend(1.0);
                if visible && c.x.abs() < c.w && c.y.abs() < c.w {
                    shadowed += 1;
                    let [x, y, width, height] = pixels.unwrap_or_else(|| panic!("{p} is shadowed"));
                    let [px, py] = [(80.0 + 80.0 * c.x / c.w) as u32, (60.0 - 60.0 * c.y / c.w) as u32];
                    assert!((x..x + width).contains(&px) && (y..y + height).contains(&py), "{p}: {px},{py} {pixels:?}");
                }
            }
        }
        assert!(shadowed > 1000 && small > 50, "{shadowed} points, {small} small rectangles");
    }
}
