//! What figures that replace the picture have in common: shaded surfaces, the eye, the lights, labels.

use crate::drawing::{Drawing, Line, Vertex, flat, stroke};
use crate::legend::{self, Sticker};
use crate::lettering::{self, Sheet};
use crate::model::Model;
use crate::palette::{self, with_opacity};
use crate::third_person::Camera;
use crate::{Overlay, ThirdPerson, over_picture};
use zfail_plan::glam::{DVec3, DVec4};
use zfail_plan::plan::Technique;
use zfail_plan::view::{Projection, View};

/// What is to be shown.
#[derive(Debug)]
pub struct Paper<'a> {
    pub overlays: &'a [Overlay],
    /// The eye's.
    pub view: &'a View,
    pub lights: &'a [usize],
    pub technique: Technique,
    pub from: ThirdPerson,
}

impl Paper<'_> {
    pub fn shows(&self, kind: Overlay) -> bool {
        self.overlays.contains(&kind)
    }

    /// A solid line that shows faintly through surfaces.
    pub fn line(&self, hue: [u8; 3], scale: f32) -> Line {
        let width = scale * over_picture::line_width(self.view.size);
        Line { hidden: 0.35, ..stroke(with_opacity(hue, 1.0), width) }
    }

    /// The same, dashed.
    pub fn dashes(&self, hue: [u8; 3]) -> Line {
        let line = self.line(hue, 1.0);
        Line { dash: 4.0 * line.width, ..line }
    }
}

/// An opaque triangle, lighter where it faces the camera at `position`.
pub fn shaded(corners: [DVec4; 3], [r, g, b]: [u8; 3], position: DVec3) -> [Vertex; 3] {
    let [a, b_, c] = corners.map(|p| p.truncate() / p.w);
    let normal = (b_ - a).cross(c - a).normalize_or_zero();
    let facing = normal.dot((position - a).normalize_or_zero()).abs();
    // From above a little lighter still, so that edges between faces show.
    let shade = 0.62 + 0.26 * facing + 0.12 * normal.y.abs();
    let color = [r, g, b].map(|c| (f64::from(c) * shade).min(255.0) as u8);
    flat(corners, [color[0], color[1], color[2], 255], 0.0)
}

/// Corners of the near rectangle relative to the anchor, in a cycle, and where the rays through them go.
pub fn near_rectangle(model: &Model, view: &View) -> [(DVec4, DVec4); 4] {
    [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].map(|(x, y): (f64, f64)| {
        let (at, ray) = match view.projection {
            Projection::Perspective { yfov, near, .. } => {
                let slope = (0.5 * yfov).tan();
                let ray = DVec3::new(x * slope * view.aspect(), y * slope, -1.0);
                (ray * near, ray)
            }
            Projection::Orthographic { ymag, near, .. } => {
                (DVec3::new(x * ymag * view.aspect(), y * ymag, -near), DVec3::NEG_Z)
            }
        };
        let turn = view.world_from_view.matrix3;
        (model.anchored((view.eye() + turn * at).extend(1.0)), (turn * ray).extend(0.0))
    })
}

/// Adds the outline of the eye's frustum and its near rectangle.
pub fn frustum(drawing: &mut Drawing, model: &Model, paper: &Paper<'_>) {
    let corners = near_rectangle(model, paper.view);
    for i in 0..4 {
        drawing.line([corners[i].0, corners[(i + 1) % 4].0], paper.line(palette::FRUSTUM, 1.2));
        drawing.line([corners[i].0, corners[i].1], paper.dashes(palette::FRUSTUM));
    }
}

/// Adds the eye, and the lights that are somewhere, with their names; arrows for those that are not.
pub fn eye_and_lights(drawing: &mut Drawing, model: &Model, paper: &Paper<'_>, camera: &Camera, around: &[DVec3]) {
    let eye = model.anchored(paper.view.eye().extend(1.0));
    if matches!(paper.view.projection, Projection::Perspective { .. }) {
        marker(drawing, camera, eye, palette::FRUSTUM, "eye");
    }
    for &light in paper.lights {
        let hue = model.hues[light];
        let at = model.anchored(model.lights[light].kind.homogeneous());
        let name = over_picture::light_name(model, light);
        if at.w != 0.0 {
            marker(drawing, camera, at, hue, &name);
            continue;
        }
        let (center, radius) = ball(around);
        let towards = at.truncate().normalize_or_zero();
        let [tail, head] = [0.9, 0.66].map(|share| center + towards * radius * share);
        let side = towards.cross((camera.position - head).normalize_or_zero()).normalize_or_zero();
        let line = paper.line(hue, 1.8);
        drawing.line([tail.extend(1.0), head.extend(1.0)], line);
        for turn in [-0.5, 0.5] {
            let barb = head + (towards + side * turn) * 0.07 * radius;
            drawing.line([barb.extend(1.0), head.extend(1.0)], line);
        }
        marker(drawing, camera, tail.extend(1.0), hue, &name);
    }
}

/// A ball around points, not the least.
pub fn ball(points: &[DVec3]) -> (DVec3, f64) {
    let bounds = zfail_plan::bounds::Bounds::of(points.iter().copied());
    if bounds.is_empty() { (DVec3::ZERO, 1.0) } else { (bounds.center(), bounds.half().length()) }
}

/// Adds a dot with a name beside it.
pub fn marker(drawing: &mut Drawing, camera: &Camera, p: DVec4, hue: [u8; 3], name: &str) {
    let Some([x, y]) = camera.pixel(p) else { return };
    let line = legend::line_height(camera.size);
    let radius = 0.3 * line;
    let middle = 0.5 * line + 2.0;
    let width = middle + radius + 0.3 * line + lettering::width(name, line) + 2.0;
    let mut sheet = Sheet::new([width.ceil() as u32, (2.0 * middle).ceil() as u32], [0; 4]);
    sheet.disc([middle; 2], radius + 1.0, with_opacity(palette::INK, 1.0));
    sheet.disc([middle; 2], radius - 0.5, with_opacity(hue, 1.0));
    text(&mut sheet, [middle + radius + 0.25 * line, 2.0], line, name);
    stick(drawing, camera, [x - middle, y - middle], sheet);
}

/// Adds a name at a point.
pub fn label(drawing: &mut Drawing, camera: &Camera, p: DVec4, name: &str) {
    let Some([x, y]) = camera.pixel(p) else { return };
    let line = legend::line_height(camera.size);
    let width = lettering::width(name, line) + 4.0;
    let mut sheet = Sheet::new([width.ceil() as u32, (line + 4.0).ceil() as u32], [0; 4]);
    text(&mut sheet, [2.0; 2], line, name);
    stick(drawing, camera, [x - 0.5 * width, y - 0.5 * line], sheet);
}

/// Dark letters with a halo, legible on anything.
fn text(sheet: &mut Sheet, [x, y]: [f32; 2], line: f32, name: &str) {
    for (dx, dy) in [(-1.0, 0.0), (1.0, 0.0), (0.0, -1.0), (0.0, 1.0)] {
        sheet.write([x + dx, y + dy], line, with_opacity(palette::PAPER, 0.8), name);
    }
    sheet.write([x, y], line, with_opacity(palette::INK, 1.0), name);
}

/// Adds a sheet where it lies in the image or nearly so.
fn stick(drawing: &mut Drawing, camera: &Camera, at: [f32; 2], sheet: Sheet) {
    let near = |k: usize| (-1e4..f32::from(u16::MAX)).contains(&at[k]);
    let room = camera.size[0] >= 160 && camera.size[1] >= 120;
    if room && near(0) && near(1) {
        drawing.stickers.push(Sticker { at: at.map(|x| x.round() as i32), sheet });
    }
}
