// Whether a view-space point lies within the light's range, cone and box.
fn reaches(light: Light, position: vec3<f32>) -> bool {
    if light.placed == 0.0 {
        return true;
    }
    let ray = position - light.position;
    if length(ray) * light.per_range > 1.0 {
        return false;
    }
    if light.shape != 0u && !within_box(light, ray) {
        return false;
    }
    if light.cos_outer < 0.0 {
        return true;
    }
    // Angle to the axis <= outer, without the cancellation of a cosine near 1.
    let along = dot(ray, light.axis);
    let across = length(ray - along * light.axis);
    return across * light.cos_outer <= along * light.sin_outer;
}
