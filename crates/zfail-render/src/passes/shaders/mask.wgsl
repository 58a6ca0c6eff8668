// What the stencil buffer says about the surface in a pixel's centre.

@fragment
fn reached(pixel: Pixel) -> @location(0) f32 {
    let depth = depth_from(textureLoad(depth_texture, vec2<i32>(pixel.position.xy), 0));
    if depth >= NO_SURFACE || !reaches(lights[pixel.light], view_position(pixel.position.xy, depth)) {
        return 0.0;
    }
    return 1.0;
}

// The value of the bit that the pipeline's stencil test looks at, in units of 1/255.
override BIT: f32 = 1.0;

@fragment
fn counted(pixel: Pixel) -> @location(0) f32 {
    let depth = depth_from(textureLoad(depth_texture, vec2<i32>(pixel.position.xy), 0));
    return select(BIT / 255.0, 0.0, depth >= NO_SURFACE);
}
