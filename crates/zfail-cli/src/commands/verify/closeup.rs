//! Further views of what one picture does not prove.
//!
//! In: a scene, the view that was asked for, and a light. Out: a view from which certain pixels are lit and others in shadow.
//! The oracle alone looks for them: at small previews of the scene from all around and from within, and from there closer and
//! closer to where its shadow ends, until few pixels are left out. Where to look depends on no picture that was rendered.

use super::proof::{ENOUGH, LightProof};
use std::collections::HashMap;
use zfail_oracle::{CastTable, Oracle, Pixel, Truth};
use zfail_plan::glam::{DAffine3, DMat3, DVec3};
use zfail_plan::light::LightKind;
use zfail_plan::view::{Projection, View};
use zfail_scene::{Light, Scene};

/// Of previews.
const PREVIEW: [u32; 2] = [96, 54];
/// Of views that are rendered; as many pixels as anyone needs.
const SIZE: [u32; 2] = [320, 180];
/// How many times closer each step is.
const CLOSER: f64 = 5.0;
/// Steps from a preview on.
const STEPS: u32 = 5;
/// Places in a preview that are looked at more closely.
const PLACES: usize = 3;
/// Pictures that the oracle makes for one light before it gives up.
const PATIENCE: u32 = 90;

/// Looks for views.
pub struct Scout<'a> {
    oracle: &'a Oracle,
    scene: &'a Scene,
    casts: CastTable,
    /// Where previews are made from, for every light.
    bases: Vec<View>,
    trails: HashMap<usize, Trail>,
}

/// How far the search for one light is.
#[derive(Default)]
struct Trail {
    base: usize,
    pictures: u32,
    /// The next one last.
    candidates: Vec<(View, u32)>,
}

impl<'a> Scout<'a> {
    /// Looks around in `scene`, of which `oracle` knows, beginning with `view`.
    pub fn new(oracle: &'a Oracle, scene: &'a Scene, view: &View) -> Self {
        let mut bases = vec![View { size: PREVIEW, ..*view }];
        bases.extend(around(scene));
        Self { oracle, scene, casts: CastTable::double(scene), bases, trails: HashMap::new() }
    }

    /// The next view that adds to what is known of a light; `None` where there is none to be found.
    pub fn next(&mut self, known: &LightProof) -> Option<View> {
        let light = &self.scene.lights[known.light];
        let mut trail = self.trails.remove(&known.light).unwrap_or_default();
        let found = self.follow(&mut trail, light, known);
        self.trails.insert(known.light, trail);
        found
    }

    fn follow(&self, trail: &mut Trail, light: &Light, known: &LightProof) -> Option<View> {
        let within = beside(light, self.scene);
        while trail.pictures < PATIENCE {
            trail.pictures += 1;
            let Some((view, step)) = trail.candidates.pop() else {
                let base = self.bases.get(trail.base).or_else(|| within.get(trail.base - self.bases.len()))?;
                trail.base += 1;
                let truth = self.oracle.judge(base, light, &self.casts);
                trail.candidates.extend(self.closer(base, &truth, PLACES).into_iter().rev().map(|view| (view, 1)));
                if trail.candidates.is_empty() && adds(&truth, known) {
                    return Some(View { size: SIZE, ..*base });
                }
                continue;
            };
            let truth = self.oracle.judge(&view, light, &self.casts);
            if adds(&truth, known) {
                return Some(view);
            }
            if step < STEPS {
                trail.candidates.extend(self.closer(&view, &truth, 1).into_iter().map(|view| (view, step + 1)));
            }
        }
        None
    }

    /// Views of the places in `truth` where shadow ends, most promising first.
    fn closer(&self, view: &View, truth: &Truth, most: usize) -> Vec<View> {
        let places = promising(truth, most);
        places.into_iter().filter_map(|[x, y]| self.closer_to(view, f64::from(x) + 0.5, f64::from(y) + 0.5)).collect()
    }

    /// A view from nearer to what is seen at a place of the image.
    fn closer_to(&self, view: &View, x: f64, y: f64) -> Option<View> {
        let depth = self.oracle.depth(view, x, y)?;
        let [width, height] = view.size.map(f64::from);
        let axes = view.world_from_view.matrix3;
        let aside = |scale: f64| axes.x_axis * ((x - 0.5 * width) * scale) - axes.y_axis * ((y - 0.5 * height) * scale);
        let (eye, ray) = match view.projection {
            Projection::Perspective { yfov, .. } => {
                (view.eye(), aside(2.0 * (0.5 * yfov).tan() / height) - axes.z_axis)
            }
            Projection::Orthographic { ymag, .. } => (view.eye() + aside(2.0 * ymag / height), -axes.z_axis),
        };
        // An orthographic eye may be behind what it sees.
        let distance = (depth * ray.length()).abs() / CLOSER;
        let towards = ray.normalize_or_zero();
        let from = eye + ray * depth - towards * distance;
        (distance > 0.0).then(|| looking(from, towards, distance * 0.02, 0.6, SIZE))
    }
}

/// Whether a view shows enough of what is not known yet.
fn adds(truth: &Truth, known: &LightProof) -> bool {
    let Ok(report) = truth.compare_mask(&truth.mask()) else { return false };
    let some = |have: usize, found: usize| have < ENOUGH && found >= ENOUGH / 5;
    report.budget().is_ok() && (some(known.lit, report.lit) || some(known.shadowed, report.shadowed))
}

/// Pixels where shadow ends that have most certain pixels of both kinds about them, not next to each other.
fn promising(truth: &Truth, most: usize) -> Vec<[u32; 2]> {
    const ABOUT: i64 = 3;
    let [width, height] = truth.size.map(i64::from);
    let at = |x: i64, y: i64| -> Option<&Pixel> {
        let inside = (0..width).contains(&x) && (0..height).contains(&y);
        inside.then(|| &truth.pixels[(y * width + x) as usize]).filter(|pixel| pixel.surface && pixel.reached)
    };
    let mut found = Vec::new();
    for y in 0..height {
        for x in 0..width {
            let Some(here) = at(x, y) else { continue };
            if ![(1, 0), (0, 1)].iter().any(|(dx, dy)| at(x + dx, y + dy).is_some_and(|p| p.lit != here.lit)) {
                continue;
            }
            let mut certain = [0; 2];
            for dy in -ABOUT..=ABOUT {
                for pixel in (-ABOUT..=ABOUT).filter_map(|dx| at(x + dx, y + dy)).filter(|p| p.mask_doubt.is_none()) {
                    certain[usize::from(pixel.lit)] += 1;
                }
            }
            found.push((certain[0].min(certain[1]), [x as u32, y as u32]));
        }
    }
    found.sort_by_key(|&(certain, place)| (std::cmp::Reverse(certain), place));
    let mut places: Vec<[u32; 2]> = Vec::new();
    for (_, place) in found {
        let near = |other: &[u32; 2]| place[0].abs_diff(other[0]).max(place[1].abs_diff(other[1])) < 8;
        if places.len() < most && !places.iter().any(near) {
            places.push(place);
        }
    }
    places
}

/// Previews from all sides, and from the middle of the scene.
fn around(scene: &Scene) -> Vec<View> {
    let bounds = scene.bounds();
    let radius = bounds.half().length();
    if bounds.is_empty() || radius.is_nan() || radius <= 0.0 {
        return Vec::new();
    }
    let steps = [-1.0, 0.0, 1.0];
    let ways = steps.into_iter().flat_map(|y| steps.into_iter().flat_map(move |x| steps.map(|z| DVec3::new(x, -y, z))));
    let outside = ways.filter(|way| *way != DVec3::ZERO).map(|way| {
        // Askew, so that nothing is seen edge-on.
        let towards = -(way + DVec3::new(0.11, 0.07, 0.17)).normalize();
        looking(bounds.center() - towards * radius * 2.6, towards, radius * 1.4, 0.8, PREVIEW)
    });
    outside.chain(from_place(bounds.center(), radius)).collect()
}

/// Previews from beside a light that is somewhere.
fn beside(light: &Light, scene: &Scene) -> Vec<View> {
    let radius = scene.bounds().half().length();
    match light.kind {
        LightKind::Directional { .. } => Vec::new(),
        LightKind::Point { position, .. } | LightKind::Spot { position, .. } => {
            from_place(position + DVec3::new(0.03, -0.05, 0.02) * radius, radius)
        }
    }
}

/// Previews from a place in six directions.
fn from_place(eye: DVec3, radius: f64) -> Vec<View> {
    let ways = [DVec3::NEG_Y, DVec3::X, DVec3::NEG_X, DVec3::Z, DVec3::NEG_Z, DVec3::Y];
    let askew = DVec3::new(0.07, -0.13, 0.05);
    ways.map(|way| looking(eye, (way + askew).normalize(), radius * 1e-3, 1.5, PREVIEW)).into()
}

fn looking(eye: DVec3, towards: DVec3, near: f64, yfov: f64, size: [u32; 2]) -> View {
    let up = if towards.y.abs() < 0.9 { DVec3::Y } else { DVec3::Z };
    let right = towards.cross(up).normalize();
    let axes = DMat3::from_cols(right, right.cross(towards), -towards);
    let world_from_view = DAffine3::from_mat3_translation(axes, eye);
    View::new(world_from_view, Projection::Perspective { yfov, near, far: None }, size)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::commands::verify::proof::Proof;

    #[test]
    fn where_a_picture_proves_nothing_a_closer_one_does() {
        let scene = zfail_builtin::scene("jail").unwrap();
        let oracle = Oracle::new(&scene);
        // Away from everything.
        let center = scene.bounds().center();
        let away = looking(center + DVec3::Y * 1000.0, DVec3::Y, 0.1, 0.5, [64, 36]);
        let mut scout = Scout::new(&oracle, &scene, &away);
        let nothing = Proof::new(&scene, &[0]);
        let view = scout.next(nothing.of(0).unwrap()).expect("there are shadows");
        let truth = oracle.judge(&view, &scene.lights[0], &CastTable::double(&scene));
        let report = truth.compare_mask(&truth.mask()).unwrap();
        assert!(report.budget().is_ok() && report.lit.max(report.shadowed) >= 20);
        assert!(scout.next(nothing.of(0).unwrap()).is_some_and(|next| next != view), "another one");
    }

    #[test]
    fn a_search_for_what_is_not_there_ends() {
        // A floor alone: nothing lies in shadow.
        let mut scene = zfail_builtin::scene("jail").unwrap();
        scene.instances.truncate(1);
        scene.instances[0].casts_shadow = false;
        let oracle = Oracle::new(&scene);
        let view = looking(scene.bounds().center() + DVec3::Y, DVec3::NEG_Y, 0.1, 0.5, [64, 36]);
        let mut known = Proof::new(&scene, &[0]);
        known.lights[0].lit = 1000;
        assert!(Scout::new(&oracle, &scene, &view).next(known.of(0).unwrap()).is_none());
    }
}
