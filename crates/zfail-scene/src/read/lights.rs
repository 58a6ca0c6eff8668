//! Lights and cameras where the nodes put them.

use super::error::Result;
use super::graph::Graph;
use super::limits::Budget;
use super::schema::{self, LightType, Root};
use glam::{DAffine3, DMat3, DVec3};
use rustc_hash::FxHashMap;
use serde_json::Value;
use std::f64::consts::FRAC_PI_2;
use std::ops::Range;
use zfail_plan::scene::{Camera, Light, LightKind, Scene};
use zfail_plan::view::Projection;

/// Adds the default scene's lights to `scene`; `held` are the instances at and below each visited node.
pub(super) fn read_lights(
    root: &Root,
    graph: &Graph,
    held: &[Range<usize>],
    budget: &Budget,
    scene: &mut Scene,
) -> Result<()> {
    let Some(lights) = &root.extensions.lights else { return Ok(()) };
    let mut held_by_name: FxHashMap<&str, Vec<Range<usize>>> = FxHashMap::default();
    for (visit, held) in graph.visits.iter().zip(held) {
        if let Some(name) = &root.nodes[visit.node].name {
            held_by_name.entry(name).or_default().push(held.clone());
        }
    }
    for visit in &graph.visits {
        let node = &root.nodes[visit.node];
        let Some(reference) = &node.extensions.light else { continue };
        let source = &lights.lights[reference.light];
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
        scene.lights.push(Light {
            name,
            kind: light_kind(source, &graph.world_from_node[visit.node]),
            color: source.color.map(positive),
            intensity: positive(source.intensity),
            excluded,
        });
    }
    Ok(())
}

fn exclusions(extras: &Value) -> impl Iterator<Item = &str> {
    extras.get("shadowExclude").and_then(Value::as_array).into_iter().flatten().filter_map(Value::as_str)
}

fn positive(x: f64) -> f32 {
    x.clamp(0.0, 1e30) as f32
}

fn light_kind(light: &schema::Light, world_from_node: &DAffine3) -> LightKind {
    let position = world_from_node.translation;
    let direction = (-world_from_node.matrix3.z_axis).try_normalize().unwrap_or(DVec3::NEG_Z);
    let range = light.range.filter(|&range| range > 0.0).unwrap_or(f64::INFINITY);
    match light.kind {
        LightType::Point => LightKind::Point { position, range },
        LightType::Directional => LightKind::Directional { direction },
        LightType::Spot => {
            let outer = light.spot.outer_cone_angle.clamp(1e-3, FRAC_PI_2);
            let inner = light.spot.inner_cone_angle.clamp(0.0, outer * 0.999);
            LightKind::Spot { position, direction, range, inner, outer }
        }
    }
}

/// Adds the default scene's cameras to `scene`.
pub(super) fn read_cameras(root: &Root, graph: &Graph, scene: &mut Scene) {
    for visit in &graph.visits {
        let node = &root.nodes[visit.node];
        let Some(index) = node.camera else { continue };
        let source = &root.cameras[index];
        let projection = match (&source.perspective, &source.orthographic) {
            (Some(p), _) => Projection::Perspective { yfov: p.yfov, near: p.znear, far: p.zfar },
            (None, Some(o)) => Projection::Orthographic { ymag: o.ymag.abs(), near: o.znear, far: o.zfar },
            (None, None) => continue,
        };
        let name = source.name.clone().or_else(|| node.name.clone());
        scene.cameras.push(Camera {
            name: name.unwrap_or_else(|| format!("camera {}", scene.cameras.len())),
            world_from_view: rigid(&graph.world_from_node[visit.node]),
            projection,
        });
    }
}

/// Rotation and translation of `m`, without scale and shear. It keeps the way the camera looks and, as near as can be,
/// its up; a mirrored camera has left and right exchanged, since a view space is right-handed.
pub(crate) fn rigid(m: &DAffine3) -> DAffine3 {
    let back = m.matrix3.z_axis.try_normalize().unwrap_or(DVec3::Z);
    let up = m.matrix3.y_axis.reject_from_normalized(back);
    let up = up.try_normalize().unwrap_or_else(|| back.any_orthonormal_vector());
    DAffine3 { matrix3: DMat3::from_cols(up.cross(back), up, back), translation: m.translation }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cameras_become_rigid() {
        let turn = DMat3::from_euler(glam::EulerRot::YXZ, 0.7, -0.3, 0.1);
        for scale in [DVec3::ONE, DVec3::new(-1.0, 1.0, 1.0), DVec3::new(2.0, 1e-4, 3.0), DVec3::new(0.0, 1.0, 1.0)] {
            let m = DAffine3 { matrix3: turn * DMat3::from_diagonal(scale), translation: DVec3::ONE };
            let r = rigid(&m);
            assert!((r.matrix3 * r.matrix3.transpose()).abs_diff_eq(DMat3::IDENTITY, 1e-12), "{scale}");
            assert!((r.matrix3.determinant() - 1.0).abs() < 1e-12, "{scale}: right-handed");
            assert!(r.matrix3.z_axis.distance(turn.z_axis) < 1e-12 && r.matrix3.y_axis.distance(turn.y_axis) < 1e-12);
        }
        assert!(rigid(&DAffine3::from_scale(DVec3::ZERO)).is_finite());
    }

    #[test]
    fn light_parameters_are_clamped() {
        let light = |json: &str| serde_json::from_str::<schema::Light>(json).unwrap();
        let spot = light(r#"{"type": "spot", "spot": {"innerConeAngle": 3, "outerConeAngle": 2}, "range": -1}"#);
        let LightKind::Spot { inner, outer, range, direction, .. } = light_kind(&spot, &DAffine3::IDENTITY) else {
            panic!()
        };
        assert!(inner < outer && outer == FRAC_PI_2 && range == f64::INFINITY && direction == DVec3::NEG_Z);
        assert_eq!(positive(-1.0), 0.0);
        assert!(positive(1e300).is_finite());
    }
}
