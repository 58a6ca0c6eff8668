// What every pass knows about the view. View space: right-handed, the eye at the origin, looking along -z.

struct Frame {
    // View-space x and y per unit of NDC: at unit depth (perspective), or anywhere (orthographic).
    view_per_ndc: vec2<f32>,
    // Pixels.
    size: vec2<f32>,
    // Radiance, pre-exposed.
    ambient: vec3<f32>,
    // 1 for an orthographic camera, 0 for a perspective one.
    orthographic: f32,
    // Scale from scene radiance to the radiance that targets hold.
    pre_exposure: f32,
    // Lights in use.
    light_count: u32,
}

@group(0) @binding(0) var<uniform> frame: Frame;

// The view-space point in a pixel's centre at a distance along the view axis.
fn view_position(pixel: vec2<f32>, depth: f32) -> vec3<f32> {
    let ndc = vec2<f32>(2.0, -2.0) * (pixel / frame.size - 0.5);
    return vec3<f32>(ndc * frame.view_per_ndc * mix(depth, 1.0, frame.orthographic), -depth);
}

fn towards_eye(position: vec3<f32>) -> vec3<f32> {
    if frame.orthographic > 0.5 {
        return vec3<f32>(0.0, 0.0, 1.0);
    }
    return normalize(-position);
}
