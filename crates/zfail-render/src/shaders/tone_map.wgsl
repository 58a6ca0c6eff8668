// Khronos PBR Neutral tone mapper: base colours pass nearly unchanged, highlights roll off and lose saturation.
fn tone_map(radiance: vec3<f32>) -> vec3<f32> {
    let shoulder = 0.76;
    let desaturation = 0.15;
    let least = min(radiance.r, min(radiance.g, radiance.b));
    let offset = select(0.04, least - 6.25 * least * least, least < 0.08);
    let color = radiance - offset;
    let peak = max(color.r, max(color.g, color.b));
    if peak < shoulder {
        return color;
    }
    let rest = 1.0 - shoulder;
    let compressed = 1.0 - rest * rest / (peak + rest - shoulder);
    let whiteness = 1.0 - 1.0 / (desaturation * (peak - compressed) + 1.0);
    return mix(color * (compressed / peak), vec3<f32>(compressed), whiteness);
}
