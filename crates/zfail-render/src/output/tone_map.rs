//! Tone mapping of colours that no shader sees: as in `tone_map.wgsl` (tested against it).

use crate::srgb;

/// What the display gets for exposed linear `radiance`, as in [`crate::Picture::hdr`]: tone-mapped, sRGB-encoded, opaque
/// RGBA from 0 to 1.
#[must_use]
pub fn displayed(radiance: [f32; 3]) -> [f64; 4] {
    let [r, g, b] = tone_map(radiance).map(|c| f64::from(srgb::encoded(c)));
    [r, g, b, 1.0]
}

/// Displayed linear colour of exposed `radiance`: the Khronos PBR Neutral tone mapper, clamped to the display.
fn tone_map(radiance: [f32; 3]) -> [f32; 3] {
    let [shoulder, desaturation] = [0.76, 0.15];
    let least = radiance.into_iter().fold(f32::INFINITY, f32::min);
    let offset = if least < 0.08 { least - 6.25 * least * least } else { 0.04 };
    let color = radiance.map(|c| c - offset);
    let peak = color.into_iter().fold(f32::NEG_INFINITY, f32::max);
    let mapped = if peak < shoulder {
        color
    } else {
        let rest = 1.0 - shoulder;
        let compressed = 1.0 - rest * rest / (peak + rest - shoulder);
        let whiteness = 1.0 - 1.0 / (desaturation * (peak - compressed) + 1.0);
        color.map(|c| c * (compressed / peak) * (1.0 - whiteness) + compressed * whiteness)
    };
    mapped.map(|c| c.clamp(0.0, 1.0))
}
