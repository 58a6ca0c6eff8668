//! How far a light reaches, as lines: its range, cone and box.

use crate::drawing::{Drawing, Line};
use crate::model::Model;
use std::f64::consts::TAU;
use zfail_plan::glam::{DVec3, DVec4};
use zfail_plan::light::LightKind;
use zfail_plan::view::{Projection, View};

/// Segments of a circle.
const SEGMENTS: usize = 96;

/// Adds the outline of what light number `light` can reach, as seen in `view`; nothing where that is everything.
pub fn outline(drawing: &mut Drawing, model: &Model, view: &View, light: usize, style: Line) {
    let at = |p: DVec3| model.anchored(p.extend(1.0));
    let mut circle = |center: DVec3, normal: DVec3, radius: f64| {
        let (u, v) = normal.any_orthonormal_pair();
        let point = |i: usize| {
            let (sin, cos) = (TAU * i as f64 / SEGMENTS as f64).sin_cos();
            at(center + (u * cos + v * sin) * radius)
        };
        (0..SEGMENTS).for_each(|i| drawing.line([point(i), point(i + 1)], style));
    };
    let lamp = &model.lights[light];
    match lamp.kind {
        LightKind::Directional { .. } => {}
        LightKind::Point { position, range } => {
            if range.is_finite() {
                sphere(view, position, range, &mut circle);
            }
        }
        LightKind::Spot { position, direction, range, outer, .. } => {
            // The cone's rim is where the sphere of the range ends it; endless cones are cut somewhere far.
            let reach = if range.is_finite() { range } else { 1e4 };
            circle(position + direction * reach * outer.cos(), direction, reach * outer.sin());
            let (u, v) = direction.any_orthonormal_pair();
            for side in [u, v, -u, -v] {
                let edge = direction * outer.cos() + side * outer.sin();
                drawing.line([at(position), at(position + edge * reach)], style);
            }
        }
    }
    if let Some(bounds) = lamp.bounds() {
        box_edges(bounds.corners().map(at)).for_each(|edge| drawing.line(edge, style));
    }
}

/// The edges of a box whose corners are ordered as [`zfail_plan::bounds::Bounds::corners`] does.
pub fn box_edges(corners: [DVec4; 8]) -> impl Iterator<Item = [DVec4; 2]> {
    let edges = (0..8_usize).flat_map(|i| [1, 2, 4].map(|bit| (i, i | bit))).filter(|(i, j)| i != j);
    edges.map(move |(i, j)| [corners[i], corners[j]])
}

/// The outline of a sphere, or from inside of it three great circles.
fn sphere(view: &View, center: DVec3, radius: f64, circle: &mut impl FnMut(DVec3, DVec3, f64)) {
    let to_center = center - view.eye();
    let distance = to_center.length();
    match view.projection {
        Projection::Orthographic { .. } => circle(center, view.world_from_view.matrix3.z_axis, radius),
        Projection::Perspective { .. } if distance > radius * (1.0 + 1e-9) => {
            // Where tangents from the eye touch.
            let share = (radius / distance).powi(2);
            circle(view.eye() + to_center * (1.0 - share), to_center / distance, radius * (1.0 - share).sqrt());
        }
        Projection::Perspective { .. } => {
            [DVec3::X, DVec3::Y, DVec3::Z].into_iter().for_each(|axis| circle(center, axis, radius));
        }
    }
}
