// Depth of opaque surfaces: nothing but positions.

struct Vertex {
    @location(0) position: vec3<f32>,
    @location(5) clip_x: vec4<f32>,
    @location(6) clip_y: vec4<f32>,
    @location(7) clip_z: vec4<f32>,
    @location(8) clip_w: vec4<f32>,
}

struct Placed {
    // The same expression as in the shadow volumes, so that caps and surfaces agree to the bit.
    @invariant @builtin(position) clip: vec4<f32>,
}

@vertex
fn place(vertex: Vertex) -> Placed {
    let clip_from_object = mat4x4<f32>(vertex.clip_x, vertex.clip_y, vertex.clip_z, vertex.clip_w);
    return Placed(clip_from_object * vec4<f32>(vertex.position, 1.0));
}

// The pass has a colour target, which this leaves alone.
@fragment
fn depth() {}
