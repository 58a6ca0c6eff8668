// The finished radiance, several samples per pixel.

@group(0) @binding(0) var radiance_texture: texture_multisampled_2d<f32>;

const SAMPLES: i32 = 4;
