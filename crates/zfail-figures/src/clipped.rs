//! What lies in a region: scene, whole volumes and silhouettes, as the figures on paper draw them.
//!
//! In: model, volumes, a region. Out: the beginning of a drawing.

use crate::Overlay;
use crate::clipping::{Region, fan};
use crate::drawing::{Drawing, Surfaces, flat};
use crate::model::Model;
use crate::over_picture;
use crate::palette::{self, with_opacity};
use crate::paper::{self, Paper};
use crate::plans::Whole;
use crate::third_person::Camera;
use zfail_plan::glam::{DMat4, DVec4};

/// Solid triangles in the region, with their colours.
pub fn scene(model: &Model, region: &Region) -> Vec<([DVec4; 3], [u8; 3])> {
    let (mut scene, mut polygon) = (Vec::new(), Vec::new());
    for (i, instance) in model.instances.iter().enumerate() {
        for (t, face) in model.meshes[instance.mesh].faces.iter().enumerate().filter(|(_, face)| face.solid) {
            region.triangle(model.corners(i, t), &mut polygon);
            scene.extend(fan(&polygon).map(|corners| (corners, face.color)));
        }
    }
    scene
}

/// A drawing, seen by `camera` in a space to which `space_from_anchored` leads, of the [`scene`] in the region, and of all
/// volumes and silhouettes there.
pub fn drawing(
    model: &Model,
    whole: &Whole,
    region: &Region,
    scene: &[([DVec4; 3], [u8; 3])],
    paper: &Paper<'_>,
    camera: &Camera,
    space_from_anchored: &DMat4,
) -> Drawing {
    let place = |p: DVec4| *space_from_anchored * p;
    let surfaces =
        scene.iter().flat_map(|&(corners, color)| paper::shaded(corners.map(place), color, camera.position)).collect();
    let mut drawing = Drawing::new(camera.clip_from_origin, false, Surfaces::Paper(surfaces));
    let by_light = paper.shows(Overlay::VolumesByLight);
    let mut polygon = Vec::new();
    for triangle in &whole.triangles {
        region.triangle(triangle.corners, &mut polygon);
        let (hue, opacity) = over_picture::glass_color(model, triangle, by_light, paper.lights);
        for corners in fan(&polygon) {
            let color = with_opacity(hue, 0.6 * opacity);
            drawing.glass.extend(flat(corners.map(place), color, triangle.winding.into()));
        }
    }
    for (light, edge) in &whole.silhouettes {
        if let Some(edge) = region.segment(*edge) {
            let hue = if by_light { model.hues[paper.lights[*light]] } else { palette::INK };
            drawing.line(edge.map(place), paper.line(hue, 0.7));
        }
    }
    if paper.shows(Overlay::Wireframe) {
        let wires = over_picture::wires(model).filter_map(|(edge, _)| region.segment(edge));
        wires.for_each(|edge| drawing.line(edge.map(place), paper.line(palette::INK, 0.3)));
    }
    over_picture::volume_legend(&mut drawing, model, by_light, paper.lights);
    drawing
}
