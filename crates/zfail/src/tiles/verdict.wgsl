@group(0) @binding(0) var shadowed: texture_2d<u32>;

@vertex
fn cover(@builtin(vertex_index) index: u32) -> @builtin(position) vec4<f32> {
    let corner = vec2<f32>(f32(index & 1u), f32(index >> 1u));
    return vec4<f32>(corner * 4.0 - 1.0, 0.0, 1.0);
}

@fragment
fn verdict(@builtin(position) position: vec4<f32>) {
    let pixel = vec2<u32>(position.xy);
    let half = (pixel.x >> 2u) & 1u;
    let word = textureLoad(shadowed, vec2((pixel.x >> 3u) + half * 2048u, pixel.y >> 3u), 0).x;
    if ((word >> ((pixel.x & 3u) * 8u + (pixel.y & 7u))) & 1u) == 0u {
        discard;
    }
}
