// Unit vectors in two numbers of -1..1: the octahedron's faces unfolded (Meyer et al., "On Floating-Point Normal
// Vectors", 2010).

fn signs(v: vec2<f32>) -> vec2<f32> {
    return select(vec2<f32>(-1.0), vec2<f32>(1.0), v >= vec2<f32>(0.0));
}

fn octahedral(n: vec3<f32>) -> vec2<f32> {
    let p = n.xy / (abs(n.x) + abs(n.y) + abs(n.z));
    return select((1.0 - abs(p.yx)) * signs(p), p, n.z >= 0.0);
}

fn from_octahedral(p: vec2<f32>) -> vec3<f32> {
    let z = 1.0 - abs(p.x) - abs(p.y);
    let xy = select((1.0 - abs(p.yx)) * signs(p), p, z >= 0.0);
    return normalize(vec3<f32>(xy, z));
}
