// The material at a point. What a material does not have is compiled away.

// How a texture is read: rows of the matrix from mesh UV to texture UV; `u.w` is the UV set.
struct Slot {
    u: vec4<f32>,
    v: vec4<f32>,
}

struct Material {
    base_color: vec4<f32>,
    emissive: vec3<f32>,
    alpha_cutoff: f32,
    metallic: f32,
    roughness: f32,
    normal_scale: f32,
    occlusion_strength: f32,
    // Reflectance at normal incidence: of the dielectric, or of everything (SPECULAR_GLOSSINESS).
    specular: vec3<f32>,
    specular_strength: f32,
    sheen: vec3<f32>,
    sheen_roughness: f32,
    tint: vec3<f32>,
    transmission: f32,
    clearcoat: f32,
    clearcoat_roughness: f32,
    base_color_slot: Slot,
    metallic_roughness_slot: Slot,
    normal_slot: Slot,
    occlusion_slot: Slot,
    emissive_slot: Slot,
    specular_color_slot: Slot,
    clearcoat_slot: Slot,
    sheen_slot: Slot,
    transmission_slot: Slot,
}

@group(1) @binding(0) var<uniform> material: Material;
@group(1) @binding(1) var base_color_texture: texture_2d<f32>;
@group(1) @binding(2) var base_color_sampler: sampler;
@group(1) @binding(3) var metallic_roughness_texture: texture_2d<f32>;
@group(1) @binding(4) var metallic_roughness_sampler: sampler;
@group(1) @binding(5) var normal_texture: texture_2d<f32>;
@group(1) @binding(6) var normal_sampler: sampler;
@group(1) @binding(7) var occlusion_texture: texture_2d<f32>;
@group(1) @binding(8) var occlusion_sampler: sampler;
@group(1) @binding(9) var emissive_texture: texture_2d<f32>;
@group(1) @binding(10) var emissive_sampler: sampler;
@group(1) @binding(11) var specular_color_texture: texture_2d<f32>;
@group(1) @binding(12) var specular_color_sampler: sampler;
@group(1) @binding(13) var clearcoat_texture: texture_2d<f32>;
@group(1) @binding(14) var clearcoat_sampler: sampler;
@group(1) @binding(15) var sheen_texture: texture_2d<f32>;
@group(1) @binding(16) var sheen_sampler: sampler;
@group(1) @binding(17) var transmission_texture: texture_2d<f32>;
@group(1) @binding(18) var transmission_sampler: sampler;

struct Surface {
    albedo: vec3<f32>,
    alpha: f32,
    // What is scattered below the surface.
    diffuse: vec3<f32>,
    // Reflectance at normal incidence and at grazing angles.
    f0: vec3<f32>,
    f90: f32,
    roughness: f32,
    clearcoat: f32,
    sheen: vec3<f32>,
    // Share that passes of what would be scattered.
    transmission: f32,
    occlusion: f32,
    emissive: vec3<f32>,
    // View space, unit: for shading, on the side of the eye for double-sided materials.
    normal: vec3<f32>,
    // View space, unit: the normal without its texture.
    smooth_normal: vec3<f32>,
    // Sine of the greatest angle between that normal and the facets around it.
    tilt: f32,
    // View space, of any length: the triangle's own, on the side of the eye.
    geometric_normal: vec3<f32>,
    // View space: from pixel to pixel.
    position_dx: vec3<f32>,
    position_dy: vec3<f32>,
}

fn slot_uv(slot: Slot, uv: vec4<f32>) -> vec2<f32> {
    let p = vec3<f32>(select(uv.xy, uv.zw, slot.u.w > 0.5), 1.0);
    return vec2<f32>(dot(slot.u.xyz, p), dot(slot.v.xyz, p));
}

fn unit_or(v: vec3<f32>, fallback: vec3<f32>) -> vec3<f32> {
    let length_squared = dot(v, v);
    // False for NaN too.
    if length_squared > 0.0 && length_squared < 1e38 {
        return v * inverseSqrt(length_squared);
    }
    return fallback;
}

// Which slots have textures.
override BASE_COLOR: bool = false;
override METALLIC_ROUGHNESS: bool = false;
override NORMAL: bool = false;
override OCCLUSION: bool = false;
override EMISSIVE: bool = false;
override SPECULAR_COLOR: bool = false;
override CLEARCOAT_TEXTURE: bool = false;
override SHEEN_TEXTURE: bool = false;
override TRANSMISSION_TEXTURE: bool = false;
// What there is beyond metallic-roughness, as the KHR_materials extensions have it. The first replaces it: the texture is
// then one of specular colour and glossiness.
override SPECULAR_GLOSSINESS: bool = false;
override SPECULAR: bool = false;
override CLEARCOAT: bool = false;
override SHEEN: bool = false;
override TRANSMISSION: bool = false;

fn surface(in: Fragment, front: bool, eye: vec3<f32>) -> Surface {
    let uv = vertex_uv(in);
    var base_color = material.base_color * vertex_color(in);
    if BASE_COLOR {
        base_color *= textureSample(base_color_texture, base_color_sampler, slot_uv(material.base_color_slot, uv));
    }
    var texel = vec4<f32>(1.0);
    if METALLIC_ROUGHNESS {
        let at = slot_uv(material.metallic_roughness_slot, uv);
        texel = textureSample(metallic_roughness_texture, metallic_roughness_sampler, at);
    }
    var specular = material.specular;
    if SPECULAR_COLOR {
        let at = slot_uv(material.specular_color_slot, uv);
        specular *= textureSample(specular_color_texture, specular_color_sampler, at).rgb;
    }
    var clearcoat = material.clearcoat;
    if CLEARCOAT_TEXTURE {
        clearcoat *= textureSample(clearcoat_texture, clearcoat_sampler, slot_uv(material.clearcoat_slot, uv)).r;
    }
    var sheen = material.sheen;
    if SHEEN_TEXTURE {
        sheen *= textureSample(sheen_texture, sheen_sampler, slot_uv(material.sheen_slot, uv)).rgb;
    }
    var transmission = material.transmission;
    if TRANSMISSION_TEXTURE {
        let at = slot_uv(material.transmission_slot, uv);
        transmission *= textureSample(transmission_texture, transmission_sampler, at).r;
    }
    let normal_uv = slot_uv(material.normal_slot, uv);
    var normal_texel = vec3<f32>(0.0, 0.0, 1.0);
    if NORMAL {
        normal_texel = textureSample(normal_texture, normal_sampler, normal_uv).xyz * 2.0 - 1.0;
    }
    var occlusion = 1.0;
    if OCCLUSION {
        let at = slot_uv(material.occlusion_slot, uv);
        let open = textureSample(occlusion_texture, occlusion_sampler, at).r;
        occlusion += material.occlusion_strength * (open - 1.0);
    }
    var emissive = material.emissive;
    if EMISSIVE {
        emissive *= textureSample(emissive_texture, emissive_sampler, slot_uv(material.emissive_slot, uv)).rgb;
    }
    let position_dx = dpdx(in.position);
    let position_dy = dpdy(in.position);
    let uv_dx = dpdx(normal_uv);
    let uv_dy = dpdy(normal_uv);

    let flat_normal = cross(position_dx, position_dy);

    var out: Surface;
    out.albedo = base_color.rgb;
    out.alpha = base_color.a;
    if SPECULAR_GLOSSINESS {
        out.f0 = specular * texel.rgb;
        out.f90 = 1.0;
        out.diffuse = base_color.rgb * (1.0 - max(out.f0.r, max(out.f0.g, out.f0.b)));
        out.albedo = out.diffuse + out.f0;
        out.roughness = clamp(1.0 - (1.0 - material.roughness) * texel.a, 0.0, 1.0);
    } else {
        let metallic = clamp(material.metallic * texel.b, 0.0, 1.0);
        var dielectric = vec3<f32>(0.04);
        out.f90 = 1.0;
        if SPECULAR {
            dielectric = min(specular, vec3<f32>(1.0)) * material.specular_strength;
            out.f90 = mix(material.specular_strength, 1.0, metallic);
        }
        out.f0 = mix(dielectric, base_color.rgb, metallic);
        out.diffuse = base_color.rgb * (1.0 - metallic);
        out.roughness = clamp(material.roughness * texel.g, 0.0, 1.0);
        transmission *= 1.0 - metallic;
    }
    out.clearcoat = clearcoat;
    out.sheen = sheen;
    out.transmission = 0.0;
    if TRANSMISSION {
        out.transmission = transmission;
        out.diffuse *= 1.0 - transmission;
    }
    out.occlusion = occlusion;
    out.emissive = emissive * frame.pre_exposure;
    out.position_dx = position_dx;
    out.position_dy = position_dy;
    out.geometric_normal = select(-flat_normal, flat_normal, dot(flat_normal, eye) >= 0.0);

    let side = select(-1.0, 1.0, front);
    let outward = side * out.geometric_normal;
    // Meshes without normals are flat.
    var normal = unit_or(select(in.normal, outward, dot(in.normal, in.normal) == 0.0), eye);
    out.smooth_normal = side * normal;
    out.tilt = in.tilt * inverseSqrt(max(dot(in.normal, in.normal), 1e-30));
    if NORMAL {
        var tangent = vertex_tangent(in);
        var bitangent = vertex_bitangent(in);
        if dot(tangent, tangent) < 1e-20 {
            // No tangents in the mesh: solve for the directions in which u and v grow on the screen.
            let perpendicular_x = cross(normal, position_dx);
            let perpendicular_y = cross(position_dy, normal);
            let handed = sign(dot(cross(position_dx, position_dy), normal));
            tangent = (perpendicular_y * uv_dx.x + perpendicular_x * uv_dy.x) * handed;
            bitangent = (perpendicular_y * uv_dx.y + perpendicular_x * uv_dy.y) * handed;
            // glTF textures have v downwards, and normal maps +y upwards.
            bitangent = -bitangent;
        }
        let t = unit_or(tangent, vec3<f32>(0.0));
        let b = unit_or(bitangent, vec3<f32>(0.0));
        let xy = normal_texel.xy * material.normal_scale;
        normal = unit_or(t * xy.x + b * xy.y + normal * normal_texel.z, normal);
    }
    out.normal = side * normal;
    return out;
}
