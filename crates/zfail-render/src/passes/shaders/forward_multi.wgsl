// With shadows, several samples per pixel: each has a verdict of its own, so each is shaded.

@group(2) @binding(0) var verdicts: texture_multisampled_2d<f32>;

@fragment
fn forward(
    in: Fragment, @builtin(front_facing) front: bool, @builtin(sample_index) sample_index: u32,
) -> @location(0) vec4<f32> {
    let shadowed = textureLoad(verdicts, vec2<i32>(in.clip.xy), i32(sample_index));
    return shade(in, front, pack4x8unorm(shadowed));
}

@fragment
fn filtered(in: Fragment, @builtin(front_facing) front: bool) -> @location(0) vec4<f32> {
    return transmittance(in, front);
}
