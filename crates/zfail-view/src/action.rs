//! Everything that can be asked for by a key or a button.

use zfail_figures::Overlay;

/// A wish of the user.
#[derive(Clone, Debug, PartialEq)]
pub enum Action {
    /// Leave.
    Quit,
    /// Show this file or built-in scene.
    Open(String),
    /// Save the picture.
    Screenshot,
    /// Save the picture and the view, and say the command line that makes the picture again.
    SaveView,
    /// Show or hide the panels.
    Panels,
    /// Show or hide the list of keys.
    Help,
    /// See the whole scene.
    Frame,
    /// See as this camera of the scene does.
    Camera(usize),
    /// Orbit or fly.
    SwitchMode,
    /// Play or pause.
    Play,
    /// All shadows on or off.
    Shadows,
    /// One sample or four.
    Samples,
    /// The next technique.
    Technique,
    /// Brighter by so many stops.
    Expose(f32),
    /// Exposure from the picture.
    AutoExposure,
    /// An overlay on or off.
    Overlay(Overlay),
    /// A new light.
    AddLight(Place),
    /// Without the selected light.
    RemoveLight,
    /// Select the next light.
    NextLight,
}

/// Where a new light goes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// At the eye.
    Eye,
    /// Above the middle of the scene.
    Above,
}
