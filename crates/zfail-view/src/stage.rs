//! A session on the device.
//!
//! In: a [`Session`]. Out: its picture as a texture at the pace that the device can keep, or at any size as pixels, which
//! are those of `zfail render`.

use crate::pace::Pace;
use crate::session::{Look, Session};
use std::time::{Duration, Instant};
use zfail_figures::{Figures, Options};
use zfail_plan::view::View;
use zfail_render::{FrameStats, Gpu, RenderError, Renderer};

/// Why there is no picture.
#[derive(Debug, thiserror::Error)]
#[error(transparent)]
pub enum StageError {
    /// The renderer has none.
    Render(#[from] RenderError),
    /// An overlay cannot be drawn on it.
    Figures(#[from] zfail_figures::Error),
}

/// A session with its renderer.
#[derive(Debug)]
pub struct Stage<'g> {
    gpu: &'g Gpu,
    /// What is shown.
    pub session: Session,
    renderer: Renderer<'g>,
    /// Once there has been an overlay.
    figures: Option<Figures<'g>>,
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
    pub fn new(gpu: &'g Gpu, session: Session) -> Result<Self, StageError> {
        let renderer = Renderer::new(gpu, &session.scene)?;
        Ok(Self { gpu, session, renderer, figures: None, last: None, pace: Pace::default() })
    }

    /// Draws the picture that is to be shown at `full` pixels, if it is not the one that is there.
    ///
    /// # Errors
    /// If the settings do not fit the device, or it fails.
    pub fn draw(&mut self, full: [u32; 2], moving: bool) -> Result<(), StageError> {
        let size = self.pace.size(full, moving);
        if !self.session.changes.picture && self.last.as_ref().is_some_and(|last| last.size == size) {
            return Ok(());
        }
        // What fails once would fail at every frame.
        self.session.changes.picture = false;
        self.upload()?;
        let start = Instant::now();
        let view = self.session.view(size);
        let mut stats = self.renderer.render(&view, &self.session.look.settings)?;
        self.annotate(&view)?;
        let time = start.elapsed();
        // Off the clock; and where it would slow motion down, only when that has ended.
        if !moving || self.gpu.info.device_type != wgpu::DeviceType::Cpu {
            self.renderer.count_fragments(&mut stats)?;
        }
        self.pace.took(size, time);
        self.last = Some(Drawn { size, time, stats });
        Ok(())
    }

    /// The last picture.
    #[must_use]
    pub fn picture(&self) -> Option<&wgpu::Texture> {
        self.renderer.shown().filter(|_| self.last.is_some())
    }

    /// The picture at `size` pixels, as every run of `zfail render --view` makes it: RGBA, rows from top to bottom.
    ///
    /// # Errors
    /// As [`Self::draw`].
    pub fn still(&self, size: [u32; 2]) -> Result<Vec<u8>, StageError> {
        let Session { scene, look, .. } = &self.session;
        let view = self.session.view(size);
        // One that has drawn before was seen to round a few colours otherwise, in their last bit.
        let mut renderer = Renderer::new(self.gpu, scene)?;
        let picture = renderer.picture(&view, &look.settings.clone().repeatable())?.0;
        match renderer.shown().filter(|_| !look.overlays.is_empty()) {
            None => Ok(picture.rgba8),
            Some(shown) => {
                annotate(&mut Figures::new(self.gpu, scene)?, look, &view, shown)?;
                Ok(self.gpu.read_texture(shown)?)
            }
        }
    }

    /// Brings renderer and figures up to date with the session.
    fn upload(&mut self) -> Result<(), StageError> {
        let changes = self.session.changes;
        self.session.upload(&mut self.renderer)?;
        if let Some(figures) = &mut self.figures {
            if changes.casting {
                figures.set_scene(&self.session.scene)?;
            }
            if changes.lights {
                figures.set_lights(&self.session.scene.lights);
            }
            if changes.pose {
                figures.set_pose(self.session.pose())?;
            }
        }
        Ok(())
    }

    /// Draws the overlays over the picture of `view`.
    fn annotate(&mut self, view: &View) -> Result<(), StageError> {
        let look = &self.session.look;
        let Some(picture) = self.renderer.shown().filter(|_| !look.overlays.is_empty()) else { return Ok(()) };
        let figures = match &mut self.figures {
            Some(figures) => figures,
            none => none.insert(Figures::new(self.gpu, &self.session.scene)?),
        };
        annotate(figures, look, view, picture)
    }
}

/// Draws the overlays of `look` over `picture`.
fn annotate(figures: &mut Figures<'_>, look: &Look, view: &View, picture: &wgpu::Texture) -> Result<(), StageError> {
    let options = Options { technique: look.settings.technique, ..Options::default() };
    Ok(figures.draw(&look.overlays, view, &options, picture)?)
}
