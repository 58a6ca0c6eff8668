// Triangles with texture coordinates and vertex colours: the vertex stage of textured materials without normal maps.

struct Vertex {
    @location(0) position: vec3<f32>,
    // The tilt (terminator.rs) in w.
    @location(1) normal: vec4<f32>,
    @location(3) uv: vec4<f32>,
    @location(4) color: vec4<f32>,
    @location(5) clip_x: vec4<f32>,
    @location(6) clip_y: vec4<f32>,
    @location(7) clip_z: vec4<f32>,
    @location(8) clip_w: vec4<f32>,
    @location(9) view_x: vec4<f32>,
    @location(10) view_y: vec4<f32>,
    @location(11) view_z: vec4<f32>,
    @location(12) normal_x: vec3<f32>,
    @location(13) normal_y: vec3<f32>,
    @location(14) normal_z: vec3<f32>,
    // Range of the lists of lights, and 1 where no shadow falls.
    @location(15) lights: vec3<u32>,
}

struct Fragment {
    // The same expression as in the shadow volumes, so that caps and surfaces agree to the bit.
    @invariant @builtin(position) clip: vec4<f32>,
    // View space, at the pixel's centre even where the triangle does not cover it: derivatives need that.
    @location(0) position: vec3<f32>,
    @location(1) @interpolate(perspective, centroid) normal: vec3<f32>,
    @location(2) @interpolate(flat) lights: vec3<u32>,
    @location(3) @interpolate(perspective, centroid) uv: vec4<f32>,
    @location(4) @interpolate(perspective, centroid) color: vec4<f32>,
    // As long as the normal.
    @location(5) @interpolate(perspective, centroid) tilt: f32,
}

@vertex
fn place(vertex: Vertex) -> Fragment {
    let p = vec4<f32>(vertex.position, 1.0);
    var out: Fragment;
    out.clip = mat4x4<f32>(vertex.clip_x, vertex.clip_y, vertex.clip_z, vertex.clip_w) * p;
    out.position = vec3<f32>(dot(vertex.view_x, p), dot(vertex.view_y, p), dot(vertex.view_z, p));
    out.normal = mat3x3<f32>(vertex.normal_x, vertex.normal_y, vertex.normal_z) * vertex.normal.xyz;
    out.tilt = vertex.normal.w * length(out.normal);
    out.lights = vertex.lights;
    out.uv = vertex.uv;
    out.color = vertex.color;
    return out;
}

fn vertex_uv(in: Fragment) -> vec4<f32> {
    return in.uv;
}

fn vertex_color(in: Fragment) -> vec4<f32> {
    return in.color;
}

fn vertex_tangent(in: Fragment) -> vec3<f32> {
    return vec3<f32>(0.0);
}

fn vertex_bitangent(in: Fragment) -> vec3<f32> {
    return vec3<f32>(0.0);
}
