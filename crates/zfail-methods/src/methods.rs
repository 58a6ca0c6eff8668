//! A scene on the device, to be shadowed by any method.

use crate::{Error, Method, Options, Shadow, Unavailable};
use zfail_plan::scene::Scene;
use zfail_plan::view::View;
use zfail_render::Gpu;

/// A scene on the device, ready to be shadowed by any method.
#[derive(Debug)]
pub struct Methods<'g> {
    gpu: &'g Gpu,
}

impl<'g> Methods<'g> {
    /// Uploads `scene`.
    ///
    /// # Errors
    /// If the scene is inconsistent or the device runs out of memory.
    pub fn new(gpu: &'g Gpu, _scene: &Scene) -> Result<Self, Error> {
        Ok(Self { gpu })
    }

    /// What light number `light` reaches in `view`, according to `method`.
    ///
    /// # Errors
    /// If the method is not available, on this device or under this view; if there is no such light; if the device fails.
    pub fn shadow(&mut self, method: Method, _view: &View, _light: usize, _options: &Options) -> Result<Shadow, Error> {
        self.gpu.check()?;
        self.availability(method)?;
        Err(Unavailable { method, reason: "it is being built".to_owned() }.into())
    }

    /// Whether the device can run `method`.
    ///
    /// # Errors
    /// What it lacks.
    pub fn availability(&self, method: Method) -> Result<(), Unavailable> {
        Err(Unavailable { method, reason: "it is being built".to_owned() })
    }
}
