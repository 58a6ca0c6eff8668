// Light that was drawn apart, one sample per pixel.

@fragment
fn further(pixel: Pixel) -> @location(0) vec4<f32> {
    return textureLoad(radiance_texture, vec2<i32>(pixel.position.xy), 0);
}
