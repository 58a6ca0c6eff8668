// A shadow map is looked up for every visible surface.

struct Map {
    // To the clip space of every face, from positions relative to the eye.
    faces: array<mat4x4<f32>, 6>,
    // Relative to the eye, or towards the light with w = 0.
    light: vec4<f32>,
    face_count: u32,
    resolution: u32,
    // Whether four texels vote.
    pcf: u32,
    // Distance at which a map begins; 0 for parallel rays.
    near: f32,
    // From there to where it ends.
    range: f32,
    // What is taken from distances: so much, and so much per tangent of the slope and texel.
    bias: f32,
    slope_bias: f32,
    // Size of a texel, at distance 1 unless rays are parallel.
    texel: f32,
}

@group(0) @binding(0) var<uniform> map: Map;
// Depth, bound as floats because not every backend loads from depth textures.
@group(0) @binding(1) var depths: texture_2d_array<f32>;

// The distance of what a face's texel sees, along the face's axis.
fn seen(at: vec2<i32>, face: u32) -> f32 {
    let depth = textureLoad(depths, clamp(at, vec2<i32>(0), vec2<i32>(i32(map.resolution) - 1)), face, 0).r;
    if map.light.w == 0.0 {
        return (1.0 - depth) * map.range;
    }
    // Nothing is seen at depth 0.
    return select(map.near / depth, 1e38, depth == 0.0);
}

@fragment
fn lit(surface: Surface) -> @location(0) f32 {
    let p = surface.position;
    let normal = normalize(cross(dpdx(p), dpdy(p)));
    let cosine = abs(dot(normal, normalize(map.light.xyz - p * map.light.w)));
    // No bias is large enough for a surface that the light only grazes.
    let tangent = min(sqrt(max(1.0 - cosine * cosine, 0.0)) / max(cosine, 1e-6), 10.0);
    for (var face = 0u; face < map.face_count; face++) {
        let clip = map.faces[face] * vec4<f32>(p, 1.0);
        if clip.w <= 0.0 || any(abs(clip.xy) > vec2<f32>(clip.w)) {
            continue;
        }
        let parallel = map.light.w == 0.0;
        let distance = select(clip.w, (1.0 - clip.z) * map.range, parallel);
        let texel = select(map.texel * distance, map.texel, parallel);
        let compared = distance - map.bias - map.slope_bias * tangent * texel;
        let at = (clip.xy / clip.w * vec2<f32>(0.5, -0.5) + 0.5) * f32(map.resolution);
        if map.pcf == 0u {
            return select(0.0, 1.0, compared <= seen(vec2<i32>(floor(at)), face));
        }
        var votes = 0u;
        for (var i = 0u; i < 4u; i++) {
            let neighbour = vec2<i32>(floor(at - 0.5)) + vec2<i32>(vec2<u32>(i & 1u, i >> 1u));
            votes += select(0u, 1u, compared <= seen(neighbour, face));
        }
        return select(0.0, 1.0, votes >= 2u);
    }
    // Outside of all maps.
    return 1.0;
}
