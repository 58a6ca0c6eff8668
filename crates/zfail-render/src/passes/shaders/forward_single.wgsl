// With shadows, one sample per pixel.

@group(2) @binding(0) var verdicts: texture_2d<f32>;

@fragment
fn forward(in: Fragment, @builtin(front_facing) front: bool) -> @location(0) vec4<f32> {
    let shadowed = textureLoad(verdicts, vec2<i32>(in.clip.xy), 0);
    return shade(in, front, pack4x8unorm(shadowed));
}

@fragment
fn filtered(in: Fragment, @builtin(front_facing) front: bool) -> @location(0) vec4<f32> {
    return transmittance(in, front);
}
