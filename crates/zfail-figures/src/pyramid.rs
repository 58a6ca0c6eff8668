//! The occlusion pyramid between a light and the near rectangle, beside the view frustum (McG 2003, section 5 and Figure 2):
//! casters that keep clear of it are counted by z-pass.
//!
//! In: model, the eye's view, a light. Out: a drawing on paper, casters coloured by case.

use crate::alternate::worth_seeing;
use crate::drawing::{Drawing, Surfaces, flat};
use crate::model::Model;
use crate::palette::{self, with_opacity};
use crate::paper::{self, Paper};
use crate::plans::Plans;
use crate::third_person::Camera;
use crate::{Error, over_picture};
use zfail_plan::glam::DVec3;

/// The figure of the first of `paper`'s lights.
pub fn compose(model: &mut Model, plans: &mut Plans, paper: &Paper<'_>) -> Result<Drawing, Error> {
    let paper = &Paper { lights: &paper.lights[..paper.lights.len().min(1)], ..*paper };
    let plan = plans.of(model, paper.view, paper.lights, paper.technique)?;
    let mut case_of = vec![None; model.instances.len()];
    for (caster, case) in (0..).zip(over_picture::cases_of(plan, model.casters().len())) {
        case_of[model.instance_of(caster)] = Some(case);
    }
    let corners = (0..model.instances.len()).flat_map(|i| {
        let faces = &model.meshes[model.instances[i].mesh].faces;
        (0..faces.len()).filter(|&t| faces[t].solid).map(move |t| (i, t))
    });
    let scene: Vec<_> = corners.map(|(i, t)| (model.corners(i, t), i)).collect();
    let points = worth_seeing(model, paper, scene.iter().flat_map(|(corners, _)| corners));
    let turn = paper.view.world_from_view.matrix3;
    let camera = Camera::around(&points, -turn.z_axis, turn.y_axis, paper.from, paper.view.size);

    // Rooms are looked into: what faces away is left out.
    let faces_camera = |corners: &[zfail_plan::glam::DVec4; 3], mirrored: bool| {
        let [a, b, c] = corners.map(|p| p.truncate());
        ((b - a).cross(c - a).dot(camera.position - a) > 0.0) != mirrored
    };
    let mut surfaces = Vec::new();
    for (corners, i) in &scene {
        if faces_camera(corners, model.place(*i).mirrored) {
            let color = match case_of[*i] {
                Some(Some(case)) => palette::CASES[case],
                Some(None) => palette::CULLED,
                None => [225; 3],
            };
            surfaces.extend(paper::shaded(*corners, color, camera.position));
        }
    }
    let mut drawing = Drawing::new(camera.clip_from_origin, false, Surfaces::Paper(surfaces));
    paper::frustum(&mut drawing, model, paper);
    add(&mut drawing, model, paper);
    paper::eye_and_lights(&mut drawing, model, paper, &camera, &points);
    if let Some(&light) = paper.lights.first() {
        over_picture::case_legend(&mut drawing, model, light);
    }
    drawing.legend.swatch(palette::FRUSTUM, "view frustum");
    drawing.legend.swatch(palette::PYRAMID, "occlusion pyramid");
    Ok(drawing)
}

/// Adds the pyramid of the first light.
pub fn add(drawing: &mut Drawing, model: &Model, paper: &Paper<'_>) {
    let Some(&light) = paper.lights.first() else { return };
    let apex = model.anchored(model.lights[light].kind.homogeneous());
    let apex = if apex.w == 0.0 { apex.truncate().normalize_or(DVec3::Y).extend(0.0) } else { apex };
    let corners = paper::near_rectangle(model, paper.view).map(|(corner, _)| corner);
    for i in 0..4 {
        let next = corners[(i + 1) % 4];
        drawing.line([corners[i], apex], paper.line(palette::PYRAMID, 1.0));
        drawing.line([corners[i], next], paper.line(palette::PYRAMID, 1.0));
        drawing.glass.extend(flat([corners[i], next, apex], with_opacity(palette::PYRAMID, 0.25), 1.0));
    }
}
