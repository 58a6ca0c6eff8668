// The backdrop, over everything that holds no surface.

@fragment
fn open(pixel: Pixel) -> @location(0) vec4<f32> {
    return without_surface(backdrop(pixel.position.xy));
}
