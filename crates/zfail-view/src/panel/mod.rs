//! The panels: everything about a scene that can be read or set, beside the picture.

mod figures;
mod lights;
mod look;
mod scene;

pub use scene::welcome;

use crate::action::Action;
use crate::message::Message;
use crate::recent::Recent;
use crate::shortcuts;
use crate::stage::Stage;
use egui::{Color32, RichText, Ui};

/// What the panels themselves remember.
#[derive(Debug)]
pub struct Desk {
    /// Whether panels are shown.
    pub visible: bool,
    /// Whether the list of keys is shown.
    pub help: bool,
    /// Whether lights have handles in the picture.
    pub handles: bool,
    /// The path that is being typed.
    path: String,
    /// Pictures are saved at this size instead of that in the window.
    fixed_size: bool,
    /// Pixels.
    size: [u32; 2],
    /// Shows casters with these letters in their names.
    filter: String,
}

impl Desk {
    /// Panels that nobody has used yet.
    pub fn new(visible: bool) -> Self {
        Self {
            visible,
            help: false,
            handles: true,
            path: String::new(),
            fixed_size: false,
            size: [1920, 1080],
            filter: String::new(),
        }
    }

    /// The size of pictures that are saved, where the window shows them at `shown`.
    pub fn still_size(&self, shown: [u32; 2]) -> [u32; 2] {
        if self.fixed_size { self.size } else { shown }
    }
}

/// Colours and spacing of all panels.
pub fn style(context: &egui::Context) {
    context.set_theme(egui::Theme::Dark);
    context.all_styles_mut(|style| {
        style.spacing.slider_width = 120.0;
        style.spacing.item_spacing.y = 4.0;
        style.spacing.scroll = egui::style::ScrollStyle { bar_width: 6.0, ..egui::style::ScrollStyle::solid() };
        style.visuals.panel_fill = Color32::from_gray(30);
        style.visuals.widgets.noninteractive.fg_stroke.color = Color32::from_gray(195);
    });
}

/// Lays out all panels, which leaves the middle of `ui`.
#[expect(clippy::too_many_arguments, reason = "the parts of the viewer that panels show")]
pub fn show(
    ui: &mut Ui,
    desk: &mut Desk,
    stage: Option<&mut Stage<'_>>,
    recent: &Recent,
    messages: &mut Vec<Message>,
    loading: Option<&str>,
    gpu: &wgpu::AdapterInfo,
    actions: &mut Vec<Action>,
) {
    if desk.help {
        help(ui.ctx(), &mut desk.help);
    }
    say(ui.ctx(), desk.visible, messages, loading);
    let Some(stage) = stage.filter(|_| desk.visible) else { return };
    egui::Panel::right("panel").default_size(320.0).size_range(270.0..=520.0).show(ui, |ui| {
        scene::header(ui, desk, stage, recent, actions);
        ui.separator();
        egui::ScrollArea::vertical().auto_shrink([false, false]).show(ui, |ui| {
            section(ui, "Camera", true, |ui| look::camera(ui, &mut stage.session, actions));
            if stage.session.animations().next().is_some() {
                section(ui, "Animation", true, |ui| look::animation(ui, &mut stage.session, actions));
            }
            section(ui, "Lights", true, |ui| lights::lights(ui, desk, &mut stage.session, actions));
            section(ui, "Surroundings", true, |ui| look::surroundings(ui, &mut stage.session));
            section(ui, "Picture", true, |ui| look::picture(ui, stage, actions));
            section(ui, "Overlays", false, |ui| look::overlays(ui, &mut stage.session));
            section(ui, "Casters", false, |ui| scene::casters(ui, &mut desk.filter, &mut stage.session));
            section(ui, "Save", false, |ui| save(ui, desk, actions));
            section(ui, "Figures", true, |ui| figures::figures(ui, stage, gpu));
        });
    });
}

fn section(ui: &mut Ui, title: &str, open: bool, content: impl FnOnce(&mut Ui)) {
    egui::CollapsingHeader::new(RichText::new(title).strong()).default_open(open).show(ui, content);
}

fn save(ui: &mut Ui, desk: &mut Desk, actions: &mut Vec<Action>) {
    ui.horizontal(|ui| {
        if ui.button("Picture (F12)").clicked() {
            actions.push(Action::Screenshot);
        }
        if ui.button("Picture and view (Ctrl+S)").clicked() {
            actions.push(Action::SaveView);
        }
    });
    ui.horizontal(|ui| {
        ui.checkbox(&mut desk.fixed_size, "Size");
        ui.add_enabled_ui(desk.fixed_size, |ui| {
            ui.add(egui::DragValue::new(&mut desk.size[0]).range(1..=16384));
            ui.label("x");
            ui.add(egui::DragValue::new(&mut desk.size[1]).range(1..=16384));
        });
    });
}

/// The latest messages over the picture, each of which can be sent away; errors only where panels are not wanted.
fn say(context: &egui::Context, all: bool, messages: &mut Vec<Message>, loading: Option<&str>) {
    /// So many are shown.
    const LATEST: usize = 4;
    let shown = |message: &Message| all || matches!(message, Message::Error(_));
    let latest: Vec<usize> = (0..messages.len()).filter(|&i| shown(&messages[i])).rev().take(LATEST).collect();
    if latest.is_empty() && loading.is_none() {
        return;
    }
    let area = egui::Area::new(egui::Id::unique("messages")).anchor(egui::Align2::LEFT_BOTTOM, [8.0, -8.0]);
    area.show(context, |ui| {
        egui::Frame::popup(ui.style()).multiply_with_opacity(0.92).show(ui, |ui| {
            ui.set_max_width((context.content_rect().width() - 360.0).max(240.0));
            if let Some(source) = loading {
                ui.horizontal(|ui| {
                    ui.spinner();
                    ui.label(format!("loading {source}"));
                });
            }
            let mut read = None;
            for &i in latest.iter().rev() {
                ui.horizontal(|ui| {
                    if ui.small_button("x").on_hover_text("Dismiss").clicked() {
                        read = Some(i);
                    }
                    words(ui, &messages[i]);
                });
            }
            if let Some(i) = read {
                messages.remove(i);
            }
        });
    });
}

fn words(ui: &mut Ui, message: &Message) {
    let text = RichText::new(message.text());
    let text = match message {
        Message::Error(_) => text.color(Color32::from_rgb(255, 120, 105)),
        Message::Note(_) => text.color(Color32::from_rgb(235, 200, 110)),
        Message::Done(_) => text,
        Message::Command(line) => {
            if ui.small_button("Copy").clicked() {
                ui.ctx().copy_text(line.clone());
            }
            text.monospace()
        }
    };
    ui.add(egui::Label::new(text).wrap());
}

/// The list of keys.
fn help(context: &egui::Context, open: &mut bool) {
    egui::Window::new("Keys").open(open).resizable(false).collapsible(false).show(context, |ui| {
        egui::Grid::new("keys").num_columns(2).spacing([16.0, 3.0]).show(ui, |ui| {
            for (what, says) in shortcuts::MOUSE {
                ui.strong(*what);
                ui.label(*says);
                ui.end_row();
            }
            for shortcut in shortcuts::ALL.iter().filter(|shortcut| !shortcut.says.is_empty()) {
                ui.strong(ui.ctx().format_shortcut(&shortcut.keys));
                ui.label(shortcut.says);
                ui.end_row();
            }
        });
    });
}
