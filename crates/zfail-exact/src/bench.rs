//! Renders a recipe, asks the oracle, and compares both masks and counts.

use crate::recipe::Recipe;
use zfail_oracle::{CastTable, Guards, Oracle, Report, SizeMismatch, Truth};
use zfail_plan::topology::TopologyError;
use zfail_plan::view::View;
use zfail_render::{AovKind, Aovs, Gpu, RenderError, Renderer, Settings};
use zfail_scene::Scene;

/// A scene that could not be compared.
#[derive(Debug, thiserror::Error)]
pub enum BenchError {
    /// The renderer failed.
    #[error(transparent)]
    Render(#[from] RenderError),
    /// The renderer's image has the wrong size.
    #[error(transparent)]
    Size(#[from] SizeMismatch),
    /// A mesh of the scene is invalid.
    #[error(transparent)]
    Topology(#[from] TopologyError),
    /// The renderer gave fewer images than there are lights.
    #[error("no image for light {0}")]
    Missing(usize),
}

/// One light's comparison.
#[derive(Clone, Debug)]
pub struct Comparison {
    /// Which light.
    pub light: usize,
    /// Masks.
    pub mask: Report,
    /// Counts modulo 256.
    pub count: Report,
}

impl Comparison {
    /// Whether any pixel is wrong.
    #[must_use]
    pub fn failed(&self) -> bool {
        !self.mask.wrong.is_empty() || !self.count.wrong.is_empty()
    }
}

/// What the renderer made of a recipe, and what is right.
#[derive(Clone, Debug)]
pub struct Images {
    /// Masks and counts of the renderer.
    pub rendered: Aovs,
    /// The truth per light.
    pub truths: Vec<Truth>,
}

impl Images {
    /// Compares every light.
    ///
    /// # Errors
    /// If images are missing or of the wrong size.
    pub fn compare(&self) -> Result<Vec<Comparison>, BenchError> {
        let image = |images: &[Vec<u8>], light: usize| images.get(light).cloned().ok_or(BenchError::Missing(light));
        let compare = |(light, truth): (usize, &Truth)| {
            let mask = truth.compare_mask(&image(&self.rendered.shadow, light)?)?;
            let count = truth.compare_count(&image(&self.rendered.stencil, light)?)?;
            Ok(Comparison { light, mask, count })
        };
        self.truths.iter().enumerate().map(compare).collect()
    }

    /// Writes pictures of one light's mask and counts and of where they are wrong, to look at; says where.
    #[must_use]
    pub fn keep(&self, name: &str, comparison: &Comparison) -> String {
        let light = comparison.light;
        let size = self.truths[light].size;
        let marks = |report: &Report| {
            let mut marks = vec![0; (size[0] * size[1]) as usize];
            report.wrong.iter().for_each(|wrong| marks[(wrong.y * size[0] + wrong.x) as usize] = 255);
            marks
        };
        let (mask, count) = (marks(&comparison.mask), marks(&comparison.count));
        let rendered = [&self.rendered.shadow[light], &self.rendered.stencil[light]];
        let pictures: [(&str, &[u8]); 4] =
            [("mask", rendered[0]), ("mask-wrong", &mask), ("counts", rendered[1]), ("counts-wrong", &count)];
        zfail_testing::keep(&format!("{name}-light-{light}"), size, &pictures)
    }

    /// Compares every light, as [`Self::compare`] does, and keeps the pictures of those that are wrong.
    ///
    /// # Errors
    /// If something cannot be compared, or is wrong: then with where the pictures are.
    pub fn judge(&self, name: &str) -> Result<Vec<Comparison>, String> {
        let comparisons = self.compare().map_err(|error| format!("{name}: {error}"))?;
        match comparisons.iter().find(|comparison| comparison.failed()) {
            None => Ok(comparisons),
            Some(wrong) => {
                let [masks, counts] = [&wrong.mask, &wrong.count].map(|report| report.wrong.len());
                let kept = self.keep(name, wrong);
                Err(format!("{name}, light {}: {masks} wrong verdicts, {counts} wrong counts; {kept}", wrong.light))
            }
        }
    }
}

/// Renders `recipe` and judges it.
///
/// # Errors
/// If the renderer fails.
pub fn images(gpu: &Gpu, recipe: &Recipe, settings: &Settings) -> Result<Images, BenchError> {
    let scene = recipe.scene();
    let rendered = render(gpu, &scene, &recipe.view, settings)?;
    Ok(Images { rendered, truths: truths(&scene, &recipe.view)? })
}

/// Masks and counts of every light of `scene`.
///
/// # Errors
/// If the renderer fails.
pub fn render(gpu: &Gpu, scene: &Scene, view: &View, settings: &Settings) -> Result<Aovs, BenchError> {
    Ok(Renderer::new(gpu, scene)?.aovs(view, settings, &[AovKind::Shadow, AovKind::Stencil])?)
}

/// The truth for every light of `scene`.
///
/// # Errors
/// If a mesh of the scene is invalid.
pub fn truths(scene: &Scene, view: &View) -> Result<Vec<Truth>, BenchError> {
    truths_with(scene, view, Guards::default())
}

/// The truth for every light of `scene`, under the given guards.
///
/// # Errors
/// If a mesh of the scene is invalid.
pub fn truths_with(scene: &Scene, view: &View, guards: Guards) -> Result<Vec<Truth>, BenchError> {
    let oracle = Oracle::with_guards(scene, guards);
    let topologies = scene.topologies()?;
    let judge = |(l, light)| {
        let castings = scene.castings(&topologies, l);
        oracle.judge(view, light, &CastTable::from_fn(scene, |i, t| castings[i][t].into()))
    };
    Ok(scene.lights.iter().enumerate().map(judge).collect())
}
