// Exposure, tone mapping and the mean of a pixel's samples. Each sample is tone-mapped before the mean is taken: an edge
// between a bright and a dark surface then stays smooth however great their contrast.

struct Exposure {
    scale: f32,
}

@group(0) @binding(2) var<uniform> exposure: Exposure;

struct Developed {
    // Exposed radiance.
    @location(0) hdr: vec4<f32>,
    // Display-encoded.
    @location(1) ldr: vec4<f32>,
}

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

fn srgb_encode(linear: vec3<f32>) -> vec3<f32> {
    let c = clamp(linear, vec3<f32>(0.0), vec3<f32>(1.0));
    return select(1.055 * pow(c, vec3<f32>(1.0 / 2.4)) - 0.055, 12.92 * c, c <= vec3<f32>(0.0031308));
}

@fragment
fn develop(pixel: Pixel) -> Developed {
    let texel = vec2<i32>(pixel.position.xy);
    var hdr = vec3<f32>(0.0);
    var ldr = vec3<f32>(0.0);
    for (var i = 0; i < SAMPLES; i++) {
        let radiance = textureLoad(radiance_texture, texel, i);
        // The share that is shown as it is.
        let as_is = clamp(radiance.a, 0.0, 1.0);
        // Half floats end at 65504; a sum beyond is infinite here.
        let exposed = clamp(radiance.rgb, vec3<f32>(0.0), vec3<f32>(65504.0)) * mix(exposure.scale, 1.0, as_is);
        hdr += exposed;
        ldr += mix(tone_map(exposed), exposed, as_is);
    }
    let mean = 1.0 / f32(SAMPLES);
    return Developed(
        vec4<f32>(min(hdr * mean, vec3<f32>(65504.0)), 1.0),
        vec4<f32>(srgb_encode(ldr * mean), 1.0),
    );
}
