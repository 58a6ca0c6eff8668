//! What is open, what else could be, and what casts shadows.

use super::Desk;
use crate::action::Action;
use crate::recent::{self, Recent};
use crate::session::Session;
use crate::stage::Stage;
use egui::{RichText, Ui};

/// Name of the scene, and the way to another one.
pub fn header(ui: &mut Ui, desk: &mut Desk, stage: &Stage<'_>, recent: &Recent, actions: &mut Vec<Action>) {
    ui.add_space(4.0);
    ui.horizontal(|ui| {
        ui.menu_button("Open", |ui| {
            ui.set_min_width(260.0);
            let typed = ui.add(egui::TextEdit::singleline(&mut desk.path).hint_text("path, or builtin:NAME"));
            if typed.lost_focus() && ui.input(|i| i.key_pressed(egui::Key::Enter)) && !desk.path.is_empty() {
                actions.push(Action::Open(desk.path.trim().to_owned()));
                ui.close();
            }
            egui::ScrollArea::vertical().max_height(420.0).show(ui, |ui| {
                if choices(ui, recent, actions) {
                    ui.close();
                }
            });
        });
        if ui.button("Keys").on_hover_text("F1").clicked() {
            actions.push(Action::Help);
        }
        let scene = &stage.session.scene;
        ui.add(egui::Label::new(RichText::new(&scene.name).strong()).truncate()).on_hover_text(&stage.session.source);
    });
}

/// Lists of scenes; returns whether one was chosen.
fn choices(ui: &mut Ui, recent: &Recent, actions: &mut Vec<Action>) -> bool {
    let before = actions.len();
    if !recent.paths().is_empty() {
        ui.weak("Recent files");
        for path in recent.paths() {
            if ui.button(recent::short(path)).on_hover_text(path).clicked() {
                actions.push(Action::Open(path.clone()));
            }
        }
    }
    ui.weak("Built-in scenes");
    for entry in zfail_builtin::SCENES {
        if ui.button(entry.name).on_hover_text(entry.description).clicked() {
            actions.push(Action::Open(format!("builtin:{}", entry.name)));
        }
    }
    actions.len() > before
}

/// What an empty window shows.
pub fn welcome(ui: &mut Ui, recent: &Recent, loading: Option<&str>, actions: &mut Vec<Action>) {
    ui.painter().rect_filled(ui.max_rect(), 0.0, ui.visuals().panel_fill);
    egui::ScrollArea::vertical().auto_shrink([false, false]).show(ui, |ui| {
        ui.vertical_centered(|ui| {
            ui.add_space(24.0);
            if let Some(source) = loading {
                ui.heading(format!("Loading {source}"));
                ui.spinner();
                return;
            }
            ui.heading("Drop a .glb, .gltf, .obj, .stl or .ply file here");
            ui.add_space(12.0);
            if !recent.paths().is_empty() {
                ui.strong("Recent files");
                for path in recent.paths() {
                    if ui.link(recent::short(path)).on_hover_text(path).clicked() {
                        actions.push(Action::Open(path.clone()));
                    }
                }
                ui.add_space(12.0);
            }
            ui.strong("Built-in scenes");
        });
        if loading.is_some() {
            return;
        }
        let width = ui.available_width();
        ui.horizontal(|ui| {
            ui.add_space((0.5 * (width - 620.0)).max(8.0));
            egui::Grid::new("built-in scenes").num_columns(2).spacing([14.0, 5.0]).show(ui, |ui| {
                for entry in zfail_builtin::SCENES {
                    if ui.link(entry.name).clicked() {
                        actions.push(Action::Open(format!("builtin:{}", entry.name)));
                    }
                    ui.label(entry.description);
                    ui.end_row();
                }
            });
        });
        ui.add_space(12.0);
    });
}

/// Which instances cast shadows.
pub fn casters(ui: &mut Ui, filter: &mut String, session: &mut Session) {
    let count = session.scene.instances.len();
    ui.horizontal(|ui| {
        ui.add(egui::TextEdit::singleline(filter).hint_text("find").desired_width(120.0));
        for (name, casts) in [("All", true), ("None", false)] {
            if ui.small_button(name).clicked() {
                (0..count).for_each(|i| session.set_casting(i, casts));
            }
        }
    });
    let wanted = filter.to_lowercase();
    let names = |i: &usize| session.scene.instances[*i].name.to_lowercase().contains(&wanted);
    let shown: Vec<usize> = (0..count).filter(names).collect();
    let height = ui.spacing().interact_size.y;
    egui::ScrollArea::vertical().id_salt("casters").max_height(180.0).show_rows(ui, height, shown.len(), |ui, rows| {
        for &i in &shown[rows] {
            let instance = &session.scene.instances[i];
            let mut casts = instance.casts_shadow;
            let name = if instance.name.is_empty() { format!("instance {i}") } else { instance.name.clone() };
            if ui.checkbox(&mut casts, name).changed() {
                session.set_casting(i, casts);
            }
        }
    });
}
