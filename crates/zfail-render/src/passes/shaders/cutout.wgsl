// Depth of masked surfaces: only where they are.

@fragment
fn depth(in: Fragment) {
    var alpha = material.base_color.a * vertex_color(in).a;
    if BASE_COLOR {
        let uv = slot_uv(material.base_color_slot, vertex_uv(in));
        alpha *= textureSample(base_color_texture, base_color_sampler, uv).a;
    }
    if alpha < material.alpha_cutoff {
        discard;
    }
}
