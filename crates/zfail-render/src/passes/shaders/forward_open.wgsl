// Without shadows.

@fragment
fn forward(in: Fragment, @builtin(front_facing) front: bool) -> @location(0) vec4<f32> {
    return shade(in, front, 0u);
}

@fragment
fn filtered(in: Fragment, @builtin(front_facing) front: bool) -> @location(0) vec4<f32> {
    return transmittance(in, front);
}
