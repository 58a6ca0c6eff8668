// Keeps one light's verdict beyond the stencil buffer, which the next light needs: draws over what the stencil test finds in
// shadow. The pipeline's write mask chooses the channel, the instance the bit.

struct Cover {
    @builtin(position) position: vec4<f32>,
    @location(0) @interpolate(flat) bit: u32,
}

@vertex
fn cover(@builtin(vertex_index) index: u32, @builtin(instance_index) bit: u32) -> Cover {
    let corner = vec2<f32>(f32(index & 1u), f32(index >> 1u));
    return Cover(vec4<f32>(corner * 4.0 - 1.0, 0.0, 1.0), bit);
}

@fragment
fn verdict(in: Cover) -> @location(0) vec4<f32> {
    return vec4<f32>(f32(1u << in.bit) / 255.0);
}
