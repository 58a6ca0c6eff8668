// What a surface sends to the eye of the light of the sky: split into what it reflects of light from everywhere alike, and
// the mean radiance where that comes from (Karis, "Real Shading in Unreal Engine 4", 2013). The curves are our own fits to
// integrals of the reflection model in `reflection.wgsl`.

// Reflected share of light from everywhere for f0 = f90 = 1, and how much of that f90 alone gives. To 0.03 on average.
fn mirrored_shares(n_v: f32, roughness: f32) -> vec2<f32> {
    let lost = pow(roughness, 0.82 + 2.04 * n_v) * (0.107 + n_v * (1.2 - 0.58 * n_v));
    let r_squared = roughness * roughness;
    let steep = pow(1.0 - n_v, 4.9 - 3.8 * roughness) / (1.0 + r_squared * (9.5 + 30.0 * r_squared));
    return vec2<f32>(1.0 - lost, min(steep, 1.0 - lost));
}

// Mean radiance that a surface of normal `n` mirrors. Rough ones mirror wide, and less where they are edge-on to the light.
fn mirrored_sky(n: vec3<f32>, eye: vec3<f32>, roughness: f32) -> vec3<f32> {
    let alpha = roughness * roughness;
    let about = unit_or(mix(reflect(-eye, n), n, alpha), n);
    return sky(dot(about, frame.up), min(HORIZON + 3.0 * alpha * alpha, 1.0));
}

// What the fibres of `fibres` reflect of light from everywhere.
fn fibre_share(n_v: f32) -> f32 {
    let per_roughness = 1.0 / max(material.sheen_roughness, 0.07);
    return min((0.25 + 0.31 * per_roughness) * exp(-n_v * (0.06 + 1.35 * per_roughness)), 1.0);
}

fn from_sky(s: Surface, eye: vec3<f32>) -> vec3<f32> {
    let n_v = clamp(dot(s.normal, eye), 0.0, 1.0);
    let shares = mirrored_shares(n_v, s.roughness);
    // What leaves only after several reflections among microfacets is added to what leaves after one (Fdez-Aguera, "A
    // Multiple-Scattering Microfacet Model for Real-Time Image-based Lighting", 2019).
    let once = s.f0 * (shares.x - shares.y) + s.f90 * shares.y;
    let mirrored = once * (1.0 + s.f0 * (1.0 / shares.x - 1.0));
    let scattered = sky(dot(s.normal, frame.up), 1.0);
    var sum = (1.0 - mirrored) * s.diffuse * scattered + mirrored * mirrored_sky(s.normal, eye, s.roughness);
    if SHEEN {
        sum *= 1.0 - 0.157 * max(s.sheen.r, max(s.sheen.g, s.sheen.b));
        sum += s.sheen * fibre_share(n_v) * scattered;
    }
    if CLEARCOAT {
        let coat_v = clamp(dot(s.smooth_normal, eye), 0.0, 1.0);
        let coat = mirrored_shares(coat_v, material.clearcoat_roughness);
        let share = s.clearcoat * (0.04 * (coat.x - coat.y) + coat.y);
        sum = sum * (1.0 - share) + share * mirrored_sky(s.smooth_normal, eye, material.clearcoat_roughness);
    }
    return sum;
}
