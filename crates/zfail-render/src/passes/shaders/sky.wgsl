// A sky whose radiance depends on the height of a direction alone: one colour below the horizon, a gradient above it.

// The scene has a sky.
override SKY: bool = false;

// The horizon as a mirror shows it, in the units of `softness`.
const HORIZON: f32 = 0.004;

// Mean radiance about a direction of height `y`, its cosine to the zenith. `softness` says how wide about: near 0 in that
// direction alone, 1 over the hemisphere by the cosine, which is the irradiance over pi, and in between a step that is
// blurred as microfacets blur it. At 1 the step is exact, (1 + y) / 2, and the gradient to 1 % of the horizon's radiance.
fn sky(y: f32, softness: f32) -> vec3<f32> {
    let above = 0.5 + 0.5 * y * inverseSqrt(mix(y * y, 1.0, softness));
    let width = sqrt(softness);
    let low = min(1.0 - 0.424 * width - (1.0 - 0.758 * width) * y, 1.0);
    return frame.nadir + above * (frame.zenith - frame.nadir + low * (frame.horizon - frame.zenith));
}
