//! What ends the viewer.

use zfail_render::RenderError;

/// Why there is no window, or no longer one.
#[derive(Debug, thiserror::Error)]
pub enum ViewError {
    /// There is nothing to show a window on.
    #[error("cannot open a window: {0}; 'zfail render' needs none")]
    NoDisplay(String),
    /// No adapter can draw into the window.
    #[error("cannot draw into a window")]
    Device(#[from] RenderError),
    /// The window's surface fails.
    #[error("the window cannot be drawn: {0}")]
    Surface(String),
    /// The driver has given up.
    #[error("the graphics device was lost: {0}")]
    Lost(String),
}
