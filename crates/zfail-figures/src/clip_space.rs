//! The scene in the eye's clip space: whatever is seen lies in a box, and volumes end on its far side, at infinity
//! (E&K 2002, Figures 2, 3 and 5).
//!
//! In: model, the eye's view, lights. Out: a drawing on paper.
//!
//! With the far plane at infinity and the near plane close to the eye, almost everything lies within a hair of the far
//! plane. The figure takes the near plane as far away as it can without cutting what is visible; infinity stays where it is.

use crate::Error;
use crate::clipped;
use crate::clipping::Region;
use crate::drawing::Drawing;
use crate::light_bounds::box_edges;
use crate::model::Model;
use crate::over_picture;
use crate::palette;
use crate::paper::{self, Paper};
use crate::plans::Plans;
use crate::third_person::Camera;
use zfail_plan::bounds::Bounds;
use zfail_plan::glam::{DMat4, DVec3, DVec4};
use zfail_plan::view::{Projection, View};

/// The box is so deep, half its height being 1.
const DEPTH: f64 = 2.4;

/// The clip-space view of `paper`.
pub fn compose(model: &mut Model, plans: &mut Plans, paper: &Paper<'_>) -> Result<Drawing, Error> {
    let whole = plans.whole(model, paper.view, paper.lights)?;
    let (view, near) = with_far_near_plane(model, paper.view);
    let clip_from_anchored = model.clip_from_anchored(&view);
    let region = Region::frustum(&clip_from_anchored);
    let boxed = box_from_clip(view.aspect()) * clip_from_anchored;
    let half = DVec3::new(view.aspect(), 1.0, 0.5 * DEPTH);
    let corners = Bounds { min: -half, max: half }.corners();
    let camera = Camera::around(&corners, DVec3::NEG_Z, DVec3::Y, paper.from, view.size);

    let scene = clipped::scene(model, &region);
    let mut drawing = clipped::drawing(model, &whole, &region, &scene, paper, &camera, &boxed);
    for edge in box_edges(corners.map(|c| c.extend(1.0))) {
        drawing.line(edge, paper.line(palette::FRUSTUM, 1.0));
    }
    for &light in paper.lights {
        let at = model.anchored(model.lights[light].kind.homogeneous());
        if region.contains(at) {
            let name = over_picture::light_name(model, light);
            paper::marker(&mut drawing, &camera, boxed * at, model.hues[light], &name);
        }
    }
    // On paper, beside the edges that are nearest to the camera and farthest from it.
    let label = |drawing: &mut Drawing, y: f64, z: f64, name: &str| {
        paper::label(drawing, &camera, DVec4::new(0.0, y, z, 1.0), name);
    };
    label(&mut drawing, -1.15, half.z, &format!("near plane, {near:.3} m"));
    label(&mut drawing, 1.15, -half.z, if view.has_far_plane() { "far plane" } else { "far plane, at infinity" });
    Ok(drawing)
}

/// The box that stands for clip space: x to the right, y up, the near plane in front. Depth is reversed, 1 at the near
/// plane.
fn box_from_clip(aspect: f64) -> DMat4 {
    let rows = [
        DVec4::new(aspect, 0.0, 0.0, 0.0),
        DVec4::new(0.0, 1.0, 0.0, 0.0),
        DVec4::new(0.0, 0.0, DEPTH, -0.5 * DEPTH),
        DVec4::W,
    ];
    DMat4::from_cols(rows[0], rows[1], rows[2], rows[3]).transpose()
}

/// `view` with its near plane moved to just before what is nearest to it, and where that is.
fn with_far_near_plane(model: &Model, view: &View) -> (View, f64) {
    let Projection::Perspective { yfov, near, far } = view.projection else { return (*view, view.near()) };
    let clip_from_anchored = model.clip_from_anchored(view);
    let scene = clipped::scene(model, &Region::frustum(&clip_from_anchored));
    let depths = scene.iter().flat_map(|(corners, _)| corners).map(|&p| (clip_from_anchored * p).w / p.w);
    let nearest = 0.98 * depths.fold(f64::INFINITY, f64::min);
    let near = if nearest.is_finite() { near.max(nearest) } else { near };
    (View { projection: Projection::Perspective { yfov, near, far }, ..*view }, near)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Overlay;
    use crate::drawing::Surfaces;
    use crate::test_scene::{paper, scene, view};
    use crate::volumes::Part;
    use zfail_plan::glam::Vec4;

    #[test]
    fn everything_is_in_the_box_and_dark_caps_on_its_far_side() {
        let (view, mut model) = (view(), Model::new(&scene()).expect("a model"));
        let paper = paper(&view, &[Overlay::ClipSpace]);
        let drawing = compose(&mut model, &mut Plans::default(), &paper).expect("a figure");
        let half = DVec3::new(view.aspect(), 1.0, 0.5 * DEPTH);
        let Surfaces::Paper(surfaces) = &drawing.surfaces else { panic!("no picture of its own") };
        let point = |position: [f32; 4]| Vec4::from(position).as_dvec4();
        let excess = |p: DVec4| ((p.truncate() / p.w).abs() - half).max_element();
        let worst = surfaces.iter().chain(&drawing.glass).map(|v| excess(point(v.position))).fold(-1.0, f64::max);
        assert!(worst.abs() < 1e-4, "{worst}");
        let [r, g, b] = palette::PARTS[Part::DarkCap as usize];
        let cap: Vec<DVec4> =
            drawing.glass.iter().filter(|v| v.color[..3] == [r, g, b]).map(|v| point(v.position)).collect();
        assert!(!cap.is_empty());
        assert!(cap.iter().all(|p| (p.z / p.w + half.z).abs() < 1e-5), "the far plane is infinity");
        let nearest = surfaces.iter().map(|v| point(v.position)).map(|p| p.z / p.w).fold(-9.0, f64::max);
        assert!(nearest > 0.8 * half.z, "the scene fills the box: {nearest}");

        // The eye's own near plane leaves the scene at the far plane.
        let unmoved = box_from_clip(view.aspect()) * model.clip_from_anchored(&view);
        let corner = |p: DVec4| unmoved * p;
        let all = clipped::scene(&model, &Region::frustum(&model.clip_from_anchored(&view)));
        let nearest = all.iter().flat_map(|(c, _)| c.map(corner)).map(|p| p.z / p.w).fold(-9.0, f64::max);
        assert!(nearest < -0.5 * half.z, "the check can fail: {nearest}");
    }
}
