//! Which surfaces a pixel may show.
//!
//! In: the soup and the pixel's ray. Out: nothing, doubt, or the faces that are first along the ray through the centre
//! or through a probe around it (guard E1).

use crate::{
    bvh::Bvh,
    cone::{self, Place, Slack},
    guard::{Guards, PROBES, ROUNDING, SNAP},
    lens::{Lens, Ray},
    soup::{Id, Soup, Triangle},
};
use glam::DVec3;

/// What a pixel shows.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Sight {
    Nothing,
    /// Something and nothing, or more surfaces than can be told apart.
    Doubtful,
    Faces(Vec<Face>),
}

/// A triangle that may be the one a pixel shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Face {
    pub triangle: Id,
    /// Bit i: it is first along the ray through probe i.
    pub probes: u64,
}

/// More candidates than this make a pixel doubtful.
const MAX_FACES: usize = 8;

/// Looks through pixels.
pub(crate) struct Looker<'a> {
    pub soup: &'a Soup,
    pub bvh: &'a Bvh,
    pub lens: &'a Lens,
    pub guards: &'a Guards,
}

/// A triangle that the ray through the centre, or one within the guard, may meet.
struct Candidate {
    triangle: Triangle,
    id: Id,
    normals: [DVec3; 3],
    /// Every ray within the guard meets it.
    certain: bool,
    /// No point of it is nearer, within the guard.
    nearest: f64,
    /// Likewise, no point that a ray within the guard meets is farther, if `certain`.
    farthest: f64,
}

struct Hit {
    id: Id,
    /// Least and greatest depth within rounding.
    range: [f64; 2],
}

/// Below this cosine to the ray a triangle counts as seen edge-on.
const EDGE_ON: f64 = 1e-6;

impl Looker<'_> {
    /// What the pixel whose centre is `(x, y)` shows.
    pub fn look(&self, x: f64, y: f64) -> Sight {
        let ray = self.lens.ray(x, y);
        let candidates = self.candidates(&ray);
        match &candidates[..] {
            [] => Sight::Nothing,
            [one] if one.certain && !self.is_clipped([one.nearest, one.farthest]) => {
                Sight::Faces(vec![Face { triangle: one.id, probes: (1 << PROBES) - 1 }])
            }
            several => self.probe(x, y, several),
        }
    }

    /// All visible triangles that a ray within the guard may meet first.
    fn candidates(&self, ray: &Ray) -> Vec<Candidate> {
        let lens = self.lens;
        let (apex, aim) = (lens.apex(), lens.aim(ray));
        let ellipse = lens.per_pixel().map(|axis| axis * self.guards.epsilon);
        let length = ray.direction.length();
        let width = |distance: f64| {
            self.guards.epsilon * lens.pixel_at(distance).max(lens.pixel_at(0.0))
                + ROUNDING * (self.soup.extent + distance)
        };
        let [near, far] = lens.depths;
        let start = near.min(0.0);
        let origin = ray.origin + ray.direction * start;
        let mut found: Vec<Candidate> = Vec::new();
        self.bvh.visit(self.soup, origin, ray.direction, f64::INFINITY, width, |id, reach| {
            let triangle = &self.soup.triangle(id);
            if !triangle.visible {
                return;
            }
            let steepness = triangle.normal.dot(ray.direction) / (triangle.normal.length() * length);
            if steepness > EDGE_ON && !triangle.double_sided {
                return;
            }
            let depth = Lens::meet(ray, triangle.v[0], triangle.normal);
            let depths = triangle.v.map(|v| lens.depth_of(v));
            let low = depths.iter().copied().fold(f64::INFINITY, f64::min);
            let high = depths.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            if high < near || low > far {
                return;
            }
            let at = depth.clamp(low.max(near), high.max(near));
            let radius = ROUNDING * (triangle.extent + at.abs() * length) / lens.spread(at).max(f64::MIN_POSITIVE);
            let normals = apex.edge_normals(&triangle.v);
            let place = cone::place(&triangle.v, &normals, aim, &Slack { ellipse, line: DVec3::ZERO, radius });
            if place == Place::Outside || place == Place::Inside && depth < 0.0 && near >= 0.0 {
                return;
            }
            let certain = place == Place::Inside && steepness.abs() > EDGE_ON;
            let (nearest, farthest) = if certain {
                let wobble = self.wobble(triangle, ray, depth) + self.tolerance(triangle, ray, depth);
                (depth - wobble, depth + wobble)
            } else {
                (low - self.tolerance(triangle, ray, low.max(near)), f64::INFINITY)
            };
            if certain && (farthest < near || nearest > far) {
                return;
            }
            if nearest - start <= *reach {
                found.push(Candidate { triangle: *triangle, id, normals, certain, nearest, farthest });
            }
            if certain && nearest > near {
                *reach = reach.min(farthest - start);
            }
        });
        let first = found.iter().filter(|c| c.certain && c.nearest > near).map(|c| c.farthest);
        let first = first.fold(f64::INFINITY, f64::min);
        found.retain(|c| c.nearest <= first);
        found
    }

    /// Looks along the rays through all probes.
    fn probe(&self, x: f64, y: f64, candidates: &[Candidate]) -> Sight {
        let mut faces: Vec<Face> = Vec::new();
        let mut misses = 0;
        let mut first_at_centre = f64::INFINITY;
        for (i, [dx, dy]) in self.guards.offsets().into_iter().enumerate() {
            let ray = self.lens.ray(x + dx, y + dy);
            let hits: Vec<_> = candidates.iter().filter_map(|c| self.hit(&ray, c)).collect();
            let first = hits.iter().map(|h| h.range[1]).fold(f64::INFINITY, f64::min);
            if i == 0 {
                first_at_centre = first;
            }
            misses += usize::from(hits.is_empty());
            for hit in hits.into_iter().filter(|h| h.range[0] <= first) {
                if self.is_clipped(hit.range) {
                    return Sight::Doubtful;
                }
                // Of coincident triangles one stands for all.
                let triangle = &self.soup.triangle(hit.id);
                let known = |f: &&mut Face| self.soup.triangle(f.triangle).coincides(triangle);
                match faces.iter_mut().find(known) {
                    Some(face) => face.probes |= 1 << i,
                    None => faces.push(Face { triangle: hit.id, probes: 1 << i }),
                }
            }
        }
        let is = |f: &Face, c: &Candidate| self.soup.triangle(f.triangle).coincides(&c.triangle);
        let missed = |c: &Candidate| !c.certain && !faces.iter().any(|f| is(f, c));
        let sliver = |c: &Candidate| missed(c) && self.may_cover(x, y, c, first_at_centre);
        let mixed = misses > 0 && !faces.is_empty();
        match faces.len() {
            _ if mixed || candidates.iter().any(sliver) => Sight::Doubtful,
            0 => Sight::Nothing,
            1..=MAX_FACES => Sight::Faces(faces),
            _ => Sight::Doubtful,
        }
    }

    /// Where `ray` meets a candidate, if it does.
    fn hit(&self, ray: &Ray, candidate: &Candidate) -> Option<Hit> {
        let triangle = &candidate.triangle;
        let steepness = triangle.normal.dot(ray.direction);
        let front = steepness < 0.0 || triangle.double_sided && steepness != 0.0;
        if !front || !cone::contains(&triangle.v, &candidate.normals, self.lens.aim(ray)) {
            return None;
        }
        let depth = Lens::meet(ray, triangle.v[0], triangle.normal);
        let tolerance = self.tolerance(triangle, ray, depth);
        let [near, far] = self.lens.depths;
        let visible = depth + tolerance >= near && depth - tolerance <= far;
        visible.then_some(Hit { id: candidate.id, range: [depth - tolerance, depth + tolerance] })
    }

    /// Whether a rasteriser that snaps vertices may draw a triangle, which no probe has met, at the pixel's centre.
    fn may_cover(&self, x: f64, y: f64, candidate: &Candidate, first: f64) -> bool {
        let aim = self.lens.aim(&self.lens.ray(x, y));
        let ellipse = self.lens.per_pixel().map(|axis| axis * SNAP);
        let slack = Slack { ellipse, line: DVec3::ZERO, radius: 0.0 };
        candidate.nearest <= first
            && cone::place(&candidate.triangle.v, &candidate.normals, aim, &slack) != Place::Outside
    }

    /// Whether a clipping plane passes through a range of depths.
    fn is_clipped(&self, [nearest, farthest]: [f64; 2]) -> bool {
        self.lens.depths.iter().any(|&plane| nearest <= plane && plane <= farthest)
    }

    /// Uncertainty of the depth at which `ray` meets `triangle`, by rounding.
    fn tolerance(&self, triangle: &Triangle, ray: &Ray, depth: f64) -> f64 {
        surface_error(self.lens, self.guards, triangle, ray, depth)
    }

    /// Largest change, within the guard, of the depth at which a ray meets `triangle`.
    fn wobble(&self, triangle: &Triangle, ray: &Ray, depth: f64) -> f64 {
        let [u, w] = self.lens.per_pixel().map(|axis| triangle.normal.dot(axis) * self.guards.epsilon);
        let slope = u.hypot(w) / triangle.normal.dot(ray.direction).abs();
        // The depth is depth / (1 +- slope) for a perspective.
        let shrink = (1.0 - slope * self.lens.divergence()).max(1e-3);
        slope * self.lens.spread(depth).abs() / shrink
    }
}

/// Rounding of depth buffer and vertex positions, as a distance along `ray` in units of depth.
pub(crate) fn surface_error(lens: &Lens, guards: &Guards, triangle: &Triangle, ray: &Ray, depth: f64) -> f64 {
    let length = ray.direction.length();
    let cosine = triangle.normal.dot(ray.direction).abs() / (triangle.normal.length() * length);
    let position = ROUNDING * (triangle.extent + depth.abs() * length) / cosine.max(1e-3);
    lens.depth_error(depth, guards.kappa) + position / length
}
