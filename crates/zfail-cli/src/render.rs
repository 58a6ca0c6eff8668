//! `zfail render`: one frame of a scene as files.

use crate::args::{self, Aov, Format};
use crate::console;
use crate::encode;
use crate::error::Error;
use crate::input;
use crate::output::{self, Outputs};
use std::collections::HashSet;
use std::path::{Path, PathBuf};
use zfail_render::{AovKind, Aovs, FrameStats, Picture, RenderError, Renderer, Settings};

/// Checks everything that can be checked, renders, encodes, and only then writes.
///
/// # Errors
/// If an argument names nothing in the scene, the scene or the device fails, or a file cannot be written.
pub fn run(args: &args::Render) -> Result<(), Error> {
    check_outputs(args)?;
    let mut scene = input::at_moment(input::complete(&args.scene.scene)?, &args.moment)?;
    scene.blended_casts = args.blended_shadows;
    console::notices(&scene.notices, args.verbosity.quiet);
    let view = input::camera(&scene, &args.camera)?.view(args.size.0, &scene.bounds());
    let lights = input::lights(&scene, &args.lights)?;
    let settings = Settings {
        technique: args.technique,
        samples: args.samples,
        shadows: !args.no_shadows,
        lights: Some(lights.clone()),
        exposure: args.exposure,
        terminator: args.terminator,
        ..Settings::default()
    };

    let progress = console::progress(4, args.verbosity.quiet || args.aovs.is_empty());
    let gpu = input::gpu(&args.device)?;
    let mut renderer = Renderer::new(&gpu, &scene).map_err(|e| failed(&e))?;
    progress.inc(1);
    progress.set_message("rendering the picture");
    let (picture, stats) = renderer.picture(&view, &settings).map_err(|e| failed(&e))?;
    progress.inc(1);
    progress.set_message("rendering the other results");
    let kinds: Vec<AovKind> = args.aovs.iter().map(|aov| aov.kind).collect();
    let aovs =
        if kinds.is_empty() { None } else { Some(renderer.aovs(&view, &settings, &kinds).map_err(|e| failed(&e))?) };
    progress.inc(1);
    progress.set_message("writing");

    let mut outputs = Outputs::default();
    outputs.add(&args.output.path, encode_picture(&picture, args.output.format)?);
    for aov in &args.aovs {
        add_aov(&mut outputs, aov, aovs.as_ref().unwrap_or(&Aovs::default()), &lights)?;
    }
    if let Some(path) = &args.stats {
        outputs.add(path, encode_stats(&stats)?);
    }
    outputs.commit()
}

/// The picture as the bytes of a file.
///
/// # Errors
/// If the encoder refuses.
pub fn encode_picture(picture: &Picture, format: Format) -> Result<Vec<u8>, Error> {
    match format {
        Format::Png => encode::png_picture(picture.size, &picture.rgba8),
        Format::Exr => encode::exr_rgb(picture.size, picture.hdr.iter().copied()),
    }
}

/// What the renderer says, as the program says it.
pub fn failed(error: &RenderError) -> Error {
    Error::failed(input::chain(error))
}

/// Finds destinations that cannot be written or that would overwrite each other, before any work is done.
fn check_outputs(args: &args::Render) -> Result<(), Error> {
    let mut taken = HashSet::new();
    let files =
        [Some(args.output.path.as_path()), args.stats.as_deref()].into_iter().flatten().map(|file| (file, false));
    let aovs = args.aovs.iter().map(|aov| (aov.path.as_path(), aov.is_folder()));
    for (path, is_folder) in files.chain(aovs) {
        if is_folder {
            output::check_folder(path)?;
        } else {
            output::check_file(path)?;
        }
        if !taken.insert(resolved(path)) {
            let twice = format!("'{}' is named for two results; give each its own name", path.display());
            return Err(Error::usage(twice));
        }
    }
    Ok(())
}

/// The same path for all spellings of one place, as far as it exists.
fn resolved(path: &Path) -> PathBuf {
    let mut missing = Vec::new();
    for ancestor in path.ancestors() {
        let here = if ancestor.as_os_str().is_empty() { Path::new(".") } else { ancestor };
        if let Ok(existing) = here.canonicalize() {
            return missing.iter().rev().fold(existing, |path, name| path.join(name));
        }
        missing.extend(ancestor.file_name());
    }
    path.to_owned()
}

/// Adds the files of one AOV; `lights[i]` is the number that the i-th mask's light has in the scene.
fn add_aov(outputs: &mut Outputs, aov: &Aov, aovs: &Aovs, lights: &[usize]) -> Result<(), Error> {
    let size = aovs.size;
    let mut add_masks = |masks: &[Vec<u8>]| {
        lights.iter().zip(masks).try_for_each(|(light, mask)| {
            outputs.add(aov.path.join(format!("light-{light}.png")), encode::png_grey(size, mask)?);
            Ok(())
        })
    };
    let bytes = match (aov.kind, aov.format) {
        (AovKind::Shadow, _) => return add_masks(&aovs.shadow),
        (AovKind::Stencil, _) => return add_masks(&aovs.stencil),
        (AovKind::Depth, _) => encode::exr_scalar(size, &aovs.depth)?,
        (AovKind::Position, _) => encode::exr_rgb(size, aovs.position.iter().copied())?,
        (AovKind::Normal, Format::Exr) => encode::exr_rgb(size, aovs.normal.iter().copied())?,
        (AovKind::Normal, Format::Png) => encode::png_rgb(size, aovs.normal.iter().map(|n| n.map(|c| 0.5 * c + 0.5)))?,
        (AovKind::Albedo, Format::Exr) => encode::exr_rgb(size, aovs.albedo.iter().copied())?,
        (AovKind::Albedo, Format::Png) => {
            encode::png_rgb(size, aovs.albedo.iter().map(|a| a.map(encode::srgb_from_linear)))?
        }
    };
    outputs.add(&aov.path, bytes);
    Ok(())
}

fn encode_stats(stats: &FrameStats) -> Result<Vec<u8>, Error> {
    let mut json =
        serde_json::to_vec_pretty(stats).map_err(|e| Error::failed(format!("cannot encode the stats: {e}")))?;
    json.push(b'\n');
    Ok(json)
}
