// What is seen where no surface is: a calm sky, or one colour.

// The picture itself is written, not radiance.
override DEVELOPED: bool = false;

// Softer than what is mirrored: the horizon is no line that competes with the scene.
const CALM: f32 = 0.2;

// Radiance behind a pixel, without exposure.
fn backdrop(pixel: vec2<f32>) -> vec3<f32> {
    if !SKY {
        return frame.background;
    }
    let ray = -towards_eye(view_position(pixel, 1.0));
    return sky(dot(ray, frame.up), CALM);
}

// For the target. A negative share to be shown as it is marks what is no surface.
fn without_surface(radiance: vec3<f32>) -> vec4<f32> {
    if DEVELOPED {
        return vec4<f32>(srgb_encode(tone_map(radiance * frame.exposure)), 1.0);
    }
    return vec4<f32>(min(radiance, vec3<f32>(BRIGHTEST)), -1.0);
}
