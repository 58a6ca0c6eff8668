//! One view, drawn in every way and judged.

use super::light::{LightReport, TechniqueReport};
use super::variants::Variant;
use crate::console;
use crate::error::Error;
use crate::input::Shot;
use indicatif::ProgressBar;
use std::time::Instant;
use zfail_oracle::{CastTable, Oracle, Truth};
use zfail_plan::topology::Topology;
use zfail_plan::view::View;
use zfail_render::{AovKind, Aovs, RenderError, Renderer};

/// What was found.
pub struct Examined {
    pub lights: Vec<LightReport>,
    /// By light that shines.
    pub truths: Vec<Truth>,
    /// By variant.
    pub images: Vec<Aovs>,
}

impl Examined {
    /// Whether nothing is wrong.
    pub fn passes(&self) -> bool {
        self.lights.iter().flat_map(|light| &light.techniques).all(TechniqueReport::passes)
    }

    /// The lights that shone.
    pub fn shone(&self) -> impl Iterator<Item = usize> {
        self.lights.iter().map(|light| light.judged.light)
    }
}

/// Judges views of one scene.
pub struct Judge<'a> {
    pub oracle: &'a Oracle,
    pub topologies: &'a [Option<Topology>],
    pub progress: &'a ProgressBar,
}

impl Judge<'_> {
    /// Draws the view in every way, and casts rays for every light: a step of progress each.
    ///
    /// # Errors
    /// If the device fails.
    pub fn examine(&self, renderer: &mut Renderer<'_>, shot: &Shot, variants: &[Variant]) -> Result<Examined, Error> {
        self.progress.set_message("rendering");
        let mut images = Vec::with_capacity(variants.len());
        for variant in variants {
            images.push(draw(renderer, shot, variant)?);
            self.progress.inc(1);
        }
        self.progress.set_message("casting rays");
        let (mut truths, mut lights) = (Vec::new(), Vec::new());
        for (i, &light) in shot.lights.iter().enumerate() {
            let truth = truth(self.oracle, shot, &shot.view, self.topologies, light);
            lights.push(LightReport::new(&shot.scene, light, &truth, variants, &images, i)?);
            truths.push(truth);
            self.progress.inc(1);
        }
        Ok(Examined { lights, truths, images })
    }

    /// Measures on a small picture how long rays will take, says so if it is long, and gives up if it is too long.
    ///
    /// # Errors
    /// If it would take more than half an hour.
    pub fn foresee(&self, shot: &Shot, quiet: bool) -> Result<(), Error> {
        const SCALE: u32 = 8;
        let Some(&light) = shot.lights.first() else { return Ok(()) };
        let size = shot.view.size.map(|side| side.div_ceil(SCALE));
        let start = Instant::now();
        let casts = CastTable::double(&shot.scene);
        let _truth = self.oracle.judge(&View { size, ..shot.view }, &shot.scene.lights[light], &casts);
        let pixels = |[width, height]: [u32; 2]| f64::from(width) * f64::from(height);
        let share = pixels(shot.view.size) / pixels(size);
        match foreseen(start.elapsed().as_secs_f64() * share * shot.lights.len() as f64) {
            Foreseen::Soon => Ok(()),
            Foreseen::Long(notice) => {
                console::notices(&[notice], quiet);
                Ok(())
            }
            Foreseen::TooLong(why) => Err(Error::failed(why)),
        }
    }
}

/// What is to be said of so many seconds of rays.
enum Foreseen {
    Soon,
    Long(String),
    TooLong(String),
}

fn foreseen(seconds: f64) -> Foreseen {
    const LONG: f64 = 30.0;
    const TOO_LONG: f64 = 1800.0;
    let remedy = "a smaller --size or fewer lights (--light N) take less";
    let minutes = (seconds / 60.0).ceil();
    match seconds {
        s if s > TOO_LONG => {
            Foreseen::TooLong(format!("the rays of this picture would take about {minutes} minutes; {remedy}"))
        }
        s if s > LONG => Foreseen::Long(format!("the rays of this picture take about {minutes} min; {remedy}")),
        _ => Foreseen::Soon,
    }
}

/// Masks and counts of the lights that shine.
pub fn draw(renderer: &mut Renderer<'_>, shot: &Shot, variant: &Variant) -> Result<Aovs, RenderError> {
    renderer.aovs(&shot.view, &variant.settings(&shot.lights), &[AovKind::Shadow, AovKind::Stencil])
}

/// What is right for a light.
pub fn truth(oracle: &Oracle, shot: &Shot, view: &View, topologies: &[Option<Topology>], light: usize) -> Truth {
    let castings = shot.scene.castings(topologies, light);
    let casts = CastTable::from_fn(&shot.scene, |instance, triangle| castings[instance][triangle].into());
    oracle.judge(view, &shot.scene.lights[light], &casts)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_takes_long_is_said_before() {
        assert!(matches!(foreseen(5.0), Foreseen::Soon));
        assert!(matches!(foreseen(90.0), Foreseen::Long(text) if text.contains("2 min") && text.contains("--size")));
        assert!(
            matches!(foreseen(1e5), Foreseen::TooLong(text) if text.contains("1667 minutes") && text.contains("--light"))
        );
        assert!(matches!(foreseen(f64::NAN), Foreseen::Soon));
    }
}
