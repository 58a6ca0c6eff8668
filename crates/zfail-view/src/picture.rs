//! The middle of the window: the picture, the handles of the lights over it, and what mouse and keys do there.

use crate::gizmo::{self, Grip, Handle};
use crate::session::Session;
use egui::{Color32, CursorIcon, Key, Painter, PointerButton, Pos2, Rect, Response, Sense, Stroke, Ui, Vec2};
use zfail_plan::glam::{DVec2, DVec3};
use zfail_plan::view::View;

/// How near to a handle the pointer takes hold of it, points.
const REACH: f32 = 11.0;

/// What the pointer holds between frames.
#[derive(Debug, Default)]
pub struct Hand {
    /// A light's handle, and where the pointer is relative to it.
    holds: Option<(usize, Grip, Vec2)>,
}

/// Where the picture is, and whether the user is moving something in it.
#[derive(Clone, Copy, Debug)]
pub struct Outcome {
    /// In points.
    pub area: Rect,
    /// Camera or light are on the move.
    pub moving: bool,
}

/// Takes what is left of `ui` for the picture; `seconds` have passed since the last frame.
pub fn picture(ui: &mut Ui, session: &mut Session, hand: &mut Hand, handles: bool, seconds: f64) -> Outcome {
    let response = ui.allocate_response(ui.available_size(), Sense::click_and_drag());
    let area = response.rect;
    session.fit(f64::from(area.aspect_ratio()).clamp(0.01, 100.0));
    // Points are precise enough for what a hand does.
    let view = session.view([area.width(), area.height()].map(|side| (side as u32).max(1)));
    // Pictures from elsewhere have lights elsewhere.
    let handles = handles && !session.look.overlays.iter().any(|overlay| overlay.replaces_picture());
    let found = if handles { gizmo::handles(&session.scene.lights, session.bounds(), &view) } else { Vec::new() };
    let near = |pointer: Pos2| {
        let distance = |handle: &Handle| place(area, handle.at).distance(pointer);
        found.iter().filter(|h| distance(h) < REACH).min_by(|a, b| distance(a).total_cmp(&distance(b)))
    };
    if response.drag_started_by(PointerButton::Primary) {
        let grip = |pointer: Pos2| near(pointer).map(|h| (h.light, h.grip, pointer - place(area, h.at)));
        hand.holds = ui.input(|input| input.pointer.press_origin()).and_then(grip);
        if let Some((light, ..)) = hand.holds {
            session.selected = Some(light);
        }
    }
    if response.clicked()
        && let Some(handle) = response.interact_pointer_pos().and_then(near)
    {
        session.selected = Some(handle.light);
    }
    let hovered = response.hover_pos().filter(|_| !response.dragged()).and_then(near);
    if hovered.is_some() {
        ui.ctx().set_cursor_icon(CursorIcon::Grab);
    }
    draw_handles(ui.painter(), area, session, &found, hovered);
    let dragged = drag(&response, &view, session, hand);
    if response.drag_stopped() {
        hand.holds = None;
    }
    let walked = walk(ui, session, seconds);
    let wheel = scroll(ui, &response, session);
    let moving = dragged || walked || wheel;
    if moving {
        session.touch();
    }
    Outcome { area, moving }
}

/// Follows the pointer; returns whether it moved anything.
fn drag(response: &Response, view: &View, session: &mut Session, hand: &Hand) -> bool {
    let delta = response.drag_delta();
    if delta == Vec2::ZERO {
        return false;
    }
    let area = response.rect;
    let share = [delta.x, delta.y].map(|d| f64::from(d / area.height().max(1.0)));
    match (hand.holds, response.interact_pointer_pos()) {
        (Some((light, grip, offset)), Some(pointer)) => {
            let Some(kind) = session.scene.lights.get(light).map(|light| light.kind) else { return false };
            let at = pointer - offset - area.min;
            let to = DVec2::new(at.x.into(), at.y.into());
            session.move_light(light, gizmo::dragged(&kind, grip, session.bounds(), view, to));
        }
        _ if response.dragged_by(PointerButton::Primary) => session.rig.turn(share),
        _ => session.rig.pan(share),
    }
    true
}

/// W, A, S, D, Q and E; returns whether one is held.
fn walk(ui: &Ui, session: &mut Session, seconds: f64) -> bool {
    if ui.ctx().egui_wants_keyboard_input() {
        return false;
    }
    let (way, fast) = ui.input(|input| {
        let axis = |plus, minus| f64::from(input.key_down(plus)) - f64::from(input.key_down(minus));
        let way = DVec3::new(axis(Key::D, Key::A), axis(Key::E, Key::Q), axis(Key::S, Key::W));
        (if input.modifiers.command { DVec3::ZERO } else { way }, input.modifiers.shift)
    });
    if way == DVec3::ZERO {
        return false;
    }
    // After a pause, the time before it does not count.
    session.rig.walk(way, seconds.min(0.1), fast);
    ui.ctx().request_repaint();
    true
}

/// The wheel; returns whether it turned.
fn scroll(ui: &Ui, response: &Response, session: &mut Session) -> bool {
    /// Points of scrolling per notch.
    const NOTCH: f32 = 50.0;
    let (scrolled, zoomed) = ui.input(|input| (input.smooth_scroll_delta.y, input.zoom_delta()));
    let notches = f64::from(scrolled / NOTCH) + f64::from(zoomed.max(1e-3).ln()) * 4.0;
    let turned = response.hovered() && notches != 0.0;
    if turned {
        session.rig.dolly(notches);
    }
    turned
}

fn draw_handles(painter: &Painter, area: Rect, session: &Session, handles: &[Handle], hovered: Option<&Handle>) {
    let painter = painter.with_clip_rect(area);
    for handle in handles {
        let Some(light) = session.scene.lights.get(handle.light) else { continue };
        let at = place(area, handle.at);
        let peak = light.color.into_iter().fold(1e-6, f32::max);
        let color =
            Color32::from(egui::Rgba::from_rgb(light.color[0] / peak, light.color[1] / peak, light.color[2] / peak));
        let selected = session.selected == Some(handle.light);
        let width = if selected { 2.5 } else { 1.5 };
        if let Some(stem) = handle.stem {
            painter.line_segment([place(area, stem), at], Stroke::new(width + 1.5, Color32::from_black_alpha(140)));
            painter.line_segment([place(area, stem), at], Stroke::new(width, color));
        }
        let radius = if hovered == Some(handle) { 8.5 } else { 6.5 };
        painter.circle(
            at,
            radius,
            Color32::from_black_alpha(150),
            Stroke::new(width + 1.0, Color32::from_black_alpha(160)),
        );
        match handle.grip {
            Grip::Position => painter.circle(at, radius - 1.5, color, Stroke::new(width, Color32::WHITE)),
            Grip::Direction => painter.circle_stroke(at, radius - 1.5, Stroke::new(width, color)),
        };
        if selected || hovered == Some(handle) {
            let text = if light.name.is_empty() { format!("light {}", handle.light) } else { light.name.clone() };
            let galley = painter.layout_no_wrap(text, egui::FontId::proportional(13.0), Color32::WHITE);
            let corner = at + Vec2::new(12.0, -0.5 * galley.size().y);
            let plate = Rect::from_min_size(corner, galley.size()).expand2(Vec2::new(4.0, 1.0));
            painter.rect_filled(plate, 3.0, Color32::from_black_alpha(150));
            painter.galley(corner, galley, Color32::WHITE);
        }
    }
}

fn place(area: Rect, at: DVec2) -> Pos2 {
    area.min + Vec2::new(at.x as f32, at.y as f32)
}
