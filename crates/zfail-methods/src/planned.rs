//! Methods that choose what to draw: carried out by the library itself, of which this is a small host.
//!
//! In: the steps to take ([`Steps`]). Out: the mask and figures. The stage has the depth pass and the verdict, and
//! [`Shadows`] counts in between; the instrumented run draws what its plan draws.

use crate::geometry::{Geometry, Mesh};
use crate::stage::{self, Stage};
use crate::volumes::{Draw, Volumes};
use crate::{Error, Figures};
use std::time::Instant;
use zfail_plan::glam::{DAffine3, Vec3};
use zfail_plan::plan::{self, FramePlan, ShadowLight, Steps};
use zfail_plan::view::View;
use zfail_render::Gpu;
use zfail_render::zfail::{Caster, Frame, Shadows, Target, low_level};
use zfail_scene::{Instance, Light};

/// What `light` reaches, by these steps.
pub fn shadow(
    gpu: &Gpu,
    stage: &mut Stage,
    geometry: &Geometry,
    view: &View,
    light: &Light,
    steps: Steps,
) -> Result<(Vec<u8>, Figures), Error> {
    let mut shadows = Shadows::new(&gpu.device, &gpu.queue);
    let mut meshes = vec![None; geometry.meshes.len()];
    let mut casters = Vec::new();
    for (_, instance, mesh) in geometry.casters(light) {
        let id = match meshes[instance.mesh] {
            Some(id) => id,
            None => shadows.add_topology(mesh.topology.clone())?,
        };
        meshes[instance.mesh] = Some(id);
        casters.push(Caster::new(id, instance.world_from_object));
    }
    let target = Target { colors: &[], depth_stencil: gpu.depth_stencil, samples: 1 };
    let pipelines = shadows.pipelines(&target);

    let start = Instant::now();
    // Who ignores the light is not among the casters.
    let lights = &[ShadowLight::new(light.kind).within(light.bounds())];
    let frame = Frame::new(view, &casters, lights).receivers(&geometry.receivers).steps(steps);
    let prepared = shadows.prepare(&frame)?;
    let planning_ms = start.elapsed().as_secs_f64() * 1e3;

    let placements = stage::placements(&gpu.device, &geometry.placements(view));
    let (mask, render_ms) = stage.play(gpu, geometry, view, 0, 0.0, &placements, |pass| {
        prepared.draw(pass, &pipelines, 0);
    })?;
    let plan = low_level::plan(&prepared);
    let drawn = drawn(plan, &geometry.casters(light).collect::<Vec<_>>());
    let fragments = stage.fragments(gpu, geometry, view, &drawn)?;
    let triangles = drawn.triangles();
    let passes = 2 + plan.lights.first().map_or(0, over_volumes);
    Ok((mask, Figures { triangles, vertices: 3 * triangles, fragments, passes, planning_ms, render_ms }))
}

/// Passes between depth and verdict: the volumes, a start value if there is one, and a fold for each of several batches.
fn over_volumes(light: &plan::LightPlan) -> u32 {
    let folds = if light.batches.len() > 1 { light.batches.len() as u32 } else { 0 };
    1 + u32::from(light.stats.near_count > 0) + folds
}

/// What the plan draws, as the stage draws it.
fn drawn(plan: &FramePlan, casters: &[(usize, &Instance, &Mesh)]) -> Volumes {
    let mut volumes = Volumes::default();
    let mut before: Option<(&plan::Draw, i32)> = None;
    for draw in &plan.draws {
        let Some(&(number, instance, mesh)) = casters.get(draw.caster as usize) else { continue };
        let same =
            |other: &plan::Draw| other.caster == draw.caster && other.light == draw.light && other.reach == draw.reach;
        let first_vertex = match before {
            Some((other, first)) if same(other) => first,
            _ => {
                let first = volumes.vertices.len() as i32;
                volumes.vertices.extend(mesh.topology.positions().iter().flat_map(|&position| {
                    let p = Vec3::from(position);
                    [p.extend(1.0).to_array(), draw.extruded(p.as_dvec3()).as_vec4().to_array()]
                }));
                first
            }
        };
        before = Some((draw, first_vertex));
        let parts = &draw.volume;
        let start = volumes.indices.len() as u32;
        for range in [&parts.sides, &parts.dark_cap, &parts.light_cap] {
            volumes.indices.extend(&plan.indices[range.start as usize..range.end as usize]);
        }
        let middle = volumes.indices.len() as u32;
        let reversed = &parts.light_cap_reversed;
        volumes.indices.extend(&plan.indices[reversed.start as usize..reversed.end as usize]);
        volumes.draws.push(Draw {
            placement: number as u32,
            first_vertex,
            outward: start..middle,
            inward: middle..volumes.indices.len() as u32,
            mirrored: is_mirrored(&instance.world_from_object),
            scissor: Some(draw.scissor),
        });
    }
    volumes
}

fn is_mirrored(world_from_object: &DAffine3) -> bool {
    world_from_object.matrix3.determinant() < 0.0
}
