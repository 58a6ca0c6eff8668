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
    // Two divisions instead of four.
    let rest = 1.0 - shoulder;
    let compressed = 1.0 - rest * rest / (peak + rest - shoulder);
    let softness = desaturation * (peak - compressed) + 1.0;
    let per_both = 1.0 / (peak * softness);
    let whiteness = 1.0 - peak * per_both;
    return mix(color * (compressed * softness * per_both), vec3<f32>(compressed), whiteness);
}

// Encoded for the display: IEC 61966-2-1, its power function as a polynomial in the square root, which is less than a
// tenth of an 8-bit step off.
fn srgb_encode(linear: vec3<f32>) -> vec3<f32> {
    let c = clamp(linear, vec3<f32>(0.0), vec3<f32>(1.0));
    let s = sqrt(c);
    var p = s * 0.51719809 - 1.62331851;
    p = p * s + 2.03118446;
    p = p * s - 1.40254364;
    p = p * s + 1.51791170;
    p = p * s - 0.04010718;
    return select(p, 12.92 * c, c <= vec3<f32>(0.0031308));
}
