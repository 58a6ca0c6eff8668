//! The light of a scene that has none, and the light from all sides of one that has some.
//!
//! In: where the scene is seen from. Out: a sun whose shadows fall where they are seen; or, where no sun comes in, a lamp
//! in the room; and radiances that fit.

use super::posed::{Posed, Sample};
use super::sight::{Blocks, Lens, Sight};
use crate::{Light, LightShape, Scene, Sky, world_triangle};
use glam::DVec3;
use std::f64::consts::PI;
use zfail_plan::bounds::Bounds;
use zfail_plan::light::LightKind;

/// Where the sun stands.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sun {
    /// Degrees clockwise from north, which is -z, seen from above; east is +x.
    pub azimuth: f64,
    /// Degrees above the horizon, more than 0 and at most 90.
    pub elevation: f64,
}

impl Sun {
    /// The direction in which it shines, unit.
    #[must_use]
    pub fn direction(&self) -> DVec3 {
        let (azimuth, elevation) = (self.azimuth.to_radians(), self.elevation.to_radians());
        -DVec3::new(azimuth.sin() * elevation.cos(), elevation.sin(), -azimuth.cos() * elevation.cos())
    }

    /// The one that shines in this direction, unit.
    #[must_use]
    pub fn shining(direction: DVec3) -> Self {
        let towards = -direction;
        Self {
            azimuth: towards.x.atan2(-towards.z).to_degrees().rem_euclid(360.0),
            elevation: towards.y.clamp(-1.0, 1.0).asin().to_degrees(),
        }
    }
}

/// Irradiance of a surface that faces the sun or is lit by the lamp as most are: with the sky's, a white one shows about the
/// greatest radiance that a display has without exposure.
const KEY: f64 = 0.8 * PI;
/// To the left of where the eye is, degrees, and above the horizon: shadows fall to the right and a little away.
const SUNS: [[f64; 2]; 5] = [[62.0, 48.0], [-62.0, 48.0], [62.0, 65.0], [-62.0, 65.0], [30.0, 78.0]];
/// How many times as much a sun to the right must light of what is seen.
const OTHER_SIDE: f64 = 1.2;
/// The share of what is seen that must be lit.
const LIT: f64 = 0.15;

/// The sky of scenes that have no light of their own.
pub(super) const SKY: Sky = Sky { zenith: [0.40, 0.44, 0.49], horizon: [0.50, 0.51, 0.52], nadir: [0.30, 0.295, 0.29] };

/// A light for a scene without any, seen from `lens`.
pub(super) fn key(posed: Posed<'_>, bounds: &Bounds, samples: &[Sample], lens: Lens, sun: Option<Sun>) -> Light {
    let light = |name: &str, kind, intensity| Light {
        name: name.to_owned(),
        kind,
        color: [1.0, 0.98, 0.95],
        intensity,
        excluded: Vec::new(),
        shape: LightShape::default(),
    };
    let sunlight = |sun: Sun| light("sun", LightKind::Directional { direction: sun.direction() }, KEY as f32);
    if let Some(sun) = sun {
        return sunlight(sun);
    }
    let towards_eye = Sun::shining(-lens.back()).azimuth;
    let suns = SUNS.map(|[left, elevation]| Sun { azimuth: towards_eye + left, elevation });
    if bounds.is_empty() {
        return sunlight(suns[0]);
    }
    let sight = Sight::new(lens, posed, bounds, Blocks::Eyes);
    let seen: Vec<Sample> = samples.iter().filter(|sample| sight.sees(sample)).copied().collect();
    // The share of what is seen, by its area in the picture, of which the sun shines on the side that is seen.
    let lit = |sun: &Sun| {
        let light = Lens::parallel(-sun.direction(), bounds);
        let sight = Sight::new(light, posed, bounds, Blocks::Light);
        let shines = |s: &Sample| (lens.share(s) > 0.0) == (light.share(s) > 0.0) && sight.reaches(s.point);
        let share = |s: &Sample| lens.share(s).abs();
        let lit: f64 = seen.iter().filter(|s| shines(s)).map(share).sum();
        lit / seen.iter().map(share).sum::<f64>()
    };
    if seen.is_empty() {
        return sunlight(suns[0]);
    }
    let [left, right] = [&suns[0], &suns[1]].map(lit);
    let first = usize::from(right > OTHER_SIDE * left);
    if left.max(right) >= LIT {
        return sunlight(suns[first]);
    }
    if let Some(&sun) = suns[2..].iter().find(|sun| lit(sun) >= LIT) {
        return sunlight(sun);
    }
    match lamp(posed, bounds, &seen, lens) {
        Some((position, intensity)) => light("lamp", LightKind::Point { position, range: f64::INFINITY }, intensity),
        None => sunlight(suns[0]),
    }
}

/// Where a lamp lights most of what is `seen`, and its intensity; `None` if it would light no more than the sun does.
fn lamp(posed: Posed<'_>, bounds: &Bounds, seen: &[Sample], lens: Lens) -> Option<(DVec3, f32)> {
    let above = |at: DVec3, share: f64| at.with_y(bounds.min.y + share * 2.0 * bounds.half().y);
    let aside = lens.eye().lerp(bounds.center(), 0.6).clamp(bounds.min, bounds.max);
    let places =
        [(bounds.center(), 0.85), (aside, 0.85), (bounds.center(), 0.7), (aside, 0.65), (bounds.center(), 0.5)];
    let mut best: (f64, Option<(DVec3, f32)>) = (LIT, None);
    for place in places.map(|(at, share)| above(at, share)) {
        let faces = [DVec3::X, DVec3::Y, DVec3::Z].into_iter().flat_map(|axis| [axis, -axis]);
        let sights: Vec<Sight> =
            faces.map(|back| Sight::new(Lens::central(place, back, [1.0; 2]), posed, bounds, Blocks::Light)).collect();
        let irradiance = |sample: &Sample| {
            let to = place - sample.point;
            let cosine = sample.normal.dot(to) / to.length();
            let cosine = if sample.both_sides { cosine.abs() } else { cosine };
            let lit = cosine > 0.0 && sights.iter().any(|sight| sight.reaches(sample.point));
            lit.then(|| cosine / to.length_squared())
        };
        let mut irradiances: Vec<f64> = seen.iter().filter_map(irradiance).filter(|e| e.is_finite()).collect();
        let share = irradiances.len() as f64 / seen.len() as f64;
        if share > 1.1 * best.0 {
            irradiances.sort_by(f64::total_cmp);
            let typical = irradiances[irradiances.len() / 2];
            best = (share, Some((place, (0.5 * KEY / typical).min(1e30) as f32)));
        }
    }
    best.1
}

/// Radiance of a white diffuse surface under the lights: irradiance over pi.
pub(super) fn typical_white(scene: &Scene) -> f32 {
    (typical_irradiance(scene) / PI).min(1e30) as f32
}

/// Light that is the same from all sides and leaves shadows of the scene's lights dark, but not black.
#[must_use]
pub fn fitting_ambient(scene: &Scene) -> [f32; 3] {
    let white = typical_white(scene);
    [0.085, 0.095, 0.115].map(|x| x * white)
}

/// A sky as bright beside the scene's lights as that of scenes without lights is beside its sun.
#[must_use]
pub fn fitting_sky(scene: &Scene) -> Sky {
    SKY.scaled(typical_white(scene) / (0.6 * KEY / PI) as f32)
}

/// Median, over a sample of the triangles that any light reaches, of the irradiance from all lights, shadows aside;
/// pi if none is reached.
fn typical_irradiance(scene: &Scene) -> f64 {
    const SAMPLES: usize = 1024;
    let triangles = |i: usize| scene.meshes[scene.instances[i].mesh].triangles.len();
    let total: usize = (0..scene.instances.len()).map(triangles).sum();
    let step = total.div_ceil(SAMPLES).max(1);
    let mut irradiances = Vec::new();
    let mut skip = 0;
    for (i, instance) in scene.instances.iter().enumerate() {
        let mesh = &scene.meshes[instance.mesh];
        for t in (skip..triangles(i)).step_by(step) {
            let [a, b, c] = world_triangle(mesh, &instance.world_from_object, t);
            if let Some(normal) = (b - a).cross(c - a).try_normalize() {
                irradiances.push(irradiance(&scene.lights, (a + b + c) / 3.0, normal));
            }
        }
        skip = (skip + step - triangles(i) % step) % step;
    }
    irradiances.retain(|e| e.is_finite() && *e > 0.0);
    irradiances.sort_by(f64::total_cmp);
    irradiances.get(irradiances.len() / 2).copied().unwrap_or(PI)
}

fn irradiance(lights: &[Light], point: DVec3, normal: DVec3) -> f64 {
    let from = |light: &Light| {
        let luminance = glam::Vec3::from(light.color).dot(glam::Vec3::new(0.2126, 0.7152, 0.0722));
        let strength = f64::from(light.intensity * luminance);
        if !light.reaches(point) {
            return 0.0;
        }
        match light.kind {
            LightKind::Directional { direction } => strength * normal.dot(direction).abs(),
            LightKind::Point { position, range } | LightKind::Spot { position, range, .. } => {
                let to = position - point;
                let distance = to.length();
                let falloff = light.shape.falloff_at(distance / range).unwrap_or_else(|| distance.powi(-2));
                strength * falloff * normal.dot(to).abs() / distance
            }
        }
    };
    lights.iter().map(from).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_sun_stands_where_a_compass_has_it() {
        for (azimuth, elevation, towards) in [
            (0.0, 45.0, DVec3::new(0.0, 1.0, -1.0)),
            (90.0, 45.0, DVec3::new(1.0, 1.0, 0.0)),
            (180.0, 45.0, DVec3::new(0.0, 1.0, 1.0)),
            (270.0, 45.0, DVec3::new(-1.0, 1.0, 0.0)),
            (123.0, 90.0, DVec3::Y),
        ] {
            let sun = Sun { azimuth, elevation };
            assert!((sun.direction() + towards.normalize()).length() < 1e-12, "{sun:?}");
            if elevation < 90.0 {
                let again = Sun::shining(sun.direction());
                assert!((again.azimuth - azimuth).abs() < 1e-9 && (again.elevation - elevation).abs() < 1e-9);
            }
        }
    }
}
