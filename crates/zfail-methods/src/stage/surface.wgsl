// Surfaces with their positions, for methods that look at each of them.

struct Vertex {
    @location(0) position: vec4<f32>,
    @location(1) clip_x: vec4<f32>,
    @location(2) clip_y: vec4<f32>,
    @location(3) clip_z: vec4<f32>,
    @location(4) clip_w: vec4<f32>,
    @location(5) relative_x: vec4<f32>,
    @location(6) relative_y: vec4<f32>,
    @location(7) relative_z: vec4<f32>,
}

struct Surface {
    @invariant @builtin(position) clip: vec4<f32>,
    // Relative to the eye, in the directions of the world.
    @location(0) position: vec3<f32>,
}

@vertex
fn place(vertex: Vertex) -> Surface {
    let clip_from_object = mat4x4<f32>(vertex.clip_x, vertex.clip_y, vertex.clip_z, vertex.clip_w);
    let p = vertex.position;
    let position = vec3<f32>(dot(vertex.relative_x, p), dot(vertex.relative_y, p), dot(vertex.relative_z, p));
    return Surface(clip_from_object * p, position);
}
