// Figures: surfaces, translucent volumes, counts and lines from homogeneous points.

struct Frame {
    clip_from_origin: mat4x4<f32>,
    // Pixels.
    size: vec2<f32>,
}

@group(0) @binding(0) var<uniform> frame: Frame;

struct Vertex {
    @location(0) position: vec4<f32>,
    @location(1) color: vec4<f32>,
    @location(2) side: f32,
}

struct Placed {
    // Depth pass, tints and counts agree to the bit.
    @invariant @builtin(position) clip: vec4<f32>,
    @location(0) @interpolate(flat) color: vec4<f32>,
    @location(1) @interpolate(flat) side: f32,
}

fn clip_of(p: vec4<f32>) -> vec4<f32> {
    var clip = frame.clip_from_origin * p;
    // As in the shadow volumes: some rasterisers lose directions almost in the image plane.
    let least = 1e-5 * max(abs(clip.x), abs(clip.y));
    if p.w == 0.0 && abs(clip.w) < least {
        clip.w = least;
    }
    return clip;
}

@vertex
fn place(vertex: Vertex) -> Placed {
    return Placed(clip_of(vertex.position), vertex.color, vertex.side);
}

fn is_seen(side: f32, front: bool) -> bool {
    return side == 0.0 || (side > 0.0) == front;
}

@fragment
fn depth(in: Placed, @builtin(front_facing) front: bool) {
    if !is_seen(in.side, front) {
        discard;
    }
}

// Marks a pixel as one that sees a surface.
@fragment
fn mark(in: Placed, @builtin(front_facing) front: bool) -> @location(0) vec4<f32> {
    if !is_seen(in.side, front) {
        discard;
    }
    return vec4<f32>(0.0, 1.0, 0.0, 0.0);
}

@fragment
fn opaque(in: Placed) -> @location(0) vec4<f32> {
    return vec4<f32>(in.color.rgb, 1.0);
}

struct Layers {
    // Optical depth times colour, and optical depth.
    @location(0) glass: vec4<f32>,
    // Colour times opacity, and opacity.
    @location(1) ink: vec4<f32>,
}

@fragment
fn tint(in: Placed, @builtin(front_facing) front: bool) -> Layers {
    if !is_seen(in.side, front) {
        discard;
    }
    return Layers(vec4<f32>(0.0), vec4<f32>(in.color.rgb * in.color.a, in.color.a));
}

// Layers of optical depth t let exp(-t) through, in any order; their colours mix by t.
@fragment
fn glass(in: Placed, @builtin(front_facing) front: bool) -> Layers {
    let t = -log(1.0 - min(in.color.a, 0.996));
    // The inside of a volume is darker than its outside.
    let shade = select(0.8, 1.0, (in.side > 0.0) == front);
    return Layers(vec4<f32>(in.color.rgb * shade * t, t), vec4<f32>(0.0));
}

// z-fail, signed and without wrapping: drawn where a volume is at or behind the visible surface.
fn step_of(side: f32, front: bool) -> vec4<f32> {
    return vec4<f32>(select(1.0, -1.0, (side > 0.0) == front), 0.0, 0.0, 0.0);
}

@fragment
fn count(in: Placed, @builtin(front_facing) front: bool) -> @location(0) vec4<f32> {
    return step_of(in.side, front);
}

// Where a finite far plane would clip, depth is clamped by hand.
struct Clamped {
    @builtin(position) clip: vec4<f32>,
    @location(0) @interpolate(flat) side: f32,
    @location(1) depth: vec2<f32>,
}

@vertex
fn place_clamped(vertex: Vertex) -> Clamped {
    let clip = clip_of(vertex.position);
    return Clamped(vec4<f32>(clip.xy, 0.5 * clip.w, clip.w), vertex.side, clip.zw);
}

struct Counted {
    @location(0) count: vec4<f32>,
    @builtin(frag_depth) depth: f32,
}

@fragment
fn count_clamped(in: Clamped, @builtin(front_facing) front: bool) -> Counted {
    return Counted(step_of(in.side, front), clamp(in.depth.x / in.depth.y, 0.0, 1.0));
}

struct Line {
    @location(0) start: vec4<f32>,
    @location(1) end: vec4<f32>,
    @location(2) color: vec4<f32>,
    // Width, opacity where hidden, dash, and whether the ends are in clip space.
    @location(3) style: vec4<f32>,
}

struct Stroke {
    @builtin(position) clip: vec4<f32>,
    @location(0) @interpolate(flat) color: vec4<f32>,
    // Across from the middle and along from the start in pixels, and 1; all times w, to be linear on the screen.
    @location(1) at: vec3<f32>,
    @location(2) @interpolate(flat) style: vec4<f32>,
}

const NOWHERE = Stroke(vec4<f32>(0.0, 0.0, 2.0, 1.0), vec4<f32>(0.0), vec3<f32>(0.0), vec4<f32>(0.0));

// The part [x, y] of 0 to 1 of a line where a value that is `a` at its start and `b` at its end is positive.
fn positive(part: vec2<f32>, a: f32, b: f32) -> vec2<f32> {
    if a <= 0.0 && b <= 0.0 {
        return vec2<f32>(1.0, 0.0);
    }
    let t = a / (a - b);
    if a < 0.0 {
        return vec2<f32>(max(part.x, t), part.y);
    }
    return select(part, vec2<f32>(part.x, min(part.y, t)), b < 0.0);
}

@vertex
fn stroke(line: Line, @builtin(vertex_index) index: u32) -> Stroke {
    var a = line.start;
    var b = line.end;
    if line.style.w == 0.0 {
        a = frame.clip_from_origin * a;
        b = frame.clip_from_origin * b;
    }
    // In front of the near plane z <= w, for depth is reversed. To the sides some margin is left for the width.
    const MARGIN = 1.5;
    var part = positive(vec2<f32>(0.0, 1.0), a.w - a.z, b.w - b.z);
    part = positive(part, MARGIN * a.w - a.x, MARGIN * b.w - b.x);
    part = positive(part, MARGIN * a.w + a.x, MARGIN * b.w + b.x);
    part = positive(part, MARGIN * a.w - a.y, MARGIN * b.w - b.y);
    part = positive(part, MARGIN * a.w + a.y, MARGIN * b.w + b.y);
    if part.x >= part.y {
        return NOWHERE;
    }
    let ends = array<vec4<f32>, 2>(mix(a, b, part.x), mix(a, b, part.y));
    if ends[0].w <= 0.0 || ends[1].w <= 0.0 {
        return NOWHERE;
    }
    let first = 0.5 * frame.size * ends[0].xy / ends[0].w;
    let last = 0.5 * frame.size * ends[1].xy / ends[1].w;
    let length = distance(first, last);
    let along = select(vec2<f32>(1.0, 0.0), (last - first) / length, length > 1e-6);
    let is_end = (index & 1u) == 1u;
    let half = 0.5 * line.style.x + 1.0;
    let across = select(-half, half, (index & 2u) != 0u);
    // So that lines which follow each other leave no gap.
    let beyond = select(-0.5, 0.5, is_end) * line.style.x;
    let offset = vec2<f32>(-along.y, along.x) * across + along * beyond;
    var clip = select(ends[0], ends[1], is_end);
    clip = vec4<f32>(clip.xy + 2.0 * offset / frame.size * clip.w, clip.z, clip.w);
    if line.style.w == 0.0 {
        // Edges lie on surfaces: this draws them nearer by a share of their distance.
        clip.z = min(clip.z * 1.002, clip.w);
    }
    let at = vec3<f32>(across, select(0.0, length, is_end) + beyond, 1.0);
    return Stroke(clip, line.color, at * clip.w, line.style);
}

fn ink_of(in: Stroke, opacity: f32) -> Layers {
    let at = in.at.xy / in.at.z;
    let inside = clamp(0.5 * in.style.x + 0.5 - abs(at.x), 0.0, 1.0);
    var a = in.color.a * opacity * inside;
    if in.style.z > 0.0 && fract(at.y / (2.0 * in.style.z)) >= 0.5 {
        a = 0.0;
    }
    return Layers(vec4<f32>(0.0), vec4<f32>(in.color.rgb * a, a));
}

@fragment
fn ink(in: Stroke) -> Layers {
    return ink_of(in, 1.0);
}

@fragment
fn hidden_ink(in: Stroke) -> Layers {
    return ink_of(in, in.style.y);
}
