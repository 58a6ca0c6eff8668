//! A session on the device.
//!
//! In: a [`Session`]. Out: its picture as a texture at the pace that the device can keep, or at any size as pixels, which
//! are those of `zfail render`.

use crate::pace::Pace;
use crate::session::Session;
use std::time::{Duration, Instant};
use zfail_render::{FrameStats, Gpu, RenderError, Renderer};

/// A session with its renderer.
#[derive(Debug)]
pub struct Stage<'g> {
    /// What is shown.
    pub session: Session,
    renderer: Renderer<'g>,
    /// Of the last picture.
    pub last: Option<Drawn>,
    /// How large the next one may be.
    pub pace: Pace,
}

/// A picture that was drawn.
#[derive(Clone, Debug)]
pub struct Drawn {
    /// Pixels.
    pub size: [u32; 2],
    /// From planning to the last pixel.
    pub time: Duration,
    /// What it was made of.
    pub stats: FrameStats,
}

impl<'g> Stage<'g> {
    /// Uploads the session's scene.
    ///
    /// # Errors
    /// If the scene is inconsistent or the device runs out of memory.
    pub fn new(gpu: &'g Gpu, session: Session) -> Result<Self, RenderError> {
        let renderer = Renderer::new(gpu, &session.scene)?;
        Ok(Self { session, renderer, last: None, pace: Pace::default() })
    }

    /// Draws the picture that is to be shown at `full` pixels, if it is not the one that is there.
    ///
    /// # Errors
    /// If the settings do not fit the device, or it fails.
    pub fn draw(&mut self, full: [u32; 2], moving: bool) -> Result<(), RenderError> {
        let size = self.pace.size(full, moving);
        if !self.session.changes.picture && self.last.as_ref().is_some_and(|last| last.size == size) {
            return Ok(());
        }
        // What fails once would fail at every frame.
        self.session.changes.picture = false;
        self.session.upload(&mut self.renderer)?;
        let start = Instant::now();
        let stats = self.renderer.render(&self.session.view(size), &self.session.look.settings)?;
        let time = start.elapsed();
        self.pace.took(size, time);
        self.last = Some(Drawn { size, time, stats });
        Ok(())
    }

    /// The last picture.
    #[must_use]
    pub fn picture(&self) -> Option<&wgpu::Texture> {
        self.renderer.shown().filter(|_| self.last.is_some())
    }

    /// The picture at `size` pixels: RGBA, rows from top to bottom.
    ///
    /// # Errors
    /// As [`Self::draw`].
    pub fn still(&mut self, size: [u32; 2]) -> Result<Vec<u8>, RenderError> {
        self.session.upload(&mut self.renderer)?;
        let picture = self.renderer.picture(&self.session.view(size), &self.session.look.settings);
        // The targets have changed.
        self.session.touch();
        Ok(picture?.0.rgba8)
    }
}
