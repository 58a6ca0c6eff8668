// Verdicts on the ground, several samples per pixel.

@group(1) @binding(0) var verdicts: texture_multisampled_2d<f32>;

@fragment
fn judged(in: Fragment, @builtin(sample_index) sample_index: u32) -> @location(0) vec4<f32> {
    return caught(in, pack4x8unorm(textureLoad(verdicts, vec2<i32>(in.clip.xy), i32(sample_index))));
}
