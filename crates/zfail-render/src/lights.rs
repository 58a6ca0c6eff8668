//! Lights as shaders want them: in view space, scaled to the range of half floats.

use crate::gpu_data::LightRecord;
use zfail_plan::glam::DVec3;
use zfail_plan::scene::{Bounds, Light, LightKind};
use zfail_plan::view::View;

/// `light` in the space of `view`, its intensity multiplied by `pre_exposure`.
pub fn record(light: &Light, view: &View, pre_exposure: f32) -> LightRecord {
    let view_from_world = view.world_from_view.matrix3.transpose();
    let place = |p: DVec3| (view_from_world * (p - view.eye())).as_vec3().to_array();
    let turn = |d: DVec3| (view_from_world * d).as_vec3().to_array();
    let common = LightRecord {
        color: light.color.map(|c| c * light.intensity * pre_exposure),
        placed: 1.0,
        cos_outer: -1.0,
        angle_offset: 1.0,
        ..Default::default()
    };
    match light.kind {
        LightKind::Point { position, range } => {
            LightRecord { position: place(position), per_range: per_range(range), ..common }
        }
        LightKind::Spot { position, direction, range, inner, outer } => {
            // KHR_lights_punctual, "Inner and Outer Cone Angles".
            let angle_scale = 1.0 / (inner.cos() - outer.cos()).max(0.001);
            LightRecord {
                position: place(position),
                axis: turn(direction),
                per_range: per_range(range),
                sin_outer: outer.sin() as f32,
                cos_outer: outer.cos() as f32,
                angle_scale: angle_scale as f32,
                angle_offset: (-outer.cos() * angle_scale) as f32,
                ..common
            }
        }
        LightKind::Directional { direction } => LightRecord { position: turn(-direction), placed: 0.0, ..common },
    }
}

fn per_range(range: f64) -> f32 {
    // A range of 0 reaches nothing, and must not become 0 * infinity in the shader.
    (1.0 / range).min(1e30) as f32
}

/// Whether `light` reaches anything within `bounds` (world space).
pub fn reaches(light: &Light, bounds: &Bounds) -> bool {
    match light.kind {
        LightKind::Point { position, range } | LightKind::Spot { position, range, .. } => {
            bounds.distance_squared(position) <= range * range
        }
        LightKind::Directional { .. } => true,
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

    fn sun(lux: f32) -> Light {
        let kind = LightKind::Directional { direction: DVec3::NEG_Y };
        Light { name: String::new(), kind, color: [1.0; 3], intensity: lux, excluded: Vec::new() }
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
}
