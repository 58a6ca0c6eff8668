//! Camera, animation, and how the picture is made.

use crate::action::Action;
use crate::camera::Mode;
use crate::session::Session;
use crate::stage::Stage;
use egui::{ComboBox, DragValue, Slider, Ui};
use zfail_figures::Overlay;
use zfail_plan::view::Projection;
use zfail_render::{Exposure, Technique, Terminator};

/// Cameras of the file, and what dragging does.
pub fn camera(ui: &mut Ui, session: &mut Session, actions: &mut Vec<Action>) {
    ui.horizontal(|ui| {
        let cameras = &session.scene.cameras;
        let shown = session.rig.preset.and_then(|i| cameras.get(i)).map_or("free", |camera| &camera.name);
        ComboBox::from_id_salt("camera").width(120.0).selected_text(shown).truncate().show_ui(ui, |ui| {
            for (i, camera) in cameras.iter().enumerate() {
                if ui.selectable_label(session.rig.preset == Some(i), format!("{}  {}", i + 1, camera.name)).clicked() {
                    actions.push(Action::Camera(i));
                }
            }
        });
        for (mode, name) in [(Mode::Orbit, "Orbit"), (Mode::Fly, "Fly")] {
            ui.selectable_value(&mut session.rig.mode, mode, name).on_hover_text("C");
        }
        if ui.button("Frame").on_hover_text("F: see the whole scene").clicked() {
            actions.push(Action::Frame);
        }
    });
    let changed = match &mut session.rig.camera.projection {
        Projection::Perspective { yfov, .. } => {
            let mut degrees = yfov.to_degrees();
            let slider = ui.add(Slider::new(&mut degrees, 5.0..=150.0).suffix("°").text("field of view"));
            if slider.changed() {
                *yfov = degrees.to_radians();
            }
            slider.changed()
        }
        Projection::Orthographic { ymag, .. } => {
            let range = 1e-9..=1e9;
            ui.horizontal(|ui| {
                ui.label("half height");
                ui.add(DragValue::new(ymag).range(range).speed(0.01)).changed()
            })
            .inner
        }
    };
    if changed {
        session.rig.preset = None;
        session.touch();
    }
}

/// Playing.
pub fn animation(ui: &mut Ui, session: &mut Session, actions: &mut Vec<Action>) {
    let names: Vec<(String, f64)> = session.animations().map(|(name, length)| (name.to_owned(), length)).collect();
    let mut moved = false;
    if names.len() > 1 {
        let shown = names.get(session.playback.animation).map_or("", |(name, _)| name);
        ComboBox::from_id_salt("animation").width(200.0).selected_text(shown).truncate().show_ui(ui, |ui| {
            for (i, (name, _)) in names.iter().enumerate() {
                moved |= ui.selectable_value(&mut session.playback.animation, i, name).changed();
            }
        });
        if moved {
            session.playback.seconds = Some(0.0);
        }
    }
    let duration = names.get(session.playback.animation).map_or(0.0, |(_, duration)| *duration);
    ui.horizontal(|ui| {
        let name = if session.playback.playing { "Pause" } else { "Play" };
        if ui.button(name).on_hover_text("Space").clicked() {
            actions.push(Action::Play);
        }
        let mut seconds = session.playback.seconds.unwrap_or(0.0);
        let slider = Slider::new(&mut seconds, 0.0..=duration)
            .suffix(" s")
            .fixed_decimals(2)
            .clamping(egui::SliderClamping::Never);
        if ui.add(slider).changed() {
            session.playback.seconds = Some(seconds.max(0.0));
            moved = true;
        }
    });
    ui.horizontal(|ui| {
        ui.label("Speed");
        ui.add(DragValue::new(&mut session.playback.speed).range(0.0..=16.0).speed(0.02).suffix("x"));
        let posed = session.playback.seconds.is_some();
        if ui
            .add_enabled(posed, egui::Button::new("At rest"))
            .on_hover_text("As the file has it, without animation")
            .clicked()
        {
            session.playback.seconds = None;
            session.playback.playing = false;
            moved = true;
        }
    });
    if moved {
        session.posed();
    }
}

/// Sky and ground.
pub fn surroundings(ui: &mut Ui, session: &mut Session) {
    let (mut sky, mut ground) = (session.scene.sky.is_some(), session.scene.ground.is_some());
    ui.horizontal(|ui| {
        if ui.checkbox(&mut sky, "Sky").on_hover_text("Light and reflections from all sides").changed() {
            session.set_sky(sky);
        }
        if ui.checkbox(&mut ground, "Ground").on_hover_text("Catches shadows and is otherwise not there").changed() {
            session.set_ground(ground);
        }
        if let Some(mut height) = session.scene.ground.map(|ground| ground.height) {
            let speed = 0.005 * crate::camera::radius(session.bounds());
            if ui.add(DragValue::new(&mut height).speed(speed).max_decimals(4).suffix(" m")).changed() {
                session.move_ground(height);
            }
        }
    });
}

/// Settings of the renderer.
pub fn picture(ui: &mut Ui, stage: &mut Stage<'_>, actions: &mut Vec<Action>) {
    let before = stage.session.look.settings.clone();
    let settings = &mut stage.session.look.settings;
    ui.horizontal(|ui| {
        ui.checkbox(&mut settings.shadows, "Shadows").on_hover_text("X");
        ComboBox::from_id_salt("technique").width(110.0).selected_text(settings.technique.name()).show_ui(ui, |ui| {
            for technique in Technique::ALL {
                ui.selectable_value(&mut settings.technique, technique, technique.name());
            }
        });
        ui.label("technique").on_hover_text("T");
    });
    ui.horizontal(|ui| {
        ui.selectable_value(&mut settings.samples, 1, "1 sample").on_hover_text("M");
        ui.selectable_value(&mut settings.samples, 4, "4 samples").on_hover_text("M");
        ui.separator();
        ui.selectable_value(&mut settings.terminator, Terminator::Soft, "soft")
            .on_hover_text("Terminator: hides the facets of coarse meshes");
        ui.selectable_value(&mut settings.terminator, Terminator::Exact, "exact")
            .on_hover_text("Terminator: as the normals say");
    });
    ui.horizontal(|ui| {
        let mut auto = settings.exposure == Exposure::Auto;
        if ui.checkbox(&mut auto, "Auto exposure").on_hover_text("0").changed() {
            actions.push(if auto { Action::AutoExposure } else { Action::Expose(0.0) });
        }
        if let Exposure::Ev(stops) = &mut settings.exposure {
            ui.add(DragValue::new(stops).range(-24.0..=24.0).speed(0.02).fixed_decimals(2).suffix(" EV"));
        }
    });
    ui.checkbox(&mut stage.pace.enabled, "Smaller pictures while moving").on_hover_text(
        "Where a picture takes more than 50 ms, it is drawn at a lower resolution until it stands still",
    );
    if *settings != before {
        stage.session.touch();
    }
}

/// What is drawn over the picture.
pub fn overlays(ui: &mut Ui, session: &mut Session) {
    egui::Grid::new("overlays").num_columns(2).spacing([16.0, 3.0]).show(ui, |ui| {
        for (i, overlay) in Overlay::ALL.into_iter().enumerate() {
            let mut shown = session.look.overlays.contains(&overlay);
            let key = (i + 1) % 10;
            if ui
                .checkbox(&mut shown, overlay.name())
                .on_hover_text(format!("{} (Alt+{key})", overlay.description()))
                .changed()
            {
                session.look.toggle(overlay);
                session.touch();
            }
            if i % 2 == 1 {
                ui.end_row();
            }
        }
    });
}
