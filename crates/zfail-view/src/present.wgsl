// The picture, enlarged to the viewport. It is sRGB-encoded already.

@group(0) @binding(0) var picture: texture_2d<f32>;
@group(0) @binding(1) var smooth_sampler: sampler;

struct Corner {
    @builtin(position) position: vec4f,
    @location(0) at: vec2f,
}

@vertex
fn corner(@builtin(vertex_index) index: u32) -> Corner {
    let at = vec2f(f32((index << 1u) & 2u), f32(index & 2u));
    return Corner(vec4f(at.x * 2.0 - 1.0, 1.0 - at.y * 2.0, 0.0, 1.0), at);
}

// For surfaces that show what they are given.
@fragment
fn encoded(in: Corner) -> @location(0) vec4f {
    return vec4f(textureSampleLevel(picture, smooth_sampler, in.at, 0.0).rgb, 1.0);
}

// For surfaces that encode what they are given.
@fragment
fn linear(in: Corner) -> @location(0) vec4f {
    let c = textureSampleLevel(picture, smooth_sampler, in.at, 0.0).rgb;
    let low = c / 12.92;
    let high = pow((c + 0.055) / 1.055, vec3f(2.4));
    return vec4f(select(high, low, c <= vec3f(0.04045)), 1.0);
}
