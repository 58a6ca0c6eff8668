// What the geometry pass wrote, several samples per pixel.

@group(1) @binding(0) var albedo_texture: texture_multisampled_2d<f32>;
@group(1) @binding(1) var surface_texture: texture_multisampled_2d<f32>;
@group(1) @binding(2) var geometric_normal_texture: texture_multisampled_2d<f32>;
@group(1) @binding(3) var depth_texture: texture_multisampled_2d<u32>;
