//! Overlays on the picture that the eye sees.
//!
//! In: kinds, view and lights. Out: one drawing of all of them.

use crate::drawing::{Drawing, Line, Surfaces, flat, stroke};
use crate::model::Model;
use crate::palette::{self, with_opacity};
use crate::plans::Plans;
use crate::volumes::{self, Part, Triangle};
use crate::{Error, Overlay, light_bounds};
use zfail_plan::glam::DVec4;
use zfail_plan::plan::{FramePlan, Technique};
use zfail_plan::scissor::Rectangle;
use zfail_plan::view::View;

/// What is to be shown.
#[derive(Debug)]
pub struct Picture<'a> {
    pub overlays: &'a [Overlay],
    pub view: &'a View,
    pub lights: &'a [usize],
    pub technique: Technique,
}

impl Picture<'_> {
    fn shows(&self, kinds: &[Overlay]) -> bool {
        kinds.iter().any(|kind| self.overlays.contains(kind))
    }
}

/// The drawing of `picture`.
pub fn compose(model: &mut Model, plans: &mut Plans, picture: &Picture<'_>) -> Result<Drawing, Error> {
    use Overlay::{Cases, Scissors, Silhouettes, Stencil, Volumes, VolumesByLight, Wireframe};
    let view = picture.view;
    let mut drawing = Drawing::new(model.clip_from_anchored(view), view.has_far_plane(), Surfaces::Scene);
    let width = line_width(view.size);
    if picture.shows(&[Stencil])
        && let Some(&light) = picture.lights.first()
    {
        stencil(&mut drawing, &plans.whole(model, view, &[light])?.triangles);
        count_legend(&mut drawing, model, light);
    }
    if picture.shows(&[Volumes, VolumesByLight, Cases, Scissors]) {
        let plan = plans.of(model, view, picture.lights, picture.technique)?;
        if picture.shows(&[Volumes, VolumesByLight]) {
            let by_light = picture.shows(&[VolumesByLight]);
            for triangle in volumes::triangles(plan, model) {
                let (hue, opacity) = glass_color(model, &triangle, by_light, picture.lights);
                let color = with_opacity(hue, opacity);
                drawing.glass_within(triangle.scissor, flat(triangle.corners, color, triangle.winding.into()));
            }
            volume_legend(&mut drawing, model, by_light, picture.lights);
        }
        if picture.shows(&[Cases]) && !picture.lights.is_empty() {
            cases(&mut drawing, model, plan);
            case_legend(&mut drawing, model, picture.lights[0]);
        }
        if picture.shows(&[Scissors]) {
            scissors(&mut drawing, model, plan, picture, width);
        }
    }
    if picture.shows(&[Scissors]) {
        for &light in picture.lights {
            let style = Line { hidden: 0.35, ..stroke(with_opacity(model.hues[light], 1.0), width) };
            light_bounds::outline(&mut drawing, model, view, light, style);
        }
        drawing.legend.heading("scissors and reach");
        light_names(&mut drawing, model, picture.lights);
        drawing.legend.swatch(palette::CASTER, "single volumes");
    }
    if picture.shows(&[Wireframe]) {
        let style = stroke(with_opacity(palette::WIRE, 0.55), 0.6 * width);
        for (edge, _) in wires(model) {
            drawing.line(edge, style);
        }
    }
    if picture.shows(&[Silhouettes]) {
        for (light, edge) in plans.whole(model, view, picture.lights)?.silhouettes {
            let color = with_opacity(silhouette_color(model, picture.lights, light), 1.0);
            drawing.line(edge, Line { hidden: 0.3, ..stroke(color, width) });
        }
        drawing.legend.heading("silhouette edges");
        if picture.lights.len() > 1 {
            light_names(&mut drawing, model, picture.lights);
        }
    }
    Ok(drawing)
}

/// Pixels.
pub fn line_width(size: [u32; 2]) -> f32 {
    (size[0].min(size[1]) as f32 / 400.0).clamp(1.4, 5.0)
}

/// White, or where there are several lights the light's.
fn silhouette_color(model: &Model, lights: &[usize], light: usize) -> [u8; 3] {
    if lights.len() > 1 { model.hues[lights[light]] } else { [255; 3] }
}

/// Hue and opacity of a triangle of a volume.
pub fn glass_color(model: &Model, triangle: &Triangle, by_light: bool, lights: &[usize]) -> ([u8; 3], f32) {
    let part = part_index(triangle.part);
    let hue = if by_light { model.hues[lights[triangle.light]] } else { palette::PARTS[part] };
    (hue, palette::PART_OPACITY[part])
}

fn part_index(part: Part) -> usize {
    match part {
        Part::Sides => 0,
        Part::DarkCap => 1,
        Part::LightCap => 2,
    }
}

/// Tells which colour is what in a figure of volumes.
pub fn volume_legend(drawing: &mut Drawing, model: &Model, by_light: bool, lights: &[usize]) {
    drawing.legend.heading("shadow volumes");
    if by_light {
        light_names(drawing, model, lights);
        return;
    }
    for (color, name) in palette::PARTS.into_iter().zip(["sides", "dark cap, at infinity", "light cap"]) {
        drawing.legend.swatch(color, name);
    }
}

/// A swatch for each light.
fn light_names(drawing: &mut Drawing, model: &Model, lights: &[usize]) {
    /// More would hide the picture.
    const MOST: usize = 8;
    for &light in lights.iter().take(MOST) {
        drawing.legend.swatch(model.hues[light], light_name(model, light));
    }
    if lights.len() > MOST {
        drawing.legend.heading(format!("and {} more", lights.len() - MOST));
    }
}

/// As legends call a light.
pub fn light_name(model: &Model, light: usize) -> String {
    /// Letters; names in files may be of any length.
    const MOST: usize = 24;
    let name: String = model.lights[light].name.chars().filter(|c| !c.is_control()).take(MOST).collect();
    if name.is_empty() || name == "light" { format!("light {light}") } else { format!("light {light}, {name}") }
}

fn stencil(drawing: &mut Drawing, triangles: &[Triangle]) {
    let mut counted = [Vec::new(), Vec::new()];
    for triangle in triangles {
        // Light caps lie on surfaces: they are drawn exactly as these.
        let list = &mut counted[usize::from(triangle.part == Part::LightCap)];
        list.extend(flat(triangle.corners, [0; 4], triangle.winding.into()));
    }
    drawing.counted = Some(counted);
}

fn count_legend(drawing: &mut Drawing, model: &Model, light: usize) {
    drawing.legend.heading("stencil count");
    drawing.legend.heading(light_name(model, light));
    for (color, name) in palette::COUNTS {
        drawing.legend.swatch(color, name);
    }
}

/// The case of each caster under the first light of a plan: 0, 1 or 2 for case 1, 2 or 3; `None` if it draws nothing.
pub fn cases_of(plan: &FramePlan, casters: usize) -> Vec<Option<usize>> {
    let mut cases = vec![None; casters];
    let batches = plan.lights.first().map_or(&[][..], |light| &light.batches);
    for draw in batches.iter().flat_map(|b| &plan.draws[b.start as usize..b.end as usize]) {
        let volume = &draw.volume;
        let light_cap = !volume.light_cap.is_empty() || !volume.light_cap_reversed.is_empty();
        let case = if draw.z_pass { 0 } else { 1 + usize::from(light_cap) };
        let slot = &mut cases[draw.caster as usize];
        *slot = (*slot).max(Some(case));
    }
    cases
}

fn cases(drawing: &mut Drawing, model: &Model, plan: &FramePlan) {
    for (caster, case) in (0..).zip(cases_of(plan, model.casters().len())) {
        let (hue, opacity) = case.map_or((palette::CULLED, 0.45), |case| (palette::CASES[case], 0.62));
        let i = model.instance_of(caster);
        let mirrored = model.place(i).mirrored;
        for (t, face) in model.meshes[model.instances[i].mesh].faces.iter().enumerate().filter(|(_, face)| face.solid) {
            let side = if face.double_sided {
                0.0
            } else if mirrored {
                -1.0
            } else {
                1.0
            };
            drawing.tints.extend(flat(model.corners(i, t), with_opacity(hue, opacity), side));
        }
    }
}

/// Tells which case has which colour.
pub fn case_legend(drawing: &mut Drawing, model: &Model, light: usize) {
    drawing.legend.heading(format!("cases under {}", light_name(model, light)));
    let names = ["1: z-pass", "2: z-fail without light cap", "3: z-fail with light cap"];
    for (color, name) in palette::CASES.into_iter().zip(names) {
        drawing.legend.swatch(color, name);
    }
    drawing.legend.swatch(palette::CULLED, "draws nothing");
}

fn scissors(drawing: &mut Drawing, model: &Model, plan: &FramePlan, picture: &Picture<'_>, width: f32) {
    for (planned, &light) in plan.lights.iter().zip(picture.lights) {
        let mut seen = Vec::new();
        for draw in planned.batches.iter().flat_map(|b| &plan.draws[b.start as usize..b.end as usize]) {
            if Some(draw.scissor) != planned.scissor && !seen.contains(&draw.scissor) {
                rectangle(drawing, picture.view, draw.scissor, stroke(with_opacity(palette::CASTER, 0.6), 0.6 * width));
                seen.push(draw.scissor);
            }
        }
        if let Some(scissor) = planned.scissor {
            rectangle(drawing, picture.view, scissor, stroke(with_opacity(model.hues[light], 1.0), 1.4 * width));
        }
    }
}

/// The outline of a pixel rectangle, inside of it.
fn rectangle(drawing: &mut Drawing, view: &View, [x, y, width, height]: Rectangle, style: Line) {
    let inset = 0.5 * f64::from(style.width);
    let [columns, rows] = view.size.map(f64::from);
    let corner = |right: bool, low: bool| {
        let px = f64::from(x) + if right { f64::from(width) - inset } else { inset };
        let py = f64::from(y) + if low { f64::from(height) - inset } else { inset };
        // Just behind the near plane, where depth is 1.
        DVec4::new(2.0 * px / columns - 1.0, 1.0 - 2.0 * py / rows, 0.99999, 1.0)
    };
    let corners = [corner(false, false), corner(true, false), corner(true, true), corner(false, true)];
    for i in 0..4 {
        drawing.line([corners[i], corners[(i + 1) % 4]], Line { screen: 1.0, ..style });
    }
}

/// Every edge of every triangle, relative to the anchor, with its instance.
pub fn wires(model: &Model) -> impl Iterator<Item = ([DVec4; 2], usize)> {
    model.instances.iter().enumerate().flat_map(|(i, instance)| {
        let (place, mesh) = (model.place(i), &model.meshes[instance.mesh]);
        mesh.edges().iter().map(move |edge| (edge.map(|v| place.point(mesh.mesh.position(v))), i))
    })
}
