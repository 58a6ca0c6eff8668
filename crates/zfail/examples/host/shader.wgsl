// The host's own forward shading: one ambient pass, then one additive pass per light.

struct Object {
    clip_from_object: mat4x4<f32>,
    world_from_object: mat4x4<f32>,
    color: vec4<f32>,
}

// xyz: position (w = 1) or direction towards the light (w = 0); colour times intensity.
struct Light {
    position: vec4<f32>,
    color: vec4<f32>,
}

@group(0) @binding(0) var<uniform> object: Object;
@group(0) @binding(1) var<uniform> light: Light;

struct Varying {
    @invariant @builtin(position) clip: vec4<f32>,
    @location(0) world: vec3<f32>,
}

@vertex
fn vertex(@location(0) position: vec3<f32>) -> Varying {
    // What zfail asks of a host: this expression, invariant.
    let clip = object.clip_from_object * vec4<f32>(position, 1.0);
    let world = object.world_from_object * vec4<f32>(position, 1.0);
    return Varying(clip, world.xyz);
}

@fragment
fn ambient() -> @location(0) vec4<f32> {
    return vec4<f32>(object.color.rgb * vec3<f32>(0.05, 0.06, 0.08), 1.0);
}

@fragment
fn lit(in: Varying) -> @location(0) vec4<f32> {
    let to = light.position.xyz - in.world * light.position.w;
    let falloff = select(1.0, 1.0 / dot(to, to), light.position.w > 0.0);
    // The facet's normal on the viewer's side: sheets are lit from both sides.
    let normal = normalize(cross(dpdy(in.world), dpdx(in.world)));
    let lambert = max(dot(normal, normalize(to)), 0.0);
    return vec4<f32>(object.color.rgb * light.color.rgb * lambert * falloff, 0.0);
}
