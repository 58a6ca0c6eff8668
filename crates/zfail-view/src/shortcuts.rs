//! The keys.

use crate::action::{Action, Place};
use egui::{Event, Key, KeyboardShortcut, Modifiers};
use zfail_figures::Overlay;

/// A key, what it does, and what the list of keys says about it.
pub struct Shortcut {
    pub keys: KeyboardShortcut,
    pub action: Action,
    pub says: &'static str,
}

const fn key(modifiers: Modifiers, key: Key, action: Action, says: &'static str) -> Shortcut {
    Shortcut { keys: KeyboardShortcut::new(modifiers, key), action, says }
}

/// All shortcuts; those with more modifiers come first, because egui lets Shift pass where it is not asked for.
pub const ALL: &[Shortcut] = &[
    key(Modifiers::CTRL, Key::Q, Action::Quit, "quit"),
    key(Modifiers::CTRL, Key::S, Action::SaveView, "save picture and view, and the command line that makes it again"),
    key(Modifiers::ALT, Key::Num1, Action::Overlay(Overlay::ALL[0]), "overlays: volumes; 2 to 0 the others"),
    key(Modifiers::ALT, Key::Num2, Action::Overlay(Overlay::ALL[1]), ""),
    key(Modifiers::ALT, Key::Num3, Action::Overlay(Overlay::ALL[2]), ""),
    key(Modifiers::ALT, Key::Num4, Action::Overlay(Overlay::ALL[3]), ""),
    key(Modifiers::ALT, Key::Num5, Action::Overlay(Overlay::ALL[4]), ""),
    key(Modifiers::ALT, Key::Num6, Action::Overlay(Overlay::ALL[5]), ""),
    key(Modifiers::ALT, Key::Num7, Action::Overlay(Overlay::ALL[6]), ""),
    key(Modifiers::ALT, Key::Num8, Action::Overlay(Overlay::ALL[7]), ""),
    key(Modifiers::ALT, Key::Num9, Action::Overlay(Overlay::ALL[8]), ""),
    key(Modifiers::ALT, Key::Num0, Action::Overlay(Overlay::ALL[9]), ""),
    key(Modifiers::NONE, Key::F12, Action::Screenshot, "save the picture"),
    key(Modifiers::NONE, Key::F1, Action::Help, "this list"),
    key(Modifiers::NONE, Key::H, Action::Panels, "hide or show the panels"),
    key(Modifiers::NONE, Key::F, Action::Frame, "see the whole scene"),
    key(Modifiers::NONE, Key::C, Action::SwitchMode, "orbit or fly"),
    key(Modifiers::NONE, Key::Num1, Action::Camera(0), "the file's first camera; 2 to 9: the others"),
    key(Modifiers::NONE, Key::Num2, Action::Camera(1), ""),
    key(Modifiers::NONE, Key::Num3, Action::Camera(2), ""),
    key(Modifiers::NONE, Key::Num4, Action::Camera(3), ""),
    key(Modifiers::NONE, Key::Num5, Action::Camera(4), ""),
    key(Modifiers::NONE, Key::Num6, Action::Camera(5), ""),
    key(Modifiers::NONE, Key::Num7, Action::Camera(6), ""),
    key(Modifiers::NONE, Key::Num8, Action::Camera(7), ""),
    key(Modifiers::NONE, Key::Num9, Action::Camera(8), ""),
    key(Modifiers::NONE, Key::Space, Action::Play, "play or pause the animation"),
    key(Modifiers::NONE, Key::X, Action::Shadows, "shadows on or off"),
    key(Modifiers::NONE, Key::M, Action::Samples, "1 or 4 samples per pixel"),
    key(Modifiers::NONE, Key::T, Action::Technique, "next technique"),
    key(Modifiers::NONE, Key::Plus, Action::Expose(0.5), "brighter by half a stop"),
    key(Modifiers::NONE, Key::Equals, Action::Expose(0.5), ""),
    key(Modifiers::NONE, Key::Minus, Action::Expose(-0.5), "darker by half a stop"),
    key(Modifiers::NONE, Key::Num0, Action::AutoExposure, "automatic exposure"),
    key(Modifiers::SHIFT, Key::L, Action::AddLight(Place::Above), "add a light above the scene"),
    key(Modifiers::NONE, Key::L, Action::AddLight(Place::Eye), "add a light at the eye"),
    key(Modifiers::NONE, Key::N, Action::NextLight, "select the next light"),
    key(Modifiers::NONE, Key::Delete, Action::RemoveLight, "remove the selected light"),
];

/// What else the list of keys says.
pub const MOUSE: &[(&str, &str)] = &[
    ("Drag", "orbit, or look around in flight; on a handle: move the light"),
    ("Right drag", "move sideways"),
    ("Wheel", "nearer or farther"),
    ("W A S D, Q E", "walk, down and up; with Shift faster"),
    ("Drop a file", "open it"),
];

/// What was pressed, unless a text field wants the keys.
pub fn pressed(context: &egui::Context) -> Vec<Action> {
    if context.egui_wants_keyboard_input() {
        return Vec::new();
    }
    context.input_mut(|input| {
        // A key that is held asks once.
        input.events.retain(|event| !matches!(event, Event::Key { repeat: true, .. }));
        ALL.iter().filter(|s| input.consume_shortcut(&s.keys)).map(|s| s.action.clone()).collect()
    })
}

#[cfg(test)]
mod tests {
    use super::ALL;

    #[test]
    fn no_key_means_two_things() {
        for (i, a) in ALL.iter().enumerate() {
            assert!(ALL[..i].iter().all(|b| a.keys != b.keys), "{:?}", a.keys);
        }
    }
}
