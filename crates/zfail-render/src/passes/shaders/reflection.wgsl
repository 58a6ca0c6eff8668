// The metallic-roughness reflection model (glTF 2.0, appendix B) and the layers over it, for light from one direction.

// The material is perfectly rough: the microfacet distribution is constant.
override ROUGH: bool = false;
// The mesh is coarse: light fades before its facets turn away.
override COARSE: bool = false;

const PI: f32 = 3.14159265358979;

fn grazing(cosine: f32) -> f32 {
    let m = max(1.0 - cosine, 0.0);
    let m_squared = m * m;
    return m_squared * m_squared * m;
}

// Microfacets that mirror l to v, distribution times visibility. n_l and n_v are cosines to the normal `n`, h is the unit half
// vector.
fn microfacets(n: vec3<f32>, h: vec3<f32>, n_l: f32, n_v: f32, roughness: f32) -> f32 {
    let n_h = clamp(dot(n, h), 0.0, 1.0);
    // A perfect mirror would show a point light as nothing at all.
    let alpha = max(roughness * roughness, 0.002);
    let alpha_squared = alpha * alpha;
    // 1 - n_h^2 as a cross product: its difference would lose the highlight of smooth surfaces.
    let n_cross_h = cross(n, h);
    let spread = max(n_h * n_h * alpha_squared + dot(n_cross_h, n_cross_h), 1e-8);
    let visibility = n_l * sqrt(n_v * n_v * (1.0 - alpha_squared) + alpha_squared)
        + n_v * sqrt(n_l * n_l * (1.0 - alpha_squared) + alpha_squared);
    return 0.5 * alpha_squared / (PI * spread * spread * visibility);
}

// Fibres: the distribution of Estevez and Kulla (2017), the visibility of Neubelt and Pettineo (2013).
fn fibres(n_h: f32, n_l: f32, n_v: f32) -> f32 {
    let roughness = max(material.sheen_roughness, 0.07);
    let power = 1.0 / (roughness * roughness);
    let sine = sqrt(max(1.0 - n_h * n_h, 0.0));
    let distribution = (2.0 + power) * pow(sine, power) / (2.0 * PI);
    return distribution / (4.0 * (n_l + n_v - n_l * n_v));
}

// Reflected radiance per irradiance, the cosine included. All vectors are unit and point away from the surface.
fn reflectance(s: Surface, v: vec3<f32>, l: vec3<f32>) -> vec3<f32> {
    let n_l = max(dot(s.normal, l), 0.0);
    let n_v = max(dot(s.normal, v), 1e-4);
    let squared = max(2.0 + 2.0 * dot(v, l), 1e-12);
    let per_length = inverseSqrt(squared);
    // The angle between v and the half vector, which bisects v and l.
    let steep = grazing(0.5 * squared * per_length);
    let h = (v + l) * per_length;

    let fresnel = s.f0 + (s.f90 - s.f0) * steep;
    var highlight = 0.5 / (PI * (n_l + n_v));
    if !ROUGH {
        highlight = microfacets(s.normal, h, n_l, n_v, s.roughness);
    }
    var sum = ((1.0 - fresnel) * s.diffuse * (1.0 / PI) + fresnel * highlight) * n_l;
    if SHEEN {
        // What fibres scatter, the base does not have: its mean over all directions.
        sum *= 1.0 - 0.157 * max(s.sheen.r, max(s.sheen.g, s.sheen.b));
        sum += s.sheen * (fibres(clamp(dot(s.normal, h), 0.0, 1.0), n_l, n_v) * n_l);
    }
    if CLEARCOAT {
        // The coat is as smooth as the mesh, whatever lies below.
        let coat_l = max(dot(s.smooth_normal, l), 0.0);
        let coat_v = max(dot(s.smooth_normal, v), 1e-4);
        let share = s.clearcoat * (0.04 + 0.96 * steep);
        let coat = microfacets(s.smooth_normal, h, coat_l, coat_v, material.clearcoat_roughness);
        sum = sum * (1.0 - share) + vec3<f32>(share * coat * coat_l);
    }
    return sum;
}

// The share of a light in direction `l` that a coarse surface takes. It is 0 wherever a facet could have turned away, and
// times the cosine it leaves 0 as steeply as the cosine itself does, to join it where all facets surely face the light.
fn terminator(s: Surface, l: vec3<f32>) -> f32 {
    let tilt = clamp(s.tilt, 1e-6, 0.9);
    let x = clamp((dot(s.smooth_normal, l) - tilt) / (min(2.5 * tilt, 1.0) - tilt), 0.0, 1.0);
    return x * (2.0 - x);
}

// Radiance towards the eye from one light that is not blocked.
fn reflected(light: Light, s: Surface, position: vec3<f32>, eye: vec3<f32>) -> vec3<f32> {
    let arrival = arriving(light, position, s.position_dx, s.position_dy);
    var share = arrival.share;
    let faces = dot(s.geometric_normal, arrival.direction) > 0.0;
    if COARSE {
        share *= terminator(s, arrival.direction);
    }
    return arrival.color * reflectance(s, eye, arrival.direction) * select(0.0, share, faces);
}
