// Blended materials over the finished opaque image, lit by every light without shadows.

override UNLIT: bool = false;

@fragment
fn blend(in: Fragment, @builtin(front_facing) front: bool) -> @location(0) vec4<f32> {
    let s = surface(in, front);
    if UNLIT {
        return vec4<f32>(s.albedo * s.alpha, s.alpha);
    }
    var radiance = frame.ambient * s.occlusion * s.albedo + s.emissive;
    for (var i = 0u; i < frame.light_count; i++) {
        radiance += reflected(
            lights[i], in.position, s.geometric_normal, s.normal, s.albedo, s.metallic, s.roughness,
        );
    }
    return vec4<f32>(min(radiance, vec3<f32>(BRIGHTEST)) * s.alpha, s.alpha);
}
