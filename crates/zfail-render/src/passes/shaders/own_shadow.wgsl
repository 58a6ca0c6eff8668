// Casting surfaces whose visible side turns away from a light lie in a shadow that they throw themselves.

@group(1) @binding(0) var<uniform> chosen: u32;

@fragment
fn turned_away(in: Fragment) -> @location(0) f32 {
    let across = dpdx(in.position);
    let down = dpdy(in.position);
    let flat_normal = cross(across, down);
    let light = lights[chosen];
    let to_light = light.position - in.position * light.placed;
    let side = select(-1.0, 1.0, dot(flat_normal, towards_eye(in.position)) >= 0.0);
    // Within the rounding of positions the stencil decides.
    let rounding = 1e-6 * length(in.position) * (length(across) + length(down)) + 1e-3 * length(flat_normal);
    if side * dot(flat_normal, to_light) > -rounding * length(to_light) {
        discard;
    }
    return 0.0;
}
