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
    base_color_slot: Slot,
    metallic_roughness_slot: Slot,
    normal_slot: Slot,
    occlusion_slot: Slot,
    emissive_slot: Slot,
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

struct Surface {
    albedo: vec3<f32>,
    alpha: f32,
    metallic: f32,
    roughness: f32,
    occlusion: f32,
    emissive: vec3<f32>,
    // View space, unit: for shading, on the side of the eye for double-sided materials.
    normal: vec3<f32>,
    // View space, unit: the normal without its texture.
    smooth_normal: vec3<f32>,
    // Sine of the greatest angle between that normal and the facets around it.
    bend: f32,
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

fn surface(in: Fragment, front: bool, eye: vec3<f32>) -> Surface {
    let uv = vertex_uv(in);
    var base_color = material.base_color * vertex_color(in);
    if BASE_COLOR {
        base_color *= textureSample(base_color_texture, base_color_sampler, slot_uv(material.base_color_slot, uv));
    }
    var metallic_roughness = vec2<f32>(material.metallic, material.roughness);
    if METALLIC_ROUGHNESS {
        let at = slot_uv(material.metallic_roughness_slot, uv);
        metallic_roughness *= textureSample(metallic_roughness_texture, metallic_roughness_sampler, at).bg;
    }
    let normal_uv = slot_uv(material.normal_slot, uv);
    var normal_texel = vec3<f32>(0.0, 0.0, 1.0);
    if NORMAL {
        normal_texel = textureSample(normal_texture, normal_sampler, normal_uv).xyz * 2.0 - 1.0;
    }
    var occlusion = 1.0;
    if OCCLUSION {
        let at = slot_uv(material.occlusion_slot, uv);
        let texel = textureSample(occlusion_texture, occlusion_sampler, at).r;
        occlusion += material.occlusion_strength * (texel - 1.0);
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
    out.metallic = clamp(metallic_roughness.x, 0.0, 1.0);
    out.roughness = clamp(metallic_roughness.y, 0.0, 1.0);
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
    out.bend = in.bend * inverseSqrt(max(dot(in.normal, in.normal), 1e-30));
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
