// Punctual lights (KHR_lights_punctual) and the metallic-roughness reflection model (glTF 2.0, appendix B).

const POINT: u32 = 0u;
const SPOT: u32 = 1u;
const DIRECTIONAL: u32 = 2u;

struct Light {
    // View space: where the light is, or the unit vector towards it.
    position: vec3<f32>,
    kind: u32,
    // View space, unit: the way a spot light shines.
    axis: vec3<f32>,
    // 1 / range, 0 where there is no limit.
    per_range: f32,
    // Pre-exposed intensity (candela) or illuminance (lux).
    color: vec3<f32>,
    // Of the cone's half angle.
    sin_outer: f32,
    cos_outer: f32,
    // Falloff from the inner to the outer angle, as the extension defines it.
    angle_scale: f32,
    angle_offset: f32,
}

@group(0) @binding(1) var<storage, read> lights: array<Light>;

// Whether a view-space point lies within the light's range and cone.
fn reaches(light: Light, position: vec3<f32>) -> bool {
    if light.kind == DIRECTIONAL {
        return true;
    }
    let ray = position - light.position;
    if length(ray) * light.per_range > 1.0 {
        return false;
    }
    if light.kind == POINT {
        return true;
    }
    // Angle to the axis <= outer, without the cancellation of a cosine near 1.
    let along = dot(ray, light.axis);
    let across = length(ray - along * light.axis);
    return across * light.cos_outer <= along * light.sin_outer;
}

struct Incidence {
    // Unit vector towards the light.
    direction: vec3<f32>,
    // Through a surface that faces the light.
    irradiance: vec3<f32>,
}

fn incidence(light: Light, position: vec3<f32>) -> Incidence {
    if light.kind == DIRECTIONAL {
        return Incidence(light.position, light.color);
    }
    let to_light = light.position - position;
    let distance_squared = max(dot(to_light, to_light), 1e-20);
    let direction = to_light * inverseSqrt(distance_squared);
    let relative_squared = distance_squared * light.per_range * light.per_range;
    var irradiance = light.color * (clamp(1.0 - relative_squared * relative_squared, 0.0, 1.0) / distance_squared);
    if light.kind == SPOT {
        let falloff = clamp(dot(light.axis, -direction) * light.angle_scale + light.angle_offset, 0.0, 1.0);
        irradiance *= falloff * falloff;
    }
    return Incidence(direction, irradiance);
}

const PI: f32 = 3.14159265358979;

// Reflected radiance per irradiance, the cosine included. All vectors are unit and point away from the surface.
fn reflectance(albedo: vec3<f32>, metallic: f32, roughness: f32, n: vec3<f32>, v: vec3<f32>, l: vec3<f32>) -> vec3<f32> {
    let n_l = dot(n, l);
    if n_l <= 0.0 {
        return vec3<f32>(0.0);
    }
    let n_v = max(dot(n, v), 1e-4);
    let between = v + l;
    let h = between * inverseSqrt(max(dot(between, between), 1e-12));
    let n_h = clamp(dot(n, h), 0.0, 1.0);
    let v_h = clamp(dot(v, h), 0.0, 1.0);
    // A perfect mirror would show a point light as nothing at all.
    let alpha = max(roughness * roughness, 0.002);
    let alpha_squared = alpha * alpha;

    let f0 = mix(vec3<f32>(0.04), albedo, metallic);
    let fresnel = f0 + (1.0 - f0) * pow(1.0 - v_h, 5.0);
    // 1 - n_h^2 as a cross product: its difference would lose the highlight of smooth surfaces.
    let n_cross_h = cross(n, h);
    let spread = max(n_h * n_h * alpha_squared + dot(n_cross_h, n_cross_h), 1e-8);
    let distribution = alpha_squared / (PI * spread * spread);
    let visibility = 0.5 / (n_l * sqrt(n_v * n_v * (1.0 - alpha_squared) + alpha_squared)
        + n_v * sqrt(n_l * n_l * (1.0 - alpha_squared) + alpha_squared));
    let diffuse = (1.0 - fresnel) * albedo * ((1.0 - metallic) / PI);
    return (diffuse + fresnel * (distribution * visibility)) * n_l;
}

// Radiance towards the eye from one light that is not blocked.
fn reflected(
    light: Light, position: vec3<f32>, geometric_normal: vec3<f32>, normal: vec3<f32>, albedo: vec3<f32>, metallic: f32,
    roughness: f32,
) -> vec3<f32> {
    let arriving = incidence(light, position);
    if !reaches(light, position) || dot(geometric_normal, arriving.direction) <= 0.0 {
        return vec3<f32>(0.0);
    }
    let scale = reflectance(albedo, metallic, roughness, normal, towards_eye(position), arriving.direction);
    return arriving.irradiance * scale;
}
