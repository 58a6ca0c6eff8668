//! Whether light reaches a surface at a pixel, and how many casters it crosses on the way.
//!
//! In: a face that the pixel may show. Out: the lit verdict and the count, each with a doubt where guard E2 or E3 finds
//! that it would change.

use crate::{
    bvh::Bvh,
    cast::CastTable,
    cone::{self, Apex, Place, Slack},
    guard::{Doubt, FACING, Guards, ROUNDING, SNAP},
    lens::{Lens, Ray},
    sight::{Face, surface_error},
    soup::{Id, Soup, Triangle},
};
use glam::DVec3;
use zfail_plan::light::LightKind;
use zfail_scene::Light;

/// The light as the soup's frame sees it.
#[derive(Clone, Debug)]
pub(crate) struct Source {
    pub apex: Apex,
    /// With positions relative to the soup's origin.
    pub light: Light,
    /// Per instance: casts no shadow from this light.
    pub excluded: Vec<bool>,
}

/// The answer for one face.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Shade {
    pub lit: bool,
    pub count: i32,
    pub reached: bool,
    pub lit_doubt: Option<Doubt>,
    pub count_doubt: Option<Doubt>,
    pub reach_doubt: Option<Doubt>,
}

/// Shades faces for one light.
pub(crate) struct Shader<'a> {
    pub soup: &'a Soup,
    pub bvh: &'a Bvh,
    pub lens: &'a Lens,
    pub guards: &'a Guards,
    pub source: &'a Source,
    pub casts: &'a CastTable,
}

/// What blocks the light: whether anything does, and the sum of weights.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct Blockers {
    any: bool,
    count: i32,
}

impl Blockers {
    fn add(&mut self, weight: i32) {
        self.any = true;
        self.count += weight;
    }
}

/// A triangle whose crossing is not the same everywhere within the guards.
struct Close {
    triangle: Triangle,
    normals: [DVec3; 3],
    faces_light: bool,
    weight: i32,
    /// It meets the face in a vertex or an edge and is turned alike: going behind one is going behind both.
    continues_face: bool,
}

impl Close {
    /// Whether the ray from the light to `point`, which the eye sees along `view`, crosses the triangle.
    fn is_crossed(&self, point: DVec3, view: DVec3) -> bool {
        let t = &self.triangle;
        let height = t.normal.dot(point - t.v[0]);
        let noise = 1e-12 * t.normal.length() * (point.length() + point.distance(t.v[0]));
        // A point in the plane counts as being just on the eye's side of it, as it does on its own triangle.
        let in_front = if height.abs() <= noise { t.normal.dot(view) < 0.0 } else { height > 0.0 };
        in_front != self.faces_light && cone::contains(&t.v, &self.normals, point)
    }
}

/// Where the pixel's ray meets the face's plane, and how far that may move.
struct Spot {
    /// The pixel's centre in the image.
    pixel: [f64; 2],
    ray: Ray,
    depth: f64,
    point: DVec3,
    slack: Slack,
}

impl Shader<'_> {
    /// Judges `face` as seen through the pixel whose centre is `(x, y)`.
    pub fn shade(&self, x: f64, y: f64, face: Face) -> Shade {
        let triangle = &self.soup.triangle(face.triangle);
        let ray = self.lens.ray(x, y);
        let Some(spot) = self.spot([x, y], &ray, triangle) else {
            let doubt = Some(Doubt::Surface);
            return Shade {
                lit: false,
                count: 0,
                reached: true,
                lit_doubt: doubt,
                count_doubt: doubt,
                reach_doubt: doubt,
            };
        };
        let mut doubts = Doubts::default();
        let own = self.own(triangle, &ray, &spot, &mut doubts);
        let mut certain = own;
        let close = self.gather(face.triangle, &spot, own, &mut certain, &mut doubts);
        let nominal = self.probe(face, &spot, &close, certain, &mut doubts);
        let (reached, reach_doubt) = self.reach(&spot);
        if matches!(self.facing(triangle), Facing::InPlane | Facing::Unclear) {
            doubts = doubts.map(Doubt::EdgeOn);
        }
        Shade {
            lit: !(nominal.any && triangle.receives),
            count: nominal.count,
            reached,
            lit_doubt: doubts.lit.filter(|_| triangle.receives),
            count_doubt: doubts.count,
            reach_doubt,
        }
    }

    /// The point to be lit; `None` if the plane is too steep to stay in front of the eye within the guard.
    fn spot(&self, pixel: [f64; 2], ray: &Ray, triangle: &Triangle) -> Option<Spot> {
        let lens = self.lens;
        let steepness = triangle.normal.dot(ray.direction);
        let depth = Lens::meet(ray, triangle.v[0], triangle.normal);
        let axes = lens.per_pixel().map(|axis| axis * self.guards.epsilon);
        let slopes = axes.map(|axis| triangle.normal.dot(axis) / steepness);
        let shrink = 1.0 - lens.divergence() * slopes[0].hypot(slopes[1]);
        if !depth.is_finite() || shrink.is_nan() || shrink < 0.5 || depth < lens.depths[0].min(0.0) {
            return None;
        }
        let scale = lens.spread(depth) / shrink;
        let point = ray.origin + ray.direction * depth;
        let ellipse = std::array::from_fn(|i| (axes[i] - ray.direction * slopes[i]) * scale);
        let line = ray.direction * surface_error(lens, self.guards, triangle, ray, depth);
        let radius = ROUNDING * (triangle.extent + depth.abs() * ray.direction.length());
        Some(Spot { pixel, ray: *ray, depth, point, slack: Slack { ellipse, line, radius } })
    }

    /// The face's own part in blocking the light, by the rule that the lit point lies just on the eye's side of it.
    fn own(&self, triangle: &Triangle, ray: &Ray, spot: &Spot, doubts: &mut Doubts) -> Blockers {
        let mut own = Blockers::default();
        if !self.casts_at(triangle) {
            return own;
        }
        let facing = self.facing(triangle);
        let seen_from_front = triangle.normal.dot(ray.direction) < 0.0;
        match facing {
            Facing::InPlane => return own,
            Facing::Unclear => {
                doubts.add(Doubt::Depth);
                return own;
            }
            Facing::Front | Facing::Back => {}
        }
        if (facing == Facing::Front) != seen_from_front {
            own.add(self.weight(triangle, facing == Facing::Front));
        }
        if self.may_leave_own_cone(triangle, facing, spot) {
            doubts.add(Doubt::Depth);
        }
        own
    }

    /// Whether rounded depths may put the spot on the other side of a side of the volume that its own face throws. The
    /// sides are nearly coplanar with a face that the light grazes.
    fn may_leave_own_cone(&self, triangle: &Triangle, facing: Facing, spot: &Spot) -> bool {
        let Slack { ellipse: [u, w], line, radius } = spot.slack;
        // A rasteriser snaps the face's edge and the side that stands on it to the same place, which may be anywhere
        // within this; so near the edge their depths are the same.
        let snap = (u.length_squared() + w.length_squared()).sqrt() * SNAP / self.guards.epsilon;
        let margin = radius + snap;
        ![spot.point - line, spot.point + line].into_iter().all(|p| self.is_within(triangle, facing, p, margin))
    }

    /// Whether `point`, with a margin, lies in the cone of `triangle` or of faces that continue it.
    fn is_within(&self, triangle: &Triangle, facing: Facing, point: DVec3, margin: f64) -> bool {
        const STEPS: u32 = 8;
        let inside = if facing == Facing::Front { -1.0 } else { 1.0 };
        let mut triangle = *triangle;
        for _ in 0..STEPS {
            let normals = self.source.apex.edge_normals(&triangle.v);
            let sides = cone::sides(&triangle.v, &normals, point);
            let beyond: [f64; 3] = std::array::from_fn(|i| -inside * sides[i] / normals[i].length());
            if (0..3).any(|i| beyond[i] > -margin && !self.continues(&triangle, facing, i)) {
                return false;
            }
            let Some(i) = (0..3).max_by(|&i, &j| beyond[i].total_cmp(&beyond[j])) else { return false };
            match triangle.neighbours[i] {
                Some(next) if beyond[i] > 0.0 => triangle = self.soup.triangle(next),
                _ => return true,
            }
        }
        false
    }

    /// Whether the caster goes on beyond edge `i` with a face turned alike, so that no side of a volume stands on it.
    fn continues(&self, triangle: &Triangle, facing: Facing, i: usize) -> bool {
        triangle.neighbours[i].is_some_and(|n| {
            let neighbour = &self.soup.triangle(n);
            self.casts_at(neighbour) && self.facing(neighbour) == facing
        })
    }

    /// Adds to `certain` what blocks the light wherever the spot moves, and returns what might.
    fn gather(&self, face: Id, spot: &Spot, own: Blockers, certain: &mut Blockers, doubts: &mut Doubts) -> Vec<Close> {
        let receiver = &self.soup.triangle(face);
        let Slack { ellipse: [u, w], line, radius } = spot.slack;
        let (towards, reach) = match self.source.apex {
            Apex::Point(light) => (light - spot.point, 1.0),
            Apex::Direction(direction) => (-direction, f64::INFINITY),
        };
        let wander = (u.length_squared() + w.length_squared()).sqrt() + line.length() + radius;
        let width = |distance: f64| wander + ROUNDING * (self.soup.extent + distance);
        let mut close = Vec::new();
        self.bvh.visit(self.soup, spot.point, towards, reach, width, |id, _| {
            let triangle = &self.soup.triangle(id);
            if id == face || !self.casts_at(triangle) {
                return;
            }
            if receiver.coincides(triangle) {
                let front = self.facing(triangle) == Facing::Front;
                if own.any {
                    certain.add(self.weight(triangle, front));
                }
                return;
            }
            if receiver.touches(triangle) && self.weight(triangle, self.facing(triangle) == Facing::Front) != 0 {
                self.check_fold(receiver, triangle, spot, doubts);
            }
            match self.crossing(triangle, spot, doubts) {
                Crossing::No => {}
                Crossing::Yes(weight) => certain.add(weight),
                Crossing::Close(normals, faces_light, weight) => {
                    let continues_face = receiver.touches(triangle)
                        && self.casts_at(receiver)
                        && self.facing(receiver) == self.facing(triangle);
                    close.push(Close { triangle: *triangle, normals, faces_light, weight, continues_face });
                }
            }
        });
        close
    }

    /// Doubts a spot so close to the outline of its caster that the depths of the face seen and of the one that turns
    /// away behind it are the same within rounding: which of their caps lies behind the other is open.
    fn check_fold(&self, face: &Triangle, behind: &Triangle, spot: &Spot, doubts: &mut Doubts) {
        let steepness = |t: &Triangle| t.normal.dot(spot.ray.direction);
        if (steepness(face) > 0.0) == (steepness(behind) > 0.0) {
            return;
        }
        let snap = self.lens.per_pixel().map(|axis| axis * SNAP);
        let uncertainty = |t: &Triangle| {
            let [u, w] = snap.map(|axis| t.normal.dot(axis) / steepness(t));
            let error = surface_error(self.lens, self.guards, t, &spot.ray, spot.depth);
            u.hypot(w) * self.lens.spread(spot.depth).abs() + error
        };
        let gap = (Lens::meet(&spot.ray, behind.v[0], behind.normal) - spot.depth).abs();
        let slack = Slack { ellipse: snap, ..Slack::NONE };
        let normals = self.lens.apex().edge_normals(&behind.v);
        let covers = || cone::place(&behind.v, &normals, self.lens.aim(&spot.ray), &slack) != Place::Outside;
        // Not a number, which an edge-on face gives, is no clear gap.
        let is_clear = gap > uncertainty(face) + uncertainty(behind);
        if !is_clear && covers() {
            doubts.add(Doubt::Depth);
        }
    }

    /// Whether light crosses `triangle` on its way to wherever the spot may move.
    fn crossing(&self, triangle: &Triangle, spot: &Spot, doubts: &mut Doubts) -> Crossing {
        let facing = self.facing(triangle);
        let faces_light = facing == Facing::Front;
        let to = spot.point - triangle.v[0];
        let height = triangle.normal.dot(to);
        // Rounding of the caster moves its shadow by as much as the light magnifies it.
        let (distance, magnified) = match self.source.apex {
            Apex::Point(light) => {
                let nearest = triangle.v.iter().map(|v| v.distance_squared(light)).fold(f64::INFINITY, f64::min);
                let distance = spot.point.distance(light);
                (distance, (distance / nearest.sqrt()).max(1.0))
            }
            Apex::Direction(_) => (to.length(), 1.0),
        };
        let rounding = ROUNDING * (triangle.extent * magnified + distance);
        let radius = spot.slack.radius + rounding;
        let slack = Slack { radius: if radius.is_finite() { radius } else { f64::MAX }, ..spot.slack };
        let level = height.abs() <= slack.along(triangle.normal) + 1e-12 * triangle.normal.length() * to.length();
        match facing {
            Facing::InPlane => return Crossing::No,
            Facing::Front if height > 0.0 && !level => return Crossing::No,
            Facing::Back if height < 0.0 && !level => return Crossing::No,
            _ => {}
        }
        let normals = self.source.apex.edge_normals(&triangle.v);
        let weight = self.weight(triangle, faces_light);
        match cone::place(&triangle.v, &normals, spot.point, &slack) {
            Place::Outside => return Crossing::No,
            Place::Inside if !level && facing != Facing::Unclear => return Crossing::Yes(weight),
            Place::Inside | Place::Near => {}
        }
        // Where rounding alone could change the answer, probing finds nothing: it moves the spot, not the caster.
        let rounded = Slack { radius, ..Slack::NONE };
        let sides = cone::sides(&triangle.v, &normals, spot.point);
        let near = |i: usize| sides[i].abs() <= rounded.along(normals[i]) && !self.continues(triangle, facing, i);
        if cone::place(&triangle.v, &normals, spot.point, &rounded) != Place::Outside
            && (facing == Facing::Unclear || (0..3).any(near))
        {
            doubts.add(Doubt::Depth);
        }
        Crossing::Close(normals, faces_light, weight)
    }

    /// Compares all probes that see the face; returns the answer at the innermost one.
    fn probe(&self, face: Face, spot: &Spot, close: &[Close], certain: Blockers, doubts: &mut Doubts) -> Blockers {
        if close.is_empty() {
            return certain;
        }
        let sum = |crossed: &dyn Fn(&Close) -> bool| {
            let mut blockers = certain;
            close.iter().filter(|c| crossed(c)).for_each(|c| blockers.add(c.weight));
            blockers
        };
        let triangle = &self.soup.triangle(face.triangle);
        let [x, y] = spot.pixel;
        let mut nominal = None;
        for (i, [dx, dy]) in self.guards.offsets().into_iter().enumerate() {
            if face.probes >> i & 1 == 0 {
                continue;
            }
            let ray = self.lens.ray(x + dx, y + dy);
            let depth = Lens::meet(&ray, triangle.v[0], triangle.normal);
            let point = ray.origin + ray.direction * depth;
            let here = sum(&|c| c.is_crossed(point, ray.direction));
            let nominal = *nominal.get_or_insert_with(|| {
                let error = ray.direction * surface_error(self.lens, self.guards, triangle, &ray, depth);
                for moved in [point - error, point + error] {
                    let at = |c: &Close| c.is_crossed(if c.continues_face { point } else { moved }, ray.direction);
                    doubts.compare(Doubt::Depth, here, sum(&at));
                }
                here
            });
            doubts.compare(Doubt::Boundary, nominal, here);
        }
        nominal.unwrap_or(certain)
    }

    /// Whether the spot is within the light's range, cone and box, and the doubt about it.
    fn reach(&self, spot: &Spot) -> (bool, Option<Doubt>) {
        let Slack { ellipse: [u, w], line, radius } = spot.slack;
        let wander = (u.length_squared() + w.length_squared()).sqrt() + line.length() + radius;
        let (position, range) = match self.source.light.kind {
            LightKind::Directional { .. } => return (true, None),
            LightKind::Point { position, range } | LightKind::Spot { position, range, .. } => (position, range),
        };
        let to = spot.point - position;
        let distance = to.length();
        let mut near_border = (distance - range).abs() <= wander + 1e-5 * distance;
        if let LightKind::Spot { direction, outer, .. } = self.source.light.kind {
            let angle = to.cross(direction).length().atan2(to.dot(direction));
            near_border |= (angle - outer).abs() * distance <= wander + 1e-5 * distance;
        }
        near_border |= self.source.light.box_excess(spot.point).abs() <= wander + 1e-5 * distance;
        (self.source.light.reaches(spot.point), near_border.then_some(Doubt::Reach))
    }

    fn casts_at(&self, triangle: &Triangle) -> bool {
        triangle.casts && !self.source.excluded.get(triangle.instance as usize).copied().unwrap_or(false)
    }

    fn weight(&self, triangle: &Triangle, faces_light: bool) -> i32 {
        self.casts.get(triangle.instance as usize, triangle.index as usize).weight(faces_light)
    }

    /// Which side of `triangle` the light is on.
    fn facing(&self, triangle: &Triangle) -> Facing {
        let apex = &self.source.apex;
        let height = apex.height(triangle.v[0], triangle.normal);
        let unit = triangle.normal.length();
        let distance = match *apex {
            Apex::Point(light) => triangle.v.iter().map(|v| v.distance(light)).fold(0.0, f64::max),
            Apex::Direction(_) => 1.0,
        };
        let rounding = if matches!(apex, Apex::Point(_)) { ROUNDING * triangle.extent } else { 0.0 };
        if height.abs() <= 1e-12 * unit * distance && apex.is_coplanar(&triangle.v) {
            Facing::InPlane
        } else if height.abs() <= unit * (FACING * distance + rounding) {
            Facing::Unclear
        } else if height > 0.0 {
            Facing::Front
        } else {
            Facing::Back
        }
    }
}

/// The side of a triangle that the light is on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Facing {
    Front,
    Back,
    /// Exactly in its plane: such a triangle blocks nothing.
    InPlane,
    /// Too close to its plane to tell.
    Unclear,
}

/// Whether light crosses a triangle on its way to a spot.
enum Crossing {
    No,
    /// With what it adds to the count.
    Yes(i32),
    /// It depends on where exactly the spot is: edge normals, whether it faces the light, what it adds.
    Close([DVec3; 3], bool, i32),
}

/// Why the answers for one face may be wrong.
#[derive(Clone, Copy, Debug, Default)]
struct Doubts {
    lit: Option<Doubt>,
    count: Option<Doubt>,
}

impl Doubts {
    fn add(&mut self, doubt: Doubt) {
        self.lit.get_or_insert(doubt);
        self.count.get_or_insert(doubt);
    }

    /// The same doubts for another reason.
    fn map(self, doubt: Doubt) -> Self {
        Self { lit: self.lit.map(|_| doubt), count: self.count.map(|_| doubt) }
    }

    fn compare(&mut self, doubt: Doubt, a: Blockers, b: Blockers) {
        // A mask that comes from the count turns where the count becomes zero.
        if a.any != b.any || (a.count == 0) != (b.count == 0) {
            self.lit.get_or_insert(doubt);
        }
        if a.count != b.count {
            self.count.get_or_insert(doubt);
        }
    }
}
