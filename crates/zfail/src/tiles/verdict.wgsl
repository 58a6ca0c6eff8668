// Brings the counts of the tile pass into the stencil: lit pixels are discarded, the others reach the stencil operation.

@group(0) @binding(0) var shadowed: texture_2d<u32>;

// The instance is where the light begins in `shadowed`.
struct Cover {
    @builtin(position) position: vec4<f32>,
    @location(0) @interpolate(flat) row: u32,
}

@vertex
fn cover(@builtin(vertex_index) index: u32, @builtin(instance_index) row: u32) -> Cover {
    let corner = vec2<f32>(f32(index & 1u), f32(index >> 1u));
    return Cover(vec4<f32>(corner * 4.0 - 1.0, 0.0, 1.0), row);
}

@fragment
fn verdict(in: Cover) {
    let pixel = vec2<u32>(in.position.xy);
    let word = textureLoad(shadowed, vec2(pixel.x >> 2u, in.row + (pixel.y >> 3u)), 0).x;
    if extractBits(word, (pixel.x & 3u) * 8u + (pixel.y & 7u), 1u) == 0u {
        discard;
    }
}
