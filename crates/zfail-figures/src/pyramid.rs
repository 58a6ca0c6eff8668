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

    // Translucent, so that rooms are looked into.
    let mut drawing = Drawing::new(camera.clip_from_origin, false, Surfaces::Paper(Vec::new()));
    for (corners, i) in &scene {
        let (hue, opacity) = match case_of[*i] {
            Some(Some(case)) => (palette::CASES[case], 0.2),
            Some(None) => (palette::CULLED, 0.14),
            None => (palette::CULLED, 0.05),
        };
        let side = if model.place(*i).mirrored { -1.0 } else { 1.0 };
        drawing.glass.extend(flat(*corners, with_opacity(hue, opacity), side));
    }
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Overlay;
    use crate::test_scene::{paper, scene, view};
    use zfail_plan::glam::Vec4;

    #[test]
    fn the_pyramid_joins_the_near_rectangle_to_the_light() {
        let (view, mut model) = (view(), Model::new(&scene()).expect("a model"));
        let drawing = compose(&mut model, &mut Plans::default(), &paper(&view, &[Overlay::Pyramid])).expect("a figure");
        let [r, g, b] = palette::PYRAMID;
        let red: Vec<_> = drawing.lines.iter().filter(|line| line.color[..3] == [r, g, b]).collect();
        let light = model.anchored(model.lights[0].kind.homogeneous()).as_vec4();
        let to_light: Vec<_> = red.iter().filter(|line| Vec4::from(line.ends[1]).distance(light) < 1e-5).collect();
        assert_eq!((red.len(), to_light.len()), (8, 4));
        for line in to_light {
            let c = model.clip_from_anchored(&view) * Vec4::from(line.ends[0]).as_dvec4();
            assert!(
                (c.x.abs() / c.w - 1.0).abs() < 1e-4 && (c.z / c.w - 1.0).abs() < 1e-4,
                "a corner of the view: {c}"
            );
        }
    }
}
