// What is laid over the picture once the layers of a figure are drawn.

@group(0) @binding(0) var glass_layer: texture_2d<f32>;
@group(0) @binding(1) var ink_layer: texture_2d<f32>;

@vertex
fn cover(@builtin(vertex_index) index: u32) -> @builtin(position) vec4<f32> {
    let corner = vec2<f32>(f32(index & 1u), f32(index >> 1u));
    return vec4<f32>(corner * 4.0 - 1.0, 0.0, 1.0);
}

// Ink over glass over the picture, colours premultiplied.
@fragment
fn lay(@builtin(position) at: vec4<f32>) -> @location(0) vec4<f32> {
    let glass = textureLoad(glass_layer, vec2<i32>(at.xy), 0);
    let ink = textureLoad(ink_layer, vec2<i32>(at.xy), 0);
    let cover = 1.0 - exp(-glass.a);
    let tinted = select(vec3<f32>(0.0), glass.rgb / glass.a * cover, glass.a > 0.0) * (1.0 - ink.a);
    return vec4<f32>(ink.rgb + tinted, 1.0 - (1.0 - ink.a) * (1.0 - cover));
}

struct Heat {
    colors: array<vec4<f32>, 11>,
}

@group(0) @binding(2) var counts: texture_2d<f32>;
@group(0) @binding(3) var<uniform> heat: Heat;

// The same as `palette::level`.
fn level(count: i32) -> i32 {
    if count < 0 {
        return 7 + min(-count, 3);
    }
    if count <= 4 {
        return count;
    }
    return select(select(7, 6, count <= 16), 5, count <= 8);
}

// The colour of a count, with some of the picture left to see shapes by.
@fragment
fn map(@builtin(position) at: vec4<f32>) -> @location(0) vec4<f32> {
    let texel = textureLoad(counts, vec2<i32>(at.xy), 0);
    let count = select(0, i32(round(texel.r)), texel.g > 0.5);
    return vec4<f32>(heat.colors[level(count)].rgb, 0.82);
}

struct Sticker {
    @builtin(position) clip: vec4<f32>,
    // Texel of the sheets for a pixel at the origin.
    @location(0) @interpolate(flat) offset: vec2<i32>,
}

struct Place {
    // Upper left corner and size in the image, pixels.
    @location(0) rectangle: vec4<f32>,
    @location(1) offset: vec2<i32>,
    // Of the image.
    @location(2) size: vec2<f32>,
}

@group(0) @binding(4) var sheets: texture_2d<f32>;

@vertex
fn stick(place: Place, @builtin(vertex_index) index: u32) -> Sticker {
    let corner = vec2<f32>(f32(index & 1u), f32(index >> 1u));
    let at = (place.rectangle.xy + corner * place.rectangle.zw) / place.size;
    return Sticker(vec4<f32>(2.0 * at.x - 1.0, 1.0 - 2.0 * at.y, 0.0, 1.0), place.offset);
}

@fragment
fn letters(in: Sticker) -> @location(0) vec4<f32> {
    return textureLoad(sheets, vec2<i32>(floor(in.clip.xy)) + in.offset, 0);
}
