// Counts side quads that lie before the visible surface. One invocation is one tile of 8x8 pixels; software devices run
// eight of them as the lanes of one vector, so that a quad is fetched once for 64 pixels and no lane depends on another.

// Invocations in a workgroup, whose entries are interleaved.
override LANES: u32 = 8u;

struct Image {
    size: vec2<u32>,
}

struct Group {
    // Where its entries begin and how many each tile has.
    first: u32,
    length: u32,
    // Where its light begins in `shadowed`.
    row: u32,
    // Count at the near plane.
    base: i32,
}

@group(0) @binding(0) var<uniform> image: Image;
@group(0) @binding(1) var<storage, read> groups: array<Group>;
// x and y of each tile in tiles, 16 bits each; all ones where a group is not full.
@group(0) @binding(2) var<storage, read> tiles: array<u32>;
// Textures, because software devices fetch texels faster than they load from buffers.
// Indices of quads, those of a group's tiles in turn; rows of 2048.
@group(0) @binding(3) var entries: texture_2d<u32>;
// Four texels a quad, 512 quads a row. Three hold four linear functions of the pixel: gradient across, gradient down, value
// in the middle of the image. The functions are the silhouette edge (inside where not negative), the edges from its ends
// to infinity (inside where the first is not negative and the second is), and the depth. The fourth texel is the weight.
@group(0) @binding(4) var quads: texture_2d<f32>;
@group(0) @binding(5) var depth: texture_2d<f32>;
// One bit a pixel, four columns of eight a texel; one light below the other.
@group(0) @binding(6) var shadowed: texture_storage_2d<r32uint, write>;

fn depths(x: u32, y: u32) -> vec4<f32> {
    let last = image.size - 1u;
    let column = min(x, last.x);
    return vec4(
        textureLoad(depth, vec2(column, min(y, last.y)), 0).x,
        textureLoad(depth, vec2(column, min(y + 1u, last.y)), 0).x,
        textureLoad(depth, vec2(column, min(y + 2u, last.y)), 0).x,
        textureLoad(depth, vec2(column, min(y + 3u, last.y)), 0).x,
    );
}

// The weight if the functions' values f put a pixel inside the quad and the quad before the surface.
fn crossing(f: vec4<f32>, weight: i32, surface: f32) -> i32 {
    let sign = bitcast<vec3<i32>>(f.xyz);
    // The shift makes a mask of the sign bit.
    return select(0, ((sign.z & ~(sign.x | sign.y)) >> 31u) & weight, f.w > surface);
}

// Four pixels downwards.
fn crossings(f: vec4<f32>, down: vec4<f32>, weight: i32, surface: vec4<f32>) -> vec4<i32> {
    let f1 = f + down;
    let f2 = f1 + down;
    let f3 = f2 + down;
    return vec4(
        crossing(f, weight, surface.x),
        crossing(f1, weight, surface.y),
        crossing(f2, weight, surface.z),
        crossing(f3, weight, surface.w),
    );
}

fn bits(counts: vec4<i32>) -> u32 {
    return dot(vec4<u32>(counts != vec4(0)), vec4(1u, 2u, 4u, 8u));
}

@compute @workgroup_size(LANES)
fn count(
    @builtin(workgroup_id) workgroup: vec3<u32>,
    @builtin(num_workgroups) workgroups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let index = workgroup.y * workgroups.x + workgroup.x;
    let group = groups[index];
    let packed = tiles[index * LANES + lane];
    let tile = vec2(packed & 0xffffu, packed >> 16u);
    let x = tile.x * 8u;
    let y = tile.y * 8u;

    let a0 = depths(x, y);
    let b0 = depths(x, y + 4u);
    let a1 = depths(x + 1u, y);
    let b1 = depths(x + 1u, y + 4u);
    let a2 = depths(x + 2u, y);
    let b2 = depths(x + 2u, y + 4u);
    let a3 = depths(x + 3u, y);
    let b3 = depths(x + 3u, y + 4u);
    let a4 = depths(x + 4u, y);
    let b4 = depths(x + 4u, y + 4u);
    let a5 = depths(x + 5u, y);
    let b5 = depths(x + 5u, y + 4u);
    let a6 = depths(x + 6u, y);
    let b6 = depths(x + 6u, y + 4u);
    let a7 = depths(x + 7u, y);
    let b7 = depths(x + 7u, y + 4u);

    // Upper and lower half of every column.
    var n: array<vec4<i32>, 16>;
    for (var i = 0u; i < 16u; i++) {
        n[i] = vec4(group.base);
    }
    // Centre of the first pixel.
    let u = f32(x) + 0.5 - 0.5 * f32(image.size.x);
    let v = f32(y) + 0.5 - 0.5 * f32(image.size.y);
    for (var i = 0u; i < group.length; i++) {
        let entry = group.first + i * LANES + lane;
        let quad = textureLoad(entries, vec2(entry & 2047u, entry >> 11u), 0).x;
        let at = vec2((quad & 511u) * 4u, quad >> 9u);
        let across = textureLoad(quads, at, 0);
        let down = textureLoad(quads, at + vec2(1u, 0u), 0);
        let middle = textureLoad(quads, at + vec2(2u, 0u), 0);
        let weight = bitcast<i32>(textureLoad(quads, at + vec2(3u, 0u), 0).x);
        // Quads that share an edge add the same numbers in the same order.
        var f = fma(across, vec4(u), fma(down, vec4(v), middle));
        let half = 4.0 * down;
        n[0] += crossings(f, down, weight, a0);
        n[1] += crossings(f + half, down, weight, b0);
        f += across;
        n[2] += crossings(f, down, weight, a1);
        n[3] += crossings(f + half, down, weight, b1);
        f += across;
        n[4] += crossings(f, down, weight, a2);
        n[5] += crossings(f + half, down, weight, b2);
        f += across;
        n[6] += crossings(f, down, weight, a3);
        n[7] += crossings(f + half, down, weight, b3);
        f += across;
        n[8] += crossings(f, down, weight, a4);
        n[9] += crossings(f + half, down, weight, b4);
        f += across;
        n[10] += crossings(f, down, weight, a5);
        n[11] += crossings(f + half, down, weight, b5);
        f += across;
        n[12] += crossings(f, down, weight, a6);
        n[13] += crossings(f + half, down, weight, b6);
        f += across;
        n[14] += crossings(f, down, weight, a7);
        n[15] += crossings(f + half, down, weight, b7);
    }
    if packed == 0xffffffffu {
        return;
    }
    for (var half = 0u; half < 2u; half++) {
        var word = 0u;
        for (var i = 0u; i < 8u; i++) {
            word |= bits(n[half * 8u + i]) << (4u * i);
        }
        textureStore(shadowed, vec2(tile.x * 2u + half, group.row + tile.y), vec4(word, 0u, 0u, 0u));
    }
}
