//! `zfail gallery`: every built-in scene as a file, with a picture from each of its cameras and a page of them all.

mod page;

use crate::console;
use crate::error::{Error, chain};
use crate::groups::{Device, Size, Verbosity, parse_samples};
use crate::output::{self, Outputs, encode};
use page::Page;
use std::path::PathBuf;
use zfail_builtin::Entry;
use zfail_files::write;
use zfail_render::{Gpu, Renderer, Settings};
use zfail_scene::{Scene, cut};

/// `zfail gallery`
#[derive(clap::Args, Debug)]
pub struct Args {
    /// Folder for NAME.glb, NAME-CAMERA.png and index.html; made if it is missing.
    #[arg(value_name = "DIR")]
    folder: PathBuf,
    /// Size of the pictures in pixels.
    #[arg(long, value_name = "WxH", default_value = "1280x720", value_parser = Size::parse)]
    size: Size,
    /// Samples per pixel.
    #[arg(long, value_name = "1|4", default_value = "4", value_parser = parse_samples)]
    samples: u32,
    #[command(flatten)]
    device: Device,
    #[command(flatten)]
    verbosity: Verbosity,
}

/// Renders everything, then writes everything.
///
/// # Errors
/// If the folder cannot be written or the device fails.
pub fn run(args: &Args) -> Result<(), Error> {
    output::check_folder(&args.folder)?;
    let gpu = args.device.open()?;
    let scenes: Vec<(&Entry, Scene)> =
        zfail_builtin::SCENES.iter().filter_map(|entry| Some((entry, zfail_builtin::scene(entry.name)?))).collect();

    let pictures = scenes.iter().map(|(_, scene)| scene.cameras.len()).sum();
    let progress = console::progress(pictures, args.verbosity.quiet);
    let mut outputs = Outputs::default();
    let mut page = Page::default();
    for (Entry { name, description }, scene) in &scenes {
        progress.set_message(*name);
        let glb = write::to_glb(scene).map_err(|e| Error::failed(format!("{name}: {}", chain(&e))))?;
        outputs.add(args.folder.join(format!("{name}.glb")), glb);
        page.scene(name, description, scene);
        // The file keeps its masks.
        let mut cut = scene.clone();
        cut::cut_masked(&mut cut, 1.0, cut::Limits::default());
        for (camera, bytes) in photograph(&gpu, &cut, args, &progress)? {
            let file = picture_name(name, &camera, scene.cameras.len());
            page.picture(&file, &camera);
            outputs.add(args.folder.join(file), bytes);
        }
    }
    outputs.add(args.folder.join("index.html"), page.finish().into_bytes());
    outputs.commit()
}

/// The picture of each camera with the camera's name.
fn photograph(
    gpu: &Gpu,
    scene: &Scene,
    args: &Args,
    progress: &indicatif::ProgressBar,
) -> Result<Vec<(String, Vec<u8>)>, Error> {
    let settings = Settings { samples: args.samples, ..Settings::default() };
    let bounds = scene.bounds();
    let mut renderer = Renderer::new(gpu, scene)?;
    let mut pictures = Vec::new();
    for camera in &scene.cameras {
        let view = camera.view(args.size.0, &bounds);
        let (picture, _) = renderer.picture(&view, &settings)?;
        pictures.push((camera.name.clone(), encode::png_picture(picture.size, &encode::rgb8(&picture.rgba8), None)?));
        progress.inc(1);
    }
    Ok(pictures)
}

/// `SCENE.png`, or `SCENE-CAMERA.png` where there are several cameras.
fn picture_name(scene: &str, camera: &str, cameras: usize) -> String {
    if cameras == 1 {
        return format!("{scene}.png");
    }
    let plain = |c: char| if c.is_ascii_alphanumeric() { c.to_ascii_lowercase() } else { '-' };
    format!("{scene}-{}.png", camera.chars().map(plain).collect::<String>())
}

#[cfg(test)]
mod tests {
    use super::picture_name;

    #[test]
    fn pictures_are_named_after_scene_and_camera() {
        assert_eq!(picture_name("hall", "Main view", 1), "hall.png");
        assert_eq!(picture_name("hall", "Main view", 2), "hall-main-view.png");
    }
}
