// Facing, silhouette and caps of one caster under one light, as index lists of indirect draws.
// McGuire et al. 2003, section 6, ComputeSilhouetteEdges; lists as `zfail_plan::volume` defines them.

struct Params {
    // Object space: (position, 1) or (towards the light, 0).
    light: vec4<f32>,
    // Powers of two that bring edges and ways to the light to about 1, so that products neither overflow nor vanish.
    edge_scale: f32,
    light_scale: f32,
    // First position of the mesh.
    first: u32,
    triangles: u32,
    // Edges with one or two triangles, and those with more.
    edges: u32,
    fans: u32,
    // A vertex that casts, from which the fan starts.
    apex: u32,
    steps: u32,
    // Where the lists begin.
    starts: vec4<u32>,
}

const SIDES = 1u;
const CONVERGING = 2u;
const FAN = 4u;
const DARK_TRIANGLES = 8u;
const LIGHT_CAP = 16u;
// Without triangles of parts that hide themselves.
const EXPOSED = 32u;

// Casting of a part.
const FRONT = 0u;
const BACK = 1u;

const NONE = 0xffffffffu;
const HIGH = 0x80000000u;

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read> positions: array<f32>;
// Three vertices and the part; the highest bit tells of parts that hide themselves.
@group(0) @binding(2) var<storage, read> triangles: array<vec4<u32>>;
// Two vertices, lower first, and two triangles, the highest bit set in those that run from the higher to the lower vertex;
// then those with more triangles, as a range of `fan_triangles`.
@group(0) @binding(3) var<storage, read> edges: array<vec4<u32>>;
@group(0) @binding(4) var<storage, read> fan_triangles: array<u32>;
@group(0) @binding(5) var<storage, read> castings: array<u32>;
@group(0) @binding(6) var<storage, read_write> weights: array<i32>;
@group(0) @binding(7) var<storage, read_write> indices: array<u32>;
// Three indirect draws of five words; the first of each counts indices.
@group(0) @binding(8) var<storage, read_write> draws: array<atomic<u32>, 15>;

// Sides and dark cap, light cap, light cap reversed.
const EXTRUDED = 0u;
const LIT = 1u;
const REVERSED = 2u;

var<workgroup> counts: array<atomic<u32>, 3>;
var<workgroup> bases: array<u32, 3>;

fn position(vertex: u32) -> vec3<f32> {
    let i = 3u * (params.first + vertex);
    return vec3<f32>(positions[i], positions[i + 1u], positions[i + 2u]);
}

// +1 where the light sees the front, -1 where it sees the back, 0 where rounding decides.
fn facing(triangle: vec3<u32>) -> i32 {
    let a = position(triangle.x);
    let ab = (position(triangle.y) - a) * params.edge_scale;
    let ac = (position(triangle.z) - a) * params.edge_scale;
    let to_light = params.light.xyz * params.light_scale - a * (params.light.w * params.light_scale);
    let p = ab.yzx * ac.zxy;
    let q = ab.zxy * ac.yzx;
    let g = dot(p - q, to_light);
    // Eight roundings on the longest way, each of 2^-24 of the sum of all terms without their signs; doubled.
    let error = dot(abs(p) + abs(q), abs(to_light)) * 0x1p-20f;
    return i32(g > error) - i32(g < -error);
}

fn weight(triangle: vec4<u32>) -> i32 {
    if triangle.w == NONE {
        return 0;
    }
    let side = facing(triangle.xyz);
    switch castings[triangle.w & ~HIGH] {
        case FRONT: { return max(side, 0); }
        case BACK: { return min(side, 0); }
        default: { return side; }
    }
}

fn has(step: u32) -> bool {
    return (params.steps & step) != 0u;
}

fn thread(group: vec3<u32>, groups: vec3<u32>, lane: u32) -> u32 {
    return (group.y * groups.x + group.x) * 256u + lane;
}

// Makes room for what the workgroup has counted.
fn reserve(lane: u32) {
    workgroupBarrier();
    if lane < 3u {
        let count = atomicLoad(&counts[lane]);
        if count > 0u {
            bases[lane] = params.starts[lane] + atomicAdd(&draws[5u * lane], count);
        }
    }
    workgroupBarrier();
}

fn put(at: u32, triangle: vec3<u32>) {
    indices[at] = triangle.x;
    indices[at + 1u] = triangle.y;
    indices[at + 2u] = triangle.z;
}

// One invocation a triangle: its weight, once and for all, and its caps.
@compute @workgroup_size(256)
fn face(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let t = thread(group, groups, lane);
    var triangle = vec4<u32>(NONE);
    var c = 0;
    if t < params.triangles {
        triangle = triangles[t];
        c = weight(triangle);
        weights[t] = c;
    }
    let dark = c != 0 && has(DARK_TRIANGLES);
    let lit = c != 0 && has(LIGHT_CAP) && !(has(EXPOSED) && (triangle.w & HIGH) != 0u);
    let list = select(REVERSED, LIT, c > 0);
    var dark_at = 0u;
    var lit_at = 0u;
    if dark {
        dark_at = atomicAdd(&counts[EXTRUDED], 3u);
    }
    if lit {
        lit_at = atomicAdd(&counts[list], 3u);
    }
    reserve(lane);
    if dark {
        let far = triangle.xyz * 2u + 1u;
        put(bases[EXTRUDED] + dark_at, select(far.xyz, far.xzy, c > 0));
    }
    if lit {
        put(bases[list] + lit_at, triangle.xyz * 2u);
    }
}

fn signed_weight(reference: u32) -> i32 {
    let c = weights[reference & ~HIGH];
    return select(c, -c, (reference & HIGH) != 0u);
}

// How often an edge is a silhouette edge: the boundary of the weights.
fn multiplicity(edge: u32) -> i32 {
    if edge < params.edges {
        let ends = edges[edge].zw;
        var m = signed_weight(ends.x);
        if ends.y != NONE {
            m += signed_weight(ends.y);
        }
        return m;
    }
    var m = 0;
    if edge < params.edges + params.fans {
        let range = edges[edge].zw;
        for (var i = range.x; i < range.y; i++) {
            m += signed_weight(fan_triangles[i]);
        }
    }
    return m;
}

// One invocation an edge: its sides, and the fan's triangles beyond them.
@compute @workgroup_size(256)
fn extrude(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let edge = thread(group, groups, lane);
    let m = multiplicity(edge);
    var ends = vec2<u32>();
    if m != 0 {
        ends = edges[edge].xy;
    }
    // The cap runs along the edge one way, the side has to run the other way.
    let a = select(ends.y, ends.x, m > 0);
    let b = select(ends.x, ends.y, m > 0);
    let fan = has(FAN) && a != params.apex && b != params.apex;
    var each = 0u;
    if has(SIDES) {
        each += select(6u, 3u, has(CONVERGING));
    }
    if fan {
        each += 3u;
    }
    let times = u32(abs(m));
    var at = 0u;
    if times * each > 0u {
        at = atomicAdd(&counts[EXTRUDED], times * each);
    }
    reserve(lane);
    at += bases[EXTRUDED];
    for (var i = 0u; i < times; i++) {
        if has(SIDES) {
            if has(CONVERGING) {
                put(at, vec3<u32>(2u * b, 2u * a, 1u));
                at += 3u;
            } else {
                put(at, vec3<u32>(2u * b, 2u * a, 2u * a + 1u));
                put(at + 3u, vec3<u32>(2u * b, 2u * a + 1u, 2u * b + 1u));
                at += 6u;
            }
        }
        if fan {
            put(at, vec3<u32>(2u * params.apex, 2u * b, 2u * a) + 1u);
            at += 3u;
        }
    }
}
