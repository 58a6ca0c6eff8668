//! Where a caster's shadow can fall on something visible.
//!
//! In: boxes around everything visible, the view, the light's reach; then a caster's box. Out: the pixels in which the
//! caster's volume can matter. Everywhere else the volume's count is zero on every visible surface, so that neither
//! z-pass nor z-fail misses it there. Distances are relative to the eye.

use super::reach::Reach;
use crate::bounds::Bounds;
use crate::convex::{Knife, Polyhedron};
use crate::scissor::{self, Rectangle};
use crate::view::{Projection, View};
use glam::{DVec2, DVec3, DVec4};

/// Pairs of faces of a box (axis, side) that share an edge, with the two corners of that edge.
const EDGES: [([usize; 2], [usize; 2]); 12] = [
    // Along x: faces of y and z.
    ([2, 4], [0, 1]),
    ([3, 4], [2, 3]),
    ([2, 5], [4, 5]),
    ([3, 5], [6, 7]),
    // Along y: faces of x and z.
    ([0, 4], [0, 2]),
    ([1, 4], [1, 3]),
    ([0, 5], [4, 6]),
    ([1, 5], [5, 7]),
    // Along z: faces of x and y.
    ([0, 2], [0, 4]),
    ([1, 2], [1, 5]),
    ([0, 3], [2, 6]),
    ([1, 3], [3, 7]),
];

/// A shadow volume's planes: 6 faces at most face the light, and 12 edges lie between those and the others.
const MOST: usize = 6 + 12;

/// What one light can reach of what the view shows.
#[derive(Clone, Debug, Default)]
pub(super) struct Receivers {
    visible: Vec<Polyhedron>,
    count: usize,
    rest: Polyhedron,
    knife: Knife,
}

impl Receivers {
    /// Prepares for a light; `boxes` are in world space.
    pub fn set(&mut self, boxes: &[Bounds], view: &View, reach: &Reach) {
        let frustum = frustum(view);
        self.count = 0;
        for bounds in boxes.iter().filter(|b| !b.is_empty()) {
            if self.count == self.visible.len() {
                self.visible.push(Polyhedron::default());
            }
            let visible = &mut self.visible[self.count];
            // Rounding may move a surface out of its box.
            let margin = 1e-6 * (bounds.half() + (bounds.center() - view.eye()).abs());
            let bounds = Bounds { min: bounds.min - margin, max: bounds.max + margin };
            visible.set_box(&bounds.corners().map(|c| c - view.eye()));
            for &plane in frustum.iter().chain(&reach.planes) {
                visible.cut(plane, &mut self.knife);
            }
            self.count += usize::from(!visible.is_empty());
        }
    }

    /// The pixels in which the shadow of a box (corners as [`Bounds::corners`] orders them) can be seen; `None` if in
    /// none. `light` is homogeneous.
    pub fn shadowed(&mut self, view: &View, corners: &[DVec3; 8], light: DVec4) -> Option<Rectangle> {
        let mut planes = [DVec4::ZERO; MOST];
        let planes = shadow_planes(corners, light, &mut planes);
        let mut pixels: Option<Rectangle> = None;
        for visible in &self.visible[..self.count] {
            self.rest.set(visible);
            for &plane in planes {
                self.rest.cut(plane, &mut self.knife);
            }
            if let Some(more) = scissor::of_visible(view, self.rest.points()) {
                pixels = Some(pixels.map_or(more, |known| scissor::union(known, more)));
            }
        }
        pixels
    }
}

/// The half spaces whose intersection is the shadow volume of a box: the box's faces towards the light, turned round, and
/// the planes through the light and the edges between those faces and the others.
fn shadow_planes<'p>(corners: &[DVec3; 8], light: DVec4, out: &'p mut [DVec4; MOST]) -> &'p [DVec4] {
    let center = corners.iter().sum::<DVec3>() / 8.0;
    let axes = [1, 2, 4].map(|i| corners[i] - corners[0]);
    let mut used = 0;
    let mut push = |plane: DVec4| {
        // All corners inside, rounding included.
        let n = plane.truncate();
        let least = corners.iter().map(|c| n.dot(*c)).fold(f64::INFINITY, f64::min);
        let margin = 1e-9 * (least.abs() + n.length() * (corners[7] - corners[0]).length());
        out[used] = n.extend(-(least - margin));
        used += 1;
    };
    // Faces by axis and side, as in `EDGES`.
    let faces: [(DVec3, bool); 6] = std::array::from_fn(|i| {
        let (axis, upper) = (i / 2, i % 2 == 1);
        let normal = axes[(axis + 1) % 3].cross(axes[(axis + 2) % 3]);
        let on = if upper { corners[1 << axis] } else { corners[0] };
        let outward = if normal.dot(on - center) >= 0.0 { normal } else { -normal };
        (outward, outward.dot(light.truncate() - on * light.w) > 0.0)
    });
    if faces.iter().all(|face| !face.1) {
        // The light is inside: shadow everywhere.
        return &[];
    }
    for &(outward, _) in faces.iter().filter(|face| face.1) {
        push((-outward).extend(0.0));
    }
    for ([f, g], [a, b]) in EDGES {
        if faces[f].1 != faces[g].1 {
            let a = corners[a];
            let (edge, to_light) = (corners[b] - a, light.truncate() - a * light.w);
            let normal = edge.cross(to_light);
            // Of an edge along the rays, only rounding is left.
            if normal.length_squared() <= 1e-12 * edge.length_squared() * to_light.length_squared() {
                continue;
            }
            let inward = if normal.dot(center - a) >= 0.0 { normal } else { -normal };
            push(inward.extend(0.0));
        }
    }
    &out[..used]
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
                reach.set(&LightKind::Point { position: at, range: 6.0 }, DVec3::ZERO);
            }
            let mut receivers = Receivers::default();
            receivers.set(&[room], &view, &reach);
            let pixels = receivers.shadowed(&view, &corners, light);
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
