// Light that was drawn apart, several samples per pixel.

@fragment
fn further(pixel: Pixel, @builtin(sample_index) sample_index: u32) -> @location(0) vec4<f32> {
    return textureLoad(radiance_texture, vec2<i32>(pixel.position.xy), i32(sample_index));
}
