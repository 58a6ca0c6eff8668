// What every pass knows about view and lights. View space: right-handed, the eye at the origin, looking along -z.

struct Light {
    // View space: where the light is, or the unit vector towards it.
    position: vec3<f32>,
    // 1 for a light in a place, 0 for one at infinity: the w of McGuire et al. 2003, section 4.
    placed: f32,
    // View space, unit: the way a spot light shines.
    axis: vec3<f32>,
    // 1 / range, 0 where there is no limit.
    per_range: f32,
    // Pre-exposed intensity (candela) or illuminance (lux).
    color: vec3<f32>,
    // Of the cone's half angle: 0 and -1 where there is no cone.
    sin_outer: f32,
    cos_outer: f32,
    // Falloff from the inner to the outer angle, as KHR_lights_punctual defines it: 0 and 1 where there is no cone.
    angle_scale: f32,
    angle_offset: f32,
    // Where the light's shape begins in `shapes`; 0 for a plain light.
    shape: u32,
    // View space, unit, perpendicular to each other and the axis: how the light is turned.
    right: vec3<f32>,
    // Cotangent of the cone's half angle.
    cot_outer: f32,
    up: vec3<f32>,
}

struct Frame {
    // View-space x and y per unit of NDC: at unit depth (perspective), or anywhere (orthographic).
    view_per_ndc: vec2<f32>,
    // Pixels.
    size: vec2<f32>,
    // Radiance, pre-exposed.
    ambient: vec3<f32>,
    // 1 for an orthographic camera, 0 for a perspective one.
    orthographic: f32,
    // View space, unit: the world's +y.
    up: vec3<f32>,
    // Scale from scene radiance to the radiance that shaders compute.
    pre_exposure: f32,
    // Radiance of pixels without a surface where there is no sky, pre-exposed.
    background: vec3<f32>,
    // Scale from that to the picture's, where it is known beforehand.
    exposure: f32,
    // Radiance of the sky straight up, of horizontal directions and straight down, pre-exposed.
    zenith: vec3<f32>,
    // Lights in use.
    light_count: u32,
    horizon: vec3<f32>,
    // And those that other passes draw, after them.
    all_lights: u32,
    nadir: vec3<f32>,
    per_ground_radius: f32,
    // View space: the middle of the ground.
    ground: vec3<f32>,
    // NDC: where the view axis meets the image.
    window_offset: vec2<f32>,
    // The first lights once more: uniforms are read once for many pixels.
    lights: array<Light, UNROLLED>,
}

const UNROLLED: u32 = 4u;

@group(0) @binding(0) var<uniform> frame: Frame;
@group(0) @binding(1) var<storage, read> lights: array<Light>;

// The view-space point in a pixel's centre at a distance along the view axis.
fn view_position(pixel: vec2<f32>, depth: f32) -> vec3<f32> {
    let ndc = vec2<f32>(2.0, -2.0) * (pixel / frame.size - 0.5) - frame.window_offset;
    return vec3<f32>(ndc * frame.view_per_ndc * mix(depth, 1.0, frame.orthographic), -depth);
}

fn towards_eye(position: vec3<f32>) -> vec3<f32> {
    return normalize(select(-position, vec3<f32>(0.0, 0.0, 1.0), frame.orthographic > 0.5));
}
