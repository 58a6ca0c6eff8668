// What the measured outputs say about the visible surface.

override ALPHA_MASK: bool = false;

struct Attributes {
    // Distance along the view axis, as bytes.
    @location(0) depth: vec4<u32>,
    // Shading normal, view space, octahedral.
    @location(1) normal: vec2<f32>,
    @location(2) albedo: vec4<f32>,
}

@fragment
fn describe(in: Fragment, @builtin(front_facing) front: bool) -> Attributes {
    let s = surface(in, front, towards_eye(in.position));
    if ALPHA_MASK && s.alpha < material.alpha_cutoff {
        discard;
    }
    return Attributes(depth_bytes(-in.position.z), octahedral(s.normal), vec4<f32>(s.albedo, 1.0));
}
