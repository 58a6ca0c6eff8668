// Exposure, tone mapping and the mean of a pixel's samples. Each sample is tone-mapped before the mean is taken: an edge
// between a bright and a dark surface then stays smooth however great their contrast.

struct Exposure {
    scale: f32,
}

@group(0) @binding(1) var<uniform> exposure: Exposure;

struct Developed {
    // Exposed radiance.
    @location(0) hdr: vec4<f32>,
    // Encoded for the display.
    @location(1) ldr: vec4<f32>,
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
