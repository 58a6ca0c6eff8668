//! What one frame yields, and its files.
//!
//! In: a renderer and a view. Out: the bytes of the picture and of the files beside it.

use super::args::Args;
use super::files::AovFiles;
use super::overlays::Overlays;
use crate::console;
use crate::error::Error;
use crate::output::{Format, encode};
use indicatif::ProgressBar;
use zfail_plan::view::View;
use zfail_render::{AovKind, Aovs, FrameStats, Picture, Renderer, Settings};

/// A rendered frame.
pub struct Results {
    picture: Picture,
    stats: FrameStats,
    aovs: Aovs,
}

impl Results {
    /// Renders the picture and whatever else is asked for, a step of `progress` each; with `counts` figures have fragments.
    ///
    /// # Errors
    /// If the renderer or the device fails.
    pub fn new(
        renderer: &mut Renderer<'_>,
        overlays: Option<&mut Overlays<'_>>,
        view: &View,
        settings: &Settings,
        aovs: &[AovFiles],
        counts: bool,
        progress: &ProgressBar,
    ) -> Result<Self, Error> {
        let (mut picture, mut stats) = renderer.picture(view, settings)?;
        if counts {
            renderer.count_fragments(&mut stats)?;
        }
        if let Some(overlays) = overlays {
            overlays.draw(renderer, view, &mut picture)?;
        }
        progress.inc(1);
        let kinds: Vec<AovKind> = aovs.iter().map(|aov| aov.kind).collect();
        let aovs = match &kinds[..] {
            [] => Aovs::default(),
            kinds => renderer.aovs(view, settings, kinds)?,
        };
        progress.inc(1);
        Ok(Self { picture, stats, aovs })
    }

    /// The pixels of the picture's file as bytes.
    pub fn pixels(&self, format: Format) -> Vec<u8> {
        format.pixels(&self.picture)
    }

    /// The files beside the picture, in the order of [`super::destinations::Destinations::sides`].
    ///
    /// # Errors
    /// If an encoder refuses.
    pub fn sides(&self, args: &Args) -> Result<Vec<Vec<u8>>, Error> {
        let mut sides = Vec::new();
        for aov in &args.aovs {
            sides.extend(aov_files(aov, &self.aovs)?);
        }
        if args.stats.is_some() {
            sides.push(stats_file(&self.stats)?);
        }
        Ok(sides)
    }
}

/// The file of one AOV, or its files, one per light.
fn aov_files(aov: &AovFiles, aovs: &Aovs) -> Result<Vec<Vec<u8>>, Error> {
    let size = aovs.size;
    let masks = |masks: &[Vec<u8>]| masks.iter().map(|mask| encode::png_grey(size, mask)).collect();
    let exr = |values: &[[f32; 3]]| encode::exr_rgb(size, &encode::rgb32f(values.iter().copied()), None);
    let file = match (aov.kind, aov.format) {
        (AovKind::Shadow, _) => return masks(&aovs.shadow),
        (AovKind::Stencil, _) => return masks(&aovs.stencil),
        (AovKind::Depth, _) => encode::exr_scalar(size, &aovs.depth)?,
        (AovKind::Position, _) => exr(&aovs.position)?,
        (AovKind::Normal, Format::Exr) => exr(&aovs.normal)?,
        (AovKind::Normal, Format::Png) => encode::png_rgb(size, aovs.normal.iter().map(|n| n.map(|c| 0.5 * c + 0.5)))?,
        (AovKind::Albedo, Format::Exr) => exr(&aovs.albedo)?,
        (AovKind::Albedo, Format::Png) => {
            encode::png_rgb(size, aovs.albedo.iter().map(|a| a.map(encode::srgb_from_linear)))?
        }
    };
    Ok(vec![file])
}

fn stats_file(stats: &FrameStats) -> Result<Vec<u8>, Error> {
    Ok(console::json(stats)?.into_bytes())
}
