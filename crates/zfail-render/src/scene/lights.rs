//! Lights as shaders want them: in view space, scaled to the range of half floats.

use crate::scene::gpu_data::LightRecord;
use zfail_plan::bounds::{Bounds, OrientedBox};
use zfail_plan::glam::DVec3;
use zfail_plan::light::LightKind;
use zfail_plan::scissor;
use zfail_plan::view::View;
use zfail_scene::Light;

/// `light` in the space of `view`, its intensity multiplied by `pre_exposure`; `shape` is where its shape is.
pub fn record(light: &Light, view: &View, pre_exposure: f32, shape: u32) -> LightRecord {
    let view_from_world = view.world_from_view.matrix3.transpose();
    let place = |p: DVec3| (view_from_world * (p - view.eye())).as_vec3().to_array();
    let turn = |d: DVec3| (view_from_world * d).as_vec3().to_array();
    let axes = light.axes();
    let common = LightRecord {
        color: light.color.map(|c| c * light.intensity * pre_exposure),
        placed: 1.0,
        cos_outer: -1.0,
        angle_offset: 1.0,
        axis: turn(-axes.z_axis),
        shape,
        right: turn(axes.x_axis),
        up: turn(axes.y_axis),
        ..Default::default()
    };
    match light.kind {
        LightKind::Point { position, range } => {
            LightRecord { position: place(position), per_range: per_range(range), ..common }
        }
        LightKind::Spot { position, range, inner, outer, .. } => {
            // KHR_lights_punctual, "Inner and Outer Cone Angles".
            let angle_scale = 1.0 / (inner.cos() - outer.cos()).max(0.001);
            LightRecord {
                position: place(position),
                per_range: per_range(range),
                sin_outer: outer.sin() as f32,
                cos_outer: outer.cos() as f32,
                angle_scale: angle_scale as f32,
                angle_offset: (-outer.cos() * angle_scale) as f32,
                cot_outer: outer.tan().recip() as f32,
                ..common
            }
        }
        LightKind::Directional { direction } => {
            LightRecord { position: turn(-direction), placed: 0.0, shape: 0, ..common }
        }
    }
}

fn per_range(range: f64) -> f32 {
    // A range of 0 reaches nothing, and must not become 0 * infinity in the shader.
    (1.0 / range).min(1e30) as f32
}

/// What bounds a light's influence on a picture, beside the range in the file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Precision {
    /// The least difference of pre-exposed radiance that the target shows.
    pub step: f64,
    /// Scale from scene radiance to pre-exposed.
    pub pre_exposure: f64,
    /// The greatest share of the irradiance that a surface of the scene sends to the eye, per steradian.
    pub reflectance: f64,
}

/// The least step of a half float near 0.
pub const HALF_FLOAT_STEP: f64 = 1.0 / (1 << 24) as f64;

/// The least difference of exposed radiance that may change an 8-bit picture by a whole step: neither the tone mapper
/// (1) nor the display encoding (12.92, at black) is steeper.
pub const DISPLAY_STEP: f64 = 1.0 / (255.0 * 12.92);

/// The greatest value that `reflectance` of `light.wgsl` takes for a material of at least this `roughness`: diffuse
/// light gives 1/pi; the microfacet distribution is at most 1 / (pi a^2), and its visibility times the cosine at most
/// 1 / (2 a), where a is the square of the roughness, not less than 0.002.
pub fn greatest_reflectance(roughness: f64) -> f64 {
    let a = (roughness * roughness).max(0.002);
    (1.0 + 0.5 / (a * a * a)) / std::f64::consts::PI
}

/// A light of the scene as one frame takes it: how far it matters there.
#[derive(Clone, Copy, Debug)]
pub struct FrameLight {
    /// Which of the scene's lights.
    pub index: usize,
    /// Placed, with the range that matters.
    pub kind: LightKind,
    /// Beyond which it lights nothing.
    pub bounds: Option<OrientedBox>,
}

impl FrameLight {
    /// Light number `index` of a scene, to its whole extent.
    pub fn new(index: usize, light: &Light) -> Self {
        Self { index, kind: light.kind, bounds: light.bounds() }
    }

    /// As far as it matters to a picture of that precision.
    pub fn effective(index: usize, light: &Light, precision: &Precision) -> Self {
        Self { kind: effective(light, precision), ..Self::new(index, light) }
    }

    /// Whether it reaches anything within `bounds` (world space).
    pub fn reaches(&self, bounds: &Bounds) -> bool {
        let in_range = match self.kind {
            LightKind::Point { position, range } | LightKind::Spot { position, range, .. } => {
                bounds.distance_squared(position) <= range * range
            }
            LightKind::Directional { .. } => true,
        };
        in_range && self.bounds.is_none_or(|light| light.meets(bounds))
    }

    /// Whether it reaches anything that `view` shows.
    pub fn is_visible(&self, view: &View) -> bool {
        let in_range = match self.kind {
            LightKind::Point { position, range } | LightKind::Spot { position, range, .. } if range.is_finite() => {
                scissor::of_ball(view, position - view.eye(), range).is_some()
            }
            _ => true,
        };
        let corners = self.bounds.map(|light| light.relative_to(view.eye()).corners().map(|c| c.extend(1.0)));
        in_range && corners.is_none_or(|corners| scissor::of_points(view, &corners).is_some())
    }
}

/// `light`'s kind as far as it matters to a picture: its range is not longer than the distance beyond which what any
/// surface reflects of it is less than `precision` shows (McGuire et al. 2003, section 4, on a light's bounds). What is
/// computed per pixel keeps the range of the file, by which the light fades.
fn effective(light: &Light, precision: &Precision) -> LightKind {
    let peak = f64::from(light.color.into_iter().fold(0.0, f32::max)) * f64::from(light.intensity);
    let share = precision.pre_exposure * precision.reflectance / precision.step;
    // Not a number where nothing is known: then the file's range stands.
    let radius = match light.shape.falloff.len() {
        0 => (peak * share).sqrt(),
        samples => {
            let is_dark = |sample: &&f32| f64::from(**sample) * peak * share < 1.0;
            let dark = light.shape.falloff.iter().rev().take_while(is_dark).count();
            let last = (samples - dark).min(samples - 1);
            light.kind.range().unwrap_or(f64::INFINITY) * (last as f64 / (samples - 1).max(1) as f64)
        }
    };
    match light.kind {
        LightKind::Point { position, range } => LightKind::Point { position, range: range.min(radius) },
        LightKind::Spot { position, direction, range, inner, outer } => {
            LightKind::Spot { position, direction, range: range.min(radius), inner, outer }
        }
        directional @ LightKind::Directional { .. } => directional,
    }
}

/// The name of a light's kind.
pub fn kind_name(kind: &LightKind) -> &'static str {
    match kind {
        LightKind::Point { .. } => "point",
        LightKind::Spot { .. } => "spot",
        LightKind::Directional { .. } => "directional",
    }
}

/// The power of two that brings the radiance of a white surface in the scene near 1, so that neither moonlight nor
/// sunlight leaves the range in which half floats are precise. Being a power of two, it changes no rounding.
pub fn pre_exposure<'l>(lights: impl Iterator<Item = &'l Light>, bounds: &Bounds, constant: &[[f32; 3]]) -> f32 {
    let reach = if bounds.is_empty() { 1.0 } else { bounds.half().length().max(1e-6) };
    let mut brightest = constant.iter().flatten().fold(0.0_f64, |sum, &c| sum.max(f64::from(c)));
    for light in lights {
        let distance = |position: DVec3| {
            if bounds.is_empty() { reach } else { position.distance(bounds.center()).max(0.5 * reach) }
        };
        let falloff = match light.kind {
            _ if !light.shape.falloff.is_empty() => light.shape.falloff.iter().copied().fold(0.0, f32::max).into(),
            LightKind::Point { position, .. } | LightKind::Spot { position, .. } => distance(position).powi(-2),
            LightKind::Directional { .. } => 1.0,
        };
        let peak = light.color.into_iter().fold(0.0, f32::max) * light.intensity;
        brightest = brightest.max(f64::from(peak) * falloff / std::f64::consts::PI);
    }
    if brightest > 0.0 && brightest.is_finite() {
        brightest.log2().round().clamp(-60.0, 60.0).exp2().recip() as f32
    } else {
        1.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use zfail_plan::glam::DAffine3;
    use zfail_plan::view::Projection;
    use zfail_scene::LightShape;

    fn sun(lux: f32) -> Light {
        let kind = LightKind::Directional { direction: DVec3::NEG_Y };
        Light {
            name: String::new(),
            kind,
            color: [1.0; 3],
            intensity: lux,
            excluded: Vec::new(),
            shape: LightShape::default(),
        }
    }

    #[test]
    fn pre_exposure_brings_radiance_near_one() {
        for lux in [1e-6, 1.0, 1e5] {
            let scale = pre_exposure([sun(lux)].iter(), &Bounds::EMPTY, &[]);
            let radiance = lux / std::f32::consts::PI * scale;
            assert!((0.7..1.42).contains(&radiance), "{lux} lux become {radiance}");
            assert_eq!(scale.to_bits() & 0x007f_ffff, 0, "{scale} is no power of two");
        }
        assert_eq!(pre_exposure([].iter(), &Bounds::EMPTY, &[[0.0; 3]]), 1.0);
    }

    #[test]
    fn light_ends_where_it_is_below_a_step() {
        let lamp = |intensity, range| {
            let kind = LightKind::Point { position: DVec3::ZERO, range };
            Light {
                name: String::new(),
                kind,
                color: [0.5, 1.0, 0.0],
                intensity,
                excluded: Vec::new(),
                shape: LightShape::default(),
            }
        };
        let reach = |light: &Light, precision: &Precision| match effective(light, precision) {
            LightKind::Point { range, .. } => range,
            _ => f64::NAN,
        };
        let precision = Precision { step: 1e-4, pre_exposure: 0.5, reflectance: 0.4 };
        let radius = reach(&lamp(8.0, f64::INFINITY), &precision);
        assert!((8.0 * 0.5 * 0.4 / (radius * radius) - 1e-4).abs() < 1e-12);
        assert_eq!(reach(&lamp(8.0, 3.0), &precision), 3.0);
        assert_eq!(reach(&lamp(0.0, f64::INFINITY), &precision), 0.0);
        assert!(reach(&lamp(9.0, f64::INFINITY), &precision) > radius);
        assert_eq!(effective(&sun(1e-9), &precision), sun(1e-9).kind);

        let curved = |falloff: &[f32]| {
            let mut light = lamp(8.0, 12.0);
            light.shape.falloff = falloff.to_vec();
            reach(&light, &precision)
        };
        assert_eq!(curved(&[0.0, 1.0]), 12.0);
        assert_eq!(curved(&[1.0, 0.5, 0.0, 0.0, 0.0]), 6.0, "light fades between its last sample and the next");
        assert_eq!(curved(&[0.0, 1e-9, 0.0]), 0.0);
    }

    #[test]
    fn a_box_ends_what_is_lit() {
        let kind = LightKind::Point { position: DVec3::ZERO, range: f64::INFINITY };
        let half_axes = [DVec3::X * 2.0, DVec3::Y, DVec3::Z * 2.0];
        let light = FrameLight { index: 0, kind, bounds: Some(OrientedBox { center: DVec3::ZERO, half_axes }) };
        let around = |p: DVec3| Bounds { min: p - 0.1, max: p + 0.1 };
        assert!(light.reaches(&around(DVec3::new(2.05, 0.5, 0.0))) && !light.reaches(&around(DVec3::Y * 1.2)));
        let projection = Projection::Perspective { yfov: 1.0, near: 0.1, far: None };
        let facing = |z: f64| View::new(DAffine3::from_translation(DVec3::new(0.0, 0.0, z)), projection, [9, 9]);
        assert!(light.is_visible(&facing(9.0)) && !light.is_visible(&facing(-2.5)));
        assert!(FrameLight { bounds: None, ..light }.is_visible(&facing(-2.5)));
    }

    #[test]
    fn no_surface_reflects_more_than_the_bound() {
        for roughness in [0.05_f64, 0.2, 0.5, 1.0] {
            let a = roughness * roughness;
            let a2 = a * a;
            let bound = greatest_reflectance(roughness);
            let mut greatest = 0.0_f64;
            for i in 1..=200 {
                for j in 1..=200 {
                    let [n_l, n_v] = [i, j].map(|k| f64::from(k) / 200.0);
                    let root = |c: f64| (c * c * (1.0 - a2) + a2).sqrt();
                    let highlight = n_l * 0.5 / (n_l * root(n_v) + n_v * root(n_l)) / (std::f64::consts::PI * a2);
                    greatest = greatest.max(highlight);
                }
            }
            assert!(greatest < bound && bound < 2.0 / std::f64::consts::PI + 100.0 * greatest, "{greatest} {bound}");
        }
    }
}
