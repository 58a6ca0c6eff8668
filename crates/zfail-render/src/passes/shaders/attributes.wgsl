// The distance that the attribute pass wrote.

@group(1) @binding(0) var depth_texture: texture_2d<u32>;
