// Counts side quads before the visible surface. One invocation is one tile of 8x8 pixels.

struct Image {
    size: vec2<u32>,
    base: i32,
    pad: u32,
}

@group(0) @binding(0) var<uniform> image: Image;
// Four texels each: the gradient of four linear functions of the pixel, across, down, and their values in the middle of
// the image; then the weight. The functions are the edges ba (inside where not negative), the two edges to infinity
// (inside where not negative; where negative) and the depth.
@group(0) @binding(1) var quads: texture_2d<f32>;
// Indices of quads, eight tiles interleaved.
@group(0) @binding(2) var entries: texture_2d<u32>;
// For every eight tiles, where their entries begin and how many each has.
@group(0) @binding(3) var<storage, read> groups: array<vec2<u32>>;
// x and y.
@group(0) @binding(4) var<storage, read> tiles: array<u32>;
@group(0) @binding(5) var depth: texture_depth_2d;
@group(0) @binding(6) var shadowed: texture_storage_2d<r32uint, write>;

fn stored(x: u32, y: u32) -> vec4<f32> {
    let last = image.size.y - 1u;
    return vec4(
        textureLoad(depth, vec2(x, min(y, last)), 0),
        textureLoad(depth, vec2(x, min(y + 1u, last)), 0),
        textureLoad(depth, vec2(x, min(y + 2u, last)), 0),
        textureLoad(depth, vec2(x, min(y + 3u, last)), 0),
    );
}

fn inside(e: vec4<f32>, weight: i32, stored: f32) -> i32 {
    let b = bitcast<vec4<i32>>(e);
    return select(0, ((b.z & ~(b.x | b.y)) >> 31u) & weight, e.w > stored);
}

fn column(e: vec4<f32>, dy: vec4<f32>, weight: i32, stored: vec4<f32>) -> vec4<i32> {
    let e1 = e + dy;
    let e2 = e1 + dy;
    let e3 = e2 + dy;
    return vec4(inside(e, weight, stored.x), inside(e1, weight, stored.y), inside(e2, weight, stored.z), inside(e3, weight, stored.w));
}

fn bits(n: vec4<i32>) -> u32 {
    let b = vec4<u32>(n != vec4(0));
    return b.x | (b.y << 1u) | (b.z << 2u) | (b.w << 3u);
}

@compute @workgroup_size(8)
fn count(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let tile = tiles[group.x * 8u + lane];
    let x = (tile & 0xffffu) * 8u;
    let y = (tile >> 16u) * 8u;
    let work = groups[group.x];
    let u = f32(x) + 0.5 - 0.5 * f32(image.size.x);
    let v = f32(y) + 0.5 - 0.5 * f32(image.size.y);
    DEPTHS
    COUNTS
    for (var i = 0u; i < work.y; i++) {
        let entry = work.x + i * 8u + lane;
        let id = textureLoad(entries, vec2(entry & 2047u, entry >> 11u), 0).x;
        let at = vec2((id & 511u) * 4u, id >> 9u);
        let dx = textureLoad(quads, at, 0);
        let dy = textureLoad(quads, at + vec2(1u, 0u), 0);
        let origin = textureLoad(quads, at + vec2(2u, 0u), 0);
        let weight = bitcast<i32>(textureLoad(quads, at + vec2(3u, 0u), 0).x);
        var e = fma(dx, vec4(u), fma(dy, vec4(v), origin));
        let dy4 = dy * 4.0;
        COLUMNS
    }
    textureStore(shadowed, vec2(tile & 0xffffu, tile >> 16u), vec4(LO, 0u, 0u, 0u));
    textureStore(shadowed, vec2((tile & 0xffffu) + 2048u, tile >> 16u), vec4(HI, 0u, 0u, 0u));
}
