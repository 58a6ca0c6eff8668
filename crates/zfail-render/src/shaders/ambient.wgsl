// The geometry and ambient pass: everything about the visible surface that later passes need, so that a texture is read
// once per pixel however many lights there are.

override ALPHA_MASK: bool = false;

struct GBuffer {
    // Base colour; alpha 1 marks unlit surfaces.
    @location(0) albedo: vec4<f32>,
    // Shading normal (octahedral), roughness, metalness.
    @location(1) surface: vec4<f32>,
    // Geometric normal, octahedral.
    @location(2) geometric_normal: vec2<f32>,
    // Distance along the view axis, as bytes.
    @location(3) depth: vec4<u32>,
    // Ambient and emitted radiance; alpha is the share of the pixel that is shown as it is, without exposure.
    @location(4) radiance: vec4<f32>,
}

@fragment
fn ambient(in: Fragment, @builtin(front_facing) front: bool) -> GBuffer {
    let s = surface(in, front);
    if ALPHA_MASK && s.alpha < material.alpha_cutoff {
        discard;
    }
    let unlit = material.unlit == 1u;
    var out: GBuffer;
    out.albedo = vec4<f32>(s.albedo, f32(material.unlit));
    out.surface = vec4<f32>(octahedral(s.normal), s.roughness, s.metallic);
    out.geometric_normal = octahedral(s.geometric_normal);
    out.depth = depth_bytes(in.depth);
    let lit = min(frame.ambient * s.occlusion * s.albedo + s.emissive, vec3<f32>(BRIGHTEST));
    out.radiance = vec4<f32>(select(lit, s.albedo, unlit), f32(material.unlit));
    return out;
}
