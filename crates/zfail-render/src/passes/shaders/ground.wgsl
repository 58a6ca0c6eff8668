// A ground that shows shadows and is otherwise not there: the backdrop, darkened by the share of light that is blocked.

// Adds the shadows of further lights to what is there.
override ADDED: bool = false;

const PI: f32 = 3.14159265358979;

// Up to this share of its radius shadows are as dark as they are; from there they fade.
const FULL: f32 = 0.4;

// `shadowed` has a bit for each light in use.
fn caught(in: Fragment, shadowed: u32) -> vec4<f32> {
    let position_dx = dpdx(in.position);
    let position_dy = dpdy(in.position);
    // Radiance of a white surface there, and what of it is missing.
    var whole = frame.ambient;
    if SKY {
        whole += sky(1.0, 1.0);
    }
    var missing = vec3<f32>(0.0);
    for (var i = 0u; i < frame.all_lights; i++) {
        let arrival = arriving(lights[i], in.position, position_dx, position_dy);
        let radiance = arrival.color * (arrival.share * max(dot(frame.up, arrival.direction), 0.0) / PI);
        whole += radiance;
        if i < frame.light_count && ((shadowed >> (i & 31u)) & 1u) == 1u {
            missing += radiance;
        }
    }
    let blocked = missing / max(whole, vec3<f32>(1e-30));
    let fade = 1.0 - smoothstep(FULL, 1.0, distance(in.position, frame.ground) * frame.per_ground_radius);
    let behind = backdrop(in.clip.xy);
    if ADDED {
        return vec4<f32>(-fade * blocked * min(behind, vec3<f32>(BRIGHTEST)), 0.0);
    }
    return without_surface(behind * (1.0 - fade * blocked));
}

// Where the stencil has told already that the one light arrives.
@fragment
fn lit(in: Fragment) -> @location(0) vec4<f32> {
    return without_surface(backdrop(in.clip.xy));
}

// And where it does not.
@fragment
fn dark(in: Fragment) -> @location(0) vec4<f32> {
    return caught(in, 1u);
}
