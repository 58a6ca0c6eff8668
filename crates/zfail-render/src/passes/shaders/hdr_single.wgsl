// The finished radiance, one sample per pixel.

@group(0) @binding(0) var radiance_texture: texture_2d<f32>;

const SAMPLES: i32 = 1;
