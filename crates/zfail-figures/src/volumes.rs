//! Planned volumes as triangles in space.
//!
//! In: a frame's plan. Out: homogeneous triangles relative to the anchor, w = 0 at infinity (E&K 2002, section 3.2.2),
//! coloured by part or light, and the silhouette edges that sides begin with.

use crate::model::{Model, Place};
use std::ops::Range;
use zfail_plan::glam::{DVec3, DVec4};
use zfail_plan::plan::{Draw, FramePlan};
use zfail_plan::scissor::Rectangle;
use zfail_plan::volume;

/// A part of a shadow volume.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    Sides,
    DarkCap,
    LightCap,
}

/// A triangle of a volume.
#[derive(Clone, Copy, Debug)]
pub struct Triangle {
    pub corners: [DVec4; 3],
    pub part: Part,
    /// Index into the lights of the plan.
    pub light: usize,
    /// +1 if its outside is counter-clockwise, -1 if clockwise.
    pub winding: i8,
    /// The pixels in which it is drawn.
    pub scissor: Rectangle,
}

/// Calls `each` for every draw of a plan, with its light and where its caster is.
fn draws(plan: &FramePlan, model: &Model, mut each: impl FnMut(usize, &Draw, &Place)) {
    for (light, planned) in plan.lights.iter().enumerate() {
        for draw in planned.batches.iter().flat_map(|b| &plan.draws[b.start as usize..b.end as usize]) {
            each(light, draw, &model.place(model.instance_of(draw.caster)));
        }
    }
}

/// All triangles of all volumes.
pub fn triangles(plan: &FramePlan, model: &Model) -> Vec<Triangle> {
    let mut triangles = Vec::new();
    let casters = model.casters();
    draws(plan, model, |light, draw, place| {
        let topology = casters[draw.caster as usize].topology;
        let outside = if draw.mirrored { -1 } else { 1 };
        let parts = [
            (Part::Sides, &draw.volume.sides, outside),
            (Part::DarkCap, &draw.volume.dark_cap, outside),
            (Part::LightCap, &draw.volume.light_cap, outside),
            (Part::LightCap, &draw.volume.light_cap_reversed, -outside),
        ];
        for (part, range, winding) in parts {
            for corners in indices(plan, range).chunks_exact(3) {
                let corner = |k: usize| vertex(draw, place, topology.position(corners[k] >> 1), corners[k] & 1 == 1);
                let corners = [corner(0), corner(1), corner(2)];
                triangles.push(Triangle { corners, part, light, winding, scissor: draw.scissor });
            }
        }
    });
    triangles
}

/// The silhouette edges of every light, each once, however many sides it has.
/// Under an orthographic view (`finite`) no sides converge.
pub fn silhouettes(plan: &FramePlan, model: &Model, finite: bool) -> Vec<(usize, [DVec4; 2])> {
    let mut edges = Vec::new();
    let casters = model.casters();
    draws(plan, model, |light, draw, place| {
        let topology = casters[draw.caster as usize].topology;
        let stride = volume::side_len(draw.light.w == 0.0 && !finite);
        let mut last = None;
        for side in indices(plan, &draw.volume.sides).chunks_exact(stride) {
            let edge = [side[0] >> 1, side[1] >> 1];
            if last.replace(edge) != Some(edge) {
                edges.push((light, edge.map(|v| place.point(topology.position(v)))));
            }
        }
    });
    edges
}

fn indices<'p>(plan: &'p FramePlan, range: &Range<u32>) -> &'p [u32] {
    &plan.indices[range.start as usize..range.end as usize]
}

/// Where a vertex of a volume is: the `place` of `volume.wgsl`, in f64.
fn vertex(draw: &Draw, place: &Place, p: DVec3, extruded: bool) -> DVec4 {
    if !extruded {
        return place.point(p);
    }
    let extruded = draw.extruded(p);
    match extruded.w {
        0.0 => place.direction(extruded.truncate()),
        w => place.point(extruded.truncate() / w),
    }
}
