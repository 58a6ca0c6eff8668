// Punctual lights (KHR_lights_punctual). One formula serves every kind of light: software rasterisers compute all branches
// anyway.

// Some light has a shape of its own.
override SHAPED: bool = false;

// What arrives of a light at a point where nothing blocks it.
struct Arrival {
    // Unit, towards the light.
    direction: vec3<f32>,
    // Of `color`: the irradiance of a surface that faces the light.
    share: f32,
    color: vec3<f32>,
}

// At a view-space position that changes by `position_dx` and `position_dy` from pixel to pixel.
fn arriving(light: Light, position: vec3<f32>, position_dx: vec3<f32>, position_dy: vec3<f32>) -> Arrival {
    let to_light = light.position - position * light.placed;
    let distance_squared = max(dot(to_light, to_light), 1e-20);
    let per_distance = inverseSqrt(distance_squared);
    let direction = to_light * per_distance;
    let relative_squared = distance_squared * light.per_range * light.per_range;
    let window = clamp(1.0 - relative_squared * relative_squared, 0.0, 1.0);
    let cone = clamp(light.angle_offset - dot(light.axis, direction) * light.angle_scale, 0.0, 1.0);
    var share = window * cone * cone * per_distance * per_distance;
    var color = light.color;
    if SHAPED && light.shape != 0u {
        let physical = window * per_distance * per_distance;
        share = cone * cone * falloff(light, distance_squared * per_distance, physical);
        if !within_box(light, -to_light) {
            share = 0.0;
        }
        if share > 0.0 {
            color *= cookie(light, -to_light, position_dx, position_dy);
        }
    }
    return Arrival(direction, share, color);
}
