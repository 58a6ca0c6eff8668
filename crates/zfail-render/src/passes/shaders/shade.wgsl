// Everything that a visible surface sends to the eye, all lights at once.

// How alpha is used.
override ALPHA_MASK: bool = false;
override BLEND: bool = false;
// Base colour is shown as it is.
override UNLIT: bool = false;
// How many lights there are if at most UNROLLED, otherwise more.
override LIGHTS: u32 = 5u;
// Adds further lights to what is there.
override ADDED: bool = false;
// The picture itself is written, not radiance.
override DEVELOPED: bool = false;

@group(0) @binding(2) var<storage, read> light_lists: array<u32>;

// Light `i` of the frame, unless bit `i` of `shadowed` is set.
fn unless_shadowed(
    i: u32, light: Light, shadowed: u32, s: Surface, position: vec3<f32>, eye: vec3<f32>,
) -> vec3<f32> {
    let radiance = reflected(light, s, position, eye);
    return select(radiance, vec3<f32>(0.0), ((shadowed >> i) & 1u) == 1u);
}

// From all lights that reach the instance; `verdicts` has a bit for each that is blocked.
fn illumination(in: Fragment, s: Surface, eye: vec3<f32>, verdicts: u32) -> vec3<f32> {
    let shadowed = select(verdicts, 0u, in.lights.z == 1u);
    var sum = vec3<f32>(0.0);
    if LIGHTS <= UNROLLED {
        if LIGHTS > 0u {
            sum += unless_shadowed(0u, frame.lights[0], shadowed, s, in.position, eye);
        }
        if LIGHTS > 1u {
            sum += unless_shadowed(1u, frame.lights[1], shadowed, s, in.position, eye);
        }
        if LIGHTS > 2u {
            sum += unless_shadowed(2u, frame.lights[2], shadowed, s, in.position, eye);
        }
        if LIGHTS > 3u {
            sum += unless_shadowed(3u, frame.lights[3], shadowed, s, in.position, eye);
        }
        return sum;
    }
    for (var k = in.lights.x; k < in.lights.y; k++) {
        let i = light_lists[k];
        sum += unless_shadowed(i, lights[i], shadowed, s, in.position, eye);
    }
    return sum;
}

// How much of the ambient light is sent back.
fn ambient_reflectance(s: Surface, eye: vec3<f32>) -> vec3<f32> {
    if TRANSMISSION {
        return s.albedo * (1.0 - s.transmission) + surface_fresnel(s, eye);
    }
    return s.albedo;
}

// What a perfectly smooth surface would mirror.
fn surface_fresnel(s: Surface, eye: vec3<f32>) -> vec3<f32> {
    return s.f0 + (s.f90 - s.f0) * grazing(dot(s.normal, eye));
}

// How much of a transmissive surface is there: its alpha counts only where the material says so.
fn coverage(s: Surface) -> f32 {
    return select(s.alpha, 1.0, material.alpha_cutoff < 0.0);
}

// What is left of the light behind a transmissive surface.
fn transmittance(in: Fragment, front: bool) -> vec4<f32> {
    let eye = towards_eye(in.position);
    let s = surface(in, front, eye);
    let passing = (1.0 - surface_fresnel(s, eye)) * s.transmission * s.albedo * material.tint;
    return vec4<f32>(mix(vec3<f32>(1.0), passing, coverage(s)), 1.0);
}

// `shadowed` has a bit for each of the first 32 lights.
fn shade(in: Fragment, front: bool, shadowed: u32) -> vec4<f32> {
    let eye = towards_eye(in.position);
    let s = surface(in, front, eye);
    if ALPHA_MASK && s.alpha < material.alpha_cutoff {
        discard;
    }
    var color = s.albedo;
    if !UNLIT {
        color = illumination(in, s, eye, shadowed);
        if !ADDED {
            color += frame.ambient * s.occlusion * ambient_reflectance(s, eye) + s.emissive;
            if SKY {
                color += s.occlusion * from_sky(s, eye);
            }
        }
        color = min(color, vec3<f32>(BRIGHTEST));
    } else if ADDED {
        // It has been shown already; blended, it still covers what is added behind it.
        color = vec3<f32>(0.0);
    }
    if DEVELOPED {
        if !UNLIT {
            color = tone_map(color * frame.exposure);
        }
        return vec4<f32>(srgb_encode(color), 1.0);
    }
    if TRANSMISSION {
        // Nothing is covered: what passes has been filtered.
        return vec4<f32>(color * coverage(s), 0.0);
    }
    if BLEND {
        return vec4<f32>(color * s.alpha, s.alpha);
    }
    // Alpha is the share of the pixel that is shown as it is, without exposure.
    return vec4<f32>(color, select(0.0, 1.0, UNLIT && !ADDED));
}
