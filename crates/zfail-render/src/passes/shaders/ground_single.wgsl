// Verdicts on the ground, one sample per pixel.

@group(1) @binding(0) var verdicts: texture_2d<f32>;

@fragment
fn judged(in: Fragment) -> @location(0) vec4<f32> {
    return caught(in, pack4x8unorm(textureLoad(verdicts, vec2<i32>(in.clip.xy), 0)));
}
