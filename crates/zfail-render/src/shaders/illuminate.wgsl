// One light's contribution to one sample, where the stencil test has found it lit. The last argument of textureLoad is
// the sample of a multisampled target, and the level, always 0, of another.

@fragment
fn illuminate(pixel: Pixel, @builtin(sample_index) sample_index: u32) -> @location(0) vec4<f32> {
    let texel = vec2<i32>(pixel.position.xy);
    // As a level it has to be signed for GLSL.
    let sample = i32(sample_index);
    let depth = depth_from(textureLoad(depth_texture, texel, sample));
    let albedo = textureLoad(albedo_texture, texel, sample);
    if depth >= NO_SURFACE || albedo.a > 0.5 {
        return vec4<f32>(0.0);
    }
    let surface = textureLoad(surface_texture, texel, sample);
    let radiance = reflected(
        lights[pixel.light],
        view_position(floor(pixel.position.xy) + 0.5, depth),
        from_octahedral(textureLoad(geometric_normal_texture, texel, sample).xy),
        from_octahedral(surface.xy),
        albedo.rgb,
        surface.w,
        surface.z,
    );
    return vec4<f32>(min(radiance, vec3<f32>(BRIGHTEST)), 0.0);
}
