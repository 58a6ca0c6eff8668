// One triangle over the whole target. The instance index says which light is drawn.

struct Pixel {
    @builtin(position) position: vec4<f32>,
    @location(0) @interpolate(flat) light: u32,
}

@vertex
fn cover(@builtin(vertex_index) vertex: u32, @builtin(instance_index) instance: u32) -> Pixel {
    let corner = vec2<f32>(f32((vertex << 1u) & 2u), f32(vertex & 2u));
    return Pixel(vec4<f32>(corner * 2.0 - 1.0, 0.0, 1.0), instance);
}
