// What lights do beyond physics: boxes, falloff curves and projected pictures.

// Word 0 is unused. A light's shape: half extents of the box, first sample and number of steps of the falloff curve (0
// where there is none), first word of the cookie (0 where there is none). A cookie: width, height, number of levels,
// whether it is filtered; then the texels of all levels, two words of 16-bit fractions each.
@group(0) @binding(3) var<storage, read> shapes: array<u32>;

fn real(word: u32) -> f32 {
    return bitcast<f32>(shapes[word]);
}

// Whether a point is within the light's box; `ray` goes to it from the light.
fn within_box(light: Light, ray: vec3<f32>) -> bool {
    let extents = vec3<f32>(real(light.shape), real(light.shape + 1u), real(light.shape + 2u));
    let local = vec3<f32>(dot(ray, light.right), dot(ray, light.up), dot(ray, light.axis));
    return all(abs(local) <= extents);
}

// Irradiance per intensity at a distance; `physical` is the light's own where no curve replaces it.
fn falloff(light: Light, distance: f32, physical: f32) -> f32 {
    let steps = shapes[light.shape + 4u];
    if steps == 0u {
        return physical;
    }
    let share = distance * light.per_range;
    if share > 1.0 {
        return 0.0;
    }
    let x = share * f32(steps);
    let i = min(u32(x), steps - 1u);
    let sample = shapes[light.shape + 3u] + i;
    return mix(real(sample), real(sample + 1u), x - f32(i));
}

fn cookie_texel(first: u32, size: vec2<i32>, at: vec2<i32>) -> vec3<f32> {
    let inside = clamp(at, vec2<i32>(0), size - 1);
    let word = first + 2u * u32(inside.y * size.x + inside.x);
    return vec3<f32>(unpack2x16unorm(shapes[word]), unpack2x16unorm(shapes[word + 1u]).x);
}

// One level of a cookie: its texels begin at `first`.
fn cookie_level(first: u32, size: vec2<i32>, uv: vec2<f32>, filtered: bool) -> vec3<f32> {
    let p = uv * vec2<f32>(size) - 0.5;
    let corner = floor(p);
    let f = select(step(vec2<f32>(0.5), p - corner), p - corner, filtered);
    let at = vec2<i32>(corner);
    let top = mix(cookie_texel(first, size, at), cookie_texel(first, size, at + vec2<i32>(1, 0)), f.x);
    let bottom =
        mix(cookie_texel(first, size, at + vec2<i32>(0, 1)), cookie_texel(first, size, at + vec2<i32>(1, 1)), f.x);
    return mix(top, bottom, f.y);
}

// What a light's cookie lets through to a point inside its cone; `ray` goes to it from the light, and changes by `ray_dx`
// and `ray_dy` from pixel to pixel.
fn cookie(light: Light, ray: vec3<f32>, ray_dx: vec3<f32>, ray_dy: vec3<f32>) -> vec3<f32> {
    var first = shapes[light.shape + 5u];
    if first == 0u {
        return vec3<f32>(1.0);
    }
    var size = vec2<i32>(i32(shapes[first]), i32(shapes[first + 1u]));
    let levels = shapes[first + 2u];
    let filtered = shapes[first + 3u] != 0u;
    first += 4u;

    let along = max(dot(ray, light.axis), 1e-20);
    let slope = vec2<f32>(dot(ray, light.right), dot(ray, light.up)) / along;
    let slope_dx = (vec2<f32>(dot(ray_dx, light.right), dot(ray_dx, light.up)) - slope * dot(ray_dx, light.axis)) / along;
    let slope_dy = (vec2<f32>(dot(ray_dy, light.right), dot(ray_dy, light.up)) - slope * dot(ray_dy, light.axis)) / along;
    // Rows go from top to bottom.
    let uv_per_slope = vec2<f32>(0.5, -0.5) * light.cot_outer;
    let uv = clamp(slope * uv_per_slope + 0.5, vec2<f32>(0.0), vec2<f32>(1.0));

    let texels_per_slope = uv_per_slope * vec2<f32>(size);
    let footprint = max(length(slope_dx * texels_per_slope), length(slope_dy * texels_per_slope));
    let detail = clamp(log2(max(footprint, 1.0)), 0.0, f32(levels - 1u));
    for (var level = 0u; level < u32(detail); level++) {
        first += 2u * u32(size.x * size.y);
        size = max(size / 2, vec2<i32>(1));
    }
    let color = cookie_level(first, size, uv, filtered);
    if fract(detail) == 0.0 {
        return color;
    }
    let next = cookie_level(first + 2u * u32(size.x * size.y), max(size / 2, vec2<i32>(1)), uv, filtered);
    return mix(color, next, fract(detail));
}
