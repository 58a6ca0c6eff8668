// The one vertex program of all passes, so that caps have the depth of the surfaces they lie on.

struct Vertex {
    // w is 1 for surfaces; 0 at infinity.
    @location(0) position: vec4<f32>,
    @location(1) clip_x: vec4<f32>,
    @location(2) clip_y: vec4<f32>,
    @location(3) clip_z: vec4<f32>,
    @location(4) clip_w: vec4<f32>,
}

struct Placed {
    @invariant @builtin(position) clip: vec4<f32>,
}

@vertex
fn place(vertex: Vertex) -> Placed {
    let clip_from_object = mat4x4<f32>(vertex.clip_x, vertex.clip_y, vertex.clip_z, vertex.clip_w);
    return Placed(clip_from_object * vertex.position);
}

// Covers the image.
@vertex
fn cover(@builtin(vertex_index) index: u32) -> @builtin(position) vec4<f32> {
    let corner = vec2<f32>(f32(index & 1u), f32(index >> 1u));
    return vec4<f32>(corner * 4.0 - 1.0, 0.0, 1.0);
}

// The stencil test has let it through.
@fragment
fn lit() -> @location(0) f32 {
    return 1.0;
}

// Fragments of the instrumented run, spread over several counters so that no one of them overflows.
@group(0) @binding(0) var<storage, read_write> counters: array<atomic<u32>, 256>;

@fragment
fn count(@builtin(position) at: vec4<f32>) {
    atomicAdd(&counters[(u32(at.x) & 15u) | ((u32(at.y) & 15u) << 4u)], 1u);
}
