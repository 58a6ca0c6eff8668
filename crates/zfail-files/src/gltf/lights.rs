//! Lights and cameras where the nodes put them.

use super::animations::Motion;
use super::graph::Graph;
use super::schema::{self, LightType, Root};
use crate::shared::error::Result;
use crate::shared::limits::Budget;
use glam::{DAffine3, DVec3};
use rustc_hash::FxHashMap;
use serde_json::Value;
use std::f64::consts::FRAC_PI_2;
use std::ops::Range;
use zfail_plan::light::LightKind;
use zfail_plan::view::Projection;
use zfail_scene::animate::placed;
use zfail_scene::placement::rigid;
use zfail_scene::{Camera, Light, LightShape, Scene};

/// Adds the default scene's lights to `scene`, and hangs those that move on the rig; `held` are the instances at and
/// below each visited node, `textures` the scene's by the document's index.
pub(super) fn read_lights(
    root: &Root,
    graph: &Graph,
    held: &[Range<usize>],
    textures: &[Option<usize>],
    budget: &Budget,
    motion: &mut Motion,
    scene: &mut Scene,
) -> Result<()> {
    let Some(lights) = &root.extensions.lights else { return Ok(()) };
    let mut held_by_name: FxHashMap<&str, Vec<Range<usize>>> = FxHashMap::default();
    for (visit, held) in graph.visits.iter().zip(held) {
        if let Some(name) = &root.nodes[visit.node].name {
            held_by_name.entry(name).or_default().push(held.clone());
        }
    }
    for (v, visit) in graph.visits.iter().enumerate().filter(|(_, visit)| visit.is_visible) {
        let node = &root.nodes[visit.node];
        let Some(reference) = &node.extensions.light else { continue };
        let source = &lights.lights[reference.light];
        let Some(source_kind) = source.kind else {
            let element = format!("extensions.KHR_lights_punctual.lights[{}]", reference.light);
            scene.notices.push(format!("{element} is of no known type: left out"));
            continue;
        };
        let name = source.name.clone().or_else(|| node.name.clone());
        let name = name.unwrap_or_else(|| format!("light {}", scene.lights.len()));
        let mut excluded = Vec::new();
        for caster in exclusions(&node.extras) {
            match held_by_name.get(caster) {
                None => scene.notices.push(format!("light \"{name}\": shadowExclude names no node \"{caster}\"")),
                Some(ranges) => {
                    let count = ranges.iter().map(ExactSizeIterator::len).sum::<usize>() as u64;
                    budget.charge(count, 16, || format!("nodes[{}].extras.shadowExclude", visit.node))?;
                    excluded.extend(ranges.iter().cloned().flatten());
                }
            }
        }
        excluded.sort_unstable();
        excluded.dedup();
        let kind = light_kind(source, source_kind, &visit.world_from_node);
        if let Some(rig_node) = motion.rig_node[v] {
            motion.rig.carry_light(scene.lights.len(), rig_node, DAffine3::IDENTITY, kind);
        }
        let element = format!("nodes[{}].extras", visit.node);
        let mut shape = shape(&node.extras, &kind, textures, &element, &mut scene.notices);
        budget.charge(shape.falloff.len() as u64, size_of::<f32>() as u64, || format!("{element}.falloff"))?;
        shape.axes = rigid(&visit.world_from_node).matrix3;
        scene.lights.push(Light {
            name,
            kind,
            color: source.color.map(positive),
            intensity: positive(source.intensity),
            excluded,
            shape,
        });
    }
    Ok(())
}

fn exclusions(extras: &Value) -> impl Iterator<Item = &str> {
    extras.get("shadowExclude").and_then(Value::as_array).into_iter().flatten().filter_map(Value::as_str)
}

/// What a light's node says about its shape in `falloff`, `cookie` and `box`. Other programs may mean something else by
/// these words, so what does not fit is no error: it becomes a notice and is left out.
fn shape(
    extras: &Value,
    kind: &LightKind,
    textures: &[Option<usize>],
    element: &str,
    notices: &mut Vec<String>,
) -> LightShape {
    let mut leave_out = |key: &str, problem: &str| notices.push(format!("{element}.{key} is left out: it {problem}"));
    let mut shape = LightShape::default();
    if let Some(value) = extras.get("falloff") {
        match numbers(value) {
            None => leave_out("falloff", "is no array of numbers"),
            Some(samples) => {
                shape.falloff = samples.into_iter().map(|x| x as f32).collect();
                let problem = shape.falloff_problem(kind).or(shape.falloff.is_empty().then_some("is empty"));
                if let Some(problem) = problem {
                    shape.falloff.clear();
                    leave_out("falloff", problem);
                }
            }
        }
    }
    if let Some(value) = extras.get("cookie") {
        match value.as_u64().map(|index| textures.get(index as usize)) {
            None => leave_out("cookie", "is no index of a texture"),
            Some(None) => leave_out("cookie", "refers to a texture that is not there"),
            Some(Some(None)) => leave_out("cookie", "refers to a texture without a readable image"),
            Some(Some(&Some(cookie))) => {
                shape.cookie = Some(cookie);
                if let Some(problem) = shape.cookie_problem(kind, usize::MAX) {
                    shape.cookie = None;
                    leave_out("cookie", problem);
                }
            }
        }
    }
    if let Some(value) = extras.get("box") {
        match numbers(value).and_then(|half| <[f64; 3]>::try_from(half).ok()) {
            None => leave_out("box", "is no array of three numbers"),
            Some(half) => {
                shape.half_extents = Some(half.into());
                if let Some(problem) = shape.box_problem(kind) {
                    shape.half_extents = None;
                    leave_out("box", problem);
                }
            }
        }
    }
    shape
}

fn numbers(value: &Value) -> Option<Vec<f64>> {
    value.as_array()?.iter().map(Value::as_f64).collect()
}

fn positive(x: f64) -> f32 {
    x.clamp(0.0, 1e30) as f32
}

fn light_kind(light: &schema::Light, kind: LightType, world_from_node: &DAffine3) -> LightKind {
    let (position, direction) = (DVec3::ZERO, DVec3::NEG_Z);
    let range = light.range.filter(|&range| range > 0.0).unwrap_or(f64::INFINITY);
    let at_origin = match kind {
        LightType::Point => LightKind::Point { position, range },
        LightType::Directional => LightKind::Directional { direction },
        LightType::Spot => {
            let outer = light.spot.outer_cone_angle.clamp(1e-3, FRAC_PI_2);
            let inner = light.spot.inner_cone_angle.clamp(0.0, outer * 0.999);
            LightKind::Spot { position, direction, range, inner, outer }
        }
    };
    placed(&at_origin, world_from_node)
}

/// Adds the default scene's cameras to `scene`, and hangs those that move on the rig.
pub(super) fn read_cameras(root: &Root, graph: &Graph, motion: &mut Motion, scene: &mut Scene) {
    for (v, visit) in graph.visits.iter().enumerate() {
        let node = &root.nodes[visit.node];
        let Some(index) = node.camera else { continue };
        let source = &root.cameras[index];
        let projection = match (&source.perspective, &source.orthographic) {
            (Some(p), _) => Projection::Perspective { yfov: p.yfov, near: p.znear, far: p.zfar },
            (None, Some(o)) => Projection::Orthographic { ymag: o.ymag.abs(), near: o.znear, far: o.zfar },
            (None, None) => continue,
        };
        let name = source.name.clone().or_else(|| node.name.clone());
        let world_from_view = rigid(&visit.world_from_node);
        if let Some(rig_node) = motion.rig_node[v] {
            motion.rig.carry_camera(scene.cameras.len(), rig_node, DAffine3::IDENTITY, world_from_view);
        }
        let name = name.unwrap_or_else(|| format!("camera {}", scene.cameras.len()));
        scene.cameras.push(Camera { name, world_from_view, projection });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn light_parameters_are_clamped() {
        let light = |json: &str| serde_json::from_str::<schema::Light>(json).unwrap();
        let spot = light(r#"{"type": "spot", "spot": {"innerConeAngle": 3, "outerConeAngle": 2}, "range": -1}"#);
        let LightKind::Spot { inner, outer, range, direction, .. } =
            light_kind(&spot, LightType::Spot, &DAffine3::IDENTITY)
        else {
            panic!()
        };
        assert!(inner < outer && outer == FRAC_PI_2 && range == f64::INFINITY && direction == DVec3::NEG_Z);
        assert_eq!(positive(-1.0), 0.0);
        assert!(positive(1e300).is_finite());
    }
}
