//! The interactive viewer of zfail: a window onto a scene, its shadows and its shadow volumes.
//!
//! In: a scene's name, and a [`Host`] that can load scenes. Out: a window, and files that the user saves.
//!
//! Data flow: `window` (events) -> `viewer` (panels, `picture`, shortcuts, actions) -> `session` (the scene and all that can be
//! changed about it; no window, no device) -> `stage` (renderer) -> `canvas` (surface).

mod action;
mod camera;
mod canvas;
mod command_line;
mod error;
mod gizmo;
mod message;
mod pace;
mod panel;
mod picture;
mod playback;
mod present;
mod recent;
mod screenshot;
mod session;
mod shortcuts;
mod stage;
mod viewer;
mod window;

pub use error::ViewError;
pub use message::Message;
pub use window::run;

use std::error::Error;
use std::fmt;
use std::path::PathBuf;
use std::sync::Arc;
use zfail_render::{GpuOptions, Settings};
use zfail_scene::Animated;

/// What to begin with.
#[derive(Clone, Debug)]
pub struct Options {
    /// A file or `builtin:NAME`; without it the window asks for one.
    pub scene: Option<String>,
    /// Of the window's inside, physical pixels.
    pub size: [u32; 2],
    /// How scenes are shown at first.
    pub settings: Settings,
    /// Whether panels are shown at first.
    pub panels: bool,
    /// Where screenshots and views are saved.
    pub folder: PathBuf,
    /// What a command line needs besides to load scenes as [`Host::load`] does.
    pub flags: Vec<String>,
    /// Which device draws.
    pub gpu: GpuOptions,
}

/// Loads a scene, named as in [`Options::scene`]; it has a camera. Errors are one line.
pub type Load = Arc<dyn Fn(&str) -> Result<Animated, String> + Send + Sync>;

/// Makes a PNG file of RGBA pixels, rows from top to bottom; width and height come first. Errors are one line.
pub type Encode = fn([u32; 2], &[u8]) -> Result<Vec<u8>, String>;

/// What the viewer leaves to the program around it.
#[derive(Clone)]
pub struct Host {
    /// Loads scenes, on a thread of its own.
    pub load: Load,
    /// Makes a picture's file.
    pub encode: Encode,
    /// An error with its causes, as one line.
    pub explain: fn(&dyn Error) -> String,
    /// Says on the terminal what the window says.
    pub say: fn(&Message),
}

impl fmt::Debug for Host {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Host").finish_non_exhaustive()
    }
}
