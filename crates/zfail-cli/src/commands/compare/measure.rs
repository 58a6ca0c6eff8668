//! What each method says, and how far that is from the truth.
//!
//! In: a scene, a camera, lights. Out: per method its mask of every light, wrong pixels and cost; or why it does not run.

use crate::error::Error;
use crate::input::Shot;
use indicatif::ProgressBar;
use zfail_methods::{Error as MethodError, Figures, Method, Methods, Options};
use zfail_oracle::{CastTable, Oracle, Truth};
use zfail_render::Gpu;

/// A scene, ready for every method, with what is right.
pub struct Course<'a> {
    gpu: &'a Gpu,
    shot: &'a Shot,
    options: Options,
    /// Per light that shines.
    pub truths: Vec<Truth>,
}

/// One method.
pub struct Entry {
    /// Which.
    pub method: Method,
    /// What it has given.
    pub outcome: Outcome,
}

/// What a method has given.
pub enum Outcome {
    /// Masks of all lights.
    Drawn(Drawn),
    /// Why there are none.
    Missing(String),
}

/// Masks of all lights.
pub struct Drawn {
    /// Per light that shines.
    pub masks: Vec<Vec<u8>>,
    /// Per light that shines, how many verdicts are wrong.
    pub wrong: Vec<usize>,
    /// Of all lights together.
    pub figures: Figures,
}

impl<'a> Course<'a> {
    /// Asks the oracle, a step of `progress` for each light.
    pub fn new(gpu: &'a Gpu, shot: &'a Shot, options: Options, progress: &ProgressBar) -> Self {
        progress.set_message("casting rays");
        let oracle = Oracle::new(&shot.scene);
        // Only verdicts are compared, and they do not depend on the weights.
        let casts = CastTable::double(&shot.scene);
        let truth = |&light: &usize| {
            progress.inc(1);
            oracle.judge(&shot.view, &shot.scene.lights[light], &casts)
        };
        let truths = shot.lights.iter().map(truth).collect();
        Self { gpu, shot, options, truths }
    }

    /// Runs every one of `chosen` on every light, each a step of `progress`.
    ///
    /// # Errors
    /// If the device fails, or the scene is inconsistent.
    pub fn run(&self, chosen: &[Method], progress: &ProgressBar) -> Result<Vec<Entry>, Error> {
        let mut methods = Methods::new(self.gpu, &self.shot.scene)?;
        let mut entries = Vec::with_capacity(chosen.len());
        for &method in chosen {
            progress.set_message(method.name());
            let outcome = match self.draw(&mut methods, method, progress) {
                Ok(drawn) => Outcome::Drawn(drawn),
                Err(MethodError::Unavailable(why)) => Outcome::Missing(why.reason),
                Err(e) => return Err(e.into()),
            };
            entries.push(Entry { method, outcome });
        }
        Ok(entries)
    }

    fn draw(&self, methods: &mut Methods<'_>, method: Method, progress: &ProgressBar) -> Result<Drawn, MethodError> {
        let mut drawn = Drawn { masks: Vec::new(), wrong: Vec::new(), figures: Figures::default() };
        for (&light, truth) in self.shot.lights.iter().zip(&self.truths) {
            let shadow = methods.shadow(method, &self.shot.view, light, &self.options)?;
            // A mask of the wrong size is wrong everywhere.
            let wrong = truth.compare_mask(&shadow.mask).map_or(truth.pixels.len(), |report| report.wrong.len());
            drawn.wrong.push(wrong);
            drawn.masks.push(shadow.mask);
            add(&mut drawn.figures, &shadow.figures);
            progress.inc(1);
        }
        Ok(drawn)
    }
}

fn add(sum: &mut Figures, of_light: &Figures) {
    sum.triangles += of_light.triangles;
    sum.vertices += of_light.vertices;
    sum.fragments += of_light.fragments;
    sum.passes += of_light.passes;
    sum.planning_ms += of_light.planning_ms;
    sum.render_ms += of_light.render_ms;
}
