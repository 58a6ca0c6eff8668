//! The alternate view: scene and whole volumes inside the eye's infinite frustum, seen from elsewhere (E&K 2002, Figure 2,
//! "alternate view of scene", and Figure 3, "with everything outside the eye's infinite frustum clipped away").
//!
//! In: model, the eye's view, lights. Out: a drawing on paper.

use crate::clipped;
use crate::clipping::Region;
use crate::drawing::Drawing;
use crate::model::Model;
use crate::paper::{self, Paper};
use crate::plans::Plans;
use crate::third_person::Camera;
use crate::{Error, Overlay, pyramid};
use zfail_plan::glam::{DMat4, DVec3, DVec4};

/// The alternate view of `paper`.
pub fn compose(model: &mut Model, plans: &mut Plans, paper: &Paper<'_>) -> Result<Drawing, Error> {
    let whole = plans.whole(model, paper.view, paper.lights)?;
    let region = Region::frustum(&model.clip_from_anchored(paper.view));
    let scene = clipped::scene(model, &region);
    let points = worth_seeing(model, paper, scene.iter().flat_map(|(corners, _)| corners));
    let turn = paper.view.world_from_view.matrix3;
    let camera = Camera::around(&points, -turn.z_axis, turn.y_axis, paper.from, paper.view.size);

    let mut drawing = clipped::drawing(model, &whole, &region, &scene, paper, &camera, &DMat4::IDENTITY);
    paper::frustum(&mut drawing, model, paper);
    if paper.shows(Overlay::Pyramid) {
        pyramid::add(&mut drawing, model, paper);
    }
    paper::eye_and_lights(&mut drawing, model, paper, &camera, &points);
    Ok(drawing)
}

/// Points that the image has to show: those of the scene, the eye, and lights that are not too far away or the arrows that
/// stand for them.
pub fn worth_seeing<'p>(model: &Model, paper: &Paper<'_>, scene: impl Iterator<Item = &'p DVec4>) -> Vec<DVec3> {
    let eye = model.anchored(paper.view.eye().extend(1.0)).truncate();
    let mut points: Vec<DVec3> = scene.map(|p| p.truncate() / p.w).collect();
    // The far ends of a plain that everything stands on would make all else small.
    let mut distances: Vec<f64> = points.iter().map(|p| p.distance(eye)).collect();
    if !distances.is_empty() {
        let most = distances.len() * 9 / 10;
        let (_, &mut usual, _) = distances.select_nth_unstable_by(most, f64::total_cmp);
        points.retain(|p| p.distance(eye) <= 1.5 * usual);
    }
    points.push(eye);
    let (center, radius) = paper::ball(&points);
    for light in paper.lights.iter().map(|&l| model.anchored(model.lights[l].kind.homogeneous())) {
        let at = light.truncate();
        if light.w == 0.0 {
            points.push(center + at.normalize_or_zero() * radius);
        } else if at.distance(center) < 2.0 * radius {
            points.push(at);
        }
    }
    points
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::drawing::{Surfaces, Vertex, flat};
    use crate::test_scene::{paper, scene, view};
    use zfail_plan::glam::{DMat4, Vec4};

    /// The greatest share by which a vertex lies outside the eye's frustum.
    fn excess(vertices: &[Vertex], clip_from_anchored: &DMat4) -> f64 {
        let excess = |v: &Vertex| {
            let c = *clip_from_anchored * Vec4::from(v.position).as_dvec4();
            let beyond = (c.x.abs() - c.w).max(c.y.abs() - c.w).max(c.z - c.w);
            beyond / c.abs().max_element()
        };
        vertices.iter().map(excess).fold(f64::NEG_INFINITY, f64::max)
    }

    #[test]
    fn nothing_remains_outside_of_the_frustum() {
        let (view, mut model) = (view(), Model::new(&scene()).expect("a model"));
        let drawing =
            compose(&mut model, &mut Plans::default(), &paper(&view, &[Overlay::Alternate])).expect("a figure");
        let clip_from_anchored = model.clip_from_anchored(&view);
        let Surfaces::Paper(surfaces) = &drawing.surfaces else { panic!("no picture of its own") };
        assert!(surfaces.len() > 30 && drawing.glass.len() > 30);
        assert!(excess(surfaces, &clip_from_anchored) < 1e-5, "{}", excess(surfaces, &clip_from_anchored));
        assert!(excess(&drawing.glass, &clip_from_anchored) < 1e-5);
        assert!(drawing.glass.iter().any(|v| v.position[3] == 0.0), "infinity stays");
        let whole = Plans::default().whole(&mut model, &view, &[0]).expect("volumes").triangles;
        let unclipped: Vec<Vertex> = whole.iter().flat_map(|t| flat(t.corners, [0; 4], 1.0)).collect();
        assert!(excess(&unclipped, &clip_from_anchored) > 0.1, "the check can fail");
    }
}
