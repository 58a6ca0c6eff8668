// A ray from every visible surface to the light.

struct Rays {
    // Relative to the eye; or towards the light and beyond the scene, with w = 0.
    light: vec4<f32>,
    // The eye itself, or towards it with w = 0.
    eye: vec4<f32>,
    // How far off the surface rays start, as a share of its distance from the eye and the light.
    offset: f32,
}

@group(0) @binding(0) var<uniform> rays: Rays;
@group(0) @binding(1) var casters: acceleration_structure;

// 1 where the light arrives and about a half where it does not: the mask is to tell rays from pixels without one.
@fragment
fn lit(surface: Surface) -> @location(0) f32 {
    let p = surface.position;
    var normal = normalize(cross(dpdx(p), dpdy(p)));
    if dot(normal, rays.eye.xyz - p * rays.eye.w) < 0.0 {
        normal = -normal;
    }
    // The position is rounded as its largest coordinate is, and so is the tracer's arithmetic.
    let size = max(length(p), length(rays.light.xyz) * rays.light.w);
    let start = p + normal * (rays.offset * size);
    let to_light = rays.light.xyz - start * rays.light.w;
    var query: ray_query;
    let flags = RAY_FLAG_FORCE_OPAQUE | RAY_FLAG_TERMINATE_ON_FIRST_HIT;
    rayQueryInitialize(&query, casters, RayDesc(flags, 0xffu, 0.0, 1.0, start, to_light));
    while rayQueryProceed(&query) {}
    let hit = rayQueryGetCommittedIntersection(&query);
    return select(0.5, 1.0, hit.kind == RAY_QUERY_INTERSECTION_NONE);
}
