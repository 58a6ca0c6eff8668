//! Lights: a list, and everything about the selected one.

use super::Desk;
use crate::action::{Action, Place};
use crate::session::Session;
use egui::{DragValue, Slider, Ui};
use zfail_plan::glam::DVec3;
use zfail_plan::light::LightKind;
use zfail_scene::Sun;

/// All lights.
pub fn lights(ui: &mut Ui, desk: &mut Desk, session: &mut Session, actions: &mut Vec<Action>) {
    ui.horizontal(|ui| {
        ui.menu_button("Add", |ui| {
            for (name, place) in [("At the eye (L)", Place::Eye), ("Above the scene (Shift+L)", Place::Above)] {
                if ui.button(name).clicked() {
                    actions.push(Action::AddLight(place));
                    ui.close();
                }
            }
        });
        if ui.add_enabled(session.selected.is_some(), egui::Button::new("Remove")).on_hover_text("Delete").clicked() {
            actions.push(Action::RemoveLight);
        }
        ui.checkbox(&mut desk.handles, "Handles").on_hover_text("Places and directions to be dragged in the picture");
    });
    egui::ScrollArea::vertical().id_salt("lights").max_height(130.0).show(ui, |ui| {
        for i in 0..session.scene.lights.len() {
            row(ui, session, i);
        }
    });
    if let Some(light) = session.selected.filter(|&light| light < session.scene.lights.len()) {
        ui.separator();
        details(ui, session, light);
    }
}

/// A line of the list.
fn row(ui: &mut Ui, session: &mut Session, i: usize) {
    ui.horizontal(|ui| {
        let light = &mut session.scene.lights[i];
        let recolored = ui.color_edit_button_rgb(&mut light.color).changed();
        let kind = match light.kind {
            LightKind::Point { .. } => "point",
            LightKind::Spot { .. } => "spot",
            LightKind::Directional { .. } => "directional",
        };
        let name = if light.name.is_empty() { format!("light {i}") } else { light.name.clone() };
        if recolored {
            session.relit();
        }
        let mut casts = session.light_casts(i);
        if ui.checkbox(&mut casts, "").on_hover_text("Casts shadows").changed() {
            session.set_light_casts(i, casts);
        }
        let selected = session.selected == Some(i);
        if ui.selectable_label(selected, format!("{name}  ({kind})")).clicked() {
            session.selected = (!selected).then_some(i);
        }
    });
}

/// What can be set of a light.
fn details(ui: &mut Ui, session: &mut Session, i: usize) {
    let light = &mut session.scene.lights[i];
    let unit = if matches!(light.kind, LightKind::Directional { .. }) { " lx" } else { " cd" };
    let intensity = Slider::new(&mut light.intensity, 0.0..=1e6).logarithmic(true).smallest_positive(1e-3);
    let relit = ui.add(intensity.suffix(unit).clamping(egui::SliderClamping::Never)).changed();
    if relit {
        light.intensity = light.intensity.clamp(0.0, 1e30);
    }
    let mut kind = light.kind;
    if relit {
        session.relit();
    }
    let speed = 0.005 * crate::camera::radius(session.bounds());
    match &mut kind {
        LightKind::Point { position, .. } => vector(ui, "position", position, speed),
        LightKind::Spot { position, direction, inner, outer, .. } => {
            vector(ui, "position", position, speed);
            unit_vector(ui, direction);
            ui.horizontal(|ui| {
                angle(ui, inner, 0.0..=outer.to_degrees());
                angle(ui, outer, inner.to_degrees().max(0.1)..=90.0);
                ui.label("cone");
            });
        }
        LightKind::Directional { direction } => {
            unit_vector(ui, direction);
            sun(ui, direction);
        }
    }
    session.move_light(i, kind);
}

fn vector(ui: &mut Ui, name: &str, vector: &mut DVec3, speed: f64) {
    ui.horizontal(|ui| {
        for component in vector.as_mut() {
            ui.add(DragValue::new(component).speed(speed).max_decimals(3));
        }
        ui.label(name);
    });
}

fn unit_vector(ui: &mut Ui, direction: &mut DVec3) {
    let mut edited = *direction;
    vector(ui, "direction", &mut edited, 0.01);
    if edited != *direction {
        *direction = edited.try_normalize().unwrap_or(*direction);
    }
}

/// The direction as a place in the sky.
fn sun(ui: &mut Ui, direction: &mut DVec3) {
    let mut sun = Sun::shining(*direction);
    ui.horizontal(|ui| {
        let mut drag = |angle: &mut f64, range| {
            ui.add(DragValue::new(angle).range(range).speed(0.5).suffix("°").max_decimals(1)).changed()
        };
        let moved = [drag(&mut sun.azimuth, -360.0..=720.0), drag(&mut sun.elevation, -90.0..=90.0)];
        ui.label("azimuth, elevation").on_hover_text("Clockwise from north, which is -z, and above the horizon");
        if moved.contains(&true) {
            *direction = sun.direction();
        }
    });
}

fn angle(ui: &mut Ui, radians: &mut f64, range: std::ops::RangeInclusive<f64>) {
    let mut degrees = radians.to_degrees();
    let drag = DragValue::new(&mut degrees).range(range).speed(0.2).suffix("°").max_decimals(1);
    if ui.add(drag).changed() {
        *radians = degrees.to_radians();
    }
}
