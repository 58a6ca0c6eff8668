// Shadow volumes: one stored position per vertex, extruded to infinity by a bit of its index.
// McGuire et al. 2003, section 6, vertex program EXTRUDE; Everitt & Kilgard 2002, section 3.2.2.

struct Draw {
    clip_from_object: mat4x4<f32>,
    // Object space: (position, 1) or (towards the light, 0).
    light: vec4<f32>,
    // Distance from the light, or along its rays, of a finite dark cap (orthographic views); 0 for a cap at infinity.
    reach: f32,
}

@group(0) @binding(0) var<storage, read> positions: array<f32>;
@group(0) @binding(1) var<storage, read> draws: array<Draw>;

struct Volume {
    @invariant @builtin(position) clip: vec4<f32>,
}

// Index 2 * vertex + extruded; instance = draw.
fn place(index: u32, instance: u32) -> vec4<f32> {
    let i = 3u * (index >> 1u);
    let p = vec3<f32>(positions[i], positions[i + 1u], positions[i + 2u]);
    let draw = draws[instance];
    if (index & 1u) == 0u {
        // The very expression of the depth pass.
        return draw.clip_from_object * vec4<f32>(p, 1.0);
    }
    let away = p * draw.light.w - draw.light.xyz;
    if draw.reach > 0.0 {
        if draw.light.w == 0.0 {
            return draw.clip_from_object * vec4<f32>(p + away * draw.reach, 1.0);
        }
        let distance = length(away);
        return draw.clip_from_object * vec4<f32>(draw.light.xyz * distance + away * draw.reach, distance);
    }
    var clip = draw.clip_from_object * vec4<f32>(away, 0.0);
    // A direction almost in the image plane: its w is all rounding, and some rasterisers lose such vertices.
    let least = 1e-5 * max(abs(clip.x), abs(clip.y));
    if abs(clip.w) < least {
        clip.w = least;
    }
    return clip;
}

@vertex
fn volume(@builtin(vertex_index) index: u32, @builtin(instance_index) instance: u32) -> Volume {
    return Volume(place(index, instance));
}

// For passes with colour attachments, whose write mask is empty.
@fragment
fn nothing() {}

// For passes that count fragments: the colour attachment adds them up.
@fragment
fn one() -> @location(0) vec4<f32> {
    return vec4<f32>(1.0);
}

// Depth clamping (Everitt & Kilgard 2002, section 4.2) by hand, for devices without it: the rasteriser sees a depth it will
// not clip, and the fragment gets the clamped true one, per sample, because every sample is tested on its own.
struct ClampedVolume {
    @invariant @builtin(position) clip: vec4<f32>,
    @location(0) @interpolate(perspective, sample) depth: vec2<f32>,
}

@vertex
fn clamped_volume(@builtin(vertex_index) index: u32, @builtin(instance_index) instance: u32) -> ClampedVolume {
    let clip = place(index, instance);
    return ClampedVolume(vec4<f32>(clip.xy, 0.5 * clip.w, clip.w), clip.zw);
}

@fragment
fn clamped_depth(in: ClampedVolume) -> @builtin(frag_depth) f32 {
    return clamp(in.depth.x / in.depth.y, 0.0, 1.0);
}

// Covers the image once, to fold a batch's counts into the sticky bit.
@vertex
fn image(@builtin(vertex_index) index: u32) -> @builtin(position) vec4<f32> {
    let corner = vec2<f32>(f32(index & 1u), f32(index >> 1u));
    return vec4<f32>(corner * 4.0 - 1.0, 0.0, 1.0);
}
